#include "attempt_fence.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "file_publish.h"
#include "job_folder.h"
#include "worker_log.h"

enum { NAME_SIZE = 32, TEXT_SIZE = 512, LOOKS = 50 /* of 100 ms, for an earlier worker to leave, which looks once a second */ };

static void name_of(int start, char name[NAME_SIZE]) { snprintf(name, NAME_SIZE, JOB_FENCE_FORMAT, start); }

/* "": not there, or nothing in it. */
static void read_fence(int folder, int start, char text[TEXT_SIZE])
{
    char name[NAME_SIZE];
    name_of(start, name);
    const int file = openat(folder, name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    const ssize_t length = file >= 0 ? read(file, text, TEXT_SIZE - 1) : 0;
    text[length > 0 ? length : 0] = '\0';
    if (file >= 0) close(file);
}

static void add_line(int folder, int start, const char *line)
{
    char name[NAME_SIZE];
    name_of(start, name);
    const int file = openat(folder, name, O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW);
    const size_t length = strlen(line);
    if (file >= 0 && (write(file, line, length) != (ssize_t)length || fsync(file) != 0))
        worker_warn("%s can't be written: %s", name, strerror(errno));
    if (file >= 0) close(file);
}

static bool is_gone(const char *text) { return strstr(text, "left\n") || strstr(text, "end ") || !strstr(text, "taken\n"); }

static void send_away(int folder, int start)
{
    char text[TEXT_SIZE];
    read_fence(folder, start, text);
    if (is_gone(text)) return;
    add_line(folder, start, "leave\n");
    for (int looks = 0; looks < LOOKS && !is_gone(text); looks++) {
        nanosleep(&(struct timespec){ .tv_nsec = 100000000 }, NULL);
        read_fence(folder, start, text);
    }
    if (!is_gone(text)) worker_warn("the worker of start %d has not said that it left: it is taken for dead", start);
}

/* False: there is a newer one. */
static bool send_others_away(int folder, const char *path, int start)
{
    DIR *entries = file_list_folder(path);
    bool is_newest = true;
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        int other;
        char end;
        if (sscanf(entry->d_name, JOB_FENCE_FORMAT "%c", &other, &end) != 1 || other == start) continue;
        if (other > start) is_newest = false;
        else send_away(folder, other);
    }
    if (entries) closedir(entries);
    if (!is_newest) worker_log("start %d of this job comes too late: there is a newer one", start);
    return is_newest;
}

bool attempt_fence_take(const char *path, int start)
{
    if (start == 0) return true;
    char name[NAME_SIZE];
    name_of(start, name);
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const int file = folder >= 0 ? openat(folder, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600) : -1;
    if (file < 0) worker_warn("start %d of this job can't take its folder: %s", start, strerror(errno));
    else close(file);
    const bool taken = file >= 0 && send_others_away(folder, path, start);
    if (taken) add_line(folder, start, "taken\n");
    if (folder >= 0) close(folder);
    return taken;
}

fence_state attempt_fence_look(int start)
{
    char text[TEXT_SIZE] = "";
    if (start == 0) return FENCE_HOLDS;
    read_fence(AT_FDCWD, start, text);
    if (strstr(text, "leave\n")) return FENCE_IS_LOST;
    return strstr(text, "stop\n") ? FENCE_STOPS : FENCE_HOLDS;
}

void attempt_fence_leave(int start)
{
    if (start > 0) add_line(AT_FDCWD, start, "left\n");
}
