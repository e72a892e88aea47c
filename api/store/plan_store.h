/* What the handlers need of a store of calibrations, beside what store.h has. A calibration's jobs are jobs as any other; its runs
 * are what the planner asked for (api/CALIBRATION.md), each with the job that is made of it. */
#ifndef PLAN_STORE_H
#define PLAN_STORE_H

#include "store.h"

enum { PLAN_STAGE_SIZE = 16 };

typedef struct plan_record {
    int64_t number; /* order of submission */
    char id[JOB_ID_SIZE], name[STUDY_NAME_SIZE], stage[PLAN_STAGE_SIZE];
    job_status status; /* accepted: nothing was planned yet; successful: there is an answer; failed: there can be none */
    int priority;
    int64_t most_jobs, runs, counts[JOB_STATUSES]; /* runs: asked for so far; counts: of these */
    double estimated_seconds;                      /* s of one worker, of all jobs at most, when it was submitted */
    double progress, eta_seconds; /* percent; s, at the pace so far, NaN: not known. Of all jobs that it may take */
    char created[JOB_TIME_SIZE], started[JOB_TIME_SIZE], finished[JOB_TIME_SIZE], updated[JOB_TIME_SIZE];
    char message[1024];
} plan_record;
typedef bool plan_visitor(void *context, const plan_record *plan);

/* What is to be kept of a new one. */
typedef struct plan_addition {
    const json_t *document; /* the request as it was posted */
    const char *name;
    int priority;
    int64_t most_jobs;
    double estimated_seconds;
} plan_addition;

store_status store_add_plan(job_store *store, const plan_addition *plan, char id[JOB_ID_SIZE]);
store_status store_find_plan(job_store *store, const char *id, plan_record *plan);
store_status store_list_plans(job_store *store, int64_t before, int64_t limit, plan_visitor *visit,
                              void *context); /* newest first */
/* Texts are for free(): the request; and what the planner said last, without cases. STORE_NOT_FOUND: no such, or it said nothing. */
store_status store_read_plan_request(job_store *store, const char *id, char **text);
store_status store_read_plan(job_store *store, const char *id, char **text);
/* [{"number", "stage", "test", "set", "parameters", "status", "results", "job"}] by their numbers, as the planner reads them, but for
 * "job", the id, which is null where the job is gone or there was none. New reference. */
store_status store_read_plan_runs(job_store *store, const char *id, json_t **runs);

/* It plans no more, and its jobs that have not ended are dismissed. STORE_CONFLICT: it has ended. */
store_status store_dismiss_plan(job_store *store, const char *id);
/* A failed or dismissed one goes on where it was; its dismissed jobs wait once more. STORE_CONFLICT: it is neither. */
store_status store_retry_plan(job_store *store, const char *id);
/* With all its jobs. STORE_CONFLICT: it has not ended. */
store_status store_delete_plan(job_store *store, const char *id);

#endif
