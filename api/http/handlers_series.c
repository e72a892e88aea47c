/* What a job gives over time: samples of its measures, and the list of its snapshots. Both come a page at a time; samples as CSV come
 * whole where no limit is asked for. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"
#include "http_accept.h"

enum { SERIES_LIMIT = 10000, SERIES_BYTES = 64 << 20, SAMPLES_IN_A_PIECE = 500 };

typedef struct series_page {
    text_buffer out;
    json_t *columns;       /* CSV alone: names of the measures, from the first row */
    const char *id, *base; /* base: of addresses */
    int64_t rows, limit, last;
    bool more;
} series_page;

/* Counts the row in; false: the page is full. */
static bool series_take(series_page *series, int64_t number)
{
    series->more = series->rows == series->limit;
    if (series->more) return false;
    series->rows++;
    series->last = number;
    return true;
}

/* end, is_attachment: of the file's name. */
static bool open_series(api_service *service, const http_request *request, http_response *response, series_page *series,
                        int64_t *after, const char *end, bool is_attachment)
{
    char problem[160];
    if (!http_request_integer(request, "after", -1, INT64_MAX, -1, after, problem, sizeof problem)
        || !http_request_integer(request, "limit", 1, SERIES_LIMIT, SERIES_LIMIT, &series->limit, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return false;
    }
    job_record job;
    if (!find_job(service, request, response, &job)) return false;
    job_record_clear(&job);
    series->id = request->segment[0];
    name_file(response, series->id, end, is_attachment);
    series->base = response->base;
    text_buffer_init(&series->out, SERIES_BYTES);
    return true;
}

static void close_series(series_page *series, http_response *response, store_status status, const char *type, const char *wanted)
{
    json_decref(series->columns);
    if (status == STORE_OK && !series->out.failed) {
        http_respond_text(response, 200, type, series->out.text, series->out.length);
        return;
    }
    text_buffer_clear(&series->out);
    respond_store_failure(response, status, wanted);
}

static void add_links(series_page *series, const char *name)
{
    text_buffer_print(&series->out, "],\"links\":[{\"rel\":\"self\",\"type\":\"application/json\",\"href\":\"%s/jobs/%s/%s\"}",
                      series->base, series->id, name);
    if (series->more)
        text_buffer_print(&series->out,
                          ",{\"rel\":\"next\",\"type\":\"application/json\",\"href\":\"%s/jobs/%s/%s?after=%lld&limit=%lld\"}",
                          series->base, series->id, name, (long long)series->last, (long long)series->limit);
    text_buffer_print(&series->out, "]}");
}

static bool add_sample_json(void *context, const sample_row *row)
{
    series_page *series = context;
    if (!series_take(series, row->number)) return false;
    text_buffer_print(&series->out, "%s{\"number\":%lld,\"step\":%lld,\"time\":", series->rows > 1 ? "," : "",
                      (long long)row->number, (long long)row->step);
    text_buffer_add_number(&series->out, row->time);
    text_buffer_print(&series->out, ",\"values\":%s}", row->measures);
    return true;
}

static void add_csv_header(series_page *series, json_t *values)
{
    series->columns = json_array();
    text_buffer_print(&series->out, "number,step,time");
    const char *name;
    json_t *value;
    json_object_foreach(values, name, value)
    {
        if (strcmp(name, "time") == 0) continue; /* the same as the row's */
        json_array_append_new(series->columns, json_string(name));
        text_buffer_print(&series->out, ",");
        text_buffer_add_csv_field(&series->out, name, strlen(name));
    }
    text_buffer_print(&series->out, "\r\n");
}

static bool add_sample_csv(void *context, const sample_row *row)
{
    series_page *series = context;
    if (!series_take(series, row->number)) return false;
    json_t *values = json_loads(row->measures, 0, NULL);
    if (!series->columns) add_csv_header(series, values);
    text_buffer_print(&series->out, "%lld,%lld,", (long long)row->number, (long long)row->step);
    text_buffer_add_number(&series->out, row->time);
    size_t i;
    json_t *name;
    json_array_foreach(series->columns, i, name)
    {
        const json_t *value = json_object_get(values, json_string_value(name));
        text_buffer_print(&series->out, ",");
        if (json_is_number(value)) text_buffer_add_number(&series->out, json_number_value(value));
    }
    text_buffer_print(&series->out, "\r\n");
    json_decref(values);
    return true;
}

bool wants_csv(const http_request *request)
{
    static const http_format formats[] = { { "json", "application/json" }, { "csv", "text/csv" } };
    return http_format_choose(request, formats, 2) == 1;
}

/* All samples as CSV, a piece at a time: what is in memory does not grow with the run. */
typedef struct sample_stream {
    series_page page;
    job_store *store;
    char id[JOB_ID_SIZE];
    int64_t after;
} sample_stream;

static bool add_piece(void *context, text_buffer *out)
{
    sample_stream *stream = context;
    series_page *page = &stream->page;
    page->rows = 0;
    page->out = *out; /* lent for this piece */
    const store_status status = store_list_samples(stream->store, stream->id, stream->after, page->limit, add_sample_csv, page);
    *out = page->out;
    if (page->rows > 0) stream->after = page->last;
    return status == STORE_OK && !out->failed;
}

static void free_sample_stream(void *context)
{
    sample_stream *stream = context;
    json_decref(stream->page.columns);
    free(stream);
}

static void stream_samples(api_service *service, const http_request *request, http_response *response, int64_t after)
{
    sample_stream *stream = calloc(1, sizeof *stream);
    text_buffer first;
    text_buffer_init(&first, SERIES_BYTES);
    text_buffer_add(&first, "", 0);
    if (stream) {
        stream->page.limit = SAMPLES_IN_A_PIECE;
        stream->store = service->store;
        stream->after = after;
        snprintf(stream->id, sizeof stream->id, "%.*s", JOB_ID_SIZE - 1, request->segment[0]);
    }
    if (!stream || !add_piece(stream, &first)) {
        if (stream) free_sample_stream(stream);
        text_buffer_clear(&first);
        respond_store_failure(response, STORE_FAILED, "read the samples");
        return;
    }
    response->pieces = (http_pieces){ add_piece, free_sample_stream, stream };
    http_respond_text(response, 200, "text/csv; charset=utf-8", first.text, first.length);
}

void list_samples(api_service *service, const http_request *request, http_response *response)
{
    series_page series = { 0 };
    int64_t after;
    const bool csv = wants_csv(request);
    if (http_request_parameter(request, "points") || http_request_parameter(request, "columns")) {
        respond_thinned_samples(service, request, response);
        return;
    }
    if (!open_series(service, request, response, &series, &after, csv ? "-samples.csv" : "-samples.json", csv)) return;
    if (csv && !http_request_parameter(request, "limit")) {
        stream_samples(service, request, response, after);
        return;
    }
    if (!csv) text_buffer_print(&series.out, "{\"samples\":[");
    else text_buffer_add(&series.out, "", 0);
    const store_status status =
        store_list_samples(service->store, series.id, after, series.limit + 1, csv ? add_sample_csv : add_sample_json, &series);
    if (!csv) add_links(&series, "samples");
    else if (series.more)
        snprintf(response->link, sizeof response->link, "<%s/jobs/%s/samples?format=csv&after=%lld&limit=%lld>; rel=\"next\"",
                 series.base, series.id, (long long)series.last, (long long)series.limit);
    close_series(&series, response, status, csv ? "text/csv; charset=utf-8" : "application/json", "read the samples");
}

static bool add_snapshot(void *context, const snapshot_row *row)
{
    series_page *series = context;
    if (!series_take(series, row->number)) return false;
    text_buffer_print(&series->out, "%s{\"number\":%lld,\"step\":%lld,\"time\":", series->rows > 1 ? "," : "",
                      (long long)row->number, (long long)row->step);
    text_buffer_add_number(&series->out, row->time);
    text_buffer_print(&series->out, ",\"bytes\":%lld,\"particles\":%lld,\"href\":\"%s/jobs/%s/snapshots/%06lld.hdf\"",
                      (long long)row->bytes, (long long)row->particles, series->base, series->id, (long long)row->number);
    if (row->frame_bytes > 0)
        text_buffer_print(&series->out, ",\"frame\":\"%s/jobs/%s/snapshots/%06lld.bin\",\"frame_bytes\":%lld", series->base,
                          series->id, (long long)row->number, (long long)row->frame_bytes);
    text_buffer_print(&series->out, "}");
    return true;
}

void list_snapshots(api_service *service, const http_request *request, http_response *response)
{
    series_page series = { 0 };
    int64_t after;
    if (!open_series(service, request, response, &series, &after, "-snapshots.json", false)) return;
    text_buffer_print(&series.out, "{\"snapshots\":[");
    const store_status status = store_list_snapshots(service->store, series.id, after, series.limit + 1, add_snapshot, &series);
    add_links(&series, "snapshots");
    close_series(&series, response, status, "application/json", "list the snapshots");
}
