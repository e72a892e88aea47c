/* What a calibration has found so far: the answer, once there is one, and its runs with what each told of the measured values. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"
#include "json_text.h"
#include "plan_info.h"
#include "plan_request.h"
#include "status_info.h"

enum { RESULTS_BYTES = 64 << 20 };

/* Of one calibration: its request as it is read, and its runs. */
typedef struct run_table {
    plan_request request;
    json_t *runs; /* as store_read_plan_runs has them */
} run_table;

static void clear_table(run_table *table)
{
    plan_request_clear(&table->request);
    json_decref(table->runs);
}

/* The request was read when it was posted, and is good. Clear the table either way. */
static bool read_table(api_service *service, const char *id, run_table *table)
{
    char *text = NULL;
    problem_list problems;
    *table = (run_table){ .runs = NULL };
    if (!problem_list_init(&problems)) return false;
    bool good = store_read_plan_request(service->store, id, &text) == STORE_OK;
    json_t *document = good ? json_loads(text, 0, NULL) : NULL;
    good = document && plan_request_parse(document, &table->request, &problems)
           && store_read_plan_runs(service->store, id, &table->runs) == STORE_OK;
    json_decref(document);
    free(text);
    problem_list_clear(&problems);
    return good;
}

static size_t test_of(const json_t *run) { return (size_t)json_integer_value(json_object_get(run, "test")); }

static const char *process_of(const run_table *table, const json_t *run)
{
    const size_t test = test_of(run);
    const json_t *request = test < table->request.tests ? table->request.test[test].request : NULL;
    const char *process = json_string_value(json_object_get(request, "process"));
    return process ? process : "";
}

static bool tells(const plan_measure *measure, const json_t *run, double *value, double *error)
{
    const json_t *results = json_object_get(run, "results");
    return test_of(run) == measure->test && json_is_object(results) && plan_measure_read(measure, results, value, error);
}

/* --- JSON --- */

static json_t *values_of(const run_table *table, const json_t *run)
{
    json_t *values = json_object();
    for (size_t m = 0; m < table->request.measures; m++) {
        double value, error;
        if (!tells(&table->request.measure[m], run, &value, &error)) continue;
        json_object_set_new(values, table->request.measure[m].name,
                            json_pack("{s:f, s:o}", "value", value, "standard_error", json_real_or_null(error)));
    }
    return values;
}

static json_t *runs_of(const run_table *table)
{
    json_t *runs = json_array(), *run;
    size_t i;
    json_array_foreach(table->runs, i, run)
    {
        json_t *shown = json_copy(run);
        json_object_del(shown, "results");
        json_object_set_new(shown, "process", json_string(process_of(table, run)));
        json_object_set_new(shown, "values", values_of(table, run));
        json_array_append_new(runs, shown);
    }
    return runs;
}

static json_t *results_of(const plan_record *plan, const run_table *table, const json_t *said)
{
    char href[80];
    const json_t *progress = json_object_get(said, "progress"), *answer = json_object_get(said, "answer");
    snprintf(href, sizeof href, "/calibrations/%s/results", plan->id);
    json_t *results = json_pack("{s:s, s:s, s:s, s:s}", "calibrationID", plan->id, "name", plan->name, "status",
                                job_status_name(plan->status), "stage", plan->stage);
    json_object_set_new(results, "progress", progress ? json_incref((json_t *)progress) : json_null());
    json_object_set_new(results, "answer", answer ? json_incref((json_t *)answer) : json_null());
    json_object_set_new(results, "runs", runs_of(table));
    json_object_set_new(results, "links", json_pack("[o]", link_to("self", "application/json", href)));
    return results;
}

static void respond_json(api_service *service, http_response *response, const plan_record *plan, const run_table *table)
{
    char *text = NULL;
    const store_status status = store_read_plan(service->store, plan->id, &text);
    if (status != STORE_OK && status != STORE_NOT_FOUND) {
        respond_store_failure(response, status, "read the results");
        return;
    }
    json_t *said = text ? json_loads(text, 0, NULL) : NULL;
    http_respond_json(response, 200, results_of(plan, table, said));
    json_decref(said);
    free(text);
}

/* --- CSV --- */

static void add_text(text_buffer *out, const char *text)
{
    text_buffer_print(out, ",");
    text_buffer_add_csv_field(out, text, strlen(text));
}

static void add_number(text_buffer *out, bool is_known, double value)
{
    text_buffer_print(out, ",");
    if (is_known && isfinite(value)) text_buffer_add_number(out, value);
}

static void write_head(const run_table *table, text_buffer *out)
{
    char name[PLAN_NAME_SIZE + 20];
    text_buffer_print(out, "run,stage,test,process,set,job,status");
    for (size_t p = 0; p < table->request.parameters; p++) add_text(out, table->request.parameter[p].pointer);
    for (size_t m = 0; m < table->request.measures; m++) {
        snprintf(name, sizeof name, "%s_standard_error", table->request.measure[m].name);
        add_text(out, table->request.measure[m].name);
        add_text(out, name);
    }
    text_buffer_print(out, "\r\n");
}

static void write_row(const run_table *table, const json_t *run, text_buffer *out)
{
    const json_t *parameters = json_object_get(run, "parameters");
    const char *job = json_string_value(json_object_get(run, "job"));
    text_buffer_print(out, "%lld,%s,%zu,%s,%lld", (long long)json_integer_value(json_object_get(run, "number")),
                      json_string_value(json_object_get(run, "stage")), test_of(run), process_of(table, run),
                      (long long)json_integer_value(json_object_get(run, "set")));
    add_text(out, job ? job : "");
    add_text(out, json_string_value(json_object_get(run, "status")));
    for (size_t p = 0; p < table->request.parameters; p++)
        add_number(out, true, json_number_value(json_object_get(parameters, table->request.parameter[p].pointer)));
    for (size_t m = 0; m < table->request.measures; m++) {
        double value = NAN, error = NAN;
        const bool is_told = tells(&table->request.measure[m], run, &value, &error);
        add_number(out, is_told, value);
        add_number(out, is_told, error);
    }
    text_buffer_print(out, "\r\n");
}

static void respond_csv(http_response *response, const run_table *table)
{
    text_buffer out;
    size_t i;
    json_t *run;
    text_buffer_init(&out, RESULTS_BYTES);
    write_head(table, &out);
    json_array_foreach(table->runs, i, run) { write_row(table, run, &out); }
    if (!out.failed) {
        http_respond_text(response, 200, "text/csv; charset=utf-8", out.text, out.length);
        return;
    }
    text_buffer_clear(&out);
    respond_store_failure(response, STORE_FAILED, "write the results");
}

static void respond_table(api_service *service, const http_request *request, http_response *response, bool csv)
{
    plan_record plan;
    run_table table;
    char version[72];
    if (!find_plan(service, request, response, &plan)) return;
    /* Nothing in it changes but with a job's state, or a plan. */
    name_file(response, plan.id, csv ? "-results.csv" : "-results.json", csv);
    snprintf(version, sizeof version, "%s-%s", csv ? "csv" : "json", plan.updated);
    if (http_respond_unchanged(request, response, version)) return;
    if (!read_table(service, plan.id, &table)) respond_store_failure(response, STORE_FAILED, "read the results");
    else if (csv) respond_csv(response, &table);
    else respond_json(service, response, &plan, &table);
    clear_table(&table);
}

void show_calibration_results(api_service *service, const http_request *request, http_response *response)
{
    respond_table(service, request, response, wants_csv(request));
}

void show_calibration_csv(api_service *service, const http_request *request, http_response *response)
{
    respond_table(service, request, response, true);
}
