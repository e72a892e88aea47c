#include "worker_log.h"

#include <stdarg.h>
#include <stdio.h>
#include <time.h>

static bool only_warnings;

void worker_log_only_warnings(bool only) { only_warnings = only; }

static void write_line(const char *level, const char *format, va_list arguments)
{
    char stamp[32], line[1200];
    struct timespec now;
    struct tm utc;
    clock_gettime(CLOCK_REALTIME, &now);
    gmtime_r(&now.tv_sec, &utc);
    strftime(stamp, sizeof stamp, "%Y-%m-%dT%H:%M:%S", &utc);
    vsnprintf(line, sizeof line, format, arguments);
    fprintf(stderr, "%s.%03ldZ %s%s\n", stamp, now.tv_nsec / 1000000, level, line);
}

void worker_log(const char *format, ...)
{
    if (only_warnings) return;
    va_list arguments;
    va_start(arguments, format);
    write_line("", format, arguments);
    va_end(arguments);
}

void worker_warn(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_line("warning: ", format, arguments);
    va_end(arguments);
}
