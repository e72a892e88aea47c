#include "worker_memory.h"

#include <errno.h>
#include <jansson.h>
#include <signal.h>
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

void worker_memory_end(void)
{
    static const char words[] = "warning: a library was refused memory\n";
    const ssize_t ignored = write(STDERR_FILENO, words, sizeof words - 1);
    (void)ignored;
    _exit(WORKER_MACHINE);
}

/* HDF5 may crash while it cleans up after memory that it was refused. Whose fault a crash is, the last error of its thread
 * tells; any other keeps its signal. Only async-signal-safe calls. */
static void end_of_a_crash(int number)
{
    if (errno == ENOMEM) worker_memory_end();
    signal(number, SIG_DFL);
    raise(number);
}

static void watch_crashes(void)
{
    static const int crashes[] = { SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL };
    static char stack[65536]; /* the usual one may be what can't grow */
    struct sigaction before, action = { .sa_handler = end_of_a_crash, .sa_flags = SA_ONSTACK };
    sigaltstack(&(stack_t){ .ss_sp = stack, .ss_size = sizeof stack }, NULL);
    for (size_t k = 0; k < sizeof crashes / sizeof crashes[0]; k++)
        if (sigaction(crashes[k], NULL, &before) == 0 && before.sa_handler == SIG_DFL) sigaction(crashes[k], &action, NULL);
}

void worker_memory_watch(void)
{
    json_set_alloc_funcs(allocate, free);
    atexit(end_of_a_library);
    watch_crashes();
}

bool worker_memory_was_short(void) { return was_short; }
