/* Memory for wide loops. */
#define _DEFAULT_SOURCE /* madvise */
#include "array.h"

#include <malloc.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "real.h"

enum { HUGE_PAGE = 1 << 21, LARGE = 2 * HUGE_PAGE };

/* Bytes of padding behind each array. The hardware prefetcher reads past the end of an array; without the padding it would fetch the
 * beginning of another one, and so take cache lines away from the thread that writes there. */
enum { FETCHED_AHEAD = 2048 };

void arrays_prepare(void)
{
    mallopt(M_MMAP_THRESHOLD, LARGE);
    mallopt(M_TRIM_THRESHOLD, 2 * LARGE);
}

static _Thread_local bool was_refused;

void arrays_begin(void) { was_refused = false; }

void arrays_refused(void) { was_refused = true; }

dem_status arrays_end(dem_status status) { return status == DEM_OK && was_refused ? DEM_NO_MEMORY : status; }

static void *refuse(void)
{
    arrays_refused();
    return NULL;
}

void *array_create(size_t count, size_t size)
{
    if (size && count > (SIZE_MAX - HUGE_PAGE - FETCHED_AHEAD) / size) return refuse();
    const size_t alignment = count * size < LARGE ? ALIGNMENT : HUGE_PAGE;
    const size_t bytes = (count * size + FETCHED_AHEAD + alignment - 1) / alignment * alignment;
    void *memory = aligned_alloc(alignment, bytes);
    if (!memory) return refuse();
    /* A step reads thousands of scattered spheres, which with small pages would miss the TLB. Where the kernel has no huge pages, the
     * memory is as useful without. */
    if (alignment == HUGE_PAGE) madvise(memory, bytes, MADV_HUGEPAGE);
    memset(memory, 0, bytes);
    return memory;
}
