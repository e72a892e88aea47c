#include "end_signals.h"

#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include "log.h"

/* Both are set once; take last. */
static void *hangup_context;
static void (*_Atomic hangup_take)(void *context);

void end_signals_on_hangup(void (*take)(void *context), void *context)
{
    hangup_context = context;
    hangup_take = take;
}

typedef struct watch {
    sigset_t ends;
    double seconds;
    int descriptor;
} watch;

/* Sudden, but nothing is lost: that is what the store is made for, and workers die with the daemon. */
static void *run(void *context)
{
    const watch *w = context;
    const uint64_t one = 1;
    int number;
    for (;;) {
        if (sigwait(&w->ends, &number) != 0) continue;
        if (number != SIGHUP || !hangup_take) break;
        hangup_take(hangup_context);
    }
    const ssize_t ignored = write(w->descriptor, &one, sizeof one);
    (void)ignored;
    struct timespec left = { .tv_sec = (time_t)w->seconds };
    while (nanosleep(&left, &left) != 0 && errno == EINTR) continue;
    log_line("leaving at once: something hangs, or the disk can't be written");
    _exit(0);
}

bool end_signals_watch(const sigset_t *ends, double seconds, int *descriptor)
{
    static watch only;
    only = (watch){ .ends = *ends, .seconds = seconds, .descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK) };
    pthread_t thread;
    *descriptor = only.descriptor;
    const bool is_open = only.descriptor >= 0;
    const int problem = is_open ? pthread_create(&thread, NULL, run, &only) : errno;
    if (is_open && problem == 0) return pthread_detach(thread) == 0;
    log_line("signals can't be watched: %s", strerror(problem));
    return false;
}
