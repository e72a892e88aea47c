/* Calibrations: added, dismissed, tried again and deleted as a whole, listed, and their runs read. What the planner asks for is added
 * in plan_work.c. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "database.h"
#include "job_store.h"
#include "log.h"
#include "plan_store.h"
#include "text_copy.h"

/* --- adding --- */

static store_status insert_plan(job_store *store, const plan_addition *plan, const char *id, const char *document)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    const store_status status = sql_run(
        store->writer, NULL,
        "INSERT INTO calibration(id,name,status,message,priority,workers,most_jobs,estimated_seconds,created,updated)"
        " VALUES(?1,?2,'accepted','',?3,?4,?5,?6,?7,?7)",
        "ttiiidt", id, plan->name, (int64_t)plan->priority, (int64_t)store->places, plan->most_jobs, plan->estimated_seconds, now);
    if (status != STORE_OK) return status;
    return sql_run(store->writer, NULL, "INSERT INTO calibration_document(calibration,request) VALUES(?,?)", "it",
                   (int64_t)sqlite3_last_insert_rowid(store->writer), document);
}

store_status store_add_plan(job_store *store, const plan_addition *plan, char id[JOB_ID_SIZE])
{
    uint32_t bits;
    if (data_folder_is_nearly_full(store->data)) return STORE_FULL;
    char *document = json_dumps(plan->document, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    store_status status = document && store_random_bits(&bits) ? store_begin(store) : STORE_FAILED;
    if (status == STORE_OK) {
        store_write_id(id, time(NULL), bits);
        status = insert_plan(store, plan, id, document);
        store_name_made(id);
        status = store_end(store, status);
    }
    free(document);
    return status;
}

/* --- ending, going on --- */

#define OF_JOBS(column) " IN (SELECT " column " FROM calibration_run WHERE job IS NOT NULL AND calibration=?)"

/* Between begin and end: the number, and whether it is in one of these states. */
static store_status find_in(job_store *store, const char *id, const char *states, int64_t *number)
{
    int64_t fits = 0;
    sqlite3_stmt *row =
        sql_prepare(store->writer, "SELECT number, instr(?2,status) FROM calibration WHERE id=?1", "tt", id, states);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) {
        *number = sqlite3_column_int64(row, 0);
        fits = sqlite3_column_int64(row, 1);
    }
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    if (status != STORE_OK) return status;
    return code != SQLITE_ROW ? STORE_NOT_FOUND : fits ? STORE_OK : STORE_CONFLICT;
}

static store_status dismiss(job_store *store, const char *id)
{
    char now[JOB_TIME_SIZE];
    int64_t number = 0;
    time_text(now);
    store_status status = find_in(store, id, "accepted running", &number);
    if (status == STORE_OK)
        status = sql_run(store->writer, NULL,
                         "UPDATE calibration SET status='dismissed', message='dismissed on request', finished=?1, updated=?1"
                         " WHERE number=?2",
                         "ti", now, number);
    if (status != STORE_OK) return status;
    return sql_run(store->writer, NULL,
                   "UPDATE job SET status='dismissed', message='dismissed with its calibration', eta_seconds=NULL, finished=?,"
                   " updated=? WHERE status IN ('accepted','running') AND number" OF_JOBS("job"),
                   "tti", now, now, number);
}

store_status store_dismiss_plan(job_store *store, const char *id)
{
    const store_status status = store_begin(store);
    return status == STORE_OK ? store_end(store, dismiss(store, id)) : status;
}

static store_status count_dismissed(job_store *store, int64_t number, int64_t *count)
{
    sqlite3_stmt *row =
        sql_prepare(store->writer, "SELECT count(*) FROM job WHERE status='dismissed' AND number" OF_JOBS("job"), "i", number);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) *count = sqlite3_column_int64(row, 0);
    return row ? sql_finish(row, code) : STORE_FAILED;
}

static store_status go_on(job_store *store, const char *id)
{
    char now[JOB_TIME_SIZE];
    int64_t number = 0, dismissed = 0;
    time_text(now);
    store_status status = find_in(store, id, "failed dismissed", &number);
    if (status == STORE_OK) status = count_dismissed(store, number, &dismissed);
    if (status == STORE_OK) status = store_check_queue(store, dismissed);
    if (status != STORE_OK) return status;
    store_name_made(id);
    status =
        sql_run(store->writer, NULL,
                "UPDATE calibration SET status=iif(started IS NULL,'accepted','running'), message='', setbacks=0, not_before=0,"
                " finished=NULL, updated=? WHERE number=?",
                "ti", now, number);
    if (status != STORE_OK) return status;
    return sql_run(store->writer, NULL, STORE_TRY_AGAIN "WHERE status='dismissed' AND number" OF_JOBS("job"), "ti", now, number);
}

store_status store_retry_plan(job_store *store, const char *id)
{
    const store_status status = store_begin(store);
    return status == STORE_OK ? store_end(store, go_on(store, id)) : status;
}

/* A job may have been put into the queue again by itself, and still run. */
static store_status has_no_work(job_store *store, int64_t number)
{
    sqlite3_stmt *row = sql_prepare(
        store->writer, "SELECT 1 FROM job WHERE status IN ('accepted','running') AND number" OF_JOBS("job"), "i", number);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    return status == STORE_OK && code == SQLITE_ROW ? STORE_CONFLICT : status;
}

/* The runs first: what becomes of their jobs is not to be kept. */
static store_status delete_all(job_store *store, const char *id, double since)
{
    int64_t number = 0;
    store_status status = find_in(store, id, "successful failed dismissed", &number);
    if (status == STORE_OK) status = has_no_work(store, number);
    if (status == STORE_OK)
        status = sql_run(store->writer, NULL, "INSERT INTO leaving(id,since) SELECT id, ? FROM job WHERE number" OF_JOBS("job"),
                         "di", since, number);
    if (status == STORE_OK) status = sql_run(store->writer, NULL, "DELETE FROM job WHERE number" OF_JOBS("job"), "i", number);
    if (status == STORE_OK) status = sql_run(store->writer, NULL, "DELETE FROM calibration WHERE number=?", "i", number);
    return status;
}

store_status store_delete_plan(job_store *store, const char *id)
{
    const double since = unix_seconds();
    store_status status = store_begin(store);
    if (status == STORE_OK) status = store_end(store, delete_all(store, id, since));
    if (status == STORE_OK) store_put_folders_aside(store, since);
    return status;
}

/* --- looking --- */

/* A run has the state of its job, or what was kept when that was deleted. */
#define RUN_STATE "coalesce(job.status,run.status)"
#define COUNT(state) " total(" RUN_STATE "='" state "'),"
#define SELECT_PLANS                                                                                                               \
    "SELECT c.number, c.id, c.name, c.stage, c.status, c.priority, c.most_jobs, c.estimated_seconds, c.created, c.started,"        \
    " c.finished, max(c.updated,coalesce(max(job.updated),'')), c.message, count(run.number)," COUNT("accepted") COUNT("running")  \
        COUNT("successful") COUNT("failed")                                                                                        \
            COUNT("dismissed") " total(iif(" RUN_STATE " IN ('accepted','running'),job.progress,100*(run.number IS NOT NULL))),"   \
                               " (julianday('now')-julianday(c.started))*86400.0"                                                  \
                               " FROM calibration c LEFT JOIN calibration_run run ON run.calibration=c.number LEFT JOIN job ON "   \
                               "job.number=run.job"

static void copy_text(char *text, size_t size, sqlite3_stmt *row, int column)
{
    text_copy(text, size, (const char *)sqlite3_column_text(row, column));
}

/* How far it is of all jobs that it may take: it may end with fewer. */
static void fill_progress(plan_record *plan, double percent_of_jobs, double seconds)
{
    const double share = plan->most_jobs > 0 ? 0.01 * percent_of_jobs / (double)plan->most_jobs : 0.0;
    plan->eta_seconds = NAN;
    plan->progress = plan->status == JOB_SUCCESSFUL ? 100.0 : fmin(99.0, 100.0 * share);
    if (plan->status == JOB_RUNNING && share > 0.02 && share < 1.0) plan->eta_seconds = fmax(seconds, 0.0) * (1.0 - share) / share;
}

static void fill_record(sqlite3_stmt *row, plan_record *plan)
{
    const char *status = (const char *)sqlite3_column_text(row, 4);
    *plan = (plan_record){ .number = sqlite3_column_int64(row, 0),
                           .priority = sqlite3_column_int(row, 5),
                           .most_jobs = sqlite3_column_int64(row, 6),
                           .estimated_seconds = sqlite3_column_double(row, 7),
                           .runs = sqlite3_column_int64(row, 13) };
    if (status) job_status_parse(status, strlen(status), &plan->status); /* the table's CHECK allows no other names */
    copy_text(plan->id, sizeof plan->id, row, 1);
    copy_text(plan->name, sizeof plan->name, row, 2);
    copy_text(plan->stage, sizeof plan->stage, row, 3);
    copy_text(plan->created, sizeof plan->created, row, 8);
    copy_text(plan->started, sizeof plan->started, row, 9);
    copy_text(plan->finished, sizeof plan->finished, row, 10);
    copy_text(plan->updated, sizeof plan->updated, row, 11);
    copy_text(plan->message, sizeof plan->message, row, 12);
    for (int i = 0; i < JOB_STATUSES; i++) plan->counts[i] = sqlite3_column_int64(row, 14 + i);
    fill_progress(plan, sqlite3_column_double(row, 14 + JOB_STATUSES), sqlite3_column_double(row, 15 + JOB_STATUSES));
}

store_status store_find_plan(job_store *store, const char *id, plan_record *plan)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(reader, SELECT_PLANS " WHERE c.id=? GROUP BY c.number", "t", id);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) fill_record(row, plan);
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    return status == STORE_OK && code != SQLITE_ROW ? STORE_NOT_FOUND : status;
}

typedef struct plan_walk {
    plan_visitor *visit;
    void *context;
} plan_walk;

static bool take_plan(sqlite3_stmt *row, void *context)
{
    const plan_walk *to = context;
    plan_record plan;
    fill_record(row, &plan);
    return to->visit(to->context, &plan);
}

store_status store_list_plans(job_store *store, int64_t before, int64_t limit, plan_visitor *visit, void *context)
{
    plan_walk to = { visit, context };
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *rows = sql_prepare(reader, SELECT_PLANS " WHERE c.number<? GROUP BY c.number ORDER BY c.number DESC LIMIT ?",
                                     "ii", before ? before : INT64_MAX, limit);
    return store_walk(store, reader, rows, take_plan, &to);
}

store_status store_read_plan_request(job_store *store, const char *id, char **text)
{
    return store_read_text(store, "SELECT request FROM calibration JOIN calibration_document ON calibration=number WHERE id=?", id,
                           text);
}

store_status store_read_plan(job_store *store, const char *id, char **text)
{
    return store_read_text(
        store, "SELECT plan FROM calibration JOIN calibration_document ON calibration=number WHERE id=? AND plan IS NOT NULL", id,
        text);
}

/* --- runs --- */

static json_t *parsed(const char *text) { return text ? json_loads(text, JSON_DECODE_ANY, NULL) : NULL; }

static bool take_run(sqlite3_stmt *row, void *context)
{
    const char *job = (const char *)sqlite3_column_text(row, 6);
    json_t *parameters = parsed((const char *)sqlite3_column_text(row, 4)),
           *results = parsed((const char *)sqlite3_column_text(row, 7));
    json_t *run = json_pack("{s:I, s:s, s:I, s:I, s:o?, s:s, s:o, s:s?}", "number", (json_int_t)sqlite3_column_int64(row, 0),
                            "stage", sqlite3_column_text(row, 1), "test", (json_int_t)sqlite3_column_int64(row, 2), "set",
                            (json_int_t)sqlite3_column_int64(row, 3), "parameters", parameters, "status",
                            sqlite3_column_text(row, 5), "results", results ? results : json_null(), "job", job);
    return run && json_array_append_new(context, run) == 0;
}

/* Where a document was damaged in the table, it is in the job's folder, too: that is looked for apart, with no reader in hand. */
static void read_results(job_store *store, json_t *runs)
{
    size_t i;
    json_t *run;
    json_array_foreach(runs, i, run)
    {
        const char *job = json_string_value(json_object_get(run, "job"));
        char *text = NULL;
        if (!job || strcmp(json_string_value(json_object_get(run, "status")), job_status_name(JOB_SUCCESSFUL)) != 0) continue;
        if (store_read_results(store, job, &text) == STORE_OK) json_object_set_new(run, "results", parsed(text));
        free(text);
    }
}

store_status store_read_plan_runs(job_store *store, const char *id, json_t **runs)
{
    *runs = json_array();
    if (!*runs) return STORE_FAILED;
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *rows = sql_prepare(reader,
                                     "SELECT run.number, run.stage, run.test, run.of_set, run.parameters, " RUN_STATE
                                     ", job.id, run.results FROM calibration_run run LEFT JOIN job ON job.number=run.job"
                                     " WHERE run.calibration=(SELECT number FROM calibration WHERE id=?) ORDER BY run.number",
                                     "t", id);
    const store_status status = store_walk(store, reader, rows, take_run, *runs);
    if (status == STORE_OK) {
        read_results(store, *runs);
    } else {
        json_decref(*runs);
        *runs = NULL;
    }
    return status;
}
