#include "run_folder.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "file_publish.h"
#include "job_folder.h"
#include "spec_file.h"
#include "worker_log.h"

static bool make_folder(const char *name)
{
    if (mkdir(name, 0755) == 0 || errno == EEXIST) return true;
    worker_warn("can't make the folder %s: %s", name, strerror(errno));
    return false;
}

bool run_folder_enter(const char *folder, event_log *events)
{
    events->fd = -1;
    if (!make_folder(folder)) return false;
    if (chdir(folder) != 0) {
        worker_warn("can't enter the folder %s: %s", folder, strerror(errno));
        return false;
    }
    if (!event_log_open(events) || !make_folder(JOB_SNAPSHOT_FOLDER)) return false;
    file_sweep_temporary(".");
    file_sweep_temporary(JOB_SNAPSHOT_FOLDER);
    return true;
}

/* "000000.hdf" and the like: a file of ours. */
static bool is_snapshot_name(const char *name)
{
    size_t digits = 0;
    while (isdigit((unsigned char)name[digits])) digits++;
    return digits >= 6 && strcmp(name + digits, ".hdf") == 0;
}

static void remove_snapshots(void)
{
    DIR *entries = opendir(JOB_SNAPSHOT_FOLDER);
    if (!entries) return;
    for (struct dirent *entry; (entry = readdir(entries));)
        if (is_snapshot_name(entry->d_name)) unlinkat(dirfd(entries), entry->d_name, 0);
    closedir(entries);
}

bool run_folder_is_of(const char *params)
{
    job_spec spec;
    problem_list problems;
    if (access(JOB_SPEC_FILE, F_OK) != 0 || !problem_list_init(&problems)) return false;
    bool same = false;
    if (spec_file_load(JOB_SPEC_FILE, NULL, 0, &spec, &problems)) {
        char *text = job_spec_to_text(&spec);
        same = text && strcmp(text, params) == 0;
        free(text);
        job_spec_clear(&spec);
    }
    problem_list_clear(&problems);
    return same;
}

bool run_folder_claim(const char *params, event_log *events)
{
    if (run_folder_is_of(params)) return true;
    unlink(JOB_RESULT_FILE);
    unlink(JOB_CHECKPOINT_FILE);
    unlink(JOB_START_FILE);
    unlink(JOB_SERIES_FILE);
    remove_snapshots();
    return event_log_empty(events) && file_write(JOB_SPEC_FILE, params, strlen(params));
}
