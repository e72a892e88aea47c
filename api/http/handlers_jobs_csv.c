/* The list of jobs as CSV: whole where no limit is asked for, a piece at a time, so that what is in memory does not grow with it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "field_columns.h"
#include "handlers.h"

enum { JOBS_IN_A_PIECE = 500, PIECE_BYTES = 64 << 20 };

typedef struct jobs_table {
    job_store *store;
    job_filter filter;
    json_t *texts;   /* that the filter points to; owned, as the next */
    json_t *columns; /* names of the summary's members */
    char last[JOB_CURSOR_SIZE];
    int64_t limit, rows; /* of this piece */
    bool is_page, more;
    text_buffer *out; /* lent for a piece */
} jobs_table;

/* A copy that lives as long as the table. */
static const char *keep(jobs_table *table, const char *text)
{
    if (!text || json_array_append_new(table->texts, json_string(text)) != 0) return NULL;
    return json_string_value(json_array_get(table->texts, json_array_size(table->texts) - 1));
}

static void keep_texts(jobs_table *table)
{
    job_filter *filter = &table->filter;
    filter->text = keep(table, filter->text);
    filter->study = keep(table, filter->study);
    filter->label_name = keep(table, filter->label_name);
    filter->label_value = keep(table, filter->label_value);
    filter->sort = keep(table, filter->sort);
    filter->after_value = keep(table, filter->after_value);
    for (size_t r = 0; r < filter->range_count; r++) {
        filter->range[r].name = keep(table, filter->range[r].name);
        filter->range[r].words = keep(table, filter->range[r].words);
    }
}

/* threads and estimated_seconds, then what the rows of inputs and results say is listed. */
static bool gather_columns(jobs_table *table)
{
    field_columns fields;
    if (!field_columns_gather(&fields)) return false;
    const field_column **list = calloc(fields.count, sizeof *list);
    const size_t count = list ? field_columns_select(&fields, COLUMNS_LISTED, list) : 0;
    json_t *names = json_pack("{s:n, s:n}", "threads", "estimated_seconds");
    for (size_t c = 0; c < count; c++) json_object_set_new(names, list[c]->shown_as, json_null());
    table->columns = names;
    free(list);
    field_columns_clear(&fields);
    return names != NULL && count > 0;
}

static void write_header(const jobs_table *table, text_buffer *out)
{
    const char *name;
    json_t *unused;
    text_buffer_print(out, "jobID,processID,status,created,started,finished,updated,progress,priority,attempt,study,message,label");
    json_object_foreach(table->columns, name, unused) text_buffer_print(out, ",%s", name);
    text_buffer_print(out, "\r\n");
}

static void add_text(text_buffer *out, const char *text) { text_buffer_add_csv_field(out, text, strlen(text)); }

/* found: where the last value was; they come in the order of the columns. */
static void add_value(text_buffer *out, const job_record *job, const char *name, size_t *found)
{
    text_buffer_add(out, ",", 1);
    size_t at = *found;
    while (at < job->summary_count && strcmp(job->summary[at].name, name) != 0) at++;
    if (at == job->summary_count) return;
    *found = at + 1;
    const summary_value *value = &job->summary[at];
    if (value->kind == SUMMARY_TEXT) add_text(out, value->text);
    else if (value->kind == SUMMARY_REAL) text_buffer_add_number(out, value->real);
    else text_buffer_print(out, "%lld", (long long)value->whole);
}

static bool add_row(void *context, const job_record *job)
{
    jobs_table *table = context;
    text_buffer *out = table->out;
    table->more = table->rows == table->limit;
    if (table->more) return false;
    table->rows++;
    snprintf(table->last, sizeof table->last, "%s", job->cursor);
    text_buffer_print(out, "%s,%s,%s,%s,%s,%s,%s,", job->id, job->process, job_status_name(job->status), job->created, job->started,
                      job->finished, job->updated);
    text_buffer_add_number(out, job->progress);
    text_buffer_print(out, ",%d,%d,%s,", job->priority, job->attempt, job->study);
    add_text(out, job->message);
    char *label = json_dumps(job->label, JSON_COMPACT);
    text_buffer_print(out, ",");
    add_text(out, label ? label : "");
    free(label);
    const char *name;
    json_t *unused;
    size_t found = 0;
    json_object_foreach(table->columns, name, unused) add_value(out, job, name, &found);
    text_buffer_print(out, "\r\n");
    return !out->failed;
}

static void go_on_after_last(jobs_table *table)
{
    const char *value = strchr(table->last, ':');
    table->filter.after = strtoll(table->last, NULL, 10);
    table->filter.after_value = value && value[1] ? value + 1 : NULL;
}

static bool add_jobs(void *context, text_buffer *out)
{
    jobs_table *table = context;
    int64_t counts[JOB_STATUSES];
    if (table->rows > 0 && !table->more) return true; /* all are out */
    if (table->rows > 0) go_on_after_last(table);
    table->rows = 0;
    table->more = false;
    table->out = out;
    table->filter.limit = table->limit + 1;
    return store_list_jobs(table->store, &table->filter, counts, add_row, table) == STORE_OK && !out->failed;
}

static void free_table(void *context)
{
    jobs_table *table = context;
    json_decref(table->texts);
    json_decref(table->columns);
    free(table);
}

void respond_jobs_csv(api_service *service, const http_request *request, http_response *response, const job_filter *filter)
{
    jobs_table *table = calloc(1, sizeof *table);
    text_buffer first;
    text_buffer_init(&first, PIECE_BYTES);
    if (table) {
        *table = (jobs_table){ .store = service->store, .filter = *filter, .texts = json_array() };
        table->is_page = http_request_parameter(request, "limit") != NULL;
        table->limit = table->is_page ? filter->limit : JOBS_IN_A_PIECE;
        keep_texts(table);
    }
    bool good = table && gather_columns(table);
    if (good) write_header(table, &first);
    if (!good || !add_jobs(table, &first)) {
        if (table) free_table(table);
        text_buffer_clear(&first);
        respond_store_failure(response, STORE_FAILED, "list the jobs");
        return;
    }
    name_file(response, "jobs", ".csv", true);
    if (table->is_page && table->more) {
        json_t *next = list_link(request, "next", table->last);
        snprintf(response->link, sizeof response->link, "<%s%s>; rel=\"next\"", response->base,
                 json_string_value(json_object_get(next, "href")));
        json_decref(next);
    }
    if (table->is_page || !table->more) free_table(table);
    else response->pieces = (http_pieces){ add_jobs, free_table, table };
    http_respond_text(response, 200, "text/csv; charset=utf-8", first.text, first.length);
}
