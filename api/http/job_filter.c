/* Which jobs a list is of: the query parameters of GET /jobs. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "handlers.h"
#include "list_columns.h"

enum { JOBS_DEFAULT_LIMIT = 50, JOBS_HIGHEST_LIMIT = 500, LONGEST_TEXT = 100 };

typedef struct filter_reading {
    const http_request *request;
    job_filter *filter;
    problem_list *problems;
} filter_reading;

static bool take_status(void *context, const char *value, size_t length)
{
    const filter_reading *reading = context;
    job_status status;
    if (job_status_parse(value, length, &status)) {
        reading->filter->statuses |= 1U << status;
        return true;
    }
    problem_list_add(reading->problems, "/status",
                     "parameter status is \"%.*s\"; must be accepted, running, successful, failed or dismissed, or several of them",
                     (int)(length < 40 ? length : 40), value);
    return true;
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

static void read_duration(const filter_reading *reading, const char *name, const char *pointer, double *seconds)
{
    const char *text = http_request_parameter(reading->request, name);
    char *end;
    *seconds = NAN;
    if (!text) return;
    if (isdigit((unsigned char)*text) && strspn(text, "0123456789.eE+-") == strlen(text)) {
        *seconds = strtod(text, &end);
        if (!*end && isfinite(*seconds)) return;
    }
    problem_list_add(reading->problems, pointer, "parameter %s is \"%.40s\"; must be a number of seconds, 0 or more", name, text);
}

static void read_times(const filter_reading *reading)
{
    const char *datetime = http_request_parameter(reading->request, "datetime");
    if (!read_datetime(datetime, reading->filter))
        problem_list_add(reading->problems, "/datetime",
                         "parameter datetime is \"%.70s\"; must be a time as 2026-11-22T01:44:55Z, or two with / between, the "
                         "earlier first, either of which may be ..",
                         datetime);
    read_duration(reading, "minDuration", "/minDuration", &reading->filter->least_seconds);
    read_duration(reading, "maxDuration", "/maxDuration", &reading->filter->most_seconds);
}

/* --- texts --- */

/* Of UTF-8: bytes that do not go on with a character. */
static size_t characters_of(const char *text)
{
    size_t count = 0;
    for (; *text; text++) count += ((unsigned char)*text & 0xC0) != 0x80;
    return count;
}

static void read_text(const filter_reading *reading)
{
    const char *text = http_request_parameter(reading->request, "q");
    reading->filter->text = text;
    if (text && characters_of(text) > LONGEST_TEXT)
        problem_list_add(reading->problems, "/q", "parameter q has %zu characters; must have at most %d", characters_of(text),
                         LONGEST_TEXT);
}

/* What a parameter's name has behind its beginning; NULL: it begins otherwise. */
static const char *name_behind(const http_parameter *one, const char *beginning)
{
    const size_t length = strlen(beginning);
    return strncmp(one->name, beginning, length) == 0 ? one->name + length : NULL;
}

/* label.project=axial: the one that is given. */
static void read_label(const filter_reading *reading, const http_parameter *one)
{
    job_filter *filter = reading->filter;
    const char *name = name_behind(one, "label.");
    if (!name) return;
    if (filter->label_name)
        problem_list_add(reading->problems, "/label.", "parameter %.40s is given beside label.%.40s; give one member of the label",
                         one->name, filter->label_name);
    else if (!*name)
        problem_list_add(reading->problems, "/label.",
                         "parameter label. names no member of the label; for example label.project=axial");
    filter->label_name = name;
    filter->label_value = one->value;
}

/* --- columns --- */

static bool find_column(const filter_reading *reading, const field_columns *columns, const char *parameter, const char *name,
                        list_column *found)
{
    if (list_column_find(columns, name, found)) return true;
    const char *nearest = list_column_nearest(columns, name);
    problem_list_add(reading->problems, parameter, "parameter %s: no column is named \"%.60s\"%s%s; GET /query lists all columns",
                     parameter + 1, name, nearest ? "; perhaps it is " : "", nearest ? nearest : "");
    return false;
}

static bool read_number(const char *text, size_t length, double missing, double *number)
{
    char copy[64], *end;
    *number = missing;
    if (length == 0) return true;
    if (length >= sizeof copy || strspn(text, "0123456789.eE+-") < length) return false;
    snprintf(copy, sizeof copy, "%.*s", (int)length, text);
    *number = strtod(copy, &end);
    return *end == '\0' && end != copy && isfinite(*number);
}

/* "30..40", "30..", "..40" or "35". */
static bool read_range(const char *text, value_range *range)
{
    const char *dots = strstr(text, "..");
    if (!dots) {
        if (!*text || !read_number(text, strlen(text), 0.0, &range->low)) return false;
        range->high = range->low;
        return true;
    }
    return strlen(text) > 2 && read_number(text, (size_t)(dots - text), -INFINITY, &range->low)
           && read_number(dots + 2, strlen(dots + 2), INFINITY, &range->high) && range->low <= range->high;
}

static bool read_truth(const char *text, value_range *range)
{
    const bool is_true = strcmp(text, "true") == 0;
    range->low = range->high = is_true;
    return is_true || strcmp(text, "false") == 0;
}

/* value.angle_deg=30..40, value.shape=sphere,tetrahedron, value.steady=true */
static void read_value(const filter_reading *reading, const field_columns *columns, const http_parameter *one)
{
    static const char *const kinds[] = { [LIST_NUMBER] =
                                             "a number, or two with .. between, the lower first, either of which may be missing",
                                         [LIST_TIME] = "",
                                         [LIST_WORD] = "a word, or several with commas between them",
                                         [LIST_TRUTH] = "true or false" };
    job_filter *filter = reading->filter;
    const char *name = name_behind(one, "value.");
    char pointer[64];
    list_column column;
    if (!name) return;
    snprintf(pointer, sizeof pointer, "/%.60s", one->name);
    if (!find_column(reading, columns, pointer, name, &column)) return;
    value_range range = { .name = name, .words = column.kind == LIST_WORD ? one->value : NULL };
    if (column.kind == LIST_TIME)
        problem_list_add(reading->problems, pointer,
                         "parameter %.60s: of times datetime, minDuration and maxDuration are asked for", one->name);
    else if (filter->range_count == MOST_RANGES)
        problem_list_add(reading->problems, pointer, "parameter %.60s: at most %d parameters value. may be given", one->name,
                         MOST_RANGES);
    else if (column.kind == LIST_WORD    ? *one->value == '\0'
             : column.kind == LIST_TRUTH ? !read_truth(one->value, &range)
                                         : !read_range(one->value, &range))
        problem_list_add(reading->problems, pointer, "parameter %.60s is \"%.60s\"; must be %s%s%s", one->name, one->value,
                         kinds[column.kind], *column.unit ? ", in " : "", column.unit);
    else filter->range[filter->range_count++] = range;
}

/* sort=-angle_deg: the largest first. */
static void read_sort(const filter_reading *reading, const field_columns *columns)
{
    const char *sort = http_request_parameter(reading->request, "sort");
    list_column column;
    if (!sort) return;
    reading->filter->sort_falls = *sort == '-';
    reading->filter->sort = sort + (*sort == '-');
    if (find_column(reading, columns, "/sort", reading->filter->sort, &column))
        reading->filter->sort_is_words = column.kind == LIST_WORD;
}

/* "123", and in a sorted list "123:35.25", or "123:" where that job lacks what is sorted by. */
static void read_cursor(const filter_reading *reading)
{
    const char *cursor = http_request_parameter(reading->request, "cursor");
    job_filter *filter = reading->filter;
    double number;
    char *end;
    if (!cursor) return;
    const long long after = isdigit((unsigned char)*cursor) ? strtoll(cursor, &end, 10) : 0;
    const bool has_value = after > 0 && *end == ':';
    if (has_value && end[1]) filter->after_value = end + 1;
    filter->after = after;
    if (after > 0 && after < INT64_MAX && (has_value || !*end) && has_value == (filter->sort != NULL)
        && (!filter->after_value || filter->sort_is_words
            || read_number(filter->after_value, strlen(filter->after_value), 0.0, &number)))
        return;
    problem_list_add(reading->problems, "/cursor",
                     "parameter cursor is \"%.60s\"; must be what the link next of the last answer has, with the same sort",
                     cursor);
}

void read_job_filter(api_service *service, const http_request *request, job_filter *filter, problem_list *problems)
{
    filter_reading reading = { request, filter, problems };
    const field_columns *columns = store_columns(service->store);
    char problem[160];
    *filter = (job_filter){ .study = http_request_parameter(request, "study") };
    read_text(&reading);
    read_times(&reading);
    for (size_t p = 0; p < request->parameter_count; p++) {
        read_label(&reading, &request->parameter[p]);
        read_value(&reading, columns, &request->parameter[p]);
    }
    read_sort(&reading, columns);
    read_cursor(&reading);
    http_request_values(request, "status", take_status, &reading);
    http_request_values(request, "processID", take_process, &reading);
    http_request_values(request, "type", take_type, &reading);
    if (!http_request_integer(request, "limit", 1, INT64_MAX, JOBS_DEFAULT_LIMIT, &filter->limit, problem, sizeof problem))
        problem_list_add(problems, "/limit", "%s", problem);
    /* More than are sent at once is no mistake: the next page has the rest. */
    if (filter->limit > JOBS_HIGHEST_LIMIT) filter->limit = JOBS_HIGHEST_LIMIT;
}

void respond_bad_parameters(http_response *response, const problem_list *problems)
{
    text_buffer detail;
    text_buffer_init(&detail, 65536);
    size_t i;
    json_t *error;
    json_array_foreach(problems->errors, i, error)
        text_buffer_print(&detail, "%s%s", i ? "; " : "", json_string_value(json_object_get(error, "detail")));
    http_respond_problems(response, 400, "Bad parameter", detail.text && !detail.failed ? detail.text : "see errors", problems);
    text_buffer_clear(&detail);
}
