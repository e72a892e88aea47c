#include "collect.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "database.h"
#include "event_tail.h"
#include "job_folder.h"
#include "job_store.h"
#include "log.h"
#include "study_results.h"
#include "text_copy.h"

enum { MOST_JOBS = 1000000, LARGEST_CSV = 256 << 20, LONGEST_PATH = 4200 };

/* Jobs of this folder have the names of their folders, and count as running until it is seen what they left. */
static store_status name_jobs(job_store *store, int repeats)
{
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = sql_run(store->writer, NULL,
                     "UPDATE job SET id=printf('" JOB_NUMBERED_SQL
                     "', study_case*?+study_repeat+1), status='running', message='started'",
                     "i", (int64_t)repeats);
    return store_end(store, status);
}

/* What its worker said of why it failed; NULL: nothing. New reference. */
static json_t *failure_of(const job_store *store, const job_claim *claim)
{
    const int file = job_file_open(store->data, claim->id, NULL, JOB_EVENTS_FILE);
    json_t *failure = NULL;
    bool more = file >= 0;
    for (int64_t at = 0; more;) {
        event_batch batch;
        if (!event_tail_read(file, at, &batch)) break;
        if (batch.any) {
            json_decref(failure);
            failure = json_incref(batch.failure);
        }
        at = batch.end;
        more = batch.more;
        event_batch_clear(&batch);
    }
    if (file >= 0) close(file);
    return failure;
}

/* One without a result: it failed, or is to be run (again). */
static bool settle(void *context, const job_claim *claim, const char *name)
{
    job_store *store = context;
    json_t *failure = failure_of(store, claim);
    const char *said = json_string_value(json_object_get(failure, "message"));
    char message[1000];
    (void)name;
    text_copy(message, sizeof message, said ? said : "");
    const store_status status = failure ? store_record_failure(store, claim, message, failure)
                                        : store_put_back(store, claim, false, "it has no results yet");
    json_decref(failure);
    return status == STORE_OK;
}

static bool write_csv(job_store *store, const char *id, const char *path)
{
    study_table table;
    study_summing summing;
    text_buffer out;
    text_buffer_init(&out, LARGEST_CSV);
    bool good = study_table_init(&table) && store_list_study_cases(store, id, study_table_add_case, &table) == STORE_OK;
    if (good) {
        study_summing_init(&summing, &table);
        good = store_list_study_runs(store, id, study_summing_add_run, &summing) == STORE_OK;
        study_summing_end(&summing);
    }
    if (good && !table.failed) study_table_write_csv(&table, &out);
    FILE *file = good && !table.failed && !out.failed ? fopen(path, "we") : NULL;
    good = file && fwrite(out.text, 1, out.length, file) == out.length;
    if (file) good = fclose(file) == 0 && good;
    if (!good) log_line("%s can't be written: %s", path, strerror(errno));
    text_buffer_clear(&out);
    study_table_clear(&table);
    return good;
}

static bool add_study(job_store *store, const json_t *document, char id[JOB_ID_SIZE], int *repeats)
{
    const study_options options = { .default_threads = 1, .most_jobs = MOST_JOBS };
    calibration machine;
    problem_list problems;
    study_spec study;
    study_estimate estimate;
    if (!problem_list_init(&problems)) return false;
    store_read_calibration(store, &machine);
    study_spec_parse(document, &options, &study, &problems);
    study_stage *stage = store_stage_study(store, &study, &machine);
    const study_taker taker = store_stage_taker(stage);
    const bool good = stage && study_check(&study, &machine, &taker, &estimate, &problems, NULL)
                      && store_add_study(store, stage, &study, &estimate, id) == STORE_OK;
    if (!good) log_line("study.json is not a study as `repose split` has written it, or can't be kept");
    *repeats = study.repeats;
    if (stage) store_drop_stage(stage);
    study_spec_clear(&study);
    problem_list_clear(&problems);
    return good;
}

static bool collect_into(job_store *store, const json_t *document, const char *csv)
{
    char id[JOB_ID_SIZE];
    int repeats;
    int64_t counts[JOB_STATUSES];
    if (!add_study(store, document, id, &repeats) || name_jobs(store, repeats) != STORE_OK) return false;
    if (store_recover(store, NULL, settle, store) != STORE_OK || !write_csv(store, id, csv)) return false;
    if (store_count_jobs(store, counts) != STORE_OK) return false;
    const int64_t jobs = counts[JOB_SUCCESSFUL] + counts[JOB_FAILED] + counts[JOB_ACCEPTED];
    printf("%lld of %lld jobs have results, %lld failed: %s and reposed.sqlite beside it\n", (long long)counts[JOB_SUCCESSFUL],
           (long long)jobs, (long long)counts[JOB_FAILED], csv);
    return true;
}

static void remove_earlier(const data_folder *data)
{
    static const char *const ends[] = { "", "-wal", "-shm" };
    char path[LONGEST_PATH];
    for (size_t e = 0; e < sizeof ends / sizeof ends[0]; e++) {
        snprintf(path, sizeof path, "%s/reposed.sqlite%s", data->path, ends[e]);
        unlink(path);
    }
}

bool collect_study(const char *folder)
{
    char path[LONGEST_PATH];
    data_folder data;
    json_error_t error;
    snprintf(path, sizeof path, "%s/study.json", folder);
    json_t *document = json_load_file(path, 0, &error);
    if (!document) log_line("%s can't be read: %s", path, error.text);
    /* A service's folder has no study.json, so nobody's database is removed. */
    if (!document || !data_folder_open_beside_workers(&data, folder)) {
        json_decref(document);
        return false;
    }
    remove_earlier(&data);
    snprintf(path, sizeof path, "%s/results.csv", data.path);
    job_store *store = store_open(&data, MOST_JOBS);
    const bool good = store && collect_into(store, document, path);
    if (store) store_close(store);
    data_folder_close(&data);
    json_decref(document);
    return good;
}
