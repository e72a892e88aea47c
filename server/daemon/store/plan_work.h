/* What the planner's thread asks of the store: which calibration is to be planned, and what came of it. */
#ifndef PLAN_WORK_H
#define PLAN_WORK_H

#include "job_store.h"

/* One that is to be planned: none of its jobs waits or runs. */
typedef struct plan_claim {
    int64_t number, workers, runs; /* runs: asked for so far; what is planned counts as long as it is as many */
    int setbacks;
    char id[JOB_ID_SIZE];
} plan_claim;

/* STORE_NOT_FOUND: none is. *put_off: some would be, but is put off. */
store_status store_next_plan(job_store *store, plan_claim *claim, bool *put_off);
/* Keeps what the planner said, and adds a job for each of its cases, all in one commit. A case that can't be a job is a run that has
 * failed. STORE_CONFLICT: the claim does not hold any more, and nothing was kept. */
store_status store_take_plan(job_store *store, const plan_claim *claim, const json_t *plan, int default_threads);
/* Later again: 1, 2, 4 s and so on up to a minute. message: why. */
store_status store_put_off_plan(job_store *store, const plan_claim *claim, const char *message);
store_status store_fail_plan(job_store *store, const plan_claim *claim, const char *message);

#endif
