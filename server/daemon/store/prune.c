#include "prune.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "database.h"
#include "job_folder.h"
#include "log.h"
#include "plan_store.h"

enum { DEEPEST = 2, MOST_ROUNDS = 1000000 };

#define HAS_ENDED "job.status IN ('successful','failed','dismissed')"
#define IS_PINNED "job.number IN (SELECT job FROM pinned)"
#define NO_JOB_LEFT "NOT EXISTS(SELECT 1 FROM calibration_run WHERE calibration=calibration.number AND job IS NOT NULL)"
#define ALL_ENDED "study.accepted+study.running=0 AND NOT EXISTS(SELECT 1 FROM job WHERE job.study=study.number AND " IS_PINNED ")"

typedef struct pruning {
    job_store *store;
    const prune_rules *rules;
    const atomic_bool *stopping;
    prune_tally *tally;
    double bytes; /* of all folders of jobs */
} pruning;

/* --- how large folders are --- */

/* What a file takes; of one with several names, which start from each other's beds, a share. */
static double bytes_of_file(const struct stat *facts)
{
    return 512.0 * (double)facts->st_blocks / fmax(1.0, S_ISREG(facts->st_mode) ? (double)facts->st_nlink : 1.0);
}

static double bytes_in(int folder, const char *name, int depth)
{
    const int inner = openat(folder, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *list = inner >= 0 ? fdopendir(inner) : NULL;
    double bytes = 0.0;
    if (!list && inner >= 0) close(inner);
    for (const struct dirent *entry; list && (entry = readdir(list)) != NULL;) {
        struct stat facts;
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        if (fstatat(dirfd(list), entry->d_name, &facts, AT_SYMLINK_NOFOLLOW) != 0) continue;
        bytes += bytes_of_file(&facts);
        if (S_ISDIR(facts.st_mode) && depth > 0) bytes += bytes_in(dirfd(list), entry->d_name, depth - 1);
    }
    if (list) closedir(list);
    return bytes;
}

/* --- who is next --- */

/* The first column of the first row, a text; "": there is none. The number is that of its second column. */
static store_status next_of(job_store *store, const char *sql, const char *before, int64_t after, char id[JOB_ID_SIZE],
                            int64_t *number)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(reader, sql, "ti", before, after);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    id[0] = '\0';
    if (code == SQLITE_ROW) {
        snprintf(id, JOB_ID_SIZE, "%s", (const char *)sqlite3_column_text(row, 0));
        *number = sqlite3_column_int64(row, 1);
    }
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    return status;
}

static double bytes_of_study(const pruning *p, const char *study)
{
    double bytes = 0.0;
    sqlite3 *reader = store_borrow_reader(p->store);
    sqlite3_stmt *row = sql_prepare(reader, "SELECT id FROM job WHERE study=(SELECT number FROM study WHERE id=?)", "t", study);
    int code = SQLITE_ERROR;
    while (row && (code = sqlite3_step(row)) == SQLITE_ROW)
        bytes += bytes_in(p->store->data->jobs, (const char *)sqlite3_column_text(row, 0), DEEPEST);
    if (row) sql_finish(row, code);
    store_return_reader(p->store, reader);
    return bytes;
}

/* --- what goes --- */

static store_status let_go(pruning *p, const char *id, bool is_study)
{
    const double bytes = is_study ? bytes_of_study(p, id) : bytes_in(p->store->data->jobs, id, DEEPEST);
    store_status status = STORE_OK;
    if (!p->rules->only_tell) status = is_study ? store_delete_study(p->store, id) : store_delete_job(p->store, id);
    if (status == STORE_CONFLICT || status == STORE_NOT_FOUND) return STORE_OK; /* somebody was there before */
    if (status != STORE_OK) return status;
    log_line("%s %s: %sdeleted to make room, %.3g MB", is_study ? "study" : "job", id, p->rules->only_tell ? "would be " : "",
             1e-6 * bytes);
    if (is_study) p->tally->studies++;
    else p->tally->jobs++;
    p->tally->bytes += bytes;
    p->bytes -= bytes;
    return STORE_OK;
}

static void empty_folder(int job, const char *name)
{
    const int inner = job >= 0 ? openat(job, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC) : -1;
    DIR *list = inner >= 0 ? fdopendir(inner) : NULL;
    for (const struct dirent *entry; list && (entry = readdir(list)) != NULL;)
        if (entry->d_name[0] != '.') unlinkat(inner, entry->d_name, 0);
    if (list) closedir(list);
    else if (inner >= 0) close(inner);
}

static void remove_snapshots(const data_folder *data, const char *id)
{
    const int job = job_folder_open(data, id);
    empty_folder(job, JOB_SNAPSHOT_FOLDER);
    empty_folder(job, JOB_BEDS_FOLDER);
    static const char *const beside[] = { JOB_SERIES_FILE, JOB_CHECKPOINT_FILE, JOB_EARLIER_CHECKPOINT_FILE, JOB_BED_FILE };
    for (size_t f = 0; job >= 0 && f < sizeof beside / sizeof beside[0]; f++) unlinkat(job, beside[f], 0);
    if (job >= 0) close(job);
}

/* The rows first: what is not told of any more is nowhere missing. Not of a job that has just been tried again. */
static store_status strip(pruning *p, const char *id)
{
    job_store *store = p->store;
    const double before = bytes_in(store->data->jobs, id, DEEPEST);
    if (!p->rules->only_tell) {
        int64_t changed = 0;
        static const char tell[] = "UPDATE job SET message=message||'; its snapshots and checkpoints were removed to make room'"
                                   " WHERE id=? AND " HAS_ENDED;
        store_status status = store_begin(store);
        if (status != STORE_OK) return status;
        status = sql_run(store->writer, &changed, tell, "t", id);
        if (status == STORE_OK && changed > 0)
            status = sql_run(store->writer, NULL, "DELETE FROM snapshot WHERE job=(SELECT number FROM job WHERE id=?)", "t", id);
        status = store_end(store, status);
        if (status != STORE_OK || changed == 0) return status;
        remove_snapshots(store->data, id);
    }
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row =
        sql_prepare(reader, "SELECT total(bytes) FROM snapshot WHERE job=(SELECT number FROM job WHERE id=?)", "t", id);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const double of_rows = code == SQLITE_ROW ? sqlite3_column_double(row, 0) : 0.0;
    if (row) sql_finish(row, code);
    store_return_reader(store, reader);
    const double bytes = p->rules->only_tell ? of_rows : before - bytes_in(store->data->jobs, id, DEEPEST);
    log_line("job %s: snapshots and checkpoints %sremoved to make room, %.3g MB", id, p->rules->only_tell ? "would be " : "",
             1e-6 * bytes);
    p->tally->stripped++;
    p->tally->bytes += bytes;
    p->bytes -= bytes;
    return STORE_OK;
}

/* One after the other, in order of submission, until there are no more, or it is enough. */
static store_status go_through(pruning *p, const char *sql, const char *before, double enough,
                               store_status (*one)(pruning *, const char *))
{
    store_status status = STORE_OK;
    int64_t number = 0;
    for (int round = 0; status == STORE_OK && !*p->stopping && !(p->bytes <= enough) && round < MOST_ROUNDS; round++) {
        char id[JOB_ID_SIZE];
        status = next_of(p->store, sql, before, number, id, &number);
        if (status != STORE_OK || !id[0]) break;
        status = one(p, id);
    }
    return status;
}

/* Its jobs went as others do, with what they told kept in its runs; those that are left, pinned ones say, keep it. */
static store_status delete_calibration(pruning *p, const char *id)
{
    store_status status = STORE_OK;
    if (!p->rules->only_tell) status = store_delete_plan(p->store, id);
    if (status == STORE_CONFLICT || status == STORE_NOT_FOUND) return STORE_OK;
    if (status == STORE_OK) log_line("calibration %s: %sdeleted", id, p->rules->only_tell ? "would be " : "");
    return status;
}

static store_status delete_job(pruning *p, const char *id) { return let_go(p, id, false); }
static store_status delete_study(pruning *p, const char *id) { return let_go(p, id, true); }

/* The next job that may go, found by its number: by an index, all that are left would be sorted for each of them. */
#define NEXT_JOB(and)                                                                                                              \
    "SELECT id, number FROM job NOT INDEXED WHERE number>?2 AND " HAS_ENDED " AND NOT " IS_PINNED and " ORDER BY number LIMIT 1"

static store_status prune_by_age(pruning *p, char before[JOB_TIME_SIZE])
{
    const time_t then = time(NULL) - (time_t)p->rules->keep_days * 86400;
    struct tm utc;
    gmtime_r(&then, &utc);
    strftime(before, JOB_TIME_SIZE, "%Y-%m-%dT%H:%M:%S.000Z", &utc);
    store_status status = go_through(p, NEXT_JOB(" AND finished<?1 AND study IS NULL"), before, -INFINITY, delete_job);
    if (status == STORE_OK)
        status =
            go_through(p, "SELECT id, number FROM study WHERE updated<?1 AND number>?2 AND " ALL_ENDED " ORDER BY number LIMIT 1",
                       before, -INFINITY, delete_study);
    if (status == STORE_OK)
        status = go_through(
            p, "SELECT id, number FROM calibration WHERE finished<?1 AND number>?2 AND " NO_JOB_LEFT " ORDER BY number LIMIT 1",
            before, -INFINITY, delete_calibration);
    return status;
}

/* from: only what has ended since then, "": all. */
static store_status prune_by_size(pruning *p, const char *from)
{
    const double enough = p->rules->keep_bytes;
    store_status status = go_through(
        p, NEXT_JOB(" AND finished>=?1 AND EXISTS(SELECT 1 FROM snapshot WHERE snapshot.job=job.number)"), from, enough, strip);
    if (status == STORE_OK) status = go_through(p, NEXT_JOB(" AND finished>=?1 AND study IS NULL"), from, enough, delete_job);
    if (status == STORE_OK)
        status =
            go_through(p, "SELECT id, number FROM study WHERE updated>=?1 AND number>?2 AND " ALL_ENDED " ORDER BY number LIMIT 1",
                       from, enough, delete_study);
    return status;
}

store_status store_prune(job_store *store, const prune_rules *rules, const atomic_bool *stopping, prune_tally *tally)
{
    pruning p = { .store = store, .rules = rules, .stopping = stopping, .tally = tally, .bytes = NAN };
    char before[JOB_TIME_SIZE] = "";
    store_status status = rules->keep_days > 0 ? prune_by_age(&p, before) : STORE_OK;
    tally->left = NAN;
    if (status != STORE_OK || !(rules->keep_bytes > 0.0)) return status;
    const int jobs = store->data->jobs;
    p.bytes = bytes_in(jobs, ".", DEEPEST + 1) - (rules->only_tell ? tally->bytes : 0.0);
    status = prune_by_size(&p, rules->only_tell ? before : "");
    tally->left = p.bytes;
    return status;
}

/* --- what could be freed --- */

enum { MOST_COUNTED = 20000 }; /* snapshots: some 10 ms */

store_status store_look_for_room(job_store *store, room_to_free *room)
{
    const disk_room disk = data_folder_room(store->data);
    *room = (room_to_free){ .free_bytes = disk.free_bytes, .free_inodes = disk.free_inodes };
    data_folder_kept_room(store->data, &room->kept_bytes, &room->kept_inodes);
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row =
        sql_prepare(reader,
                    "SELECT count(DISTINCT job), total(bytes), count(*), (SELECT total(jobs) FROM job_count WHERE status IN"
                    " ('successful','failed','dismissed')) FROM (SELECT snapshot.job AS job, bytes FROM snapshot JOIN job ON"
                    " job.number=snapshot.job WHERE " HAS_ENDED " AND NOT " IS_PINNED " ORDER BY snapshot.job LIMIT ?)",
                    "i", (int64_t)MOST_COUNTED);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) {
        room->jobs = sqlite3_column_int64(row, 0);
        room->snapshot_bytes = sqlite3_column_double(row, 1);
        room->is_more = sqlite3_column_int64(row, 2) == MOST_COUNTED;
        room->ended = sqlite3_column_int64(row, 3);
    }
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    return status;
}
