/* repose: one virtual test, run or checked. With no daemon at all it serves a laptop, a test or a batch
 * system; the daemon starts it for every attempt at a job. */
#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "calibrate.h"
#include "confinement.h"
#include "file_publish.h"
#include "file_seal.h"
#include "hdf_file.h"
#include "job_run.h"
#include "json_text.h"
#include "machine_error.h"
#include "plan_report.h"
#include "run_profile.h"
#include "run_summary.h"
#include "spec_file.h"
#include "start_file.h"
#include "study_report.h"
#include "study_split.h"
#include "variant.h"
#include "version.h"
#include "worker_log.h"
#include "worker_memory.h"

enum { LONGEST_RESULT = 10000000, MOST_THREADS = 256 };

#define HELP_RUN                                                                                                                   \
    "repose run SPEC --out DIR     run the test that the file SPEC describes (\"-\": stdin)\n"                                     \
    "    --threads N               instead of those of the spec; results do not depend on it\n"                                    \
    "    --attempt N               of a job that was begun before (default 1)\n"                                                   \
    "    --checkpoint-seconds S    between checkpoints (default 30); the first comes after a tenth of it\n"                        \
    "    --json                    print the results as JSON\n"                                                                    \
    "    --profile                 print what the time went into, and keep it as profile.json (not of a granule)\n"                \
    "    --isa avx512|avx2|plain   the instruction set to use (default: the best that the processor has); results do not\n"        \
    "                              depend on it. Also of check and calibrate\n"                                                    \
    "    --confine                 let the run read and write DIR alone, and let it neither start programs nor use the\n"          \
    "                              network, as the daemon's workers; a file to start from must then lie in DIR\n"                  \
    "    --start N                 of several workers on one folder, on whatever machine, the one with the largest N has it;\n"    \
    "                              the others leave (exit 7)\n"                                                                    \
    "    --save-bed                keep the settled bed as bed.hdf, for other jobs of a study that would settle the same\n"
#define HELP_CHECK                                                                                                                 \
    "repose check SPEC             print the spec with every default filled in, and an estimate of steps, time and\n"              \
    "                              memory; or every problem it has. Of a study: its cases and what it costs; of a\n"               \
    "                              calibration: its tests and what it takes at most\n"                                             \
    "    --data DIR                where this machine's speed is kept once it is measured (./data where it is there,\n"            \
    "                              else in the user's cache alone)\n"
#define HELP_CALIBRATE                                                                                                             \
    "repose calibrate              measure this machine's speed where that was not yet done; --data DIR as with check;\n"          \
    "                              --json prints the whole of it\n"
#define HELP_PLAN                                                                                                                  \
    "repose plan FILE              of a calibration {\"request\", \"runs\"} (\"-\": stdin): print which cases to run next, or "    \
    "the\n"                                                                                                                        \
    "                              answer, or every problem of the request\n"
#define HELP_SPLIT                                                                                                                 \
    "repose split STUDY --out DIR  write the jobs of a study as numbered folders, and DIR/job.sbatch, which runs them as an\n"     \
    "                              array of Slurm's, with PBS or by GNU parallel\n"
#define HELP_COLLECT                                                                                                               \
    "repose collect DIR            of such a study, whatever has run so far: DIR/results.csv, and DIR/reposed.sqlite with the\n"   \
    "                              tables of a service\n"
#define HELP_EXIT                                                                                                                  \
    "\n"                                                                                                                           \
    "A run that was interrupted goes on from its checkpoint when it is started again with the same SPEC and DIR. Results\n"        \
    "of another SPEC in DIR are never overwritten.\n"                                                                              \
    "Exit: 0 done, 1 fault, 2 bad spec or usage, 3 stopped by a signal (to be continued), 4 numerical failure, 5 disk,\n"          \
    "6 memory, descriptors or the like that the machine did not give, 7 another start has DIR.\n"

static const char help[] =
    HELP_RUN HELP_CHECK HELP_CALIBRATE HELP_PLAN HELP_SPLIT HELP_COLLECT "repose COMMAND --help | --help | --version\n" HELP_EXIT;

/* Complete once main has begun. */
static char program_version[80];

static const char no_spec[] = "give one SPEC file";

typedef struct command_line {
    const char *spec, *out, *data;
    const char *isa; /* NULL: the best there is */
    int threads;     /* 0: those of the spec */
    bool json;
    bool help; /* that alone is asked for */
    bool confine;
    run_options run;
} command_line;

static enum worker_exit refuse_usage(const char *problem, const char *value)
{
    fprintf(stderr, "repose: %s%s%s\nTry: repose --help\n", problem, value ? ": " : "", value ? value : "");
    return WORKER_BAD_SPEC;
}

static bool read_whole(const char *name, const char *text, int most, int *number)
{
    char *end;
    const long value = strtol(text, &end, 10);
    if (!*end && end != text && value >= 1 && value <= most) {
        *number = (int)value;
        return true;
    }
    fprintf(stderr, "repose: --%s is \"%s\"; must be a whole number in [1, %d]\n", name, text, most);
    return false;
}

static bool read_seconds(const char *name, const char *text, double *seconds)
{
    char *end;
    *seconds = strtod(text, &end);
    if (!*end && end != text && isfinite(*seconds) && *seconds >= 0.0) return true;
    fprintf(stderr, "repose: --%s is \"%s\"; must be a number of at least 0 s\n", name, text);
    return false;
}

/* argv[0] is the program's name, in the place of the word "run" or "check". */
static enum worker_exit read_command_line(int argc, char **argv, command_line *line)
{
    static const struct option options[] = {
        { "out", required_argument, NULL, 'o' },
        { "threads", required_argument, NULL, 't' },
        { "attempt", required_argument, NULL, 'a' },
        { "checkpoint-seconds", required_argument, NULL, 'c' },
        { "json", no_argument, NULL, 'j' },
        { "profile", no_argument, NULL, 'p' },
        { "data", required_argument, NULL, 'd' },
        { "isa", required_argument, NULL, 'i' },
        { "help", no_argument, NULL, 'h' },
        { "confine", no_argument, NULL, 'f' },
        { "save-bed", no_argument, NULL, 'b' },
        { "start", required_argument, NULL, 's' },
        { NULL, 0, NULL, 0 },
    };
    *line = (command_line){ .run = { .attempt = 1, .checkpoint_seconds = 30.0, .program = program_version } };
    bool good = true;
    for (int option; good && (option = getopt_long(argc, argv, "o:h", options, NULL)) != -1;) {
        switch (option) {
        case 'o': line->out = optarg; break;
        case 't': good = read_whole("threads", optarg, MOST_THREADS, &line->threads); break;
        case 'a': good = read_whole("attempt", optarg, INT_MAX, &line->run.attempt); break;
        case 'c': good = read_seconds("checkpoint-seconds", optarg, &line->run.checkpoint_seconds); break;
        case 'j': line->json = true; break;
        case 'p': line->run.profile = true; break;
        case 'h': line->help = true; return WORKER_DONE;
        case 'd': line->data = optarg; break;
        case 'f': line->confine = true; break;
        case 'b': line->run.save_bed = true; break;
        case 's': good = read_whole("start", optarg, INT_MAX, &line->run.start_number); break;
        case 'i':
            line->isa = optarg;
            good = variant_isa_is_usable(optarg);
            break;
        default: return WORKER_BAD_SPEC; /* getopt has said why */
        }
        if (!good) return WORKER_BAD_SPEC;
    }
    if (optind < argc) line->spec = argv[optind];
    if (optind + 1 < argc) return refuse_usage("not understood", argv[optind + 1]);
    return WORKER_DONE;
}

static uint64_t random_seed(void)
{
    uint64_t seed = 0;
    if (getrandom(&seed, sizeof seed, 0) != (ssize_t)sizeof seed) worker_warn("no random seed from the system: taking 0");
    return seed;
}

static enum worker_exit show(const char *text)
{
    fputs(text, stdout);
    return WORKER_DONE;
}

/* Where the spec has no seed: that of the run in the folder, so that the same SPEC and DIR are the same run. */
static uint64_t seed_if_missing(const char *folder)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/" JOB_SPEC_FILE, folder ? folder : "");
    size_t length;
    file_state state;
    struct stat facts; /* a symbolic link is not ours to read */
    const bool is_ours = folder && lstat(path, &facts) == 0 && S_ISREG(facts.st_mode);
    char *text = is_ours ? file_read_sealed(path, SPEC_FILE_LONGEST, NULL, &length, &state) : NULL;
    json_t *earlier = text ? json_loadb(text, length, 0, NULL) : NULL;
    free(text);
    const json_t *seed = json_object_get(json_object_get(earlier, "inputs"), "seed");
    const uint64_t chosen = json_is_integer(seed) ? (uint64_t)json_integer_value(seed) : random_seed();
    json_decref(earlier);
    return chosen;
}

static void print_json(json_t *document)
{
    char *text = json_text_write(document);
    if (text) fputs(text, stdout);
    free(text);
    json_decref(document);
}

static enum worker_exit refuse(problem_list *problems)
{
    print_json(problem_json(400, "about:blank", "Bad specification", "The specification can't be run as it is.", problems));
    return WORKER_BAD_SPEC;
}

static const char *path_of(const char *name) { return strcmp(name, "-") == 0 ? "/dev/stdin" : name; }

/* What paths in the spec are relative to. */
static const char *beside(const char *name) { return strcmp(name, "-") == 0 ? NULL : name; }

/* Whether the spec's file can't be opened for want of something of the machine. */
static bool machine_keeps_from(const char *path)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    const bool keeps = file < 0 && machine_error_is(errno);
    if (file >= 0) close(file);
    return keeps;
}

/* The spec, or the problem document on stdout. Refused only when it has problems twice: a call that failed once, for want of
 * memory say, is no problem of the spec. */
static enum worker_exit load_spec(const char *name, const char *folder, job_spec *spec)
{
    problem_list problems;
    const uint64_t seed = seed_if_missing(folder);
    bool loaded = false;
    const start_source beds = start_files(beside(name));
    for (int looks = 0; looks < 2 && !loaded; looks++) {
        if (looks > 0) problem_list_clear(&problems);
        problem_list_init(&problems);
        loaded = spec_file_load(path_of(name), &beds, seed, spec, &problems);
    }
    enum worker_exit exit = WORKER_DONE;
    if (!loaded && (worker_memory_was_short() || machine_keeps_from(path_of(name)))) {
        worker_warn("%s can't be read: no memory, or no descriptor", name);
        exit = WORKER_MACHINE;
    } else if (!loaded) {
        exit = refuse(&problems);
    }
    problem_list_clear(&problems);
    return exit;
}

/* What a job's, a study's or a calibration's document would make. New reference; NULL: problems say why. */
static json_t *check_document(const json_t *document, const start_source *beds, const calibration *machine, problem_list *problems)
{
    if (plan_report_is_calibration(document)) return plan_report(document, machine, problems);
    if (study_report_is_study(document)) return study_report(document, beds, random_seed(), machine, problems);
    job_spec spec;
    if (!job_spec_parse_with(beds, NULL, document, random_seed(), &spec, problems)) return NULL;
    json_t *report = job_spec_report(&spec, machine);
    job_spec_clear(&spec);
    return report;
}

/* argv as read_command_line had it, where the word has made room for the program's name. */
static bool take_over(const command_line *line, const char *precision, char *word, char **argv)
{
    argv[0] = word;
    return variant_take_over(line->isa, precision, argv - 1);
}

static enum worker_exit check(int argc, char **argv, char *word)
{
    command_line line;
    enum worker_exit exit = read_command_line(argc, argv, &line);
    if (exit != WORKER_DONE) return exit;
    if (line.help) return show(HELP_CHECK);
    if (!line.spec) return refuse_usage(no_spec, NULL);
    if (!take_over(&line, "single", word, argv)) return WORKER_FAULT; /* whose speed is told */
    calibration machine;
    bool is_new;
    calibrate(line.data, &machine, &is_new);
    problem_list problems;
    problem_list_init(&problems);
    json_t *document = spec_file_read(path_of(line.spec), &problems);
    const start_source beds = start_files(beside(line.spec));
    json_t *report = document ? check_document(document, &beds, &machine, &problems) : NULL;
    json_decref(document);
    if (report) print_json(report);
    else exit = refuse(&problems);
    problem_list_clear(&problems);
    return exit;
}

/* What a calibration was, for whoever watches; --json: the whole of it. */
static enum worker_exit calibrate_here(int argc, char **argv, char *word)
{
    command_line line;
    calibration machine;
    bool is_new;
    const enum worker_exit exit = read_command_line(argc, argv, &line);
    if (exit != WORKER_DONE) return exit;
    if (line.help) return show(HELP_CALIBRATE);
    if (line.spec) return refuse_usage("not understood", line.spec);
    if (!take_over(&line, "single", word, argv)) return WORKER_FAULT;
    if (!calibrate(line.data, &machine, &is_new)) return WORKER_FAULT;
    if (line.json) print_json(calibration_to_json(&machine));
    else
        printf("%s, %s: %.1f M sphere-steps/s in the paper's drum\n", machine.processor,
               is_new ? "measured now" : "as measured before", 1e3 / machine.sphere[0]);
    return WORKER_DONE;
}

static void path_beside(const char *name, char path[PATH_MAX + 16])
{
    char own[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
    own[length > 0 ? length : 0] = '\0';
    const char *end = strrchr(own, '/');
    snprintf(path, PATH_MAX + 16, "%.*s/%s", end ? (int)(end - own) : 0, own, name);
}

/* A study into folders of its own. */
static enum worker_exit split(int argc, char **argv)
{
    command_line line;
    enum worker_exit exit = read_command_line(argc, argv, &line);
    if (exit != WORKER_DONE) return exit;
    if (line.help) return show(HELP_SPLIT);
    if (!line.spec || !line.out) return refuse_usage("give a STUDY file, and say where to write: --out DIR", NULL);
    char program[PATH_MAX + 16];
    path_beside("repose", program);
    problem_list problems;
    problem_list_init(&problems);
    json_t *document = spec_file_read(path_of(line.spec), &problems);
    const start_source beds = start_files(beside(line.spec));
    const bool good = document && study_split(document, &beds, random_seed(), NULL, program, line.out, &problems);
    json_decref(document);
    if (!good) exit = problem_list_is_empty(&problems) ? WORKER_DISK : refuse(&problems);
    problem_list_clear(&problems);
    return exit;
}

/* A program of its own, beside this one: no run loads the planner's linear algebra, or the daemon's database. */
static enum worker_exit become(const char *name, char **argv)
{
    char program[PATH_MAX + 16];
    path_beside(name, program);
    execv(program, argv);
    const int reason = errno;
    fprintf(stderr, "repose: %s: %s\n", program, strerror(reason));
    return machine_error_is(reason) ? WORKER_MACHINE : WORKER_FAULT;
}

static enum worker_exit collect(char **argv, char *word)
{
    argv[1] = word;
    return become("reposed", argv);
}

/* The working directory is the job folder now. */
static void print_result(const command_line *line, const job_spec *spec)
{
    size_t length;
    char *text = file_read(JOB_RESULT_FILE, LONGEST_RESULT, &length);
    if (!text) return;
    if (line->json) {
        fputs(text, stdout);
    } else {
        json_t *result = json_loadb(text, length, 0, NULL);
        job_run_summarize(spec, result, line->out);
        json_decref(result);
    }
    free(text);
}

static void print_profile(void)
{
    json_t *report = json_load_file(JOB_PROFILE_FILE, 0, NULL); /* a granule has none */
    if (report) run_profile_print(report);
    json_decref(report);
}

static enum worker_exit run(int argc, char **argv, char *word)
{
    command_line line;
    job_spec spec;
    enum worker_exit exit = read_command_line(argc, argv, &line);
    if (exit == WORKER_DONE && line.help) return show(HELP_RUN HELP_EXIT);
    if (exit == WORKER_DONE && !line.spec) exit = refuse_usage(no_spec, NULL);
    if (exit == WORKER_DONE && !line.out) exit = refuse_usage("say where to write: --out DIR", NULL);
    if (exit == WORKER_DONE && strcmp(line.spec, "-") == 0 && !variant_keep_stdin()) exit = WORKER_FAULT;
    if (exit == WORKER_DONE && line.confine && !confinement_begin(line.out, path_of(line.spec))) exit = WORKER_MACHINE;
    if (exit == WORKER_DONE) exit = load_spec(line.spec, line.out, &spec);
    if (exit != WORKER_DONE) return exit;
    job_run_hold_signals();
    if (!take_over(&line, spec.inputs.precision > 0 ? "double" : "single", word, argv)) {
        exit = machine_error_is(errno) || (line.confine && errno == EACCES) ? WORKER_MACHINE : WORKER_FAULT;
        job_spec_clear(&spec);
        return exit;
    }
    if (line.threads) job_spec_set_threads(&spec, line.threads);
    line.run.on_terminal = isatty(STDOUT_FILENO) && !line.json;
    worker_log_only_warnings(line.run.on_terminal && isatty(STDERR_FILENO));
    if (line.confine && !confinement_complete(line.out)) {
        job_spec_clear(&spec);
        return WORKER_MACHINE;
    }
    hdf_init();
    job_run_catch_signals();
    char start[PATH_MAX];
    if (*spec.inputs.start.file) line.run.start = realpath(spec.inputs.start.file, start);
    exit = job_run(&spec, line.out, &line.run);
    if (line.run.on_terminal) terminal_end_progress();
    if (exit == WORKER_DONE) print_result(&line, &spec);
    if (exit == WORKER_DONE && line.run.profile && !line.json) print_profile();
    job_spec_clear(&spec);
    return exit;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fputs(help, stderr);
        return WORKER_BAD_SPEC;
    }
    worker_memory_watch();
    snprintf(program_version, sizeof program_version, "" REPOSED_VERSION "%s", reposed_commit);
    char *word = argv[1];
    argv[1] = argv[0];
    int exit = WORKER_DONE;
    if (strcmp(word, "run") == 0) exit = run(argc - 1, argv + 1, word);
    else if (strcmp(word, "check") == 0) exit = check(argc - 1, argv + 1, word);
    else if (strcmp(word, "calibrate") == 0) exit = calibrate_here(argc - 1, argv + 1, word);
    else if (strcmp(word, "plan") == 0) exit = become("repose-plan", argv + 1);
    else if (strcmp(word, "split") == 0) exit = split(argc - 1, argv + 1);
    else if (strcmp(word, "collect") == 0) exit = collect(argv, word);
    else if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) exit = show(help);
    else if (strcmp(word, "--version") == 0) printf("repose " REPOSED_VERSION "%s\n", reposed_commit);
    else exit = refuse_usage("not a command", word);
    if (exit != WORKER_DONE && exit != WORKER_STOPPED && confinement_has_refused()) exit = WORKER_MACHINE;
    /* After a failed write HDF5's own cleaning up at exit crashes: leave without it. */
    if (fflush(stdout) != 0 && exit == WORKER_DONE) exit = WORKER_DISK;
    fflush(stderr);
    _exit(exit);
}
