#include "slurm_bundle.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "job_folder.h"
#include "text_buffer.h"

enum { LONGEST_SCRIPT = 65536, LONGEST_FENCE = 512, LONGEST_WORDS = 4096 };

#define RESOURCES_LINE "#resources: "
#define MEMBER_LINE "#: %31s %d %d %d %d %lf %lf"

/* The bundle ends with a worker that was stopped or killed: what Slurm then says of the whole is the reason. A worker that finds
 * itself superseded (7) says nothing. */
static const char script_of_one[] =
    "child= stopped=\n"
    "trap 'stopped=1; test -z \"$child\" || kill -TERM \"$child\" 2>/dev/null' TERM INT\n"
    "umask 077\n"
    "ulimit -c 0\n"
    "one() {\n"
    "    id=$1 start=$2 attempt=$3 threads=$4; shift 4\n"
    "    test -z \"$stopped\" || exit 3\n"
    "    \"$worker\" run \"$jobs/$id/" JOB_SPEC_FILE
    "\" --out \"$jobs/$id\" --attempt \"$attempt\" --threads \"$threads\" \"$@\" \\\n"
    "        --start \"$start\" </dev/null >/dev/null 2>>\"$jobs/$id/" JOB_LOG_FILE "\" &\n"
    "    child=$!\n"
    "    wait \"$child\"; code=$?\n"
    "    while kill -0 \"$child\" 2>/dev/null; do wait \"$child\"; code=$?; done\n"
    "    child=\n"
    "    test \"$code\" = 7 || echo \"end $code\" >>\"$jobs/$id/$(printf '" JOB_FENCE_FORMAT "' \"$start\")\"\n"
    "    if test \"$code\" = 3 || test \"$code\" -gt 127; then exit \"$code\"; fi\n"
    "}\n";

static void add_quoted(text_buffer *out, const char *name, const char *value)
{
    text_buffer_print(out, "%s='", name);
    for (const char *c = value; *c; c++) {
        if (*c == '\'') text_buffer_print(out, "'\\''");
        else text_buffer_add(out, c, 1);
    }
    text_buffer_print(out, "'\n");
}

static void add_member(text_buffer *out, const bundle_member *member, const bundle_worker *worker)
{
    text_buffer_print(out, "one %s %d %d %d%s%s\n", member->job, member->start, member->attempt, member->threads,
                      worker->confine ? " --confine" : "", member->save_bed ? " --save-bed" : "");
}

static void script_path(char path[SLURM_PATH_SIZE], const data_folder *data, const char *name, const char *end)
{
    snprintf(path, SLURM_PATH_SIZE, "%s/slurm/%s.sh%s", data->path, name, end);
}

static bool write_whole(const char *path, const char *text)
{
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600);
    const size_t length = strlen(text);
    const bool good = file >= 0 && write(file, text, length) == (ssize_t)length && fsync(file) == 0;
    const int reason = errno;
    if (file >= 0) close(file);
    errno = reason;
    return good;
}

static bool sync_folder(const data_folder *data)
{
    char path[SLURM_PATH_SIZE];
    snprintf(path, sizeof path, "%s/slurm", data->path);
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool good = folder >= 0 && fsync(folder) == 0;
    if (folder >= 0) close(folder);
    return good;
}

bool slurm_bundle_write(const slurm_bundle *bundle, const data_folder *data, const bundle_worker *worker)
{
    char path[SLURM_PATH_SIZE], temporary[SLURM_PATH_SIZE], jobs[SLURM_PATH_SIZE];
    text_buffer script;
    text_buffer_init(&script, LONGEST_SCRIPT);
    snprintf(jobs, sizeof jobs, "%s/jobs", data->path);
    script_path(path, data, bundle->name, "");
    script_path(temporary, data, bundle->name, ".tmp");
    text_buffer_print(&script, "#!/bin/sh\n# Jobs of a reposed, to be run one after the other.\n");
    if (*bundle->resources) text_buffer_print(&script, RESOURCES_LINE "%s\n", bundle->resources);
    for (int m = 0; m < bundle->count; m++) {
        const bundle_member *member = &bundle->member[m];
        text_buffer_print(&script, "#: %s %d %d %d %d %.0f %.0f\n", member->job, member->start, member->attempt, member->threads,
                          member->save_bed, member->seconds, member->memory_bytes);
    }
    add_quoted(&script, "worker", worker->program);
    add_quoted(&script, "jobs", jobs);
    text_buffer_print(&script, "%s", script_of_one);
    for (int m = 0; m < bundle->count; m++) add_member(&script, &bundle->member[m], worker);
    errno = ENOMEM;
    const bool good = !script.failed && write_whole(temporary, script.text) && rename(temporary, path) == 0 && sync_folder(data);
    text_buffer_clear(&script);
    return good;
}

void slurm_bundle_remove(const slurm_bundle *bundle, const data_folder *data)
{
    char path[SLURM_PATH_SIZE];
    script_path(path, data, bundle->name, "");
    unlink(path);
    slurm_bundle_words_path(bundle, data, path);
    unlink(path);
}

void slurm_bundle_words_path(const slurm_bundle *bundle, const data_folder *data, char path[SLURM_PATH_SIZE])
{
    snprintf(path, SLURM_PATH_SIZE, "%s/slurm/%s.err", data->path, bundle->name);
}

/* As much of a file as fits; "" where it is not there: then false. */
static bool read_beginning(const char *path, char *text, size_t size)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    const ssize_t length = file >= 0 ? read(file, text, size - 1) : 0;
    if (file >= 0) close(file);
    text[length > 0 ? length : 0] = '\0';
    return file >= 0;
}

bool slurm_bundle_took_too_much_memory(const slurm_bundle *bundle, const data_folder *data)
{
    char path[SLURM_PATH_SIZE], words[LONGEST_WORDS];
    slurm_bundle_words_path(bundle, data, path);
    read_beginning(path, words, sizeof words);
    return strstr(words, "memory limit") || strstr(words, "oom-kill") || strstr(words, "oom_kill");
}

static bool read_member(const char *line, bundle_member *member)
{
    int save_bed;
    *member = (bundle_member){ .code = -1 };
    if (sscanf(line, MEMBER_LINE, member->job, &member->start, &member->attempt, &member->threads, &save_bed, &member->seconds,
               &member->memory_bytes)
        != 7)
        return false;
    member->save_bed = save_bed != 0;
    return true;
}

static void read_resources(const char *line, slurm_bundle *bundle)
{
    const size_t start = sizeof RESOURCES_LINE - 1;
    if (strncmp(line, RESOURCES_LINE, start) != 0) return;
    snprintf(bundle->resources, sizeof bundle->resources, "%.*s", (int)strcspn(line + start, "\n"), line + start);
}

slurm_bundle *slurm_bundle_read(const data_folder *data, const char *name)
{
    char path[SLURM_PATH_SIZE], line[SLURM_PATH_SIZE];
    script_path(path, data, name, "");
    FILE *file = fopen(path, "re");
    slurm_bundle *bundle = file ? calloc(1, sizeof *bundle) : NULL;
    while (bundle && bundle->count < BUNDLE_MOST && fgets(line, sizeof line, file))
        if (read_member(line, &bundle->member[bundle->count])) bundle->count++;
        else read_resources(line, bundle);
    if (file) fclose(file);
    if (!bundle || bundle->count == 0) {
        free(bundle);
        return NULL;
    }
    snprintf(bundle->name, sizeof bundle->name, "%s", name);
    bundle->stage = BUNDLE_DOUBTFUL;
    bundle->is_written = true;
    return bundle;
}

static void fence_path(char path[SLURM_PATH_SIZE], const data_folder *data, const bundle_member *member)
{
    snprintf(path, SLURM_PATH_SIZE, "%s/jobs/%s/" JOB_FENCE_FORMAT, data->path, member->job, member->start);
}

void slurm_fence_read(const data_folder *data, const bundle_member *member, bool *has_begun, int *code)
{
    char path[SLURM_PATH_SIZE], text[LONGEST_FENCE];
    fence_path(path, data, member);
    *has_begun = read_beginning(path, text, sizeof text);
    const char *end = strstr(text, "end ");
    *code = end && strchr(end, '\n') ? (int)strtol(end + 4, NULL, 10) : -1;
}

void slurm_fence_tell(const data_folder *data, const bundle_member *member, const char *word, bool *has_begun)
{
    char path[SLURM_PATH_SIZE], line[16];
    fence_path(path, data, member);
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
    *has_begun = file < 0 && errno == EEXIST;
    if (*has_begun) file = open(path, O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW);
    const int length = snprintf(line, sizeof line, "%s\n", word);
    const ssize_t ignored = file >= 0 ? write(file, line, (size_t)length) : 0;
    (void)ignored;
    if (file >= 0) close(file);
}
