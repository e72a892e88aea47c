/* Walks over jobs, samples and snapshots. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "database.h"
#include "job_store.h"
#include "process_type.h"
#include "text_buffer.h"
#include "text_copy.h"

/* The first RECORD_COLUMNS fill the record; the rest, by their own names, are the summary: these two, and what the rows of
 * inputs and results say is listed. */
#define RECORD_COLUMNS 16
#define RECORD                                                                                                                     \
    "SELECT job.number, job.id, job.process, job.status, job.attempt, job.progress, job.eta_seconds, job.created,"                 \
    " job.started, job.finished, job.updated, job.message, job.label, study.id,"                                                   \
    " job.number IN (SELECT job FROM pinned), job.priority, job.threads, job.estimated_seconds"
enum { MORE_OF_JOB = 2, LONGEST_SELECT = 65536 };

static void write_select(const field_tables *fields, text_buffer *sql)
{
    text_buffer_print(sql, RECORD "%s FROM job%s LEFT JOIN study ON study.number=job.study", fields->select_listed,
                      fields->join_listed);
}

static void copy_text(char *text, size_t size, sqlite3_stmt *row, int column)
{
    text_copy(text, size, (const char *)sqlite3_column_text(row, column));
}

static bool is_truth(const field_tables *fields, int i)
{
    const int listed = i - RECORD_COLUMNS - MORE_OF_JOB;
    return listed >= 0 && field_column_is_truth(fields->listed[listed]);
}

static json_t *summary_of(const field_tables *fields, sqlite3_stmt *row)
{
    json_t *summary = json_object();
    assert(sqlite3_column_count(row) == RECORD_COLUMNS + MORE_OF_JOB + (int)fields->listed_count);
    for (int i = RECORD_COLUMNS; i < sqlite3_column_count(row); i++) {
        const char *name = sqlite3_column_name(row, i);
        switch (sqlite3_column_type(row, i)) {
        case SQLITE_INTEGER:
            json_object_set_new(summary, name,
                                is_truth(fields, i) ? json_boolean(sqlite3_column_int(row, i))
                                                    : json_integer(sqlite3_column_int64(row, i)));
            break;
        case SQLITE_FLOAT: json_object_set_new(summary, name, json_real(sqlite3_column_double(row, i))); break;
        case SQLITE_TEXT: json_object_set_new(summary, name, json_string((const char *)sqlite3_column_text(row, i))); break;
        default: break; /* not known yet */
        }
    }
    return summary;
}

static void fill_record(const field_tables *fields, sqlite3_stmt *row, job_record *job)
{
    *job = (job_record){ .number = sqlite3_column_int64(row, 0),
                         .attempt = sqlite3_column_int(row, 4),
                         .progress = sqlite3_column_double(row, 5) };
    copy_text(job->id, sizeof job->id, row, 1);
    copy_text(job->process, sizeof job->process, row, 2);
    const char *status = (const char *)sqlite3_column_text(row, 3);
    job_status_parse(status, strlen(status), &job->status); /* the table's CHECK allows no other names */
    job->eta_seconds = sqlite3_column_type(row, 6) == SQLITE_NULL ? NAN : sqlite3_column_double(row, 6);
    copy_text(job->created, sizeof job->created, row, 7);
    copy_text(job->started, sizeof job->started, row, 8);
    copy_text(job->finished, sizeof job->finished, row, 9);
    copy_text(job->updated, sizeof job->updated, row, 10);
    copy_text(job->message, sizeof job->message, row, 11);
    copy_text(job->study, sizeof job->study, row, 13);
    job->priority = sqlite3_column_int(row, 15);
    job->is_pinned = sqlite3_column_int(row, 14) != 0;
    job->label = json_loads((const char *)sqlite3_column_text(row, 12), 0, NULL);
    job->summary = summary_of(fields, row);
}

store_status store_find_job(job_store *store, const char *id, job_record *job)
{
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_SELECT);
    write_select(&store->fields, &sql);
    text_buffer_print(&sql, " WHERE job.id=?");
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql.failed ? NULL : sql_prepare(reader, sql.text, "t", id);
    text_buffer_clear(&sql);
    store_status status = STORE_FAILED;
    if (statement) {
        const int code = sqlite3_step(statement);
        if (code == SQLITE_ROW) fill_record(&store->fields, statement, job);
        status = sql_finish(statement, code);
        if (status == STORE_OK && code != SQLITE_ROW) status = STORE_NOT_FOUND;
    }
    store_return_reader(store, reader);
    return status;
}

/* One walk over the jobs before it, in their index alone. */
static const char place_sql[] =
    "WITH before(jobs, seconds) AS ("
    " SELECT count(*), total(estimated_seconds) FROM job INDEXED BY job_waiting_turn WHERE status='accepted' AND priority>?1"
    " UNION ALL SELECT count(*), total(estimated_seconds) FROM job INDEXED BY job_waiting_turn"
    " WHERE status='accepted' AND priority=?1 AND (turn,number)<(?2,?3)"
    " UNION ALL SELECT 0, total(coalesce(eta_seconds,estimated_seconds*(1-progress/100))) FROM job WHERE status='running')"
    "SELECT sum(jobs)+1,"
    " strftime('%Y-%m-%dT%H:%M:%fZ','now',format('+%.3f seconds',min(1e9,total(seconds)/?4))) FROM before";

store_status store_find_place(job_store *store, const char *id, queue_place *place)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(reader, "SELECT priority, turn, number FROM job WHERE id=? AND status='accepted'", "t", id);
    int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const bool waits = code == SQLITE_ROW;
    int64_t key[3] = { 0 };
    for (int k = 0; waits && k < 3; k++) key[k] = sqlite3_column_int64(row, k);
    store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    if (waits && status == STORE_OK) {
        row = sql_prepare(reader, place_sql, "iiii", key[0], key[1], key[2], (int64_t)store->places);
        code = row ? sqlite3_step(row) : SQLITE_ERROR;
        if (code == SQLITE_ROW) {
            place->position = sqlite3_column_int64(row, 0);
            copy_text(place->expected_start, sizeof place->expected_start, row, 1);
        }
        status = row ? sql_finish(row, code) : STORE_FAILED;
    }
    store_return_reader(store, reader);
    return status == STORE_OK && !waits ? STORE_NOT_FOUND : status;
}

/* --- lists --- */

/* "a,b" of what is in the set, each with quotes; false: the set is empty. */
static bool write_set(text_buffer *sql, unsigned set, int count, const char *(*name)(int))
{
    bool any = false;
    for (int i = 0; i < count; i++) {
        if (!(set & (1U << i))) continue;
        text_buffer_print(sql, "%s'%s'", any ? "," : "", name(i));
        any = true;
    }
    return any;
}

static const char *name_of_status(int status) { return job_status_name((job_status)status); }
static const char *name_of_process(int process) { return process_types[process]->name; }

static int count_processes(void)
{
    int count = 0;
    while (process_types[count]) count++;
    return count;
}

/* s that a job has run. */
#define SECONDS_RUN                                                                                                                \
    "CASE WHEN job.status<>'accepted' THEN"                                                                                        \
    " round(86400.0*(julianday(coalesce(job.finished,'now'))-julianday(job.started)),3) END"

/* All but the statuses. Only fixed pieces go into the SQL; what the user gave is bound, by bind_filter. */
static void write_condition(const job_filter *filter, text_buffer *sql)
{
    text_buffer_print(sql,
                      " WHERE job.number<?1 AND (?2 IS NULL OR instr(lower(job.label), lower(?2)) OR instr(job.id, ?2)) AND %s",
                      filter->study ? "job.study=(SELECT number FROM study WHERE id=?3)" : "?3 IS NULL");
    if (filter->created_from[0] || filter->created_before[0])
        text_buffer_print(sql, " AND job.created>=?4 AND (?5='' OR job.created<?5)");
    else text_buffer_print(sql, " AND ?4=?5");
    if (isnan(filter->least_seconds) && isnan(filter->most_seconds)) text_buffer_print(sql, " AND ?6 IS ?7");
    else text_buffer_print(sql, " AND " SECONDS_RUN ">=coalesce(?6,0) AND " SECONDS_RUN "<=coalesce(?7,1e300)");
    text_buffer_print(sql, filter->label_name
                               ? " AND EXISTS(SELECT 1 FROM json_each(job.label) WHERE key=?9 AND CAST(value AS TEXT)=?10)"
                               : " AND ?9 IS ?10");
    if (filter->by_type && !filter->type_is_process) text_buffer_print(sql, " AND 0");
    if (!filter->by_process) return;
    text_buffer_print(sql, " AND job.process IN (");
    write_set(sql, filter->processes, count_processes(), name_of_process);
    text_buffer_print(sql, ")");
}

static sqlite3_stmt *prepare_filtered(sqlite3 *reader, const text_buffer *sql, const job_filter *filter, int64_t before)
{
    if (sql->failed) return NULL;
    return sql_prepare(reader, sql->text, "ittttdditt", before, filter->text, filter->study, filter->created_from,
                       filter->created_before, filter->least_seconds, filter->most_seconds, filter->limit, filter->label_name,
                       filter->label_value);
}

/* One status walks its index in order; for several the + keeps the walk on the jobs themselves, newest first, where an
 * index would need a sort of all it finds. */
static void write_list_sql(const field_tables *fields, const job_filter *filter, text_buffer *sql)
{
    const bool single = (filter->statuses & (filter->statuses - 1U)) == 0U;
    write_select(fields, sql);
    write_condition(filter, sql);
    if (filter->statuses) {
        text_buffer_print(sql, single ? " AND job.status IN (" : " AND +job.status IN (");
        write_set(sql, filter->statuses, JOB_STATUSES, name_of_status);
        text_buffer_print(sql, ")");
    }
    text_buffer_print(sql, " ORDER BY job.number DESC LIMIT ?8");
}

store_status store_list_jobs(job_store *store, const job_filter *filter, job_visitor *visit, void *context)
{
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_SELECT);
    write_list_sql(&store->fields, filter, &sql);
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = prepare_filtered(reader, &sql, filter, filter->before ? filter->before : INT64_MAX);
    store_status status = STORE_FAILED;
    if (statement) {
        int code;
        bool more = true;
        while (more && (code = sqlite3_step(statement)) == SQLITE_ROW) {
            job_record job;
            fill_record(&store->fields, statement, &job);
            more = visit(context, &job);
            job_record_clear(&job);
        }
        status = sql_finish(statement, code);
    }
    store_return_reader(store, reader);
    text_buffer_clear(&sql);
    return status;
}

static bool lets_all_through(const job_filter *filter)
{
    return !filter->label_name && !filter->by_process && !filter->by_type && !filter->text && !filter->study
           && !filter->created_from[0] && !filter->created_before[0] && isnan(filter->least_seconds) && isnan(filter->most_seconds);
}

store_status store_count_listed(job_store *store, const job_filter *filter, int64_t counts[JOB_STATUSES])
{
    if (lets_all_through(filter)) return store_count_jobs(store, counts);
    text_buffer sql;
    text_buffer_init(&sql, 8192);
    text_buffer_print(&sql, "SELECT job.status, count(*) FROM job");
    write_condition(filter, &sql);
    text_buffer_print(&sql, " GROUP BY job.status LIMIT max(?8, 5)");
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = prepare_filtered(reader, &sql, filter, INT64_MAX);
    store_status status = STORE_FAILED;
    memset(counts, 0, JOB_STATUSES * sizeof *counts);
    if (statement) {
        int code;
        while ((code = sqlite3_step(statement)) == SQLITE_ROW) {
            const char *name = (const char *)sqlite3_column_text(statement, 0);
            job_status of;
            if (job_status_parse(name, strlen(name), &of)) counts[of] = sqlite3_column_int64(statement, 1);
        }
        status = sql_finish(statement, code);
    }
    store_return_reader(store, reader);
    text_buffer_clear(&sql);
    return status;
}

/* A walk over rows of one job that begin with number, step and time. */
static store_status walk(job_store *store, const char *sql, const char *id, int64_t after, int64_t limit, store_row_taker *take,
                         void *context)
{
    sqlite3 *reader = store_borrow_reader(store);
    return store_walk(store, reader, sql_prepare(reader, sql, "tii", id, after, limit), take, context);
}

typedef struct sample_walk {
    sample_visitor *visit;
    void *context;
} sample_walk;

static bool take_sample(sqlite3_stmt *row, void *context)
{
    const sample_walk *to = context;
    const sample_row sample = { sqlite3_column_int64(row, 0), sqlite3_column_int64(row, 1), sqlite3_column_double(row, 2),
                                (const char *)sqlite3_column_text(row, 3) };
    return to->visit(to->context, &sample);
}

store_status store_list_samples(job_store *store, const char *id, int64_t after, int64_t limit, sample_visitor *visit,
                                void *context)
{
    sample_walk to = { visit, context };
    return walk(store,
                "SELECT number, step, time, measures FROM sample WHERE job=(SELECT number FROM job WHERE id=?) AND number>?"
                " ORDER BY number LIMIT ?",
                id, after, limit, take_sample, &to);
}

typedef struct snapshot_walk {
    snapshot_visitor *visit;
    void *context;
} snapshot_walk;

static bool take_snapshot(sqlite3_stmt *row, void *context)
{
    const snapshot_walk *to = context;
    const snapshot_row snapshot = { sqlite3_column_int64(row, 0), sqlite3_column_int64(row, 1), sqlite3_column_int64(row, 2),
                                    sqlite3_column_int64(row, 3), sqlite3_column_double(row, 4) };
    return to->visit(to->context, &snapshot);
}

store_status store_list_snapshots(job_store *store, const char *id, int64_t after, int64_t limit, snapshot_visitor *visit,
                                  void *context)
{
    snapshot_walk to = { visit, context };
    return walk(
        store,
        "SELECT number, step, bytes, particles, time FROM snapshot WHERE job=(SELECT number FROM job WHERE id=?) AND number>?"
        " ORDER BY number LIMIT ?",
        id, after, limit, take_snapshot, &to);
}
