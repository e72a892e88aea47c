#include "worker_memory.h"

#include <jansson.h>
#include <stdlib.h>
#include <unistd.h>

#include "job_folder.h"

static bool was_short;

static void *allocate(size_t size)
{
    void *memory = malloc(size);
    if (!memory && size > 0) was_short = true;
    return memory;
}

/* Our own ends leave by _exit. */
static void end_of_a_library(void) { _exit(WORKER_MACHINE); }

void worker_memory_watch(void)
{
    json_set_alloc_funcs(allocate, free);
    atexit(end_of_a_library);
}

bool worker_memory_was_short(void) { return was_short; }
