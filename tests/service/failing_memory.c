/* To be preloaded: lets one allocation of the program reposed fail, as where memory is short, and counts all of them in the file
 * FAILING_MEMORY, int64 that can be read and set while the program runs:
 *
 *   made     allocations since this was last set to 0
 *   failing  the first of them that fails; 0: none
 *   failures how many fail from there on
 *   alive    pieces of memory that are not yet given back */
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

typedef struct memory_counts {
    _Atomic int64_t made, failing, failures, alive;
} memory_counts;
static memory_counts nowhere, *counts = &nowhere;

__attribute__((constructor)) static void open_counts(void)
{
    char path[4096] = "";
    const char *name = getenv("FAILING_MEMORY");
    if (!name || readlink("/proc/self/exe", path, sizeof path - 1) < 0 || strcmp(strrchr(path, '/'), "/reposed") != 0) return;
    const int file = open(name, O_RDWR);
    if (file < 0) abort();
    counts = mmap(NULL, sizeof nowhere, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (counts == MAP_FAILED) abort();
    close(file);
}

static bool fails(void)
{
    const int64_t number = atomic_fetch_add(&counts->made, 1) + 1, first = counts->failing;
    if (first == 0 || number < first || number >= first + counts->failures) return false;
    errno = ENOMEM;
    return true;
}

static void *counted(void *memory)
{
    if (memory) atomic_fetch_add(&counts->alive, 1);
    return memory;
}

/* The C library's own, by the names that it has for them beside the usual ones. */
void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t bytes);
void *__libc_realloc(void *memory, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);
void __libc_free(void *memory);

void *malloc(size_t bytes) { return fails() ? NULL : counted(__libc_malloc(bytes)); }
void *calloc(size_t count, size_t bytes) { return fails() ? NULL : counted(__libc_calloc(count, bytes)); }
void *aligned_alloc(size_t alignment, size_t bytes) { return fails() ? NULL : counted(__libc_memalign(alignment, bytes)); }
int posix_memalign(void **memory, size_t alignment, size_t bytes)
{
    *memory = aligned_alloc(alignment, bytes);
    return *memory ? 0 : ENOMEM;
}
void *realloc(void *memory, size_t bytes)
{
    if (fails()) return NULL;
    void *grown = __libc_realloc(memory, bytes);
    return memory ? grown : counted(grown);
}
void free(void *memory)
{
    if (memory) atomic_fetch_sub(&counts->alive, 1);
    __libc_free(memory);
}
