#include "data_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <time.h>
#include <unistd.h>

#include "checksum.h"
#include "job_folder.h"
#include "log.h"
#include "sha256.h"

/* Of the disk, for what has been begun; of a small one a share. */
#define KEPT_BYTES 64e6
#define KEPT_INODES 1000.0
#define KEPT_SHARE 0.02

enum { LONGEST_SEAL = 64 };

static bool ends_in_tmp(const char *name)
{
    const size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".tmp") == 0;
}

/* Whether workers on other machines have written there, which may be at work now. */
static bool has_fence(int folder)
{
    bool has = false;
    DIR *list = folder >= 0 ? fdopendir(openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)) : NULL;
    for (const struct dirent *entry; list && !has && (entry = readdir(list)) != NULL;)
        has = strncmp(entry->d_name, JOB_FENCE_START, sizeof JOB_FENCE_START - 1) == 0;
    if (list) closedir(list);
    return has;
}

/* Files being written when something died: never renamed, so nobody knows them. A worker that lives on elsewhere sweeps its folder
 * itself. depth: folders further down; parent: the one above, -1: none that counts. */
static void sweep_unfinished(int folder, int depth, int parent)
{
    DIR *list = fdopendir(dup(folder));
    if (!list) return;
    rewinddir(list);
    for (const struct dirent *entry; (entry = readdir(list)) != NULL;) {
        if (entry->d_name[0] == '.') continue;
        if (ends_in_tmp(entry->d_name)) {
            if (has_fence(folder) || has_fence(parent)) break;
            unlinkat(folder, entry->d_name, 0);
        } else if (depth > 0) {
            const int inner = openat(folder, entry->d_name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
            if (inner < 0) continue;
            sweep_unfinished(inner, depth - 1, folder);
            close(inner);
        }
    }
    closedir(list);
}

/* A daemon that was killed in the moment of a fork has left a child that holds the lock until it dies, too: in a moment. */
static bool take_lock(data_folder *data, const char *path)
{
    enum { TRIES = 30 };
    const struct timespec pause = { .tv_nsec = 100000000 };
    char name[4096];
    snprintf(name, sizeof name, "%s/lock", path);
    data->lock = open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    for (int tries = 0; data->lock >= 0 && tries < TRIES; tries++) {
        if (flock(data->lock, LOCK_EX | LOCK_NB) == 0) return true;
        if (errno != EWOULDBLOCK) break;
        nanosleep(&pause, NULL);
        errno = EWOULDBLOCK;
    }
    if (errno == EWOULDBLOCK) log_line("%s is in use by another reposed", path);
    else log_line("%s can't be locked: %s", path, strerror(errno));
    return false;
}

bool data_folder_open_beside_workers(data_folder *data, const char *path)
{
    *data = (data_folder){ .jobs = -1, .lock = -1 };
    char jobs[4096], resolved[4096];
    snprintf(jobs, sizeof jobs, "%s/jobs", path);
    if ((mkdir(path, 0700) != 0 && errno != EEXIST) || (mkdir(jobs, 0700) != 0 && errno != EEXIST) || !realpath(path, resolved)
        || strlen(resolved) >= sizeof data->path) {
        log_line("data folder %s can't be made or used: %s", path, strerror(errno));
        return false;
    }
    memcpy(data->path, resolved, strlen(resolved) + 1);
    if (!take_lock(data, path)) return false;
    data->jobs = open(jobs, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (data->jobs < 0) {
        log_line("folder %s can't be opened: %s", jobs, strerror(errno));
        return false;
    }
    return true;
}

bool data_folder_open(data_folder *data, const char *path)
{
    if (!data_folder_open_beside_workers(data, path)) return false;
    sweep_unfinished(data->jobs, 2, -1);
    return true;
}

void data_folder_close(data_folder *data)
{
    if (data->jobs >= 0) close(data->jobs);
    if (data->lock >= 0) close(data->lock);
    data->jobs = data->lock = -1;
}

/* Whole or not at all. */
static bool write_whole(int folder, const char *name, const char *text)
{
    char temporary[64];
    snprintf(temporary, sizeof temporary, "%s.tmp", name);
    const int file = openat(folder, temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (file < 0) return false;
    const size_t length = strlen(text);
    size_t done = 0;
    while (done < length) {
        const ssize_t written = write(file, text + done, length - done);
        if (written < 0 && errno != EINTR) break;
        if (written > 0) done += (size_t)written;
    }
    bool good = done == length;
    good = close(file) == 0 && good;
    return good && renameat(folder, temporary, folder, name) == 0;
}

/* The table's copy rules: this one may have been damaged since it was written. */
static bool has_spec(const data_folder *data, const char *id, const char *spec)
{
    char *text = job_file_read(data, id, JOB_SPEC_FILE, strlen(spec));
    const bool same = text && strcmp(text, spec) == 0;
    free(text);
    return same;
}

bool job_folder_create(const data_folder *data, const char *id, const char *spec)
{
    if (mkdirat(data->jobs, id, 0700) != 0 && errno != EEXIST) return false;
    const int folder = job_folder_open(data, id);
    if (folder < 0) return false;
    const bool good = has_spec(data, id, spec) || write_whole(folder, JOB_SPEC_FILE, spec);
    const int reason = errno;
    close(folder);
    errno = reason;
    return good;
}

static void remove_strangers(int folder, const char *id)
{
    DIR *list = folder >= 0 ? fdopendir(folder) : NULL;
    for (const struct dirent *entry; list && (entry = readdir(list)) != NULL;) {
        struct stat found;
        if (fstatat(dirfd(list), entry->d_name, &found, AT_SYMLINK_NOFOLLOW) != 0) continue;
        if (S_ISREG(found.st_mode) || S_ISDIR(found.st_mode) || unlinkat(dirfd(list), entry->d_name, 0) != 0) continue;
        log_line("job %s: %s in its folder was %s, and is removed", id, entry->d_name,
                 S_ISLNK(found.st_mode) ? "a symbolic link" : "no file");
    }
    if (list) closedir(list);
    else if (folder >= 0) close(folder);
}

void job_folder_tidy(const data_folder *data, const char *id)
{
    struct stat found;
    if (fstatat(data->jobs, id, &found, AT_SYMLINK_NOFOLLOW) != 0) return;
    if (!S_ISDIR(found.st_mode) && unlinkat(data->jobs, id, 0) == 0) log_line("job %s: its folder was none, and is removed", id);
    const int folder = job_folder_open(data, id);
    if (folder < 0) return;
    const int snapshots = openat(folder, JOB_SNAPSHOT_FOLDER, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    const int beds = openat(folder, JOB_BEDS_FOLDER, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    remove_strangers(folder, id);
    remove_strangers(snapshots, id);
    remove_strangers(beds, id);
}

bool job_folder_sync(const data_folder *data, const char *id)
{
    const int folder = job_folder_open(data, id);
    if (folder < 0) return false;
    const bool good = fsync(folder) == 0 && fsync(data->jobs) == 0;
    const int reason = errno;
    close(folder);
    errno = reason;
    return good;
}

static bool copy(int from, int to)
{
    for (;;) {
        const ssize_t moved = copy_file_range(from, NULL, to, NULL, 1 << 30, 0);
        if (moved < 0 && errno == EINTR) continue;
        if (moved <= 0) return moved == 0;
    }
}

/* By way of a temporary name, as everything that must be whole. */
static bool copy_durably(int from, int folder, const char *name)
{
    char temporary[64];
    snprintf(temporary, sizeof temporary, "%s.tmp", name);
    const int to = openat(folder, temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600);
    bool good = to >= 0 && copy(from, to) && fsync(to) == 0;
    if (to >= 0) good = close(to) == 0 && good;
    return good && renameat(folder, temporary, folder, name) == 0;
}

/* The jobs of a study start from the same file, whose hash is taken once. A file that was changed so that this does not show is
 * refused by the workers. */
static bool hash_of(int file, char hex[SHA256_HEX_SIZE])
{
    static _Thread_local struct stat last;
    static _Thread_local char hash[SHA256_HEX_SIZE];
    struct stat facts;
    if (fstat(file, &facts) != 0) return false;
    const bool is_known = hash[0] && facts.st_dev == last.st_dev && facts.st_ino == last.st_ino && facts.st_size == last.st_size
                          && facts.st_mtim.tv_sec == last.st_mtim.tv_sec && facts.st_mtim.tv_nsec == last.st_mtim.tv_nsec;
    if (!is_known && !sha256_of_file(file, hash)) {
        hash[0] = '\0';
        return false;
    }
    last = facts;
    memcpy(hex, hash, sizeof hash);
    return true;
}

static bool write_hash(int file, int folder)
{
    char line[SHA256_HEX_SIZE + 1];
    if (!hash_of(file, line)) return false;
    memcpy(line + SHA256_HEX_SIZE - 1, "\n", 2);
    return write_whole(folder, JOB_START_HASH_FILE, line);
}

bool job_folder_add_start(const data_folder *data, const char *id, const char *from, const char *folder, const char *name)
{
    if (mkdirat(data->jobs, id, 0700) != 0 && errno != EEXIST) return false;
    char path[200];
    snprintf(path, sizeof path, "%s%s%s/%s", from, folder ? "/" : "", folder ? folder : "", name);
    const int file = job_file_open(data, from, folder, name), to = job_folder_open(data, id);
    bool good = file >= 0 && to >= 0;
    if (good) good = write_hash(file, to);
    if (good && linkat(data->jobs, path, to, JOB_START_FILE, 0) != 0 && errno != EEXIST)
        good = copy_durably(file, to, JOB_START_FILE);
    const int reason = errno;
    if (file >= 0) close(file);
    if (to >= 0) close(to);
    errno = reason;
    return good;
}

void job_folder_discard(const data_folder *data, const char *id)
{
    const int folder = job_folder_open(data, id);
    if (folder < 0) return;
    unlinkat(folder, JOB_SPEC_FILE, 0);
    unlinkat(folder, JOB_SPEC_FILE ".tmp", 0);
    unlinkat(folder, JOB_START_FILE, 0);
    unlinkat(folder, JOB_START_FILE ".tmp", 0);
    unlinkat(folder, JOB_START_HASH_FILE, 0);
    unlinkat(folder, JOB_START_HASH_FILE ".tmp", 0);
    close(folder);
    unlinkat(data->jobs, id, AT_REMOVEDIR); /* refuses unless empty */
}

static void gone_name(const char *id, char name[64]) { snprintf(name, 64, "%s.gone", id); }

void job_folder_put_aside(const data_folder *data, const char *id)
{
    char gone[64];
    gone_name(id, gone);
    renameat(data->jobs, id, data->jobs, gone); /* where that fails it is removed under its own name */
}

/* All in it, down to `depth` further folders; never through a symbolic link. */
static void empty_folder(int folder, int depth, const atomic_bool *stopping)
{
    DIR *list = fdopendir(dup(folder));
    if (!list) return;
    rewinddir(list);
    for (const struct dirent *entry; !*stopping && (entry = readdir(list)) != NULL;) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        if (unlinkat(folder, entry->d_name, 0) == 0 || depth == 0) continue;
        const int inner = openat(folder, entry->d_name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        if (inner < 0) continue;
        empty_folder(inner, depth - 1, stopping);
        close(inner);
        unlinkat(folder, entry->d_name, AT_REMOVEDIR);
    }
    closedir(list);
}

static bool remove_folder(const data_folder *data, const char *name, const atomic_bool *stopping)
{
    enum { DEEPEST = 8 };
    const int folder = openat(data->jobs, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return errno == ENOENT || (errno != EMFILE && errno != ENFILE && unlinkat(data->jobs, name, 0) == 0);
    /* A worker holds this lock to its end, and would go on writing here. */
    const bool is_free = flock(folder, LOCK_EX | LOCK_NB) == 0;
    if (is_free) empty_folder(folder, DEEPEST, stopping);
    close(folder);
    return is_free && unlinkat(data->jobs, name, AT_REMOVEDIR) == 0;
}

bool job_folder_remove(const data_folder *data, const char *id, const atomic_bool *stopping)
{
    char gone[64];
    gone_name(id, gone);
    const bool aside = remove_folder(data, gone, stopping); /* first, so that its name is free */
    return remove_folder(data, id, stopping) && aside;
}

int job_folder_open(const data_folder *data, const char *id)
{
    return openat(data->jobs, id, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

int job_file_open(const data_folder *data, const char *id, const char *folder, const char *name)
{
    const int job = job_folder_open(data, id);
    if (job < 0) return -1;
    const int inner = folder ? openat(job, folder, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC) : job;
    const int file = inner < 0 ? -1 : openat(inner, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (folder && inner >= 0) close(inner);
    close(job);
    return file;
}

static bool read_all(int file, char *text, size_t size)
{
    for (size_t done = 0; done < size;) {
        const ssize_t got = read(file, text + done, size - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return false;
        if (got == 0) break; /* it has become shorter */
        done += (size_t)got;
    }
    return true;
}

char *job_file_read(const data_folder *data, const char *id, const char *name, size_t limit)
{
    const int file = job_file_open(data, id, NULL, name);
    if (file < 0) return NULL;
    struct stat facts;
    char *text = NULL;
    if (fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) && (size_t)facts.st_size <= limit)
        text = calloc(1, (size_t)facts.st_size + 1);
    const bool good = text && read_all(file, text, (size_t)facts.st_size);
    const int reason = errno;
    close(file);
    if (!good) free(text);
    errno = reason;
    return good ? text : NULL;
}

bool data_folder_try_write(const data_folder *data)
{
    static const char name[] = "written-to-try.tmp", text[4096] = "";
    unlinkat(data->jobs, name, 0);
    const int file = openat(data->jobs, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0) return false;
    const ssize_t written = write(file, text, sizeof text);
    bool good = written == (ssize_t)sizeof text && fsync(file) == 0;
    const int reason = written >= 0 && written < (ssize_t)sizeof text ? ENOSPC : errno;
    good = close(file) == 0 && good;
    unlinkat(data->jobs, name, 0);
    errno = reason;
    return good;
}

/* What an ended worker leaves needs no spec, and one of another kind may write no checksum. */
static bool seal_fits(const data_folder *data, const char *id, const char *text, const char *spec)
{
    char lines[CHECKSUM_LINES + 1];
    char *seal = job_file_read(data, id, JOB_RESULT_SUM_FILE, LONGEST_SEAL);
    checksum_write_lines(text, strlen(text), spec ? spec : "", lines);
    if (!spec && seal && strlen(seal) >= CHECKSUM_LINE) seal[CHECKSUM_LINE] = lines[CHECKSUM_LINE] = '\0';
    const int file = seal ? -1 : job_file_open(data, id, NULL, JOB_RESULT_SUM_FILE);
    const bool fits = seal ? strcmp(seal, lines) == 0 : !spec && file < 0 && errno == ENOENT;
    if (file >= 0) close(file);
    free(seal);
    return fits;
}

char *job_result_read(const data_folder *data, const char *id, const char *spec)
{
    char *text = job_file_read(data, id, JOB_RESULT_FILE, LARGEST_RESULT);
    json_t *result = text && seal_fits(data, id, text, spec) ? json_loads(text, 0, NULL) : NULL;
    const bool whole = json_is_object(result);
    json_decref(result);
    if (whole) return text;
    free(text);
    return NULL;
}

void job_result_remove(const data_folder *data, const char *id)
{
    const int folder = job_folder_open(data, id);
    if (folder < 0) return;
    unlinkat(folder, JOB_RESULT_FILE, 0);
    unlinkat(folder, JOB_RESULT_SUM_FILE, 0);
    close(folder);
}

void job_bed_remove(const data_folder *data, const char *id)
{
    const int folder = job_folder_open(data, id);
    if (folder < 0) return;
    unlinkat(folder, JOB_BED_FILE, 0);
    unlinkat(folder, JOB_BED_HASH_FILE, 0);
    close(folder);
}

bool job_folder_add_bed(const data_folder *data, const char *id, const char *from, const char *line)
{
    char path[80];
    struct stat found;
    snprintf(path, sizeof path, "%.64s/" JOB_BED_FILE, from);
    job_bed_remove(data, id);
    const int to = job_folder_open(data, id);
    bool good = to >= 0 && linkat(data->jobs, path, to, JOB_BED_FILE, 0) == 0;
    /* It may be a link, which is another worker's to make and would be in the way of this one. */
    good = good && fstatat(to, JOB_BED_FILE, &found, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(found.st_mode)
           && write_whole(to, JOB_BED_HASH_FILE, line);
    const int reason = errno;
    if (to >= 0) close(to);
    if (!good) job_bed_remove(data, id);
    errno = reason;
    return good;
}

disk_room data_folder_room(const data_folder *data)
{
    struct statvfs disk;
    if (fstatvfs(data->jobs, &disk) != 0) return (disk_room){ NAN, NAN, NAN };
    const double block = (double)disk.f_frsize;
    return (disk_room){ block * (double)disk.f_blocks, block * (double)disk.f_bavail, (double)disk.f_favail };
}

void data_folder_kept_room(const data_folder *data, double *bytes, double *inodes)
{
    struct statvfs disk;
    *bytes = *inodes = NAN;
    if (fstatvfs(data->jobs, &disk) != 0) return;
    *bytes = fmin(KEPT_BYTES, KEPT_SHARE * (double)disk.f_frsize * (double)disk.f_blocks);
    *inodes = fmin(KEPT_INODES, KEPT_SHARE * (double)disk.f_files); /* 0: of a file system that has no limit */
}

bool data_folder_is_nearly_full(const data_folder *data)
{
    double kept_bytes, kept_inodes;
    const disk_room room = data_folder_room(data);
    data_folder_kept_room(data, &kept_bytes, &kept_inodes);
    return room.free_bytes < kept_bytes || room.free_inodes < kept_inodes;
}

bool data_folder_sync(const data_folder *data) { return syncfs(data->jobs) == 0; }

double data_folder_free_bytes(const data_folder *data) { return data_folder_room(data).free_bytes; }
