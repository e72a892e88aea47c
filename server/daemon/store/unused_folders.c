/* Folders of jobs that never came to be: the daemon died in a POST after it had made the folder, and before the row. */
#include <dirent.h>
#include <string.h>
#include <unistd.h>

#include "database.h"
#include "job_folder.h"
#include "job_store.h"
#include "log.h"

/* Nothing in it but what a POST puts there. */
static bool is_of_a_post(const data_folder *data, const char *id)
{
    const int folder = job_folder_open(data, id);
    DIR *list = folder >= 0 ? fdopendir(folder) : NULL;
    bool known = list != NULL;
    if (!list && folder >= 0) close(folder);
    for (const struct dirent *entry; known && (entry = readdir(list)) != NULL;)
        known = strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0 || strcmp(entry->d_name, JOB_SPEC_FILE) == 0
                || strcmp(entry->d_name, JOB_START_FILE) == 0 || strcmp(entry->d_name, JOB_START_HASH_FILE) == 0;
    if (list) closedir(list);
    return known;
}

store_status store_remove_unused_folders(job_store *store)
{
    const int jobs = dup(store->data->jobs);
    DIR *list = jobs >= 0 ? fdopendir(jobs) : NULL;
    if (!list && jobs >= 0) close(jobs);
    if (!list) return STORE_FAILED;
    rewinddir(list);
    store_status status = STORE_OK;
    for (const struct dirent *entry; status == STORE_OK && (entry = readdir(list)) != NULL;) {
        if (!job_id_is_valid(entry->d_name)) continue;
        status = store_has_job(store, entry->d_name);
        if (status != STORE_NOT_FOUND) continue;
        status = STORE_OK;
        if (!is_of_a_post(store->data, entry->d_name)) continue;
        log_line("job %s was never added: its folder is removed", entry->d_name);
        job_folder_discard(store->data, entry->d_name);
    }
    closedir(list);
    return status;
}
