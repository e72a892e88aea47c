/* Walks over jobs, samples and snapshots. */
#include <assert.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "checksum.h"
#include "database.h"
#include "job_folder.h"
#include "job_index.h"
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

static const char *name_of(const field_tables *fields, int i)
{
    static const char *const of_job[MORE_OF_JOB] = { "threads", "estimated_seconds" };
    return i < MORE_OF_JOB ? of_job[i] : fields->listed[i - MORE_OF_JOB]->shown_as;
}

/* False: it is not known yet. */
static bool read_value(const field_tables *fields, sqlite3_stmt *row, int i, summary_value *value)
{
    const int column = RECORD_COLUMNS + i;
    *value = (summary_value){ .name = name_of(fields, i) };
    switch (sqlite3_column_type(row, column)) {
    case SQLITE_INTEGER:
        value->kind = i >= MORE_OF_JOB && field_column_is_truth(fields->listed[i - MORE_OF_JOB]) ? SUMMARY_TRUTH : SUMMARY_WHOLE;
        value->whole = sqlite3_column_int64(row, column);
        return true;
    case SQLITE_FLOAT:
        value->kind = SUMMARY_REAL;
        value->real = sqlite3_column_double(row, column);
        return isfinite(value->real);
    case SQLITE_TEXT:
        value->kind = SUMMARY_TEXT;
        value->text = strdup((const char *)sqlite3_column_text(row, column));
        return value->text != NULL;
    default: return false;
    }
}

static void read_summary(const field_tables *fields, sqlite3_stmt *row, job_record *job)
{
    const int count = MORE_OF_JOB + (int)fields->listed_count;
    assert(sqlite3_column_count(row) == RECORD_COLUMNS + count);
    job->summary = malloc((size_t)count * sizeof *job->summary);
    for (int i = 0; job->summary && i < count; i++)
        if (read_value(fields, row, i, &job->summary[job->summary_count])) job->summary_count++;
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
    read_summary(fields, row, job);
}

/* column: of the table, which is this id, or this number where there is none. */
static store_status find_by(job_store *store, const char *column, const char *id, int64_t number, job_record *job)
{
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_SELECT);
    write_select(&store->fields, &sql);
    text_buffer_print(&sql, " WHERE job.%s=?", column);
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql.failed ? NULL
                              : id       ? sql_prepare(reader, sql.text, "t", id)
                                         : sql_prepare(reader, sql.text, "i", number);
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

store_status store_find_job(job_store *store, const char *id, job_record *job) { return find_by(store, "id", id, 0, job); }

store_status store_find_numbered_job(job_store *store, int64_t number, job_record *job)
{
    return find_by(store, "number", NULL, number, job);
}

/* One walk over the jobs before it, in their index alone; `and`: what else they are. `running`: of which jobs at work the
 * rest has to be waited for, at so many places. */
#define PLACE(index, and, running, places)                                                                                         \
    "WITH before(jobs, seconds) AS ("                                                                                              \
    " SELECT count(*), total(estimated_seconds) FROM job INDEXED BY " index " WHERE status='accepted' AND priority>?1"             \
        and " UNION ALL SELECT count(*), total(estimated_seconds) FROM job INDEXED BY " index                                      \
            " WHERE status='accepted' AND priority=?1 AND (turn,number)<(?2,?3)"                                                   \
        and " UNION ALL SELECT 0, total(coalesce(eta_seconds,estimated_seconds*(1-progress/100))) FROM job WHERE "                 \
            "status='running'" running ")SELECT sum(jobs)+1,"                                                                      \
            " strftime('%Y-%m-%dT%H:%M:%fZ','now',format('+%.3f seconds',min(1e9,total(seconds)/" places                           \
            "))) FROM before WHERE ?4>0"
#define IS_SHORT " AND estimated_seconds<2.0"
static const char place_sql[] = PLACE("job_waiting_turn", "", "", "?4");
static const char lane_sql[] = PLACE("job_waiting_short", IS_SHORT, IS_SHORT, "1");

static store_status read_place(sqlite3 *reader, const char *sql, const int64_t key[3], int64_t places, queue_place *place)
{
    sqlite3_stmt *row = sql_prepare(reader, sql, "iiii", key[0], key[1], key[2], places);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) {
        place->position = sqlite3_column_int64(row, 0);
        copy_text(place->expected_start, sizeof place->expected_start, row, 1);
    }
    return row ? sql_finish(row, code) : STORE_FAILED;
}

/* A short job starts by whichever comes first, its turn or the lane; those that it overtakes there are not before it. */
store_status store_find_place(job_store *store, const char *id, queue_place *place)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(
        reader, "SELECT priority, turn, number, estimated_seconds<2.0 FROM job WHERE id=? AND status='accepted'", "t", id);
    int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const bool waits = code == SQLITE_ROW;
    int64_t key[4] = { 0 };
    for (int k = 0; waits && k < 4; k++) key[k] = sqlite3_column_int64(row, k);
    store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    if (waits && status == STORE_OK) status = read_place(reader, place_sql, key, store->places, place);
    if (waits && status == STORE_OK && key[3]) {
        queue_place lane;
        status = read_place(reader, lane_sql, key, store->places, &lane);
        place->position = lane.position;
        if (status == STORE_OK && strcmp(lane.expected_start, place->expected_start) < 0)
            memcpy(place->expected_start, lane.expected_start, sizeof place->expected_start);
    }
    store_return_reader(store, reader);
    return status == STORE_OK && !waits ? STORE_NOT_FOUND : status;
}

/* --- lists --- */

/* Newest first, of one status or of all: what the database lists by an index, and has counted. */
static bool is_plain(const job_filter *filter)
{
    const bool single = (filter->statuses & (filter->statuses - 1U)) == 0U;
    return single && !filter->label_name && !filter->by_process && !filter->by_type && !filter->text && !filter->study
           && !filter->created_from[0] && !filter->created_before[0] && isnan(filter->least_seconds) && isnan(filter->most_seconds)
           && filter->range_count == 0 && !filter->sort;
}

const field_columns *store_columns(const job_store *store) { return &store->fields.columns; }

bool store_lists_quickly(job_store *store, const job_filter *filter)
{
    return is_plain(filter) || job_index_is_ready(store->index, filter);
}

static const char *only_status(const job_filter *filter)
{
    for (int s = 0; s < JOB_STATUSES; s++)
        if (filter->statuses == 1U << s) return job_status_name((job_status)s);
    return NULL;
}

static store_status list_plainly(job_store *store, const job_filter *filter, job_visitor *visit, void *context)
{
    const char *status = only_status(filter);
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_SELECT);
    write_select(&store->fields, &sql);
    text_buffer_print(&sql, " WHERE job.number<?1 AND %s ORDER BY job.number DESC LIMIT ?3",
                      status ? "job.status=?2" : "?2 IS NULL");
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement =
        sql.failed ? NULL : sql_prepare(reader, sql.text, "iti", filter->after ? filter->after : INT64_MAX, status, filter->limit);
    store_status result = STORE_FAILED;
    if (statement) {
        int code;
        bool more = true;
        while (more && (code = sqlite3_step(statement)) == SQLITE_ROW) {
            job_record job;
            fill_record(&store->fields, statement, &job);
            snprintf(job.cursor, sizeof job.cursor, "%lld", (long long)job.number);
            more = visit(context, &job);
            job_record_clear(&job);
        }
        result = sql_finish(statement, code);
    }
    store_return_reader(store, reader);
    text_buffer_clear(&sql);
    return result;
}

/* One that has changed since it was found, and does not fit any more, is passed over. False ends the walk. */
static bool visit_one(const job_store *store, sqlite3_stmt *row, const job_filter *filter, const found_job *found,
                      job_visitor *visit, void *context)
{
    job_record job;
    fill_record(&store->fields, row, &job);
    memcpy(job.cursor, found->cursor, sizeof job.cursor);
    const bool more = filter->statuses && !(filter->statuses & (1U << job.status)) ? true : visit(context, &job);
    job_record_clear(&job);
    return more;
}

/* In one transaction, since taking the locks of one a job takes longer than reading it. */
static store_status visit_found(job_store *store, sqlite3 *reader, const job_filter *filter, const found_job *found, size_t count,
                                job_visitor *visit, void *context)
{
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_SELECT);
    write_select(&store->fields, &sql);
    text_buffer_print(&sql, " WHERE job.number=?");
    const store_status begun = sql_run(reader, NULL, "BEGIN", "");
    sqlite3_stmt *row = sql.failed || begun != STORE_OK ? NULL : sql_prepare(reader, sql.text, "");
    text_buffer_clear(&sql);
    int code = row ? SQLITE_DONE : SQLITE_ERROR;
    bool more = true;
    for (size_t k = 0; more && k < count && code == SQLITE_DONE; k++) {
        sqlite3_reset(row);
        sqlite3_bind_int64(row, 1, found[k].number);
        code = sqlite3_step(row);
        if (code != SQLITE_ROW) continue;
        more = visit_one(store, row, filter, &found[k], visit, context);
        code = SQLITE_DONE; /* a number is that of one job */
    }
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    if (begun == STORE_OK) sql_run(reader, NULL, "COMMIT", "");
    return status;
}

/* 0: any study will do; -1: there is none of that id. */
static store_status find_study_number(sqlite3 *reader, const char *id, int64_t *number)
{
    *number = 0;
    if (!id) return STORE_OK;
    sqlite3_stmt *row = sql_prepare(reader, "SELECT number FROM study WHERE id=?", "t", id);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    *number = code == SQLITE_ROW ? sqlite3_column_int64(row, 0) : -1;
    return row ? sql_finish(row, code) : STORE_FAILED;
}

static store_status list_found(job_store *store, const job_filter *filter, int64_t counts[JOB_STATUSES], job_visitor *visit,
                               void *context)
{
    found_job *found = malloc((size_t)filter->limit * sizeof *found);
    if (!found) return STORE_FAILED;
    int64_t study;
    size_t count = 0;
    sqlite3 *reader = store_borrow_reader(store);
    store_status status = find_study_number(reader, filter->study, &study);
    if (status == STORE_OK) status = job_index_find(store->index, reader, filter, study, counts, found, &count);
    if (status == STORE_OK) status = visit_found(store, reader, filter, found, count, visit, context);
    store_return_reader(store, reader);
    free(found);
    return status;
}

store_status store_list_jobs(job_store *store, const job_filter *filter, int64_t counts[JOB_STATUSES], job_visitor *visit,
                             void *context)
{
    if (!is_plain(filter)) return list_found(store, filter, counts, visit, context);
    const store_status status = store_count_jobs(store, counts);
    return status == STORE_OK ? list_plainly(store, filter, visit, context) : status;
}

store_status store_find_all(job_store *store, const job_filter *filter, int64_t counts[JOB_STATUSES], int64_t **numbers,
                            size_t *count)
{
    int64_t study;
    sqlite3 *reader = store_borrow_reader(store);
    *numbers = NULL;
    store_status status = find_study_number(reader, filter->study, &study);
    if (status == STORE_OK) status = job_index_find_all(store->index, reader, filter, study, counts, numbers, count);
    store_return_reader(store, reader);
    return status;
}

void store_warm(job_store *store)
{
    sqlite3 *reader = store_borrow_reader(store);
    job_index_warm(store->index, reader);
    store_return_reader(store, reader);
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
    int folder; /* descriptor of the job's snapshots; -1: there is none */
} snapshot_walk;

/* Files are only ever replaced: another one has another inode, size or time. */
static void look_at_frame(int folder, snapshot_row *snapshot)
{
    char name[64];
    struct stat facts;
    snprintf(name, sizeof name, JOB_FRAME_FILE_FORMAT, (long long)snapshot->number);
    if (folder < 0 || fstatat(folder, name, &facts, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(facts.st_mode)) return;
    const uint64_t seen[] = { facts.st_ino, (uint64_t)facts.st_mtim.tv_sec, (uint64_t)facts.st_mtim.tv_nsec };
    snapshot->frame_bytes = facts.st_size;
    snapshot->frame_version = checksum_of(seen, sizeof seen);
}

static bool take_snapshot(sqlite3_stmt *row, void *context)
{
    const snapshot_walk *to = context;
    snapshot_row snapshot = { .number = sqlite3_column_int64(row, 0),
                              .step = sqlite3_column_int64(row, 1),
                              .bytes = sqlite3_column_int64(row, 2),
                              .particles = sqlite3_column_int64(row, 3),
                              .time = sqlite3_column_double(row, 4) };
    look_at_frame(to->folder, &snapshot);
    return to->visit(to->context, &snapshot);
}

store_status store_list_snapshots(job_store *store, const char *id, int64_t after, int64_t limit, snapshot_visitor *visit,
                                  void *context)
{
    const int job = job_folder_open(store->data, id);
    snapshot_walk to = { visit, context, -1 };
    if (job >= 0) {
        to.folder = openat(job, JOB_SNAPSHOT_FOLDER, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        close(job);
    }
    const store_status status =
        walk(store,
             "SELECT number, step, bytes, particles, time FROM snapshot WHERE job=(SELECT number FROM job WHERE id=?) AND number>?"
             " ORDER BY number LIMIT ?",
             id, after, limit, take_snapshot, &to);
    if (to.folder >= 0) close(to.folder);
    return status;
}

typedef struct column_walk {
    column_visitor *visit;
    void *context;
} column_walk;

static bool take_column(sqlite3_stmt *row, void *context)
{
    const column_walk *to = context;
    const char *type = (const char *)sqlite3_column_text(row, 2);
    return to->visit(to->context, (const char *)sqlite3_column_text(row, 0), (const char *)sqlite3_column_text(row, 1),
                     type ? type : "");
}

store_status store_list_columns(job_store *store, column_visitor *visit, void *context)
{
    column_walk to = { visit, context };
    sqlite3 *reader = store_borrow_reader(store);
    return store_walk(
        store, reader,
        sql_prepare(reader,
                    "SELECT one.name, column.name, column.type FROM sqlite_schema one, pragma_table_xinfo(one.name) column"
                    " WHERE one.type IN ('table','view') AND one.name NOT LIKE 'sqlite_%'"
                    " ORDER BY one.type DESC, one.name, column.cid",
                    ""),
        take_column, &to);
}
