#include "log.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

void time_text(char *text)
{
    struct timespec now;
    struct tm parts;
    clock_gettime(CLOCK_REALTIME, &now);
    gmtime_r(&now.tv_sec, &parts);
    const size_t length = strftime(text, 28, "%Y-%m-%dT%H:%M:%S", &parts);
    snprintf(text + length, 28 - length, ".%03uZ", (unsigned)(now.tv_nsec / 1000000) % 1000U);
}

double monotonic_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void log_line(const char *format, ...)
{
    char line[1024];
    time_text(line);
    size_t length = strlen(line);
    line[length++] = ' ';
    va_list arguments;
    va_start(arguments, format);
    const int written = vsnprintf(line + length, sizeof line - length - 1, format, arguments);
    va_end(arguments);
    if (written > 0) length += (size_t)written < sizeof line - length - 1 ? (size_t)written : sizeof line - length - 2;
    line[length++] = '\n';
    /* One write a line: lines of several threads never mix. A log that can't be written is no reason to stop. */
    const ssize_t ignored = write(STDERR_FILENO, line, length);
    (void)ignored;
}
