/* Many jobs at once, cancelled or deleted by a filter: in pieces, so that nobody else waits long for the writer. */
#include <stdlib.h>
#include <string.h>

#include "database.h"
#include "job_store.h"
#include "log.h"

/* s: of a piece, for which the writer is held, and of all, for which the lane of what writes is */
#define SECONDS_A_PIECE 0.05
#define SECONDS_AT_ONCE 1.0

typedef struct batch {
    job_store *store;
    bool deletes;
    int64_t *number; /* (count) of jobs, oldest first; owned */
    size_t count, next;
    job_batch *result;
} batch;

static int compare_numbers(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

static bool take_pinned(sqlite3_stmt *row, void *context)
{
    batch *all = context;
    const int64_t pinned = sqlite3_column_int64(row, 0);
    int64_t *found = bsearch(&pinned, all->number, all->count, sizeof pinned, compare_numbers);
    if (!found) return true;
    memmove(found, found + 1, (size_t)(all->number + all->count - found - 1) * sizeof *found);
    all->count--;
    all->result->pinned++;
    return true;
}

/* Who pinned a job meant it to stay, and hardly thought of it at the filter. */
static store_status leave_pinned(batch *all)
{
    sqlite3 *reader = store_borrow_reader(all->store);
    return store_walk(all->store, reader, sql_prepare(reader, "SELECT job FROM pinned", ""), take_pinned, all);
}

static store_status find(batch *all, const job_filter *filter)
{
    const unsigned ended = 1U << JOB_SUCCESSFUL | 1U << JOB_FAILED | 1U << JOB_DISMISSED, every = (1U << JOB_STATUSES) - 1;
    const unsigned wanted = filter->statuses ? filter->statuses : every, fit = wanted & (all->deletes ? ended : every & ~ended);
    int64_t counts[JOB_STATUSES] = { 0 };
    job_filter narrow = *filter;
    narrow.statuses = fit;
    store_status status = store_find_all(all->store, &narrow, counts, &all->number, &all->count);
    if (status != STORE_OK) return status;
    for (int s = 0; s < JOB_STATUSES; s++)
        if ((wanted & ~fit) & (1U << s)) all->result->unfit += counts[s];
    if (fit == 0) all->count = 0; /* to the filter 0 means all */
    return all->deletes ? leave_pinned(all) : STORE_OK;
}

static store_status tell_ids(batch *all, size_t from, size_t to, bool (*tell)(void *context, const char *id), void *context)
{
    store_status status = STORE_OK;
    sqlite3 *reader = store_borrow_reader(all->store);
    bool more = true;
    for (size_t k = from; status == STORE_OK && more && k < to; k++) {
        sqlite3_stmt *row = sql_prepare(reader, "SELECT id FROM job WHERE number=?", "i", all->number[k]);
        const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
        if (code == SQLITE_ROW) more = tell(context, (const char *)sqlite3_column_text(row, 0));
        status = row ? sql_finish(row, code) : STORE_FAILED;
    }
    store_return_reader(all->store, reader);
    return status;
}

/* Between begin and end. changed: 0 where the job has changed since it was found, or is gone. */
static store_status change_one(batch *all, int64_t number, double since, int64_t *changed)
{
    sqlite3 *writer = all->store->writer;
    char now[JOB_TIME_SIZE];
    time_text(now);
    if (!all->deletes)
        return sql_run(
            writer, changed,
            "UPDATE job SET status='dismissed', message='dismissed on request', eta_seconds=NULL, finished=?1, updated=?1"
            " WHERE number=?2 AND status IN ('accepted','running')",
            "ti", now, number);
    store_status status = sql_run(writer, changed,
                                  "INSERT INTO leaving(id,since) SELECT id, ? FROM job WHERE number=?"
                                  " AND status NOT IN ('accepted','running') AND number NOT IN (SELECT job FROM pinned)",
                                  "di", since, number);
    if (status == STORE_OK && *changed > 0) status = sql_run(writer, NULL, "DELETE FROM job WHERE number=?", "i", number);
    return status;
}

static store_status change_piece(batch *all)
{
    const double start = monotonic_seconds(), since = unix_seconds();
    int64_t changed = 0, one;
    size_t next = all->next;
    store_status status = store_begin(all->store);
    if (status != STORE_OK) return status;
    while (status == STORE_OK && next < all->count && monotonic_seconds() - start < SECONDS_A_PIECE) {
        status = change_one(all, all->number[next++], since, &one);
        changed += one;
    }
    status = store_end(all->store, status);
    if (status != STORE_OK) return status;
    all->next = next;
    all->result->changed += changed;
    if (all->deletes) store_put_folders_aside(all->store, since);
    return STORE_OK;
}

store_status store_change_jobs(job_store *store, const job_filter *filter, bool deletes, bool only_tell, const client_watch *client,
                               bool (*tell)(void *context, const char *id), void *context, job_batch *result)
{
    *result = (job_batch){ 0 };
    batch all = { .store = store, .deletes = deletes, .result = result };
    const double start = monotonic_seconds();
    store_status status = find(&all, filter);
    result->found = (int64_t)all.count;
    if (status == STORE_OK) status = tell_ids(&all, 0, all.count, tell, context);
    while (status == STORE_OK && !only_tell && all.next < all.count && monotonic_seconds() - start < SECONDS_AT_ONCE
           && !client_has_left(client))
        status = change_piece(&all);
    result->left = (int64_t)(all.count - all.next);
    free(all.number);
    /* What is done is told, also where the disk refused the rest. */
    return result->changed > 0 ? STORE_OK : status;
}
