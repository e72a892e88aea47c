#include "data_check.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "checksum.h"
#include "data_folder.h"
#include "database.h"
#include "frame_format.h"
#include "job_folder.h"
#include "log.h"
#include "schema.h"

typedef struct look {
    data_folder data; /* lock -1: only looking */
    sqlite3 *database;
    bool repair;
    long long found, mended, jobs, files;
} look;

/* mended: what was done about it; NULL: nothing. */
static void tell(look *l, const char *mended, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void tell(look *l, const char *mended, const char *format, ...)
{
    char text[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    l->found++;
    if (mended) l->mended++;
    printf("%s%s%s\n", text, mended ? ": " : "", mended ? mended : "");
}

static bool is_true(look *l, const char *sql, const char *id)
{
    sqlite3_stmt *row = sql_prepare(l->database, sql, strchr(sql, '?') ? "t" : "", id);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const bool yes = code == SQLITE_ROW && sqlite3_column_int64(row, 0) != 0;
    if (row) sql_finish(row, code);
    return yes;
}

static const char *run(look *l, const char *sql, const char *id, const char *what)
{
    if (!l->repair) return NULL;
    return sql_run(l->database, NULL, sql, strchr(sql, '?') ? "t" : "", id) == STORE_OK ? what : NULL;
}

/* --- the database by itself --- */

/* Lines of SQLite's own about what is wrong; their number. */
static int ask(look *l, const char *pragma, bool print)
{
    sqlite3_stmt *row;
    int wrong = 0;
    if (sqlite3_prepare_v2(l->database, pragma, -1, &row, NULL) != SQLITE_OK) wrong = 1;
    while (row && sqlite3_step(row) == SQLITE_ROW) {
        const char *text = (const char *)sqlite3_column_text(row, 0);
        if (text && strcmp(text, "ok") == 0) continue;
        if (print) printf("the database: %s\n", text ? text : "?");
        wrong++;
    }
    if (sqlite3_finalize(row) != SQLITE_OK) wrong++; /* so damaged that it can't be looked at */
    return wrong;
}

static void check_database(look *l)
{
    if (ask(l, "PRAGMA integrity_check(20)", true)) {
        const bool mended = l->repair && sqlite3_exec(l->database, "REINDEX", NULL, NULL, NULL) == SQLITE_OK
                            && ask(l, "PRAGMA integrity_check(1)", false) == 0;
        tell(l, mended ? "its indices are made anew" : NULL, "the database is damaged%s",
             mended || !l->repair ? "" : "; put a backup in its place");
    }
    if (ask(l, "PRAGMA foreign_key_check", false)) tell(l, NULL, "rows of the database belong to jobs that are not there");
    static const char counts[] =
        "SELECT count(*) FROM job_count c WHERE jobs<>(SELECT count(*) FROM job WHERE job.status=c.status)";
    if (is_true(l, counts, NULL))
        tell(l,
             run(l, "UPDATE job_count SET jobs=(SELECT count(*) FROM job WHERE job.status=job_count.status)", NULL, "counted anew"),
             "the counts of jobs by status are wrong");
    /* Where such a run stayed, its calibration would never know what became of it. */
    static const char lost[] = "SELECT count(*) FROM calibration_run WHERE job IS NOT NULL AND job NOT IN (SELECT number FROM job)";
    if (is_true(l, lost, NULL))
        tell(l,
             run(l, "UPDATE calibration_run SET job=NULL, status='failed' WHERE job NOT IN (SELECT number FROM job)", NULL,
                 "they count as failed"),
             "runs of calibrations have jobs that are not there");
}

/* --- files --- */

static bool sum_of(int file, off_t length, char line[CHECKSUM_LINE + 1])
{
    char piece[65536];
    checksum state;
    checksum_begin(&state);
    for (off_t at = 0; at < length;) {
        const size_t wanted = length - at < (off_t)sizeof piece ? (size_t)(length - at) : sizeof piece;
        const ssize_t got = pread(file, piece, wanted, at);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        checksum_add(&state, piece, (size_t)got);
        at += got;
    }
    checksum_write_line(checksum_end(&state), line);
    return true;
}

/* size: of the file. */
static bool hdf_is_whole(int file, off_t size)
{
    char said[CHECKSUM_LINE + 1] = "", line[CHECKSUM_LINE + 1];
    return size > CHECKSUM_LINE && pread(file, said, CHECKSUM_LINE, size - CHECKSUM_LINE) == CHECKSUM_LINE
           && sum_of(file, size - CHECKSUM_LINE, line) && strcmp(said, line) == 0;
}

/* Out of the job's folder, so that nobody takes it for good. */
static const char *put_into_lost(look *l, const char *id, const char *name)
{
    char from[300], to[400];
    snprintf(from, sizeof from, "%s%s%s", id, name ? "/" : "", name ? name : "");
    snprintf(to, sizeof to, "../lost/%s", from);
    for (char *c = to + strlen("../lost/"); *c; c++)
        if (*c == '/') *c = '-';
    if (!l->repair || (mkdirat(l->data.jobs, "../lost", 0700) != 0 && errno != EEXIST)) return NULL;
    return renameat(l->data.jobs, from, l->data.jobs, to) == 0 ? "put into lost" : NULL;
}

static void check_file(look *l, const char *id, const char *folder, const char *name, bool (*is_whole)(int file, off_t size))
{
    char path[200];
    snprintf(path, sizeof path, "%s%s%.100s", folder ? folder : "", folder ? "/" : "", name);
    const int file = job_file_open(&l->data, id, folder, name);
    struct stat facts;
    const bool opened = file >= 0 && fstat(file, &facts) == 0;
    const bool whole = opened && S_ISREG(facts.st_mode) && is_whole(file, facts.st_size);
    if (file >= 0) close(file);
    l->files++;
    if (!whole && (opened || errno != ENOENT))
        tell(l, put_into_lost(l, id, path), "job %s: %s does not fit its %s", id, path,
             is_whole == hdf_is_whole ? "checksum" : "head");
}

/* Cut short by a crash of the machine, it would be sent as it is. */
static bool frame_is_whole(int file, off_t size)
{
    unsigned char head[FRAME_HEAD_BYTES];
    return pread(file, head, sizeof head, 0) == (ssize_t)sizeof head && frame_bytes_told(head) == (size_t)size;
}

static void check_binaries(look *l, const char *id, const char *folder)
{
    const int job = job_folder_open(&l->data, id);
    const int inner = job >= 0 && folder ? openat(job, folder, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC) : job;
    DIR *list = inner >= 0 ? fdopendir(inner) : NULL;
    for (const struct dirent *entry; list && (entry = readdir(list)) != NULL;) {
        const char *end = strrchr(entry->d_name, '.');
        if (end && strcmp(end, ".hdf") == 0) check_file(l, id, folder, entry->d_name, hdf_is_whole);
        else if (end && folder && strcmp(end, ".bin") == 0) check_file(l, id, folder, entry->d_name, frame_is_whole);
    }
    if (list) closedir(list);
    else if (inner >= 0) close(inner);
    if (folder && job >= 0) close(job);
}

static void check_result(look *l, const char *id)
{
    char *there = job_file_read(&l->data, id, JOB_RESULT_FILE, LARGEST_RESULT);
    char *sound = there ? job_result_read(&l->data, id, NULL) : NULL;
    if (there) l->files++;
    if (there && !sound) {
        const char *done = put_into_lost(l, id, JOB_RESULT_FILE);
        put_into_lost(l, id, JOB_RESULT_SUM_FILE);
        tell(l, done, "job %s: " JOB_RESULT_FILE " does not fit its checksum; the database has its text", id);
    }
    free(there);
    free(sound);
}

/* A database of an earlier program has no such checksums. */
static void check_document(look *l, const char *id)
{
    static const char has_sums[] = "SELECT count(*)>0 FROM pragma_table_info('result') WHERE name='checksum'";
    if (!is_true(l, has_sums, id)) return;
    sqlite3_stmt *row = sql_prepare(
        l->database, "SELECT document, checksum FROM result WHERE job=(SELECT number FROM job WHERE id=?) AND checksum IS NOT NULL",
        "t", id);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const char *text = code == SQLITE_ROW ? (const char *)sqlite3_column_text(row, 0) : NULL;
    const bool sound = !text || checksum_of(text, strlen(text)) == (uint64_t)sqlite3_column_int64(row, 1);
    if (row) sql_finish(row, code);
    if (sound) return;
    char *kept = job_result_read(&l->data, id, NULL);
    static const char gone[] = "DELETE FROM result WHERE job=(SELECT number FROM job WHERE id=?)";
    static const char again[] = "UPDATE result SET document=?, checksum=? WHERE job=(SELECT number FROM job WHERE id=?)";
    const char *done = kept ? NULL : run(l, gone, id, "its row is removed");
    if (kept && l->repair
        && sql_run(l->database, NULL, again, "tit", kept, (int64_t)checksum_of(kept, strlen(kept)), id) == STORE_OK)
        done = "those of its folder are in their place now";
    tell(l, done, "job %s: its results in the database do not fit their checksum", id);
    free(kept);
}

/* --- what the tables say of a job's files --- */

static void check_snapshots(look *l, const char *id)
{
    sqlite3_stmt *row = sql_prepare(
        l->database, "SELECT number, file, bytes FROM snapshot WHERE job=(SELECT number FROM job WHERE id=?) ORDER BY number", "t",
        id);
    int code = SQLITE_ERROR;
    while (row && (code = sqlite3_step(row)) == SQLITE_ROW) {
        const char *name = (const char *)sqlite3_column_text(row, 1);
        const int file = name && !strchr(name, '/') ? job_file_open(&l->data, id, JOB_SNAPSHOT_FOLDER, name) : -1;
        struct stat facts;
        const bool there = file >= 0 && fstat(file, &facts) == 0 && facts.st_size == sqlite3_column_int64(row, 2);
        if (file >= 0) close(file);
        if (there) continue;
        const long long number = sqlite3_column_int64(row, 0);
        char sql[160];
        snprintf(sql, sizeof sql, "DELETE FROM snapshot WHERE number=%lld AND job=(SELECT number FROM job WHERE id=?)", number);
        tell(l, run(l, sql, id, "its row is removed"), "job %s: snapshot %lld is not there, or has another size", id, number);
    }
    if (row) sql_finish(row, code);
}

static void check_job(look *l, const char *id)
{
    l->jobs++;
    check_binaries(l, id, JOB_SNAPSHOT_FOLDER);
    check_binaries(l, id, JOB_BEDS_FOLDER);
    check_binaries(l, id, NULL);
    check_document(l, id);
    check_result(l, id);
    check_snapshots(l, id);
    static const char lost[] = "SELECT status='successful' AND number NOT IN (SELECT job FROM result) FROM job WHERE id=?";
    if (!is_true(l, lost, id)) return;
    static const char failed[] = "UPDATE job SET status='failed', message='its results were lost; to be tried again' WHERE id=?";
    tell(l, run(l, failed, id, "failed now, so that it can be tried again"), "job %s: it is successful, but has no results", id);
}

static void check_jobs(look *l)
{
    char id[JOB_ID_SIZE] = "";
    for (;;) { /* row by row, since rows change */
        static const char next[] =
            "SELECT id FROM job WHERE id>? AND +status IN ('successful','failed','dismissed') ORDER BY id LIMIT 1";
        sqlite3_stmt *row = sql_prepare(l->database, next, "t", id);
        const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
        char found[JOB_ID_SIZE] = "";
        if (code == SQLITE_ROW) snprintf(found, sizeof found, "%s", (const char *)sqlite3_column_text(row, 0));
        if (row) sql_finish(row, code);
        if (code != SQLITE_ROW) return;
        memcpy(id, found, sizeof id);
        check_job(l, id);
    }
}

/* Folders that no job has. A daemon makes the folder of a job before its row, and an old folder is still being removed after it. */
static void check_folders(look *l)
{
    const int jobs = dup(l->data.jobs);
    DIR *list = jobs >= 0 ? fdopendir(jobs) : NULL;
    if (!list && jobs >= 0) close(jobs);
    if (list) rewinddir(list);
    for (const struct dirent *entry; list && (entry = readdir(list)) != NULL;) {
        char id[JOB_ID_SIZE];
        struct stat facts;
        if (entry->d_name[0] == '.') continue;
        snprintf(id, sizeof id, "%.*s", (int)strcspn(entry->d_name, "."), entry->d_name);
        if (fstatat(l->data.jobs, entry->d_name, &facts, AT_SYMLINK_NOFOLLOW) != 0) continue;
        const bool has_name = job_id_is_valid(entry->d_name) && S_ISDIR(facts.st_mode);
        if (has_name && is_true(l, "SELECT 1 FROM job WHERE id=?", id)) continue;
        if (is_true(l, "SELECT 1 FROM leaving WHERE id=?", id)) continue;
        if (!l->repair && time(NULL) - facts.st_mtime < 60) continue;
        tell(l, put_into_lost(l, entry->d_name, NULL), "jobs/%.100s belongs to no job", entry->d_name);
    }
    if (list) closedir(list);
}

static bool open_for_looking(look *l, const char *path)
{
    char name[4096];
    snprintf(name, sizeof name, "%.4000s/jobs", path);
    l->data = (data_folder){ .jobs = open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC), .lock = -1 };
    if (l->data.jobs >= 0) return true;
    log_line("folder %s can't be opened: %s", name, strerror(errno));
    return false;
}

static bool is_of_this_program(look *l, const char *name)
{
    char sql[80];
    snprintf(sql, sizeof sql, "SELECT user_version=%d FROM pragma_user_version", schema_version);
    if (is_true(l, sql, NULL)) return true;
    log_line("%s was made by another version of this program; a newer one brings it up to date when it serves it", name);
    return false;
}

bool data_check(const char *path, bool repair)
{
    look l = { .repair = repair };
    char name[4096];
    struct stat facts;
    snprintf(name, sizeof name, "%.4000s/reposed.sqlite", path);
    if (stat(name, &facts) != 0) {
        log_line("%s can't be opened: %s", name, strerror(errno)); /* it would be made */
        return false;
    }
    if (repair ? !data_folder_open(&l.data, path) : !open_for_looking(&l, path)) return false;
    l.database = repair ? database_open_writer(name) : database_open_reader(name);
    const bool known = l.database && is_of_this_program(&l, name);
    if (known) {
        check_database(&l);
        check_jobs(&l);
        check_folders(&l);
        printf("%lld jobs that have ended, %lld files of theirs: %lld found, %lld mended\n", l.jobs, l.files, l.found, l.mended);
    }
    const bool sound = known && l.found == l.mended;
    database_close(l.database);
    data_folder_close(&l.data);
    return sound;
}
