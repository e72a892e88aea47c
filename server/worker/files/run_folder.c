#include "run_folder.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "checkpoint_file.h"
#include "file_publish.h"
#include "file_seal.h"
#include "job_folder.h"
#include "json_text.h"
#include "spec_file.h"
#include "worker_log.h"

static bool make_folder(const char *name)
{
    if (mkdir(name, 0755) == 0 || errno == EEXIST) return true;
    worker_warn("can't make the folder %s: %s", name, strerror(errno));
    return false;
}

/* What is there is ours: no symbolic link, behind which a file of somebody else may lie, nor a pipe or device. */
static bool is_plain(const char *name, mode_t kind)
{
    struct stat found;
    if (lstat(name, &found) != 0) return errno == ENOENT || errno == ENAMETOOLONG;
    if ((found.st_mode & S_IFMT) == kind) return true;
    worker_warn("%s in the job folder is no %s but %s: it is not used, and not replaced", name,
                kind == S_IFDIR ? "folder" : "plain file", S_ISLNK(found.st_mode) ? "a symbolic link" : "something else");
    return false;
}

static bool all_is_plain(void)
{
    static const char *const files[] = {
        JOB_SPEC_FILE,    JOB_START_FILE,      JOB_EVENTS_FILE,        JOB_SERIES_FILE,      JOB_WALLS_FILE,
        JOB_FIELDS_FILE,  JOB_CHECKPOINT_FILE, JOB_RESULT_FILE,        JOB_PROFILE_FILE,     JOB_EARLIER_CHECKPOINT_FILE,
        JOB_BED_FILE,     JOB_PICTURE_FILE,    JOB_SMALL_PICTURE_FILE, JOB_FIELDS_TEXT_FILE, JOB_TRACERS_FILE,
        JOB_TRACERS_TABLE
    };
    bool plain = is_plain(JOB_SNAPSHOT_FOLDER, S_IFDIR);
    plain = is_plain(JOB_BEDS_FOLDER, S_IFDIR) && plain;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) plain = is_plain(files[i], S_IFREG) && plain;
    return plain;
}

bool run_folder_enter(const char *folder, event_log *events)
{
    events->fd = -1;
    if (!make_folder(folder)) return false;
    if (chdir(folder) != 0) {
        worker_warn("can't enter the folder %s: %s", folder, strerror(errno));
        return false;
    }
    if (!all_is_plain() || !event_log_open(events) || !make_folder(JOB_SNAPSHOT_FOLDER)) return false;
    file_sweep_temporary(".");
    file_sweep_temporary(JOB_SNAPSHOT_FOLDER);
    file_sweep_temporary(JOB_BEDS_FOLDER);
    return true;
}

bool run_folder_add_beds(void) { return make_folder(JOB_BEDS_FOLDER); }

/* "000000.hdf", "000000.bin", "001.before.hdf" and the like: a file of ours. */
static bool is_numbered(const char *name, size_t least_digits)
{
    size_t digits = 0;
    while (isdigit((unsigned char)name[digits])) digits++;
    static const char *const ends[] = { ".hdf", ".bin", ".before.hdf" };
    for (size_t k = 0; digits >= least_digits && k < sizeof ends / sizeof ends[0]; k++)
        if (strcmp(name + digits, ends[k]) == 0) return true;
    return false;
}

static void remove_numbered(const char *folder, size_t least_digits)
{
    DIR *entries = file_list_folder(folder);
    if (!entries) return;
    for (struct dirent *entry; (entry = readdir(entries));)
        if (is_numbered(entry->d_name, least_digits)) unlinkat(dirfd(entries), entry->d_name, 0);
    closedir(entries);
}

void run_folder_empty_beds(void) { remove_numbered(JOB_BEDS_FOLDER, 3); }

/* The spec.json of the folder, canonical; to be freed. NULL: *state tells why. */
static char *spec_of_folder(file_state *state)
{
    size_t length;
    job_spec spec;
    problem_list problems;
    char *text = NULL, *written = file_read_sealed(JOB_SPEC_FILE, SPEC_FILE_LONGEST, NULL, &length, state);
    if (!written || !problem_list_init(&problems)) {
        free(written);
        return NULL;
    }
    json_t *document = json_text_load(written, length, &problems);
    if (document && job_spec_parse(NULL, document, 0, &spec, &problems)) {
        text = job_spec_to_text(&spec);
        job_spec_clear(&spec);
    }
    if (!text) *state = FILE_DAMAGED;
    json_decref(document);
    problem_list_clear(&problems);
    free(written);
    return text;
}

folder_owner run_folder_owner(const char *params, const char *brief)
{
    file_state state;
    char *text = spec_of_folder(&state);
    const bool same = text && strcmp(text, params) == 0;
    free(text);
    if (same) return FOLDER_OURS;
    if (state == FILE_UNREADABLE) return FOLDER_UNREADABLE;
    return state == FILE_DAMAGED && checkpoint_is_of(brief) ? FOLDER_OURS_BY_CHECKPOINT : FOLDER_OF_ANOTHER;
}

bool run_folder_claim(folder_owner owner, const char *params, event_log *events)
{
    static const char *const leftovers[] = { JOB_RESULT_FILE,  JOB_CHECKPOINT_FILE,    JOB_EARLIER_CHECKPOINT_FILE,
                                             JOB_START_FILE,   JOB_SERIES_FILE,        JOB_BED_FILE,
                                             JOB_PICTURE_FILE, JOB_SMALL_PICTURE_FILE, JOB_FIELDS_TEXT_FILE };
    if (owner == FOLDER_OURS) return true;
    if (owner == FOLDER_UNREADABLE) return false;
    if (owner == FOLDER_OF_ANOTHER) {
        for (size_t k = 0; k < sizeof leftovers / sizeof leftovers[0]; k++) unlink(leftovers[k]);
        remove_numbered(JOB_SNAPSHOT_FOLDER, 6);
        run_folder_empty_beds();
        if (!event_log_empty(events)) return false;
    }
    return file_write_sealed(JOB_SPEC_FILE, params, strlen(params), NULL);
}
