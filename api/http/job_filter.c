/* Which jobs a list is of: the query parameters of GET /jobs. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "handlers.h"
#include "process_type.h"

enum { JOBS_DEFAULT_LIMIT = 50, JOBS_HIGHEST_LIMIT = 500, LONGEST_TEXT = 100 };

typedef struct filter_reading {
    job_filter *filter;
    char *problem;
    size_t size;
} filter_reading;

static bool take_status(void *context, const char *value, size_t length)
{
    const filter_reading *reading = context;
    job_status status;
    if (job_status_parse(value, length, &status)) {
        reading->filter->statuses |= 1U << status;
        return true;
    }
    snprintf(reading->problem, reading->size,
             "parameter status is \"%.*s\"; must be accepted, running, successful, failed or dismissed, or several of them",
             (int)(length < 40 ? length : 40), value);
    return false;
}

/* A process that there is not has no jobs. */
static bool take_process(void *context, const char *value, size_t length)
{
    const filter_reading *reading = context;
    reading->filter->by_process = true;
    for (size_t p = 0; process_types[p]; p++)
        if (strlen(process_types[p]->name) == length && strncmp(process_types[p]->name, value, length) == 0)
            reading->filter->processes |= 1U << p;
    return true;
}

/* All jobs are of type process; there are none of another. */
static bool take_type(void *context, const char *value, size_t length)
{
    const filter_reading *reading = context;
    reading->filter->by_type = true;
    if (length == strlen("process") && strncmp(value, "process", length) == 0) reading->filter->type_is_process = true;
    return true;
}

/* --- times --- */

static bool read_digits(const char **at, int count, int low, int high, int *number)
{
    *number = 0;
    for (int i = 0; i < count; i++, ++*at) {
        if (!isdigit((unsigned char)**at)) return false;
        *number = 10 * *number + (**at - '0');
    }
    return *number >= low && *number <= high;
}

static bool skip(const char **at, const char *any)
{
    if (!**at || !strchr(any, **at)) return false;
    ++*at;
    return true;
}

/* ".25": ms, and how many ms a step in the last digit that counts is. */
static bool read_fraction(const char **at, int64_t *ms, int64_t *step)
{
    if (!skip(at, ".")) return true;
    if (!isdigit((unsigned char)**at)) return false;
    int64_t unit = 1000;
    for (; isdigit((unsigned char)**at); ++*at) {
        if (unit == 1) continue; /* finer than jobs' times are */
        unit /= 10;
        *ms += (**at - '0') * unit;
    }
    *step = unit;
    return true;
}

/* "Z" or "+02:00": s that the clock there is ahead. A + in a query is a space. */
static bool read_zone(const char **at, int64_t *ahead)
{
    int hours, minutes;
    *ahead = 0;
    if (skip(at, "Zz")) return true;
    const bool west = **at == '-';
    if (!skip(at, "+- ") || !read_digits(at, 2, 0, 23, &hours) || !skip(at, ":") || !read_digits(at, 2, 0, 59, &minutes))
        return false;
    *ahead = (west ? -1 : 1) * (3600 * hours + 60 * minutes);
    return true;
}

/* RFC 3339: a time, or a date alone. In ms since 1970: its beginning, and that of the next day, second, ... */
static bool read_instant(const char *text, size_t length, int64_t *from, int64_t *until)
{
    char copy[64];
    int year, month, day, hour = 0, minute = 0, second = 0;
    int64_t ms = 0, step = 86400000, ahead = 0;
    if (length >= sizeof copy) return false;
    snprintf(copy, sizeof copy, "%.*s", (int)length, text);
    const char *at = copy;
    if (!read_digits(&at, 4, 1, 9999, &year) || !skip(&at, "-") || !read_digits(&at, 2, 1, 12, &month) || !skip(&at, "-")
        || !read_digits(&at, 2, 1, 31, &day))
        return false;
    if (*at) {
        step = 1000;
        if (!skip(&at, "Tt ") || !read_digits(&at, 2, 0, 23, &hour) || !skip(&at, ":") || !read_digits(&at, 2, 0, 59, &minute)
            || !skip(&at, ":") || !read_digits(&at, 2, 0, 60, &second) || !read_fraction(&at, &ms, &step)
            || !read_zone(&at, &ahead))
            return false;
    }
    struct tm parts = {
        .tm_year = year - 1900, .tm_mon = month - 1, .tm_mday = day, .tm_hour = hour, .tm_min = minute, .tm_sec = second
    };
    *from = 1000 * ((int64_t)timegm(&parts) - ahead) + ms;
    *until = *from + step;
    return *at == '\0' && parts.tm_mon == month - 1; /* timegm makes March of the 30th of February */
}

/* As jobs' times are written, so that texts compare as times do. */
static void write_time(int64_t ms, char text[JOB_TIME_SIZE])
{
    const time_t second = (time_t)((ms - (ms % 1000 + 1000) % 1000) / 1000);
    struct tm parts;
    gmtime_r(&second, &parts);
    if (parts.tm_year + 1900 < 0 || parts.tm_year + 1900 > 9999) { /* of a zone at the edge of the years */
        snprintf(text, JOB_TIME_SIZE, "%s", ms < 0 ? "0" : "9999-12-31T23:59:59.999Z");
        return;
    }
    const size_t length = strftime(text, JOB_TIME_SIZE, "%Y-%m-%dT%H:%M:%S", &parts);
    snprintf(text + length, JOB_TIME_SIZE - length, ".%03dZ", (int)((ms % 1000 + 1000) % 1000));
}

static bool is_open_end(const char *text, size_t length) { return length == 0 || (length == 2 && strncmp(text, "..", 2) == 0); }

/* An instant, or two with a slash between of which either may be "..": of a job's creation. */
static bool read_datetime(const char *text, job_filter *filter)
{
    const char *slash = text ? strchr(text, '/') : NULL;
    int64_t from = INT64_MIN, until = INT64_MAX, unused;
    if (!text) return true;
    if (!slash) {
        if (!read_instant(text, strlen(text), &from, &until)) return false;
    } else {
        const size_t length = (size_t)(slash - text), rest = strlen(slash + 1);
        if (!is_open_end(text, length) && !read_instant(text, length, &from, &unused)) return false;
        if (!is_open_end(slash + 1, rest) && !read_instant(slash + 1, rest, &unused, &until)) return false;
        if (from >= until || (from == INT64_MIN && until == INT64_MAX && length + rest == 0)) return false;
    }
    if (from != INT64_MIN) write_time(from, filter->created_from);
    if (until != INT64_MAX) write_time(until, filter->created_before);
    return true;
}

static bool read_duration(const http_request *request, const char *name, double *seconds, char *problem, size_t size)
{
    const char *text = http_request_parameter(request, name);
    char *end;
    *seconds = NAN;
    if (!text) return true;
    if (isdigit((unsigned char)*text) && strspn(text, "0123456789.eE+-") == strlen(text)) {
        *seconds = strtod(text, &end);
        if (!*end && isfinite(*seconds)) return true;
    }
    snprintf(problem, size, "parameter %s is \"%.40s\"; must be a number of seconds, 0 or more", name, text);
    return false;
}

/* Of UTF-8: bytes that do not go on with a character. */
static size_t characters_of(const char *text)
{
    size_t count = 0;
    for (; *text; text++) count += ((unsigned char)*text & 0xC0) != 0x80;
    return count;
}

/* label.project=axial: the one that is given. */
static bool read_label(const http_request *request, job_filter *filter, char *problem, size_t size)
{
    static const char beginning[] = "label.";
    for (size_t p = 0; p < request->parameter_count; p++) {
        const http_parameter *one = &request->parameter[p];
        if (strncmp(one->name, beginning, strlen(beginning)) != 0) continue;
        if (filter->label_name) {
            snprintf(problem, size, "parameter %.40s is given beside label.%.40s; give one member of the label", one->name,
                     filter->label_name);
            return false;
        }
        filter->label_name = one->name + strlen(beginning);
        filter->label_value = one->value;
        if (*filter->label_name) continue;
        snprintf(problem, size, "parameter label. names no member of the label; for example label.project=axial");
        return false;
    }
    return true;
}

bool read_job_filter(const http_request *request, job_filter *filter, char *problem, size_t size)
{
    filter_reading reading = { filter, problem, size };
    filter->text = http_request_parameter(request, "q");
    filter->study = http_request_parameter(request, "study");
    if (filter->text && characters_of(filter->text) > LONGEST_TEXT) {
        snprintf(problem, size, "parameter q has %zu characters; must have at most %d", characters_of(filter->text), LONGEST_TEXT);
        return false;
    }
    const char *datetime = http_request_parameter(request, "datetime");
    if (!read_datetime(datetime, filter)) {
        snprintf(problem, size,
                 "parameter datetime is \"%.70s\"; must be a time as 2026-11-22T01:44:55Z, or two with / between, the earlier "
                 "first, either of which may be ..",
                 datetime);
        return false;
    }
    if (!read_label(request, filter, problem, size) || !http_request_values(request, "status", take_status, &reading)
        || !http_request_values(request, "processID", take_process, &reading)
        || !http_request_values(request, "type", take_type, &reading)
        || !read_duration(request, "minDuration", &filter->least_seconds, problem, size)
        || !read_duration(request, "maxDuration", &filter->most_seconds, problem, size)
        || !http_request_integer(request, "limit", 1, INT64_MAX, JOBS_DEFAULT_LIMIT, &filter->limit, problem, size)
        || !http_request_integer(request, "cursor", 1, INT64_MAX, 0, &filter->before, problem, size))
        return false;
    /* More than are sent at once is no mistake: the next page has the rest. */
    if (filter->limit > JOBS_HIGHEST_LIMIT) filter->limit = JOBS_HIGHEST_LIMIT;
    return true;
}
