#include "event_log.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#include "file_publish.h"
#include "job_folder.h"
#include "worker_log.h"

static bool fail(event_log *log, const char *reason)
{
    if (!log->failed) file_log_write_failure(JOB_EVENTS_FILE, reason);
    log->failed = true;
    return false;
}

/* The daemon that starts a second attempt may be quicker than the first worker's death. */
static bool lock_for_this_worker(int fd)
{
    for (int tries = 0; tries < 50; tries++) {
        if (flock(fd, LOCK_EX | LOCK_NB) == 0) return true;
        if (errno == ENOLCK || errno == ENOSYS || errno == EOPNOTSUPP) return true; /* a network file system without locks */
        nanosleep(&(struct timespec){ .tv_nsec = 100000000 }, NULL);
    }
    return false;
}

static bool cut_unfinished_line(int fd)
{
    off_t end = lseek(fd, 0, SEEK_END);
    if (end < 0) return false;
    off_t keep = end;
    for (char last; keep > 0; keep--) {
        if (pread(fd, &last, 1, keep - 1) != 1) return false;
        if (last == '\n') break;
    }
    return keep == end || ftruncate(fd, keep) == 0;
}

bool event_log_open(event_log *log)
{
    *log = (event_log){ .fd = open(JOB_EVENTS_FILE, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0644) };
    if (log->fd < 0) return fail(log, strerror(errno));
    if (!lock_for_this_worker(log->fd)) return fail(log, "another worker is at work in this folder");
    if (!cut_unfinished_line(log->fd)) return fail(log, strerror(errno));
    return true;
}

void event_log_close(event_log *log)
{
    if (log->fd >= 0) close(log->fd);
    log->fd = -1;
}

bool event_log_empty(event_log *log) { return ftruncate(log->fd, 0) == 0 || fail(log, strerror(errno)); }

bool event_log_add(event_log *log, json_t *event)
{
    if (log->failed) {
        json_decref(event);
        return false;
    }
    char *line = event ? json_dumps(event, JSON_COMPACT | JSON_REAL_PRECISION(12)) : NULL;
    json_decref(event);
    if (!line) return fail(log, "out of memory");
    const size_t length = strlen(line);
    line[length] = '\n'; /* in place of the end of the text: a line is one write */
    const ssize_t written = write(log->fd, line, length + 1);
    const int reason = errno;
    free(line);
    if (written == (ssize_t)length + 1) return true;
    return fail(log, written < 0 ? strerror(reason) : "no room for a whole line");
}

bool event_log_sync(event_log *log) { return !log->failed && (fsync(log->fd) == 0 || fail(log, strerror(errno))); }
