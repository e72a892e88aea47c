#include "plan_work.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "database.h"
#include "log.h"
#include "process_type.h"

#define LONGEST_DELAY 60.0 /* s */
#define FENCE                                                                                                                      \
    " WHERE number=? AND status IN ('accepted','running')"                                                                         \
    " AND (SELECT count(*) FROM calibration_run WHERE calibration=calibration.number)=?"

store_status store_next_plan(job_store *store, plan_claim *claim, bool *put_off)
{
    *claim = (plan_claim){ 0 };
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(
        reader,
        "SELECT number, id, workers, setbacks, (SELECT count(*) FROM calibration_run WHERE calibration=calibration.number),"
        " not_before>?1 AND not_before<?1+2*?2 AS late FROM calibration INDEXED BY calibration_at_work"
        " WHERE status IN ('accepted','running') AND NOT EXISTS(SELECT 1 FROM calibration_run run JOIN job ON job.number=run.job"
        "  WHERE run.calibration=calibration.number AND job.status IN ('accepted','running')) ORDER BY late, number LIMIT 1",
        "dd", unix_seconds(), LONGEST_DELAY);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    bool is_late = false;
    if (code == SQLITE_ROW) {
        *claim = (plan_claim){ .number = sqlite3_column_int64(row, 0),
                               .workers = sqlite3_column_int64(row, 2),
                               .setbacks = sqlite3_column_int(row, 3),
                               .runs = sqlite3_column_int64(row, 4) };
        snprintf(claim->id, sizeof claim->id, "%s", (const char *)sqlite3_column_text(row, 1));
        is_late = sqlite3_column_int(row, 5);
    }
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    *put_off = is_late || status != STORE_OK;
    return status == STORE_OK && (code != SQLITE_ROW || is_late) ? STORE_NOT_FOUND : status;
}

/* --- cases as jobs --- */

/* A case that was read: its job, or none, where it can't be one. */
typedef struct planned_job {
    bool is_job;
    job_spec spec;
    char *text, *parameters; /* owned */
    char id[JOB_ID_SIZE];
} planned_job;

static void clear_jobs(planned_job *jobs, size_t count)
{
    for (size_t i = 0; jobs && i < count; i++) {
        if (jobs[i].is_job) job_spec_clear(&jobs[i].spec);
        free(jobs[i].text);
        free(jobs[i].parameters);
    }
    free(jobs);
}

static void tell_of_refusal(const plan_claim *claim, const json_t *one, const problem_list *problems)
{
    const json_t *first = json_array_get(problems->errors, 0);
    log_line("calibration %s: run %lld can't be one: %s %s", claim->id,
             (long long)json_integer_value(json_object_get(one, "number")), json_string_value(json_object_get(first, "pointer")),
             json_string_value(json_object_get(first, "detail")));
}

/* False: no memory. */
static bool read_case(const plan_claim *claim, const json_t *one, int default_threads, int priority, planned_job *job)
{
    json_t *request = json_object_get(one, "request"), *label = json_object_get(request, "label");
    problem_list problems;
    if (!json_is_object(label) || !problem_list_init(&problems)) return false;
    json_object_set_new(label, "calibrationID", json_string(claim->id));
    json_t *inputs = json_object_get(request, "inputs");
    const process_type *type = process_type_find(json_string_value(json_object_get(request, "process")));
    if (type && spec_field_find(type->inputs, SPEC_INPUTS, "threads") && !json_object_get(inputs, "threads"))
        json_object_set_new(inputs, "threads", json_integer(default_threads));
    job->parameters = json_dumps(json_object_get(one, "parameters"), JSON_COMPACT | JSON_REAL_PRECISION(17));
    job->is_job = job_spec_parse(NULL, request, 0, &job->spec, &problems);
    if (job->is_job) {
        job->spec.priority = priority;
        job->text = job_spec_to_text(&job->spec);
    } else {
        tell_of_refusal(claim, one, &problems);
    }
    problem_list_clear(&problems);
    return job->parameters && (!job->is_job || job->text);
}

static store_status read_priority_of(job_store *store, int64_t number, int *priority)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(reader, "SELECT priority FROM calibration WHERE number=?", "i", number);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) *priority = sqlite3_column_int(row, 0);
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    return status == STORE_OK && code != SQLITE_ROW ? STORE_CONFLICT : status;
}

/* Ids of one batch follow one another, so that no two are the same. */
static planned_job *read_cases(const plan_claim *claim, const json_t *cases, int default_threads, int priority)
{
    const size_t count = json_array_size(cases);
    const time_t now = time(NULL);
    planned_job *jobs = calloc(count + 1, sizeof *jobs);
    uint32_t bits;
    bool good = jobs && store_random_bits(&bits);
    for (size_t i = 0; good && i < count; i++) {
        good = read_case(claim, json_array_get(cases, i), default_threads, priority, &jobs[i]);
        store_write_id(jobs[i].id, now, bits + (uint32_t)i);
    }
    if (good) return jobs;
    clear_jobs(jobs, count);
    return NULL;
}

/* --- keeping what was planned --- */

static store_status insert_run(job_store *store, const plan_claim *claim, const json_t *one, const planned_job *job,
                               const calibration *machine)
{
    int64_t number = 0;
    store_status status = STORE_OK;
    if (job->is_job) status = store_insert_next(store, &job->spec, job->id, job->text, machine, &number);
    if (status != STORE_OK) return status;
    return sql_run(store->writer, NULL,
                   "INSERT INTO calibration_run(calibration,number,stage,test,of_set,parameters,job,status)"
                   " VALUES(?,?,?,?,?,?,nullif(?,0),?)",
                   "iitiitit", claim->number, (int64_t)json_integer_value(json_object_get(one, "number")),
                   json_string_value(json_object_get(one, "stage")), (int64_t)json_integer_value(json_object_get(one, "test")),
                   (int64_t)json_integer_value(json_object_get(one, "set")), job->parameters, number,
                   job->is_job ? NULL : "failed");
}

static store_status update_row(job_store *store, const plan_claim *claim, const json_t *plan)
{
    char now[JOB_TIME_SIZE];
    int64_t changed = 0;
    const json_t *answer = json_object_get(plan, "answer");
    const char *found = json_string_value(json_object_get(answer, "status"));
    time_text(now);
    const store_status status = sql_run(
        store->writer, &changed,
        "UPDATE calibration SET status=?, stage=?, message=?, started=coalesce(started,?), finished=?, updated=?, setbacks=0,"
        " not_before=0" FENCE,
        "ttttttii", job_status_name(answer ? JOB_SUCCESSFUL : JOB_RUNNING), json_string_value(json_object_get(plan, "stage")),
        found ? found : "", now, answer ? now : NULL, now, claim->number, claim->runs);
    return status == STORE_OK && changed == 0 ? STORE_CONFLICT : status;
}

static store_status keep(job_store *store, const plan_claim *claim, const json_t *plan, const char *text, const planned_job *jobs,
                         const calibration *machine)
{
    const json_t *cases = json_object_get(plan, "cases");
    store_status status = update_row(store, claim, plan);
    if (status == STORE_OK) status = store_check_queue(store, (int64_t)json_array_size(cases));
    if (status == STORE_OK)
        status =
            sql_run(store->writer, NULL, "UPDATE calibration_document SET plan=? WHERE calibration=?", "ti", text, claim->number);
    for (size_t i = 0; status == STORE_OK && i < json_array_size(cases); i++)
        status = insert_run(store, claim, json_array_get(cases, i), &jobs[i], machine);
    return status;
}

/* Without the cases, which are jobs now. */
static char *text_of(const json_t *plan)
{
    json_t *rest = json_copy((json_t *)plan);
    if (rest) json_object_del(rest, "cases");
    char *text = rest ? json_dumps(rest, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(rest);
    return text;
}

store_status store_take_plan(job_store *store, const plan_claim *claim, const json_t *plan, int default_threads)
{
    const json_t *cases = json_object_get(plan, "cases");
    calibration machine;
    int priority = 0;
    store_status status = read_priority_of(store, claim->number, &priority);
    if (status != STORE_OK) return status;
    if (data_folder_is_nearly_full(store->data)) return STORE_FULL;
    store_read_calibration(store, &machine);
    planned_job *jobs = read_cases(claim, cases, default_threads, priority);
    char *text = jobs ? text_of(plan) : NULL;
    status = text ? store_begin(store) : STORE_FAILED;
    if (status == STORE_OK) status = store_end(store, keep(store, claim, plan, text, jobs, &machine));
    free(text);
    clear_jobs(jobs, json_array_size(cases));
    return status;
}

store_status store_put_off_plan(job_store *store, const plan_claim *claim, const char *message)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status =
        sql_run(store->writer, NULL,
                "UPDATE calibration SET message=?, not_before=?+min(?,1<<min(setbacks,16)), setbacks=setbacks+1, updated=?" FENCE,
                "tddtii", message, unix_seconds(), LONGEST_DELAY, now, claim->number, claim->runs);
    return store_end(store, status);
}

store_status store_fail_plan(job_store *store, const plan_claim *claim, const char *message)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = sql_run(store->writer, NULL, "UPDATE calibration SET status='failed', message=?, finished=?, updated=?" FENCE, "tttii",
                     message, now, now, claim->number, claim->runs);
    return store_end(store, status);
}
