/* The database first, as of one moment; then the folder of each job that is in it. What a folder gets later than that does no harm:
 * at the start jobs are put back that the table has as running, and workers believe no file without its checksum. A job that is
 * deleted meanwhile is taken out of the copy. */
#include "backup.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "database.h"
#include "job_folder.h"
#include "log.h"

enum { DEEPEST = 2 };

typedef struct backup {
    char from[4096], into[4096];
    sqlite3 *live, *copy;
    int jobs, jobs_copied; /* descriptors of both folders of jobs */
    long long job_count, linked, written;
} backup;

static bool say(const char *name, const char *what)
{
    log_line("%s %s: %s", name, what, strerror(errno));
    return false;
}

/* Replaced by rename, never written to: a second name will do. */
static bool never_changes(const char *name)
{
    const char *end = strrchr(name, '.');
    return (end && (strcmp(end, ".hdf") == 0 || strcmp(end, ".bin") == 0)) || strcmp(name, JOB_SPEC_FILE) == 0
           || strcmp(name, JOB_RESULT_FILE) == 0 || strcmp(name, JOB_RESULT_SUM_FILE) == 0;
}

static bool copy_file(int from, int to, const char *name)
{
    const int in = openat(from, name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (in < 0) return errno == ENOENT || errno == ELOOP;
    const int out = openat(to, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
    char piece[65536];
    ssize_t got = out < 0 ? -1 : 1;
    while (got > 0 || (got < 0 && errno == EINTR && out >= 0)) {
        got = read(in, piece, sizeof piece);
        for (ssize_t done = 0, wrote; done < got; done += wrote) {
            wrote = write(out, piece + done, (size_t)(got - done));
            if (wrote < 0 && errno == EINTR) wrote = 0;
            else if (wrote < 0) done = got = -1, wrote = 0;
        }
    }
    const int reason = errno;
    close(in);
    const bool good = out >= 0 && close(out) == 0 && got == 0;
    if (got < 0) errno = reason;
    return good;
}

static bool copy_entry(backup *b, int from, int to, const char *name)
{
    if (never_changes(name)) {
        if (linkat(from, name, to, name, 0) == 0) {
            b->linked++;
            return true;
        }
        if (errno == ENOENT) return true; /* it has just been replaced or deleted */
    }
    b->written++;
    return copy_file(from, to, name);
}

static bool copy_folder(backup *b, int from, int to, int depth);

static bool copy_inner(backup *b, int from, int to, const char *name, int depth)
{
    const int inner = openat(from, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    const bool made = inner >= 0 && (mkdirat(to, name, 0700) == 0 || errno == EEXIST);
    const int copied = made ? openat(to, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC) : -1;
    const bool good = copied >= 0 && copy_folder(b, inner, copied, depth);
    const int reason = errno;
    if (inner >= 0) close(inner);
    if (copied >= 0) close(copied);
    errno = reason;
    return good;
}

static bool copy_folder(backup *b, int from, int to, int depth)
{
    const int again = openat(from, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = again >= 0 ? fdopendir(again) : NULL;
    bool good = list != NULL;
    for (const struct dirent *entry; good && (entry = readdir(list)) != NULL;) {
        const char *name = entry->d_name;
        const size_t length = strlen(name);
        struct stat facts;
        if (strcmp(name, ".") == 0 || strcmp(name, "..") == 0 || (length > 4 && strcmp(name + length - 4, ".tmp") == 0)) continue;
        if (fstatat(from, name, &facts, AT_SYMLINK_NOFOLLOW) != 0) continue;
        if (S_ISREG(facts.st_mode)) good = copy_entry(b, from, to, name);
        else if (S_ISDIR(facts.st_mode) && depth > 0) good = copy_inner(b, from, to, name, depth - 1);
    }
    const int reason = errno;
    if (list) closedir(list);
    errno = reason;
    return good;
}

/* In one step, so that it is of one moment; the daemon writes on meanwhile. */
static bool copy_database(backup *b)
{
    char path[4200];
    snprintf(path, sizeof path, "%s/reposed.sqlite", b->from);
    b->live = database_open_reader(path);
    snprintf(path, sizeof path, "%s/reposed.sqlite", b->into);
    if (!b->live || sqlite3_open_v2(path, &b->copy, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, NULL) != SQLITE_OK) return false;
    sqlite3_backup *copying = sqlite3_backup_init(b->copy, "main", b->live, "main");
    if (copying) sqlite3_backup_step(copying, -1);
    const int code = copying ? sqlite3_backup_finish(copying) : sqlite3_errcode(b->copy);
    if (code == SQLITE_OK) return sqlite3_exec(b->copy, "PRAGMA foreign_keys=ON", NULL, NULL, NULL) == SQLITE_OK;
    log_line("the database can't be copied: %s", sqlite3_errstr(code));
    return false;
}

static bool is_deleted(backup *b, const char *id)
{
    sqlite3_stmt *row = sql_prepare(b->live, "SELECT 1 FROM job WHERE id=?", "t", id);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    return row && sql_finish(row, code) == STORE_OK && code == SQLITE_DONE;
}

/* Jobs that wait may have no folder yet. */
static bool copy_job(backup *b, const char *id)
{
    struct stat facts;
    b->job_count++;
    const bool is_there = fstatat(b->jobs, id, &facts, AT_SYMLINK_NOFOLLOW) == 0 && S_ISDIR(facts.st_mode);
    if (is_there && !copy_inner(b, b->jobs, b->jobs_copied, id, DEEPEST) && !is_deleted(b, id)) return say(id, "can't be copied");
    if (!is_deleted(b, id)) return true;
    b->job_count--;
    return sql_run(b->copy, NULL, "DELETE FROM job WHERE id=?", "t", id) == STORE_OK;
}

static bool copy_jobs(backup *b)
{
    char path[4200];
    snprintf(path, sizeof path, "%s/jobs", b->from);
    b->jobs = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    snprintf(path, sizeof path, "%s/jobs", b->into);
    b->jobs_copied = mkdir(path, 0700) == 0 ? open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (b->jobs < 0 || b->jobs_copied < 0) return say(path, "can't be filled");
    char after[JOB_ID_SIZE] = "";
    for (bool more = true; more;) { /* row by row, since a row may have to go */
        sqlite3_stmt *row = sql_prepare(b->copy, "SELECT id FROM job WHERE id>? ORDER BY id LIMIT 1", "t", after);
        const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
        char next[JOB_ID_SIZE] = "";
        more = code == SQLITE_ROW;
        if (more) snprintf(next, sizeof next, "%s", (const char *)sqlite3_column_text(row, 0));
        if (!row || sql_finish(row, code) != STORE_OK || (more && !copy_job(b, next))) return false;
        memcpy(after, next, sizeof after);
    }
    return true;
}

static bool copy_rest(backup *b)
{
    const int from = open(b->from, O_RDONLY | O_DIRECTORY | O_CLOEXEC), into = open(b->into, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool good = from >= 0 && into >= 0 && copy_file(from, into, "calibration.json") && syncfs(into) == 0;
    if (!good) say(b->into, "can't be written");
    if (from >= 0) close(from);
    if (into >= 0) close(into);
    return good;
}

/* A name of its own until it is whole: who finds a backup finds all of it. */
static bool publish(const backup *b, const char *to)
{
    struct stat facts;
    if (lstat(to, &facts) == 0) {
        errno = EEXIST;
        return say(to, "can't be made");
    }
    return rename(b->into, to) == 0 || say(to, "can't be made");
}

bool backup_make(const char *data, const char *to)
{
    backup b = { .jobs = -1, .jobs_copied = -1 };
    snprintf(b.from, sizeof b.from, "%.4000s", data);
    struct stat facts;
    size_t length = strlen(to);
    while (length > 1 && to[length - 1] == '/') length--;
    snprintf(b.into, sizeof b.into, "%.*s.partial", (int)(length > 4000 ? 4000 : length), to);
    if (lstat(to, &facts) == 0) errno = EEXIST;
    else if (mkdir(b.into, 0700) == 0) {
        bool good = copy_database(&b) && copy_jobs(&b);
        database_close(b.copy);
        database_close(b.live);
        if (b.jobs >= 0) close(b.jobs);
        if (b.jobs_copied >= 0) close(b.jobs_copied);
        good = good && copy_rest(&b) && publish(&b, to);
        if (good) printf("%s: %lld jobs; %lld files by a second name, %lld copied\n", to, b.job_count, b.linked, b.written);
        else log_line("%s is not whole and can be removed", b.into);
        return good;
    }
    return say(errno == EEXIST && lstat(to, &facts) != 0 ? b.into : to, "can't be made");
}
