/* The worker's log: timestamped lines on stderr, which the daemon keeps as log.txt. */
#ifndef WORKER_LOG_H
#define WORKER_LOG_H

#include <stdbool.h>

/* With a progress line on the same terminal, only warnings are worth the space. */
void worker_log_only_warnings(bool only_warnings);

void worker_log(const char *format, ...) __attribute__((format(printf, 1, 2)));
void worker_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
