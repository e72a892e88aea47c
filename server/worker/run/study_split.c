#include "study_split.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "job_folder.h"
#include "study_spec.h"

/* A job of the array is given a minute for each of its runs, and three times what these are expected to take. */
#define TIME_FACTOR 3.0
#define MEMORY_TO_START 268435456.0

enum { MOST_JOBS = 1000000, MOST_TASKS = 1000 /* Slurm takes 1001 in an array unless it is told otherwise */, LONGEST_NAME = 64 };

typedef struct splitting {
    const study_spec *study;
    int folder; /* descriptor */
    int threads;
    bool failed;
} splitting;

static bool say_failure(const char *name)
{
    fprintf(stderr, "repose: %s can't be written: %s\n", name, strerror(errno));
    return false;
}

static bool write_file(int folder, const char *name, const char *text)
{
    const int file = openat(folder, name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
    const size_t length = strlen(text);
    const bool good = file >= 0 && write(file, text, length) == (ssize_t)length;
    if (file < 0 || close(file) != 0 || !good) return say_failure(name);
    return true;
}

static bool make_folder(int folder, const char *name)
{
    return mkdirat(folder, name, 0777) == 0 || errno == EEXIST || say_failure(name);
}

static bool take_job(void *context, const job_spec *spec, size_t index, int repeat)
{
    splitting *s = context;
    char folder[LONGEST_NAME], name[LONGEST_NAME + 16];
    char *text = job_spec_to_text(spec);
    snprintf(folder, sizeof folder, "jobs/" JOB_NUMBERED_FORMAT, index * (size_t)s->study->repeats + (size_t)repeat + 1);
    snprintf(name, sizeof name, "%s/" JOB_SPEC_FILE, folder);
    if (spec->threads > s->threads) s->threads = spec->threads;
    s->failed = !text || !make_folder(s->folder, folder) || !write_file(s->folder, name, text);
    free(text);
    return !s->failed;
}

static const char script_end[] =
    "task=${SLURM_ARRAY_TASK_ID:-${PBS_ARRAY_INDEX:-${PBS_ARRAYID:-${TASK:?say which: TASK=1 sh job.sbatch}}}}\n"
    "child= stopped=\n"
    "trap 'stopped=1; test -z \"$child\" || kill -TERM \"$child\" 2>/dev/null' TERM INT\n"
    "number=$(((task - 1) * each + 1))\n"
    "while test \"$number\" -le $((task * each)) && test \"$number\" -le \"$jobs\" && test -z \"$stopped\"; do\n"
    "    folder=jobs/$(printf %06d \"$number\")\n"
    "    \"$program\" run \"$folder/" JOB_SPEC_FILE "\" --out \"$folder\" >\"$folder/summary.txt\" 2>>\"$folder/" JOB_LOG_FILE
    "\" &\n"
    "    child=$!\n"
    "    wait \"$child\"\n"
    "    while kill -0 \"$child\" 2>/dev/null; do wait \"$child\"; done\n"
    "    number=$((number + 1))\n"
    "done\n";

static void print_quoted(FILE *out, const char *text)
{
    fputc('\'', out);
    for (const char *c = text; *c; c++) {
        if (*c == '\'') fputs("'\\''", out);
        else fputc(*c, out);
    }
    fputs("'\n", out);
}

static bool write_script(const splitting *s, const study_estimate *estimate, const char *program, const char *path)
{
    char *text = NULL;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    if (!out) return say_failure("job.sbatch");
    const long jobs = (long)s->study->cases * s->study->repeats, each = (jobs + MOST_TASKS - 1) / MOST_TASKS;
    const double seconds = (double)each * (60.0 + TIME_FACTOR * estimate->wall_seconds / (double)jobs);
    fprintf(out,
            "#!/bin/sh\n"
            "#SBATCH --job-name=reposed --array=1-%ld --nodes=1 --ntasks=1 --cpus-per-task=%d --mem=%.0fM --time=%.0f\n"
            "#SBATCH --signal=B:TERM@60 --output=/dev/null\n"
            "# sbatch job.sbatch; or qsub -J 1-%ld job.sbatch; or seq %ld | parallel TASK={} sh job.sbatch\n"
            "# What was cut short goes on from where it was when it is submitted once more; what is done stays as it is.\n"
            "jobs=%ld each=%ld\nprogram=",
            (jobs + each - 1) / each, s->threads, (2.0 * estimate->memory_bytes + MEMORY_TO_START) / 1048576.0,
            seconds / 60.0 + 2.0, (jobs + each - 1) / each, (jobs + each - 1) / each, jobs, each);
    print_quoted(out, program);
    fputs("cd ", out);
    print_quoted(out, path);
    fputs(script_end, out);
    const bool good = fclose(out) == 0 && write_file(s->folder, "job.sbatch", text);
    free(text);
    return good;
}

static bool write_study(const splitting *s)
{
    char *text = json_dumps(s->study->document, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    const bool good = text && write_file(s->folder, "study.json", text);
    free(text);
    return good;
}

static bool split(splitting *s, const calibration *machine, const char *program, const char *folder, problem_list *problems)
{
    char path[PATH_MAX];
    study_estimate estimate;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) return say_failure(folder);
    s->folder = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (s->folder < 0 || !realpath(folder, path)) return say_failure(folder);
    if (faccessat(s->folder, "study.json", F_OK, 0) == 0) {
        errno = EEXIST;
        return say_failure("study.json"); /* its folders may hold results */
    }
    const study_taker taker = { .take = take_job, .context = s };
    if (!make_folder(s->folder, "jobs") || !study_check(s->study, machine, &taker, &estimate, problems, NULL)) return false;
    return write_script(s, &estimate, program, path) && write_study(s);
}

bool study_split(const json_t *document, const start_source *beds, uint64_t seed_if_missing, const calibration *machine,
                 const char *program, const char *folder, problem_list *problems)
{
    const study_options options = {
        .seed_if_missing = seed_if_missing, .default_threads = 1, .most_jobs = MOST_JOBS, .beds = beds
    };
    study_spec study;
    study_estimate estimate;
    splitting s = { .study = &study, .folder = -1, .threads = 1 };
    study_spec_parse(document, &options, &study, problems);
    /* Once without writing anything: a study with problems leaves no folder. */
    const bool good =
        study_check(&study, machine, NULL, &estimate, problems, NULL) && split(&s, machine, program, folder, problems);
    if (s.folder >= 0) close(s.folder);
    study_spec_clear(&study);
    return good;
}
