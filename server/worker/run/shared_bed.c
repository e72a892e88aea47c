#include "shared_bed.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "file_publish.h"
#include "job_folder.h"
#include "spec_bed.h"
#include "worker_log.h"

bool shared_bed_save(char hash[SHA256_HEX_SIZE])
{
    unlink(JOB_BED_FILE);
    const int file = link(JOB_CHECKPOINT_FILE, JOB_BED_FILE) == 0 ? open(JOB_BED_FILE, O_RDONLY | O_CLOEXEC | O_NOFOLLOW) : -1;
    const bool saved = file >= 0 && sha256_of_file(file, hash);
    if (!saved) worker_warn("the settled bed can't be kept for other jobs of the study: %s", strerror(errno));
    if (file >= 0) close(file);
    return saved;
}

/* "HASH  JOB\n", as the daemon wrote it. */
static bool read_line(char hash[SHA256_HEX_SIZE], char job[JOB_ID_SIZE])
{
    size_t length = 0;
    char *line = file_read(JOB_BED_HASH_FILE, SHA256_HEX_SIZE + JOB_ID_SIZE + 2, &length);
    const size_t hex = SHA256_HEX_SIZE - 1;
    const bool good = line && length > hex + 3 && line[hex] == ' ' && line[hex + 1] == ' ' && line[length - 1] == '\n'
                      && length - hex - 3 < JOB_ID_SIZE;
    if (good) {
        snprintf(hash, SHA256_HEX_SIZE, "%s", line);
        snprintf(job, JOB_ID_SIZE, "%.*s", (int)(length - hex - 3), line + hex + 2);
    }
    free(line);
    return good && job_id_is_valid(job);
}

static bool has_hash(const char *hash)
{
    char found[SHA256_HEX_SIZE] = "";
    const int file = open(JOB_BED_FILE, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    const bool same = file >= 0 && sha256_of_file(file, found) && strcmp(found, hash) == 0;
    if (file >= 0) close(file);
    return same;
}

/* Whether a run of these two settles the same bed. */
static bool settles_the_same(const job_spec *spec, const char *params)
{
    problem_list problems;
    job_spec other;
    json_t *document = json_loads(params, JSON_REJECT_DUPLICATES, NULL);
    char *ours = spec_bed_text(spec), *theirs = NULL;
    if (document && problem_list_init(&problems)) {
        if (job_spec_parse(NULL, document, 0, &other, &problems)) {
            theirs = spec_bed_text(&other);
            job_spec_clear(&other);
        }
        problem_list_clear(&problems);
    }
    const bool same = ours && theirs && strcmp(ours, theirs) == 0;
    json_decref(document);
    free(ours);
    free(theirs);
    return same;
}

file_state shared_bed_read(const job_spec *spec, const char *program, checkpoint *saved)
{
    char hash[SHA256_HEX_SIZE], job[JOB_ID_SIZE];
    memset(saved, 0, sizeof *saved);
    if (!read_line(hash, job) || !has_hash(hash)) {
        worker_warn("%s is not the bed that the daemon was told of, and is not used", JOB_BED_FILE);
        return FILE_DAMAGED;
    }
    file_state state = checkpoint_read(saved, JOB_BED_FILE, NULL);
    if (state != FILE_WHOLE) return state;
    /* Another version may settle another bed. */
    const bool fits = strcmp(saved->program, program) == 0 && saved->next_sample == 0 && saved->next_snapshot == 0
                      && settles_the_same(spec, saved->params);
    if (fits) {
        memcpy(saved->settled_by, job, sizeof job);
        return FILE_WHOLE;
    }
    worker_warn("%s is not the bed of this run, and is not used", JOB_BED_FILE);
    checkpoint_clear(saved);
    return FILE_DAMAGED;
}

void shared_bed_remove(void)
{
    unlink(JOB_BED_FILE);
    unlink(JOB_BED_HASH_FILE);
}
