/* One line an event on stderr, with the time in UTC: text, or JSON. */
#ifndef LOG_H
#define LOG_H

#include <stdbool.h>
#include <stddef.h>

/* Whether lines are JSON objects from now on: time, message, and the id of the request that this thread answers, where it does. */
void log_as_json(bool json);
/* The request that the calling thread answers from now on; "": none. The id is copied. */
enum { LOG_REQUEST_SIZE = 65 };
void log_set_request(const char *id);
/* A request that was answered; told where lines are JSON, and where it failed by our fault. */
void log_request(const char *method, const char *path, int status, double seconds);
void log_line(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* "2026-11-22T01:44:55.123Z"; text has room for 28. */
void time_text(char *text);
/* Seconds of a clock that never jumps. */
double monotonic_seconds(void);
/* Of the clock that people set, since 1970. */
double unix_seconds(void);

#endif
