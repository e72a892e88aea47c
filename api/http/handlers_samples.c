/* Samples thinned for a plot: of each of so many stretches the least and the largest of every column that is asked for, so that no peak
 * is lost, however many samples there are. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"

enum { MOST_COLUMNS = 32, MOST_POINTS = 10000, LONGEST_NAME = 64, MOST_NUMBERS = 8 << 20, MOST_BYTES = 64 << 20 };

typedef struct sample_place {
    int64_t number, step;
    double time;
    bool is_kept;
} sample_place;

typedef struct thinning {
    char column[MOST_COLUMNS][LONGEST_NAME];
    size_t columns, rows, room;
    bool chooses, is_too_much, no_memory;
    char unknown[LONGEST_NAME]; /* a column that no sample has; "": there is none */
    sample_place *place;        /* (rows) */
    double *value;              /* (rows, columns); NaN: not known */
} thinning;

static bool take_column(void *context, const char *name, size_t length)
{
    thinning *t = context;
    if (t->columns == MOST_COLUMNS || length >= LONGEST_NAME) return false;
    snprintf(t->column[t->columns++], LONGEST_NAME, "%.*s", (int)length, name);
    return true;
}

/* All measures of the first sample, where none is chosen. */
static void learn_columns(thinning *t, json_t *values)
{
    const char *name;
    json_t *value;
    json_object_foreach(values, name, value)
    {
        if (!t->chooses && strcmp(name, "time") != 0) take_column(t, name, strlen(name));
    }
    for (size_t c = 0; c < t->columns; c++)
        if (!json_object_get(values, t->column[c])) memcpy(t->unknown, t->column[c], sizeof t->unknown);
}

static bool grow(thinning *t)
{
    const size_t room = 2 * t->room + 1024;
    sample_place *place = realloc(t->place, room * sizeof *place);
    if (place) t->place = place;
    double *value = place ? realloc(t->value, room * (t->columns + 1) * sizeof *value) : NULL;
    if (value) t->value = value;
    t->room = value ? room : t->room;
    return value != NULL;
}

static bool take_sample(void *context, const sample_row *row)
{
    thinning *t = context;
    json_t *values = json_loads(row->measures, 0, NULL);
    if (t->rows == 0) learn_columns(t, values);
    t->is_too_much = (t->rows + 1) * (t->columns + 4) > MOST_NUMBERS;
    t->no_memory = !t->is_too_much && t->rows == t->room && !grow(t);
    const bool goes_on = !t->unknown[0] && !t->is_too_much && !t->no_memory;
    if (goes_on) {
        t->place[t->rows] = (sample_place){ row->number, row->step, row->time, false };
        for (size_t c = 0; c < t->columns; c++) {
            const json_t *value = json_object_get(values, t->column[c]);
            t->value[t->rows * t->columns + c] = json_is_number(value) ? json_number_value(value) : NAN;
        }
        t->rows++;
    }
    json_decref(values);
    return goes_on;
}

/* Of the rows from begin to end. */
static void keep_extremes(thinning *t, size_t column, size_t begin, size_t end)
{
    size_t least = end, largest = end;
    for (size_t i = begin; i < end; i++) {
        const double value = t->value[i * t->columns + column];
        if (isnan(value)) continue;
        if (least == end || value < t->value[least * t->columns + column]) least = i;
        if (largest == end || value > t->value[largest * t->columns + column]) largest = i;
    }
    if (least < end) t->place[least].is_kept = t->place[largest].is_kept = true;
}

static void thin(thinning *t, int64_t points)
{
    const size_t stretches = points > 1 ? (size_t)points / 2 : 1, n = t->rows;
    const bool all = n <= (size_t)points;
    for (size_t i = 0; i < n; i++) t->place[i].is_kept = all || i == 0 || i == n - 1;
    for (size_t s = 0; !all && s < stretches; s++)
        for (size_t c = 0; c < t->columns; c++) keep_extremes(t, c, s * n / stretches, (s + 1) * n / stretches);
}

static void add_value(text_buffer *out, double value, const char *if_unknown)
{
    if (isnan(value)) text_buffer_print(out, "%s", if_unknown);
    else text_buffer_add_number(out, value);
}

static void add_json(const thinning *t, text_buffer *out)
{
    const char *between = "";
    text_buffer_print(out, "{\"of\":%zu,\"samples\":[", t->rows);
    for (size_t i = 0; i < t->rows; i++) {
        const sample_place *place = &t->place[i];
        if (!place->is_kept) continue;
        text_buffer_print(out, "%s{\"number\":%lld,\"step\":%lld,\"time\":", between, (long long)place->number,
                          (long long)place->step);
        text_buffer_add_number(out, place->time);
        text_buffer_print(out, ",\"values\":{");
        for (size_t c = 0; c < t->columns; c++) {
            if (c > 0) text_buffer_print(out, ",");
            text_buffer_add_json_string(out, t->column[c], strlen(t->column[c]));
            text_buffer_print(out, ":");
            add_value(out, t->value[i * t->columns + c], "null");
        }
        text_buffer_print(out, "}}");
        between = ",";
    }
}

static void add_csv(const thinning *t, text_buffer *out)
{
    text_buffer_print(out, "number,step,time");
    for (size_t c = 0; c < t->columns; c++) {
        text_buffer_print(out, ",");
        text_buffer_add_csv_field(out, t->column[c], strlen(t->column[c]));
    }
    text_buffer_print(out, "\r\n");
    for (size_t i = 0; i < t->rows; i++) {
        const sample_place *place = &t->place[i];
        if (!place->is_kept) continue;
        text_buffer_print(out, "%lld,%lld,", (long long)place->number, (long long)place->step);
        text_buffer_add_number(out, place->time);
        for (size_t c = 0; c < t->columns; c++) {
            text_buffer_print(out, ",");
            add_value(out, t->value[i * t->columns + c], "");
        }
        text_buffer_print(out, "\r\n");
    }
}

static void respond(const thinning *t, const http_request *request, http_response *response)
{
    const bool csv = wants_csv(request);
    text_buffer out;
    text_buffer_init(&out, MOST_BYTES);
    name_file(response, request->segment[0], csv ? "-samples.csv" : "-samples.json", csv);
    if (csv) add_csv(t, &out);
    else add_json(t, &out);
    if (!csv)
        text_buffer_print(&out, "],\"links\":[{\"rel\":\"self\",\"type\":\"application/json\",\"href\":\"%s/jobs/%s/samples\"}]}",
                          response->base, request->segment[0]);
    if (!out.failed) {
        http_respond_text(response, 200, csv ? "text/csv; charset=utf-8" : "application/json", out.text, out.length);
        return;
    }
    text_buffer_clear(&out);
    respond_store_failure(response, STORE_FAILED, "thin the samples");
}

/* False: the response says what is wrong. */
static bool read_query(thinning *t, const http_request *request, http_response *response, int64_t *after, int64_t *points)
{
    char problem[160] = "these columns are too many, or one has too long a name";
    if (http_request_integer(request, "points", 2, MOST_POINTS, MOST_POINTS, points, problem, sizeof problem)
        && http_request_integer(request, "after", -1, INT64_MAX, -1, after, problem, sizeof problem)
        && http_request_values(request, "columns", take_column, t)) {
        t->chooses = t->columns > 0;
        return true;
    }
    http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
    return false;
}

static void thin_and_respond(api_service *service, thinning *t, const http_request *request, http_response *response)
{
    int64_t after, points;
    if (!read_query(t, request, response, &after, &points)) return;
    const store_status status = store_list_samples(service->store, request->segment[0], after, INT64_MAX, take_sample, t);
    if (t->unknown[0]) {
        http_respond_problem(response, 400, NULL, "Bad parameter",
                             "no sample has a column \"%s\"; /jobs/%s/samples?limit=1 shows those that "
                             "there are",
                             t->unknown, request->segment[0]);
    } else if (t->is_too_much) {
        http_respond_problem(response, 400, NULL, "Bad parameter",
                             "these are more numbers than are thinned at once: ask for fewer columns, or for a part by after");
    } else if (status != STORE_OK || t->no_memory) {
        respond_store_failure(response, STORE_FAILED, "read the samples");
    } else {
        thin(t, points);
        respond(t, request, response);
    }
}

void respond_thinned_samples(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    response->wants_lane = !request->in_lane; /* all samples are read */
    if (response->wants_lane || !find_job(service, request, response, &job)) return;
    job_record_clear(&job);
    thinning *t = calloc(1, sizeof *t);
    if (t) thin_and_respond(service, t, request, response);
    else respond_store_failure(response, STORE_FAILED, "read the samples");
    if (t) {
        free(t->place);
        free(t->value);
    }
    free(t);
}
