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
/* A correction beyond these tells of a machine that had other things to do. */
#define LEAST_CORRECTION 0.5
#define MOST_CORRECTION 3.0

enum { RUNS = 9 };

static calibration calibration_of_file(const data_folder *data)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/" CALIBRATION_FILE, data->path);
    json_t *document = json_load_file(path, JSON_REJECT_DUPLICATES, NULL);
    calibration machine;
    calibration_from_json(document, &machine);
    json_decref(document);
    return machine;
}

/* What a step took over what was to be expected of it; NaN where the specification is no longer understood. */
static double ratio_of_run(const char *text, double seconds_a_step, const calibration *machine)
{
    problem_list problems;
    if (!problem_list_init(&problems)) return NAN;
    json_t *document = json_loads(text, 0, NULL);
    job_spec spec;
    double ratio = NAN;
    if (document && job_spec_parse(NULL, document, 0, &spec, &problems)) {
        const job_estimate estimate = job_spec_estimate(&spec, machine);
        ratio = seconds_a_step * estimate.steps / estimate.wall_seconds;
        job_spec_clear(&spec);
    }
    json_decref(document);
    problem_list_clear(&problems);
    return ratio;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median of the latest runs, so that one odd run does not decide. Runs from before the calibration may have been
 * another program's. */
static double correction_of_runs(sqlite3 *reader, const calibration *machine)
{
    double ratio[RUNS];
    size_t count = 0;
    sqlite3_stmt *statement =
        sql_prepare(reader,
                    "SELECT job.spec, r.wall_seconds/r.steps FROM run_result r JOIN job ON job.number=r.job"
                    " WHERE r.steps>0 AND r.wall_seconds>" LEAST_SECONDS " AND job.finished>?1 ORDER BY r.job DESC LIMIT 9",
                    "t", machine->made);
    if (!statement) return 1.0;
    int code;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW && count < RUNS) {
        const double one =
            ratio_of_run((const char *)sqlite3_column_text(statement, 0), sqlite3_column_double(statement, 1), machine);
        if (one > 0.0) ratio[count++] = one;
    }
    sql_finish(statement, code);
    if (count == 0) return 1.0;
    qsort(ratio, count, sizeof *ratio, ascending);
    return fmin(fmax(ratio[count / 2], LEAST_CORRECTION), MOST_CORRECTION);
}

void store_read_calibration(job_store *store, calibration *machine)
{
    *machine = calibration_of_file(store->data);
    sqlite3 *reader = store_borrow_reader(store);
    machine->correction = correction_of_runs(reader, machine);
    store_return_reader(store, reader);
}
