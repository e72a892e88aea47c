/* Studies: added and dismissed as a whole, listed, and their runs walked for the results. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "database.h"
#include "job_store.h"
#include "log.h"
#include "study_stage.h"
#include "text_buffer.h"
#include "text_copy.h"

/* --- adding --- */

static store_status insert_study(job_store *store, const study_spec *study, const study_estimate *estimate, const char *id,
                                 int64_t *number)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    char *document = json_dumps(study->document, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    store_status status = document ? STORE_OK : STORE_FAILED;
    if (status == STORE_OK)
        status = sql_run(store->writer, NULL,
                         "INSERT INTO study(id,process,name,cases,repeats,jobs,estimated_seconds,created,updated,priority) "
                         "VALUES(?1,?2,?3,?4,?5,?4*?5,?6,?7,?7,?8)",
                         "tttiidti", id, study->process, study->name, (int64_t)study->cases, (int64_t)study->repeats,
                         estimate->wall_seconds, now, (int64_t)study->priority);
    *number = sqlite3_last_insert_rowid(store->writer);
    if (status == STORE_OK)
        status = sql_run(store->writer, NULL, "INSERT INTO study_document VALUES(?,?)", "it", *number, document);
    free(document);
    return status;
}

/* Of one second: ids follow one another, because among ten thousand random ones of the same second two would be equal once
 * in a hundred studies. */
store_status store_add_study(job_store *store, study_stage *stage, const study_spec *study, const study_estimate *estimate,
                             char id[JOB_ID_SIZE])
{
    int64_t number;
    if (data_folder_is_nearly_full(store->data)) {
        study_stage_discard_starts(stage);
        return STORE_FULL;
    }
    store_status status = study_stage_match_beds(stage);
    if (status == STORE_OK) status = study_stage_bring_starts(stage);
    if (status == STORE_OK) status = store_begin(store);
    if (status == STORE_OK) {
        status = store_check_queue(store, (int64_t)study->cases * study->repeats);
        if (status == STORE_OK) status = insert_study(store, study, estimate, study_stage_id(stage), &number);
        if (status == STORE_OK) status = study_stage_copy(stage, number);
        store_name_made(study_stage_id(stage));
        status = store_end(store, status);
    }
    if (status == STORE_OK) snprintf(id, JOB_ID_SIZE, "%s", study_stage_id(stage));
    else study_stage_discard_starts(stage);
    return status;
}

/* --- dismissing --- */

store_status store_dismiss_study(job_store *store, const char *id)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    int64_t changed = 0;
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status =
        sql_run(store->writer, &changed,
                "UPDATE job SET status='dismissed', message='dismissed with its study', eta_seconds=NULL, finished=?1, updated=?1"
                " WHERE study=(SELECT number FROM study WHERE id=?2) AND status IN ('accepted','running')",
                "tt", now, id);
    status = store_end(store, status);
    if (status != STORE_OK || changed > 0) return status;
    study_record study;
    const store_status found = store_find_study(store, id, &study);
    return found == STORE_OK ? STORE_CONFLICT : found;
}

/* --- looking --- */

/* The + keeps to the index of running jobs, which are few, where a study may have ten thousand. */
#define SELECT_STUDIES                                                                                                             \
    "SELECT number, id, process, name, cases, repeats, jobs, estimated_seconds, created, started, updated,"                        \
    " accepted, running, successful, failed, dismissed,"                                                                           \
    " (SELECT coalesce(sum(progress),0) FROM job WHERE status='running' AND +job.study=study.number), priority FROM study"

static void copy_text(char *text, size_t size, sqlite3_stmt *row, int column)
{
    text_copy(text, size, (const char *)sqlite3_column_text(row, column));
}

static void fill_record(sqlite3_stmt *row, study_record *study)
{
    *study = (study_record){ .number = sqlite3_column_int64(row, 0),
                             .cases = sqlite3_column_int64(row, 4),
                             .repeats = sqlite3_column_int64(row, 5),
                             .jobs = sqlite3_column_int64(row, 6),
                             .estimated_seconds = sqlite3_column_double(row, 7),
                             .priority = sqlite3_column_int(row, 17) };
    copy_text(study->id, sizeof study->id, row, 1);
    copy_text(study->process, sizeof study->process, row, 2);
    copy_text(study->name, sizeof study->name, row, 3);
    copy_text(study->created, sizeof study->created, row, 8);
    copy_text(study->started, sizeof study->started, row, 9);
    copy_text(study->updated, sizeof study->updated, row, 10);
    for (int i = 0; i < JOB_STATUSES; i++) study->counts[i] = sqlite3_column_int64(row, 11 + i);
    const int64_t ended = study->jobs - study->counts[JOB_ACCEPTED] - study->counts[JOB_RUNNING];
    if (study->jobs > 0) study->progress = (100.0 * (double)ended + sqlite3_column_double(row, 16)) / (double)study->jobs;
}

store_status store_find_study(job_store *store, const char *id, study_record *study)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader, SELECT_STUDIES " WHERE id=?", "t", id);
    store_status status = STORE_FAILED;
    if (statement) {
        const int code = sqlite3_step(statement);
        if (code == SQLITE_ROW) fill_record(statement, study);
        status = sql_finish(statement, code);
        if (status == STORE_OK && code != SQLITE_ROW) status = STORE_NOT_FOUND;
    }
    store_return_reader(store, reader);
    return status;
}

store_status store_read_study(job_store *store, const char *id, char **text)
{
    return store_read_text(store, "SELECT document FROM study JOIN study_document ON study=number WHERE id=?", id, text);
}

typedef struct study_walk {
    study_visitor *visit;
    study_case_visitor *visit_case;
    study_run_visitor *visit_run;
    void *context;
} study_walk;

static bool take_study(sqlite3_stmt *row, void *context)
{
    const study_walk *to = context;
    study_record study;
    fill_record(row, &study);
    return to->visit(to->context, &study);
}

store_status store_list_studies(job_store *store, int64_t before, int64_t limit, study_visitor *visit, void *context)
{
    study_walk to = { .visit = visit, .context = context };
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader, SELECT_STUDIES " WHERE number<? ORDER BY number DESC LIMIT ?", "ii",
                                          before ? before : INT64_MAX, limit);
    return store_walk(store, reader, statement, take_study, &to);
}

static bool take_case(sqlite3_stmt *row, void *context)
{
    const study_walk *to = context;
    const study_case_row one = { sqlite3_column_int64(row, 0), (const char *)sqlite3_column_text(row, 1),
                                 (const char *)sqlite3_column_text(row, 2), (const char *)sqlite3_column_text(row, 3) };
    return to->visit_case(to->context, &one);
}

store_status store_list_study_cases(job_store *store, const char *id, study_case_visitor *visit, void *context)
{
    study_walk to = { .visit_case = visit, .context = context };
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader,
                                          "SELECT position, name, inputs, label FROM study_case"
                                          " WHERE study=(SELECT number FROM study WHERE id=?) ORDER BY position",
                                          "t", id);
    return store_walk(store, reader, statement, take_case, &to);
}

/* Of the columns of a run the first say which job; the rest, by their own names, what it measured. */
enum { RUN_COLUMNS = 2, LONGEST_SELECT = 65536 };

static json_t *measures_of(sqlite3_stmt *row)
{
    json_t *measures = json_object();
    for (int i = RUN_COLUMNS; i < sqlite3_column_count(row); i++) {
        const int type = sqlite3_column_type(row, i);
        if (type == SQLITE_NULL) continue;
        json_object_set_new(measures, sqlite3_column_name(row, i),
                            type == SQLITE_TEXT ? json_string((const char *)sqlite3_column_text(row, i))
                                                : json_real(sqlite3_column_double(row, i)));
    }
    return measures;
}

static bool take_run(sqlite3_stmt *row, void *context)
{
    const study_walk *to = context;
    const char *status = (const char *)sqlite3_column_text(row, 1);
    study_run_row run = { .index = sqlite3_column_int64(row, 0) };
    job_status_parse(status, strlen(status), &run.status); /* the table's CHECK allows no other names */
    json_t *measures = measures_of(row);
    run.measures = measures;
    const bool more = to->visit_run(to->context, &run);
    json_decref(measures);
    return more;
}

store_status store_list_study_runs(job_store *store, const char *id, study_run_visitor *visit, void *context)
{
    study_walk to = { .visit_run = visit, .context = context };
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_SELECT);
    text_buffer_print(&sql,
                      "SELECT job.study_case, job.status%s FROM job%s WHERE job.study=(SELECT number FROM study WHERE id=?)"
                      " ORDER BY job.study_case, job.study_repeat",
                      store->fields.select_study, store->fields.join_study);
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql.failed ? NULL : sql_prepare(reader, sql.text, "t", id);
    text_buffer_clear(&sql);
    return store_walk(store, reader, statement, take_run, &to);
}
