/* Keys of requests that may be sent again. A key is kept by the commit of what its request did, so neither is there without the
 * other; the answer, which is made of what was committed, follows in a commit of its own. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "database.h"
#include "job_store.h"
#include "log.h"

#define SECONDS_KEPT (7 * 86400.0)
enum { MOST_KEYS = 100000, LONGEST_ANSWER = 64 << 10 };

static _Thread_local request_key *used;
static _Thread_local char made[JOB_ID_SIZE];

void store_use_key(request_key *key)
{
    used = key;
    made[0] = '\0';
}

void store_name_made(const char *id) { snprintf(made, sizeof made, "%s", id); }

/* Those whose time is up, and the oldest of too many. */
static store_status forget_old(job_store *store, double now)
{
    const store_status status = sql_run(store->writer, NULL, "DELETE FROM request_key WHERE since<=?", "d", now - SECONDS_KEPT);
    if (status != STORE_OK) return status;
    return sql_run(store->writer, NULL, "DELETE FROM request_key WHERE number<=(SELECT max(number) FROM request_key)-?", "i",
                   (int64_t)MOST_KEYS - 1);
}

store_status store_keep_key(job_store *store)
{
    request_key *key = used;
    int64_t added;
    if (!key || key->is_kept) return STORE_OK;
    const double now = unix_seconds();
    store_status status = forget_old(store, now);
    if (status == STORE_OK)
        status = sql_run(store->writer, &added, "INSERT OR IGNORE INTO request_key(key,fingerprint,since,made) VALUES(?,?,?,?)",
                         "tidt", key->key, (int64_t)key->fingerprint, now, made);
    if (status != STORE_OK) return status;
    key->is_taken = added == 0;
    key->is_kept = added > 0;
    return key->is_taken ? STORE_CONFLICT : STORE_OK;
}

store_status store_find_answer(job_store *store, const char *key, kept_answer *answer)
{
    *answer = (kept_answer){ 0 };
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row =
        sql_prepare(reader, "SELECT fingerprint, made, status, location, body FROM request_key WHERE key=? AND since>?", "td", key,
                    unix_seconds() - SECONDS_KEPT);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) {
        const char *location = (const char *)sqlite3_column_text(row, 3), *body = (const char *)sqlite3_column_text(row, 4);
        answer->fingerprint = (uint64_t)sqlite3_column_int64(row, 0);
        snprintf(answer->made, sizeof answer->made, "%s", (const char *)sqlite3_column_text(row, 1));
        answer->status = sqlite3_column_int(row, 2);
        snprintf(answer->location, sizeof answer->location, "%s", location ? location : "");
        answer->body = body ? strdup(body) : NULL;
    }
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    return status == STORE_OK && code != SQLITE_ROW ? STORE_NOT_FOUND : status;
}

void store_keep_answer(job_store *store, const char *key, int status, const char *location, const char *body)
{
    if (strlen(body) > LONGEST_ANSWER || store_begin(store) != STORE_OK) return;
    const store_status kept =
        store_end(store, sql_run(store->writer, NULL, "UPDATE request_key SET status=?, location=?, body=? WHERE key=?", "ittt",
                                 (int64_t)status, location, body, key));
    if (kept != STORE_OK) log_line("the answer to a request with an Idempotency-Key is not kept");
}
