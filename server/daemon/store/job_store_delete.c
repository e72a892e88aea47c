/* Jobs that have ended: tried again, or deleted with all that the tables have of them. Studies likewise. */
#include <stdlib.h>
#include <time.h>

#include "database.h"
#include "job_store.h"
#include "log.h"

/* The first column of the first row, a number or a count; between begin and end. */
static store_status read_number(job_store *store, const char *sql, const char *id, int64_t *number)
{
    sqlite3_stmt *statement = sql_prepare(store->writer, sql, "t", id);
    if (!statement) return STORE_FAILED;
    const int code = sqlite3_step(statement);
    *number = code == SQLITE_ROW ? sqlite3_column_int64(statement, 0) : 0;
    const store_status status = sql_finish(statement, code);
    return status == STORE_OK && code != SQLITE_ROW ? STORE_NOT_FOUND : status;
}

static store_status put_into_queue(job_store *store, const char *id)
{
    int64_t may_be;
    char now[JOB_TIME_SIZE];
    time_text(now);
    store_status status = read_number(store, "SELECT status IN ('failed','dismissed') FROM job WHERE id=?", id, &may_be);
    if (status == STORE_OK && !may_be) return STORE_CONFLICT;
    if (status == STORE_OK) status = store_check_queue(store, 1);
    if (status != STORE_OK) return status;
    store_name_made(id);
    return sql_run(store->writer, NULL, STORE_TRY_AGAIN "WHERE id=?", "tt", now, id);
}

store_status store_retry_job(job_store *store, const char *id)
{
    const store_status status = store_begin(store);
    return status == STORE_OK ? store_end(store, put_into_queue(store, id)) : status;
}

store_status store_pin_job(job_store *store, const char *id, bool pinned)
{
    int64_t number;
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = read_number(store, "SELECT number FROM job WHERE id=?", id, &number);
    if (status == STORE_OK)
        status = sql_run(store->writer, NULL, pinned ? "INSERT OR IGNORE INTO pinned VALUES(?)" : "DELETE FROM pinned WHERE job=?",
                         "i", number);
    return store_end(store, status);
}

/* Those of its jobs that failed. */
static store_status put_failed_into_queue(job_store *store, const char *id)
{
    int64_t failed, number = 0;
    char now[JOB_TIME_SIZE];
    time_text(now);
    store_status status = read_number(store, "SELECT failed FROM study WHERE id=?", id, &failed);
    if (status == STORE_OK && failed == 0) return STORE_CONFLICT;
    if (status == STORE_OK) status = store_check_queue(store, failed);
    if (status == STORE_OK) status = read_number(store, "SELECT number FROM study WHERE id=?", id, &number);
    if (status != STORE_OK) return status;
    store_name_made(id);
    return sql_run(store->writer, NULL, STORE_TRY_AGAIN "WHERE study=? AND +status='failed'", "ti", now, number);
}

store_status store_retry_study(job_store *store, const char *id)
{
    const store_status status = store_begin(store);
    return status == STORE_OK ? store_end(store, put_failed_into_queue(store, id)) : status;
}

/* Out of the way before the answer is sent; what is in them goes later (folder_remover.h). */
void store_put_folders_aside(job_store *store, double since)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader, "SELECT id FROM leaving WHERE since=?", "d", since);
    int code = SQLITE_ERROR;
    while (statement && (code = sqlite3_step(statement)) == SQLITE_ROW)
        job_folder_put_aside(store->data, (const char *)sqlite3_column_text(statement, 0));
    if (statement) sql_finish(statement, code);
    store_return_reader(store, reader);
}

static store_status delete_job(job_store *store, const char *id, double since)
{
    int64_t has_ended;
    store_status status = read_number(store, "SELECT status NOT IN ('accepted','running') FROM job WHERE id=?", id, &has_ended);
    if (status == STORE_OK && !has_ended) return STORE_CONFLICT;
    if (status == STORE_OK) status = sql_run(store->writer, NULL, "INSERT INTO leaving(id,since) VALUES(?,?)", "td", id, since);
    if (status == STORE_OK) status = sql_run(store->writer, NULL, "DELETE FROM job WHERE id=?", "t", id);
    return status;
}

/* Its jobs first: they refer to it. */
static store_status delete_study(job_store *store, const char *id, double since)
{
    int64_t unfinished, number = 0;
    store_status status = read_number(store, "SELECT accepted+running FROM study WHERE id=?", id, &unfinished);
    if (status == STORE_OK && unfinished > 0) return STORE_CONFLICT;
    if (status == STORE_OK) status = read_number(store, "SELECT number FROM study WHERE id=?", id, &number);
    if (status == STORE_OK)
        status =
            sql_run(store->writer, NULL, "INSERT INTO leaving(id,since) SELECT id, ? FROM job WHERE study=?", "di", since, number);
    if (status == STORE_OK) status = sql_run(store->writer, NULL, "DELETE FROM job WHERE study=?", "i", number);
    if (status == STORE_OK) status = sql_run(store->writer, NULL, "DELETE FROM study WHERE number=?", "i", number);
    return status;
}

static store_status delete_one(job_store *store, store_status (*from_tables)(job_store *, const char *, double), const char *id)
{
    const double since = unix_seconds();
    store_status status = store_begin(store);
    if (status == STORE_OK) status = store_end(store, from_tables(store, id, since));
    if (status == STORE_OK) store_put_folders_aside(store, since);
    return status;
}

store_status store_delete_job(job_store *store, const char *id) { return delete_one(store, delete_job, id); }

store_status store_delete_study(job_store *store, const char *id) { return delete_one(store, delete_study, id); }
