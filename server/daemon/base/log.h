/* One line an event on stderr, with the time in UTC. */
#ifndef LOG_H
#define LOG_H

#include <stddef.h>

void log_line(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* "2026-11-22T01:44:55.123Z"; text has room for 28. */
void time_text(char *text);
/* Seconds of a clock that never jumps. */
double monotonic_seconds(void);

#endif
