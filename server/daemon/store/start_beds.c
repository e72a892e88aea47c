/* The beds of jobs, from which other jobs start: found in the table of jobs and in their folders, and given to the new
 * job's folder under a name of its own, so that nothing depends on the old job afterwards. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "csv_table.h"
#include "database.h"
#include "job_folder.h"
#include "job_store.h"

/* Whether the file is there. The list of snapshots is the table's; a checkpoint is its file. */
static bool has_file(job_store *store, const start_inputs *start, problem_list *problems)
{
    int file = -1;
    if (isnan(start->snapshot)) {
        file = job_file_open(store->data, start->job, NULL, JOB_CHECKPOINT_FILE);
        if (file < 0)
            problem_list_add(problems, "/inputs/start/checkpoint", "is asked for, but the job %s has none yet", start->job);
    } else if (store_open_snapshot(store, start->job, (int64_t)start->snapshot, &file) != STORE_OK || file < 0) {
        problem_list_add(problems, "/inputs/start/snapshot",
                         "is %.0f, which the job %s does not have; /jobs/%s/snapshots lists them", start->snapshot, start->job,
                         start->job);
    }
    if (file >= 0) close(file);
    return file >= 0;
}

/* NaN: not known. */
static double particles_of(job_store *store, const char *job)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row =
        sql_prepare(reader, "SELECT particles FROM drum_input WHERE job=(SELECT number FROM job WHERE id=?)", "t", job);
    const double particles = row && sqlite3_step(row) == SQLITE_ROW ? sqlite3_column_double(row, 0) : NAN;
    sqlite3_finalize(row);
    store_return_reader(store, reader);
    return particles;
}

static json_t *find_bed(void *context, const start_inputs *start, double *particles, problem_list *problems)
{
    char *text = NULL;
    if (*start->file) {
        problem_list_add(problems, "/inputs/start/file", "is for `repose run` alone; give a job, or the particles");
        return NULL;
    }
    const store_status status = store_read_spec(context, start->job, &text);
    json_t *spec = status == STORE_OK ? json_loads(text, 0, NULL) : NULL;
    free(text);
    const char *process = json_string_value(json_object_get(spec, "process"));
    if (status == STORE_NOT_FOUND) problem_list_add(problems, "/inputs/start/job", "is \"%s\"; there is no such job", start->job);
    else if (!process)
        problem_list_add(problems, "/inputs/start/job", "is \"%s\", whose specification could not be read; try again", start->job);
    else if (strcmp(process, "drum") != 0)
        problem_list_add(problems, "/inputs/start/job", "is \"%s\", a %s; must be a drum", start->job, process);
    if (process && strcmp(process, "drum") == 0 && has_file(context, start, problems)) {
        *particles = particles_of(context, start->job);
        return spec;
    }
    json_decref(spec);
    return NULL;
}

static json_t *read_table(void *context, given_table kind, const char *name, const char *pointer, problem_list *problems)
{
    char *text = NULL;
    if (kind != GIVEN_BED) {
        problem_list_add(problems, pointer, "is for `repose run` alone; %s",
                         kind == GIVEN_SIEVES ? "give sizes, and cumulative or shares"
                                              : "send the table to /beds, and give its id as bed");
        return NULL;
    }
    const store_status status = store_read_bed(context, name, &text);
    json_t *list = NULL;
    if (status == STORE_OK) list = csv_read_particles(text, strlen(text), problems);
    else
        problem_list_add(problems, pointer, "is \"%.60s\"%s", name,
                         status == STORE_NOT_FOUND ? "; there is no such bed: /beds lists them"
                                                   : ", which could not be read; try again");
    free(text);
    return list;
}

start_source store_beds(job_store *store) { return (start_source){ .find = find_bed, .table = read_table, .context = store }; }
