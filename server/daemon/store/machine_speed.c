/* How fast this machine is, for estimates: DATA/calibration.json as `repose calibrate` wrote it, corrected by what the
 * latest runs really took. */
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "database.h"
#include "job_store.h"

/* Runs shorter than this tell more of starting than of steps. */
#define LEAST_SECONDS "0.5"
/* A correction beyond these tells of a machine that had other things to do; of a processor other than the one that was measured it
 * may also tell how fast that is. */
#define LEAST_CORRECTION 0.5
#define MOST_CORRECTION 3.0
#define OF_ANOTHER_PROCESSOR 4.0

/* So many runs are looked at, and of these as many as one type of processor has made. */
#define RUNS 27
#define RUNS_OF_ONE 9
#define TEXT_OF(number) #number
#define AS_TEXT(number) TEXT_OF(number)

/* Read once by each thread, and again where it has changed: it is replaced as a whole. */
static calibration calibration_of_file(const data_folder *data)
{
    static _Thread_local struct stat last;
    static _Thread_local calibration known;
    char path[4096];
    struct stat facts = { 0 };
    snprintf(path, sizeof path, "%s/" CALIBRATION_FILE, data->path);
    const bool is_there = stat(path, &facts) == 0;
    const bool is_known = is_there && facts.st_dev == last.st_dev && facts.st_ino == last.st_ino && facts.st_size == last.st_size
                          && facts.st_mtim.tv_sec == last.st_mtim.tv_sec && facts.st_mtim.tv_nsec == last.st_mtim.tv_nsec;
    if (is_known) return known;
    json_t *document = is_there ? json_load_file(path, JSON_REJECT_DUPLICATES, NULL) : NULL;
    calibration_from_json(document, &known);
    last = document ? facts : (struct stat){ 0 };
    json_decref(document);
    return known;
}

/* What a step took over what was to be expected of it. */
static double ratio_of_run(sqlite3_stmt *row, const calibration *machine)
{
    const calibration_load load = { .spheres = sqlite3_column_double(row, 1),
                                    .of_particle = sqlite3_column_double(row, 2),
                                    .law = (dem_contact_law)sqlite3_column_int(row, 3),
                                    .friction = sqlite3_column_double(row, 4),
                                    .rolling_friction = sqlite3_column_int(row, 5),
                                    .in_double = sqlite3_column_int(row, 6),
                                    .threads = sqlite3_column_int(row, 7) };
    return sqlite3_column_double(row, 0) / (sqlite3_column_double(row, 8) * calibration_seconds_a_step(machine, &load));
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct past_run {
    double ratio;
    char processor[CALIBRATION_TEXT]; /* "": not known, of runs from before: the one that was measured */
} past_run;

/* The latest first. Runs from before the calibration may have been another program's. An index holds the runs that are long
 * enough, so that some rows are read of however many. */
static size_t read_past_runs(sqlite3 *reader, const calibration *machine, past_run run[RUNS])
{
    size_t count = 0;
    sqlite3_stmt *statement = sql_prepare(
        reader,
        "SELECT r.seconds, l.spheres, l.of_particle, l.law, l.friction, l.rolling_friction, l.in_double, l.threads,"
        " l.factor, coalesce(r.processor,'') FROM (SELECT job, wall_seconds/steps AS seconds, processor FROM run_result"
        "  WHERE steps>0 AND wall_seconds>" LEAST_SECONDS " ORDER BY job DESC LIMIT " AS_TEXT(
            RUNS) ") r"
                  " JOIN job_load l ON l.job=r.job JOIN job ON job.number=r.job WHERE job.finished>?1 AND l.law BETWEEN 0 AND 2"
                  " ORDER BY r.job DESC",
        "t", machine->made);
    if (!statement) return 0;
    int code;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW && count < RUNS) {
        const double one = ratio_of_run(statement, machine);
        if (!(one > 0.0 && isfinite(one))) continue;
        const char *processor = (const char *)sqlite3_column_text(statement, 9);
        run[count].ratio = one;
        snprintf(run[count++].processor, CALIBRATION_TEXT, "%s", *processor ? processor : machine->processor);
    }
    sql_finish(statement, code);
    return count;
}

/* On which most of them ran. */
static const char *usual_processor(const past_run run[RUNS], size_t count)
{
    size_t best = 0, most = 0;
    for (size_t i = 0; i < count; i++) {
        size_t alike = 0;
        for (size_t k = 0; k < count; k++) alike += strcmp(run[i].processor, run[k].processor) == 0;
        if (alike > most) {
            most = alike;
            best = i;
        }
    }
    return run[best].processor;
}

/* Whose speed estimates are of, and the median of its latest runs, so that one odd run does not decide. Where workers run on other
 * machines, their processors may be of another type than the one that was measured. */
static void correct_by_runs(sqlite3 *reader, calibration *machine)
{
    past_run run[RUNS];
    double ratio[RUNS_OF_ONE];
    size_t used = 0;
    const size_t count = read_past_runs(reader, machine, run);
    if (count == 0) return;
    const char *processor = usual_processor(run, count);
    for (size_t i = 0; i < count && used < RUNS_OF_ONE; i++)
        if (strcmp(run[i].processor, processor) == 0) ratio[used++] = run[i].ratio;
    qsort(ratio, used, sizeof *ratio, ascending);
    const double room = strcmp(processor, machine->processor) == 0 ? 1.0 : OF_ANOTHER_PROCESSOR;
    machine->correction = fmin(fmax(ratio[used / 2], LEAST_CORRECTION / room), MOST_CORRECTION * room);
    snprintf(machine->processor, sizeof machine->processor, "%s", processor);
}

store_status store_insert_load(sqlite3 *writer, int64_t job, const job_estimate *estimate, const calibration *machine)
{
    const calibration_load *load = &estimate->load;
    const double factor = estimate->wall_seconds / (estimate->steps * calibration_seconds_a_step(machine, load));
    if (!(load->spheres > 0.0) || !isfinite(factor)) return STORE_OK; /* no steps, nothing to learn from */
    return sql_run(writer, NULL, "INSERT INTO job_load VALUES(?,?,?,?,?,?,?,?,?)", "iddidiiid", job, load->spheres,
                   load->of_particle, (int64_t)load->law, load->friction, (int64_t)load->rolling_friction, (int64_t)load->in_double,
                   (int64_t)load->threads, factor);
}

void store_read_calibration(job_store *store, calibration *machine)
{
    *machine = calibration_of_file(store->data);
    sqlite3 *reader = store_borrow_reader(store);
    machine->correction = 1.0;
    correct_by_runs(reader, machine);
    store_return_reader(store, reader);
}
