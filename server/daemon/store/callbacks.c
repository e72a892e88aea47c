#include "callbacks.h"

#include <stdio.h>
#include <string.h>

#include "database.h"
#include "log.h"

#define SECONDS_TRIED (3 * 86400.0)
#define LONGEST_DELAY (2 * 3600.0) /* twice what the sender ever asks for */
enum { TIMES_TRIED = 20, MOST_CALLBACKS = 100000 };

static const char *address(const json_t *subscriber, const char *name)
{
    return json_string_value(json_object_get(subscriber, name));
}

store_status store_insert_subscriber(sqlite3 *writer, int64_t job, const json_t *subscriber)
{
    if (!subscriber) return STORE_OK;
    const char *base = address(subscriber, "base");
    return sql_run(writer, NULL, "INSERT INTO subscriber(job,success,in_progress,failed,base) VALUES(?,?,?,?,?)", "itttt", job,
                   address(subscriber, "successUri"), address(subscriber, "inProgressUri"), address(subscriber, "failedUri"),
                   base ? base : "");
}

store_status store_next_callback(job_store *store, callback *next)
{
    *next = (callback){ 0 };
    const double now = unix_seconds(); /* what is put off for longer than anything ever is, was so before the clock was set back */
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(reader,
                                    "SELECT c.job, c.news, c.tries, job.id, c.kind, c.uri, s.base FROM callback c"
                                    " JOIN job ON job.number=c.job JOIN subscriber s ON s.job=c.job"
                                    " WHERE c.due NOT BETWEEN ? AND ? ORDER BY c.due LIMIT 1",
                                    "dd", now, now + LONGEST_DELAY);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) {
        next->job = sqlite3_column_int64(row, 0);
        next->news = sqlite3_column_int64(row, 1);
        next->tries = sqlite3_column_int(row, 2);
        snprintf(next->id, sizeof next->id, "%s", (const char *)sqlite3_column_text(row, 3));
        snprintf(next->kind, sizeof next->kind, "%s", (const char *)sqlite3_column_text(row, 4));
        snprintf(next->uri, sizeof next->uri, "%s", (const char *)sqlite3_column_text(row, 5));
        snprintf(next->base, sizeof next->base, "%s", (const char *)sqlite3_column_text(row, 6));
    }
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    return status == STORE_OK && code != SQLITE_ROW ? STORE_NOT_FOUND : status;
}

store_status store_end_callback(job_store *store, const callback *told)
{
    const store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    return store_end(store, sql_run(store->writer, NULL, "DELETE FROM callback WHERE job=? AND kind=? AND news=?", "iti", told->job,
                                    told->kind, told->news));
}

store_status store_put_off_callback(job_store *store, const callback *told, bool was_tried, double seconds, const char *same_host)
{
    const double until = unix_seconds() + seconds;
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = sql_run(store->writer, NULL, "UPDATE callback SET tries=tries+? WHERE job=? AND kind=? AND news=?", "iiti",
                     (int64_t)was_tried, told->job, told->kind, told->news);
    if (status == STORE_OK)
        status = sql_run(store->writer, NULL, "UPDATE callback SET due=?1 WHERE due<?1 AND substr(uri,1,length(?2))=?2", "dt",
                         until, same_host);
    return store_end(store, status);
}

store_status store_forget_callbacks(job_store *store, int64_t *forgotten)
{
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = sql_run(store->writer, forgotten,
                     "DELETE FROM callback WHERE (since<=? AND tries>=?)"
                     " OR since<(SELECT since FROM callback ORDER BY since DESC LIMIT 1 OFFSET ?)",
                     "dii", unix_seconds() - SECONDS_TRIED, (int64_t)TIMES_TRIED, (int64_t)MOST_CALLBACKS);
    return store_end(store, status);
}
