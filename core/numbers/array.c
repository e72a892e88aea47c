/* Memory for wide loops. */
#define _DEFAULT_SOURCE /* madvise */
#include <malloc.h>
#include <sys/mman.h>

#include "real.h"

enum { HUGE_PAGE = 1 << 21, LARGE = 2 * HUGE_PAGE };

/* Behind an array, what the processor fetches ahead of whoever works on its end: else that is the beginning of another array,
 * which it takes from the thread that works there. */
enum { FETCHED_AHEAD = 2048 };

void arrays_prepare(void)
{
    mallopt(M_MMAP_THRESHOLD, LARGE);
    mallopt(M_TRIM_THRESHOLD, 2 * LARGE);
}

void *array_create(size_t count, size_t size)
{
    if (size && count > (SIZE_MAX - HUGE_PAGE - FETCHED_AHEAD) / size) return NULL;
    const size_t alignment = count * size < LARGE ? ALIGNMENT : HUGE_PAGE;
    const size_t bytes = (count * size + FETCHED_AHEAD + alignment - 1) / alignment * alignment;
    void *memory = aligned_alloc(alignment, bytes);
    if (!memory) return NULL;
    /* Thousands of spheres apart from each other are read at once: with small pages their addresses miss. If there are no huge
     * pages, it is as it was. */
    if (alignment == HUGE_PAGE) madvise(memory, bytes, MADV_HUGEPAGE);
    memset(memory, 0, bytes);
    return memory;
}
