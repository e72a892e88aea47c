#include "schedule.h"

#include <math.h>

static int64_t step_of(double steps_between, int64_t number) { return llround((double)number * steps_between); }

/* How many of 0, 1, 2, ... fall at or before the end (or strictly before it). */
static int64_t count_until(double steps_between, int64_t end, int strictly_before)
{
    int64_t count = (int64_t)((double)end / steps_between);
    while (count > 0 && step_of(steps_between, count - 1) > end - strictly_before) count--;
    while (step_of(steps_between, count) <= end - strictly_before) count++;
    return count;
}

schedule schedule_of(const job_spec *spec)
{
    const double dt = spec->scene.time_step;
    schedule plan = {
        .steps_per_sample = spec->sample_interval / dt,
        .steps_per_snapshot = spec->snapshot_interval / dt,
    };
    const int64_t steps = llround(spec->duration / dt);
    schedule_end_at(&plan, steps, count_until(plan.steps_per_sample, steps, 0));
    return plan;
}

int64_t schedule_sample_step(const schedule *plan, int64_t number) { return step_of(plan->steps_per_sample, number); }

int64_t schedule_snapshot_step(const schedule *plan, int64_t number)
{
    return number + 1 >= plan->snapshots ? plan->rotation_steps : step_of(plan->steps_per_snapshot, number);
}

void schedule_end_at(schedule *plan, int64_t step, int64_t samples)
{
    plan->rotation_steps = step;
    plan->samples = samples;
    plan->snapshots = 1;
    if (plan->steps_per_snapshot > 0.0) plan->snapshots += count_until(plan->steps_per_snapshot, step, 1);
}
