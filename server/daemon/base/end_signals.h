/* The signals that end the daemon, taken by a thread of their own: whatever the other threads hang in, the process is gone a
 * bounded time later. */
#ifndef END_SIGNALS_H
#define END_SIGNALS_H

#include <signal.h>
#include <stdbool.h>

/* Starts the thread. ends: blocked in all threads. When one of them comes, `descriptor` becomes readable, and the process is
 * ended after `seconds` unless it has ended by then. False: no memory, descriptor or thread for it. */
bool end_signals_watch(const sigset_t *ends, double seconds, int *descriptor);
/* From then on SIGHUP ends nothing, but has this called in that thread. */
void end_signals_on_hangup(void (*take)(void *context), void *context);

#endif
