/* When to measure and when to write a snapshot, in whole steps since rotation began: a restart, and any way of
 * dividing a run into calls, meets the same steps. */
#ifndef SCHEDULE_H
#define SCHEDULE_H

#include <stdint.h>

#include "job_spec.h"

typedef struct schedule {
    double steps_per_sample, steps_per_snapshot; /* not whole; the latter 0: only the last snapshot */
    int64_t rotation_steps;                      /* of the whole run */
    int64_t samples, snapshots;                  /* in all */
} schedule;

schedule schedule_of(const job_spec *spec);

/* The run ends at this step instead, after so many samples. */
void schedule_end_at(schedule *plan, int64_t step, int64_t samples);

int64_t schedule_sample_step(const schedule *plan, int64_t number);
int64_t schedule_snapshot_step(const schedule *plan, int64_t number); /* the last one at the end */

#endif
