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

/* So many runs are looked at. */
#define RUNS 9
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

/* The median of the latest runs, so that one odd run does not decide. Runs from before the calibration may have been
 * another program's. An index holds the runs that are long enough, so that nine rows are read of however many. */
static double correction_of_runs(sqlite3 *reader, const calibration *machine)
{
    double ratio[RUNS];
    size_t count = 0;
    sqlite3_stmt *statement = sql_prepare(
        reader,
        "SELECT r.seconds, l.spheres, l.of_particle, l.law, l.friction, l.rolling_friction, l.in_double, l.threads,"
        " l.factor FROM (SELECT job, wall_seconds/steps AS seconds FROM run_result"
        "  WHERE steps>0 AND wall_seconds>" LEAST_SECONDS " ORDER BY job DESC LIMIT " AS_TEXT(
            RUNS) ") r"
                  " JOIN job_load l ON l.job=r.job JOIN job ON job.number=r.job WHERE job.finished>?1 AND l.law BETWEEN 0 AND 2",
        "t", machine->made);
    if (!statement) return 1.0;
    int code;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW && count < RUNS) {
        const double one = ratio_of_run(statement, machine);
        if (one > 0.0 && isfinite(one)) ratio[count++] = one;
    }
    sql_finish(statement, code);
    if (count == 0) return 1.0;
    qsort(ratio, count, sizeof *ratio, ascending);
    return fmin(fmax(ratio[count / 2], LEAST_CORRECTION), MOST_CORRECTION);
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
    machine->correction = correction_of_runs(reader, machine);
    store_return_reader(store, reader);
}
