#include "file_publish.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "worker_log.h"

void file_log_write_failure(const char *name, const char *reason)
{
    struct statvfs disk;
    if (statvfs(".", &disk) == 0)
        worker_warn("can't write %s: %s (%.1f MB free on its disk)", name, reason,
                    1e-6 * (double)disk.f_bavail * (double)disk.f_frsize);
    else worker_warn("can't write %s: %s", name, reason);
}

static bool sync_path(const char *path, int flags)
{
    const int fd = open(path, flags | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0) return false;
    const bool synced = fsync(fd) == 0;
    return close(fd) == 0 && synced;
}

/* A second name first, so that there is always a file NAME; where the file system has none, the one name. */
static bool keep(const char *name, const char *before)
{
    char second[PATH_MAX];
    snprintf(second, sizeof second, "%s.tmp", before);
    unlink(second);
    if (link(name, second) == 0) return rename(second, before) == 0;
    return errno == ENOENT || rename(name, before) == 0;
}

bool file_publish(const char *name) { return file_publish_keeping(name, NULL); }

bool file_publish_keeping(const char *name, const char *before)
{
    char temporary[PATH_MAX], folder[PATH_MAX];
    snprintf(temporary, sizeof temporary, "%s.tmp", name);
    snprintf(folder, sizeof folder, "%s", name);
    if (sync_path(temporary, O_RDWR) && (!before || keep(name, before)) && rename(temporary, name) == 0
        && sync_path(dirname(folder), O_RDONLY | O_DIRECTORY))
        return true;
    file_log_write_failure(name, strerror(errno));
    unlink(temporary);
    return false;
}

static bool write_all(int fd, const char *text, size_t length)
{
    while (length > 0) {
        const ssize_t written = write(fd, text, length);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        text += written;
        length -= (size_t)written;
    }
    return true;
}

bool file_write(const char *name, const char *text, size_t length)
{
    char temporary[PATH_MAX];
    snprintf(temporary, sizeof temporary, "%s.tmp", name);
    unlink(temporary); /* made anew, and not through a symbolic link */
    const int fd = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (fd >= 0) {
        const bool written = write_all(fd, text, length);
        if (close(fd) == 0 && written) return file_publish(name);
    }
    file_log_write_failure(name, strerror(errno));
    unlink(temporary);
    return false;
}

bool file_write_stream(const char *name, FILE *stream, char **text, const size_t *length)
{
    const bool made = stream && fclose(stream) == 0 && *text;
    if (!made) worker_warn("can't write %s: out of memory", name);
    const bool written = made && file_write(name, *text, *length);
    free(*text);
    *text = NULL;
    return written;
}

char *file_read(const char *name, size_t most, size_t *length)
{
    FILE *file = fopen(name, "rbe");
    if (!file) {
        if (errno != ENOENT) worker_warn("can't read %s: %s", name, strerror(errno));
        return NULL;
    }
    char *text = NULL;
    size_t used = 0, room = 0;
    for (size_t count = 1; count > 0 && used <= most; used += count) {
        if (room - used < 4096) {
            room = room * 2 + 8192;
            char *larger = realloc(text, room);
            if (!larger) break;
            text = larger;
        }
        count = fread(text + used, 1, room - used - 1, file);
    }
    const bool whole = feof(file) && !ferror(file) && used <= most;
    fclose(file);
    if (whole && text) {
        text[used] = '\0';
        *length = used;
        return text;
    }
    worker_warn("can't read %s, or it is longer than %zu bytes", name, most);
    free(text);
    return NULL;
}

DIR *file_list_folder(const char *folder)
{
    const int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
    DIR *entries = fd < 0 ? NULL : fdopendir(fd);
    if (!entries && fd >= 0) close(fd);
    return entries;
}

void file_sweep_temporary(const char *folder)
{
    DIR *entries = file_list_folder(folder);
    if (!entries) return;
    for (struct dirent *entry; (entry = readdir(entries));) {
        const size_t length = strlen(entry->d_name);
        if (length > 4 && strcmp(entry->d_name + length - 4, ".tmp") == 0) unlinkat(dirfd(entries), entry->d_name, 0);
    }
    closedir(entries);
}
