/* What a job's folder holds, by name. */
#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "job_folder.h"
#include "job_store.h"

/* A file that is being written gets its name by the rename at the end. */
static bool is_listed(int folder, const char *name)
{
    static const char being_written[] = ".tmp";
    const size_t length = strlen(name), end = sizeof being_written - 1;
    struct stat facts;
    if (length >= end && strcmp(name + length - end, being_written) == 0) return false;
    return fstatat(folder, name, &facts, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(facts.st_mode);
}

/* Takes the descriptor. */
static store_status list_folder(int folder, const char *name, job_file_taker *take, void *context)
{
    struct dirent **entry = NULL;
    const int count = folder < 0 ? -1 : scandirat(folder, ".", &entry, NULL, alphasort);
    bool goes_on = true;
    for (int i = 0; i < count; i++) {
        if (goes_on && is_listed(folder, entry[i]->d_name)) goes_on = take(context, name, entry[i]->d_name);
        free(entry[i]);
    }
    free(entry);
    if (folder >= 0) close(folder);
    return count < 0 ? STORE_NOT_FOUND : goes_on ? STORE_OK : STORE_FAILED;
}

store_status store_list_files(job_store *store, const char *id, job_file_taker *take, void *context)
{
    const int folder = job_folder_open(store->data, id);
    if (folder < 0) return STORE_NOT_FOUND;
    static const char *const names[] = { JOB_SNAPSHOT_FOLDER, JOB_BEDS_FOLDER };
    enum { INNER = sizeof names / sizeof names[0] };
    int inner[INNER];
    for (int f = 0; f < INNER; f++) inner[f] = openat(folder, names[f], O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    store_status status = list_folder(folder, NULL, take, context);
    for (int f = 0; f < INNER; f++) {
        if (inner[f] < 0) continue;
        if (status == STORE_OK) status = list_folder(inner[f], names[f], take, context);
        else close(inner[f]);
    }
    return status;
}

store_status store_open_file(job_store *store, const char *id, const char *folder, const char *name, int *file)
{
    *file = strchr(name, '/') ? -1 : job_file_open(store->data, id, folder, name);
    return *file >= 0 ? STORE_OK : STORE_NOT_FOUND;
}
