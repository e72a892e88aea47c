#include "log.h"

#include <stdarg.h>
#include <stdbool.h>
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

double unix_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static _Atomic bool as_json;
static _Thread_local char request[LOG_REQUEST_SIZE];

void log_as_json(bool json) { as_json = json; }

void log_set_request(const char *id) { snprintf(request, sizeof request, "%s", id); }

/* One write a line: lines of several threads never mix. A log that can't be written is no reason to stop. */
static void write_line(char *line, size_t length)
{
    line[length++] = '\n';
    const ssize_t ignored = write(STDERR_FILENO, line, length);
    (void)ignored;
}

/* facts: members of the object, with their comma before; "": none. */
static void write_json(const char *message, const char *facts)
{
    char time[28], line[3000];
    time_text(time);
    size_t length = (size_t)snprintf(line, sizeof line, "{\"time\":\"%s\",\"message\":\"", time);
    for (const unsigned char *c = (const unsigned char *)message; *c && length < sizeof line - 900; c++) {
        if (*c == '"' || *c == '\\') line[length++] = '\\';
        if (*c < 0x20) length += (size_t)snprintf(line + length, 8, "\\u%04x", *c);
        else line[length++] = (char)*c;
    }
    length += (size_t)snprintf(line + length, sizeof line - length - 2, "\"%s%s%s%.600s}", request[0] ? ",\"request\":\"" : "",
                               request, request[0] ? "\"" : "", facts);
    write_line(line, length);
}

void log_line(const char *format, ...)
{
    char line[1024];
    va_list arguments;
    time_text(line);
    size_t length = strlen(line);
    line[length++] = ' ';
    if (as_json) length = 0;
    va_start(arguments, format);
    const int written = vsnprintf(line + length, sizeof line - length - 1, format, arguments);
    va_end(arguments);
    if (written > 0) length += (size_t)written < sizeof line - length - 1 ? (size_t)written : sizeof line - length - 2;
    line[length] = '\0';
    if (as_json) write_json(line, "");
    else write_line(line, length);
}

/* The method and the path have plain characters alone (http_guard.c); what has others was refused before it had a path. */
void log_request(const char *method, const char *path, int status, double seconds)
{
    char facts[600];
    if (!as_json) {
        if (status >= 500) log_line("%s %s: answered %d%s%s", method, path, status, request[0] ? "; request " : "", request);
        return;
    }
    const bool is_plain = path[strcspn(path, "\"\\")] == '\0' && method[strcspn(method, "\"\\")] == '\0';
    snprintf(facts, sizeof facts, ",\"method\":\"%.16s\",\"path\":\"%.300s\",\"status\":%d,\"seconds\":%.6f",
             is_plain ? method : "?", is_plain ? path : "?", status, seconds);
    write_json("answered", facts);
}
