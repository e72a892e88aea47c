#include "folder_remover.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "database.h"
#include "log.h"

/* s between looks at what is not to be kept: less often where one takes long */
#define BETWEEN_PRUNINGS 60.0
#define SHARE_OF_PRUNING 50.0

enum { SECONDS_UNTIL_AGAIN = 2, SECONDS_KEPT = 60, IDS_A_LOOK = 1000 };

/* The next ids behind `after`, which becomes the last of them. Their number; negative: the database can't be read. */
static int list_ids(job_store *store, char after[JOB_ID_SIZE], char (*id)[JOB_ID_SIZE])
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement =
        sql_prepare(reader, "SELECT id FROM leaving WHERE id>? ORDER BY id LIMIT ?", "ti", after, (int64_t)IDS_A_LOOK);
    int count = 0, code = SQLITE_ERROR;
    while (statement && (code = sqlite3_step(statement)) == SQLITE_ROW)
        snprintf(id[count++], JOB_ID_SIZE, "%s", (const char *)sqlite3_column_text(statement, 0));
    if (!statement || sql_finish(statement, code) != STORE_OK) count = -1;
    store_return_reader(store, reader);
    if (count > 0) snprintf(after, JOB_ID_SIZE, "%s", id[count - 1]);
    return count;
}

/* True: none of the folders that have to go is there any more. */
static bool remove_folders(folder_remover *remover, int64_t *rows)
{
    char after[JOB_ID_SIZE] = "", (*id)[JOB_ID_SIZE] = calloc(IDS_A_LOOK, sizeof *id);
    bool all = id != NULL;
    int count = 1;
    *rows = 0;
    while (id && count > 0 && !remover->stopping) {
        count = list_ids(remover->store, after, id);
        for (int i = 0; i < count && !remover->stopping; i++)
            all = job_folder_remove(remover->store->data, id[i], &remover->stopping) && all;
        if (count > 0) *rows += count;
    }
    free(id);
    return all && count == 0;
}

static store_status forget(job_store *store, double until, int64_t *forgotten)
{
    const store_status status = store_begin(store);
    return status == STORE_OK
               ? store_end(store, sql_run(store->writer, forgotten, "DELETE FROM leaving WHERE since<=?", "d", until))
               : status;
}

/* One look. Seconds until the next; 0: nothing is left. */
static int look(folder_remover *remover)
{
    int64_t rows, forgotten = 0;
    const double now = unix_seconds();
    if (!remove_folders(remover, &rows)) return SECONDS_UNTIL_AGAIN; /* a worker has not left yet, or a disk refuses */
    if (rows == 0) return 0;
    if (forget(remover->store, now - SECONDS_KEPT, &forgotten) != STORE_OK) return SECONDS_KEPT;
    return forgotten < rows ? SECONDS_KEPT + 1 : 0;
}

/* Seconds until the next; 0: there is nothing to keep to. */
static int prune(folder_remover *remover)
{
    const double start = monotonic_seconds();
    pthread_mutex_lock(&remover->lock);
    const prune_rules rules = remover->rules;
    const double next = remover->prune_next;
    pthread_mutex_unlock(&remover->lock);
    if (rules.keep_days == 0 && !(rules.keep_bytes > 0.0)) return 0;
    if (start < next) return 1 + (int)fmin(1e6, next - start);
    prune_tally tally = { .jobs = 0 };
    store_prune(remover->store, &rules, &remover->stopping, &tally);
    const double end = monotonic_seconds(), pause = fmax(BETWEEN_PRUNINGS, SHARE_OF_PRUNING * (end - start));
    pthread_mutex_lock(&remover->lock);
    if (remover->prune_next <= next) remover->prune_next = end + pause; /* else other rules came meanwhile */
    remover->pruned.jobs += tally.jobs;
    remover->pruned.studies += tally.studies;
    remover->pruned.stripped += tally.stripped;
    remover->pruned.bytes += tally.bytes;
    pthread_mutex_unlock(&remover->lock);
    return 1 + (int)fmin(1e6, pause);
}

prune_tally folder_remover_pruned(folder_remover *remover)
{
    pthread_mutex_lock(&remover->lock);
    const prune_tally pruned = remover->pruned;
    pthread_mutex_unlock(&remover->lock);
    return pruned;
}

bool prune_once(const char *path, const prune_rules *rules)
{
    data_folder data;
    int64_t rows;
    if (!data_folder_open(&data, path)) return false;
    folder_remover remover = { .store = store_open(&data, 1) };
    prune_tally tally = { .jobs = 0 };
    bool good = remover.store && store_prune(remover.store, rules, &remover.stopping, &tally) == STORE_OK;
    if (good && !rules->only_tell) good = remove_folders(&remover, &rows);
    if (good)
        printf("%lld jobs and %lld studies%s deleted, snapshots of %lld jobs%s removed: %.3g MB\n", (long long)tally.jobs,
               (long long)tally.studies, rules->only_tell ? " would be" : "", (long long)tally.stripped,
               rules->only_tell ? " would be" : "", 1e-6 * tally.bytes);
    if (remover.store) store_close(remover.store);
    data_folder_close(&data);
    return good;
}

static void *remove_what_leaves(void *context)
{
    folder_remover *remover = context;
    store_warm(remover->store);
    while (!remover->stopping) {
        const int until_prune = prune(remover), until_look = look(remover);
        const int seconds = until_look == 0 || (until_prune > 0 && until_prune < until_look) ? until_prune : until_look;
        struct timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_sec += seconds;
        pthread_mutex_lock(&remover->lock);
        int woken = 0;
        while (!remover->is_due && !remover->stopping && woken == 0)
            woken = seconds ? pthread_cond_timedwait(&remover->wakes, &remover->lock, &until)
                            : pthread_cond_wait(&remover->wakes, &remover->lock);
        remover->is_due = false;
        pthread_mutex_unlock(&remover->lock);
    }
    return NULL;
}

bool folder_remover_start(folder_remover *remover, job_store *store, const prune_rules *rules)
{
    *remover = (folder_remover){ .store = store, .rules = *rules };
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&remover->lock, NULL);
    pthread_cond_init(&remover->wakes, &monotonic);
    pthread_condattr_destroy(&monotonic);
    if (pthread_create(&remover->thread, NULL, remove_what_leaves, remover) == 0) return true;
    log_line("no thread is to be had for removing folders");
    return false;
}

void folder_remover_set_rules(folder_remover *remover, const prune_rules *rules)
{
    pthread_mutex_lock(&remover->lock);
    remover->rules = *rules;
    remover->prune_next = monotonic_seconds();
    remover->is_due = true;
    pthread_cond_signal(&remover->wakes);
    pthread_mutex_unlock(&remover->lock);
}

void folder_remover_wake(folder_remover *remover)
{
    pthread_mutex_lock(&remover->lock);
    remover->is_due = true;
    pthread_cond_signal(&remover->wakes);
    pthread_mutex_unlock(&remover->lock);
}

void folder_remover_stop(folder_remover *remover)
{
    pthread_mutex_lock(&remover->lock);
    remover->stopping = true;
    pthread_cond_signal(&remover->wakes);
    pthread_mutex_unlock(&remover->lock);
    pthread_join(remover->thread, NULL);
}
