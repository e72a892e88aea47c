/* Transactions of several threads that reach the disk together. A commit waits for the disk, some milliseconds; whoever comes
 * meanwhile waits for the writer, and all of these then share the next one:
 *
 *   store_begin   the first begins a transaction, those after it a savepoint within it
 *   store_end     nobody else waits for the writer: commit for all; else wait until the last of them has
 *
 * So nobody has an answer before its rows are on the disk, what fails is rolled back alone, and one thread by itself commits as
 * ever. What rolls back the whole transaction, a full disk say, fails all of its members. */
#include <stdlib.h>

#include "database.h"
#include "job_store.h"
#include "log.h"

enum { MOST_MEMBERS = 64 };

struct write_group {
    int members; /* who wait for it, whose changes are in it or who saw them; the last that knows what came of it frees it */
    int left;
    bool is_over;
    store_status status;
};

/* With the writer's lock held, as all but store_begin and store_end. */
static store_status open_group(job_store *store)
{
    store->group = calloc(1, sizeof *store->group);
    if (!store->group) return STORE_FAILED;
    const store_status status = sql_run(store->writer, NULL, "BEGIN IMMEDIATE", "");
    if (status == STORE_OK) return STORE_OK;
    free(store->group);
    store->group = NULL;
    return status;
}

/* Ends it for all of its members; the next to come opens another. status: anything but STORE_OK rolls it back. */
static void close_group(job_store *store, store_status status)
{
    write_group *group = store->group;
    store->group = NULL;
    if (status == STORE_OK) status = sql_run(store->writer, NULL, "COMMIT", "");
    /* A full disk may have rolled back by itself already. */
    if (!sqlite3_get_autocommit(store->writer)) sql_run(store->writer, NULL, "ROLLBACK", "");
    size_t count;
    bool are_more;
    const int64_t *changed = job_index_changing(store->index, &count, &are_more);
    if (status == STORE_OK && (count > 0 || are_more)) job_changes_note(store->changes, changed, count, are_more);
    job_index_note_end(store->index, status == STORE_OK);
    pthread_mutex_lock(&store->group_lock);
    group->status = status;
    group->is_over = true;
    pthread_cond_broadcast(&store->group_is_over);
    pthread_mutex_unlock(&store->group_lock);
}

static store_status wait_for(job_store *store, write_group *group)
{
    pthread_mutex_lock(&store->group_lock);
    while (!group->is_over) pthread_cond_wait(&store->group_is_over, &store->group_lock);
    const store_status status = group->status;
    const bool is_last = ++group->left == group->members;
    pthread_mutex_unlock(&store->group_lock);
    if (is_last) free(group);
    return status;
}

/* Nobody waits who could commit later, or enough have joined. */
static bool is_due(job_store *store) { return atomic_load(&store->writers_waiting) == 0 || store->group->members >= MOST_MEMBERS; }

store_status store_begin(job_store *store)
{
    atomic_fetch_add(&store->writers_waiting, 1);
    pthread_mutex_lock(&store->write_lock);
    atomic_fetch_sub(&store->writers_waiting, 1);
    store->is_joined = store->group != NULL;
    const store_status status = store->is_joined ? sql_run(store->writer, NULL, "SAVEPOINT member", "") : open_group(store);
    if (status == STORE_OK) return STORE_OK;
    if (store->is_joined && is_due(store)) close_group(store, STORE_OK); /* the others wait for it */
    pthread_mutex_unlock(&store->write_lock);
    return status;
}

/* False: what this member did can't be told from what the others did, so all goes. */
static bool end_member(job_store *store, store_status *status)
{
    if (*status == STORE_OK) *status = store_keep_key(store);
    if (sqlite3_get_autocommit(store->writer) || !store->is_joined) return *status == STORE_OK;
    if (*status == STORE_OK) *status = sql_run(store->writer, NULL, "RELEASE member", "");
    return *status == STORE_OK
           || (!sqlite3_get_autocommit(store->writer) && sql_run(store->writer, NULL, "ROLLBACK TO member", "") == STORE_OK
               && sql_run(store->writer, NULL, "RELEASE member", "") == STORE_OK);
}

store_status store_end(job_store *store, store_status status)
{
    write_group *group = store->group;
    const bool is_kept = end_member(store, &status);
    /* Who is refused for what others have done waits, too, until that is on the disk. */
    const bool waits = status == STORE_OK || store->is_joined;
    if (waits) group->members++;
    if (!is_kept) close_group(store, status);
    else if (is_due(store)) close_group(store, STORE_OK);
    pthread_mutex_unlock(&store->write_lock);
    if (!waits) { /* it was alone in it */
        free(group);
        return status;
    }
    const store_status common = wait_for(store, group);
    return common == STORE_OK ? status : common;
}

store_status store_try_write(job_store *store)
{
    if (pthread_mutex_trylock(&store->write_lock) != 0) return STORE_OK;
    const bool is_writing = store->group != NULL;
    pthread_mutex_unlock(&store->write_lock);
    if (is_writing) return STORE_OK;
    const store_status status = store_begin(store);
    return status == STORE_OK ? store_end(store, sql_run(store->writer, NULL, "UPDATE job_count SET jobs=jobs", "")) : status;
}
