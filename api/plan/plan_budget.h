/* How the jobs that a calibration may take are spent, and what they take. */
#ifndef PLAN_BUDGET_H
#define PLAN_BUDGET_H

#include "job_spec.h"
#include "plan_request.h"

typedef struct plan_budget {
    size_t points;   /* of the start, each run by every fitted test */
    size_t repeated; /* of them, those that are run a second time */
    size_t explore;  /* jobs of start and refining */
    size_t sets;     /* that are verified, each by every test; 0: nothing is left for it */
} plan_budget;

plan_budget plan_budget_make(const plan_request *request);

/* At most; of the clock, were they run one after the other, each test with its parameters in the middle of their ranges. */
typedef struct plan_estimate {
    double jobs, steps, wall_seconds, snapshot_bytes, disk_bytes;
} plan_estimate;

/* machine NULL: by built-in figures. */
plan_estimate plan_estimate_make(const plan_request *request, const calibration *machine);
json_t *plan_estimate_to_json(const plan_estimate *estimate);

/* plan_check.c: what is unusual in the tests with their parameters in the middle of their ranges, and where a job or all of them ask
 * for more than one POST may, or take more disk than is free (NaN: not known). limits NULL: anything may be asked for. Pointers are
 * into the calibration's request. */
void plan_check(const plan_request *request, const calibration *machine, const post_limits *limits, double free_bytes,
                problem_list *problems, problem_list *warnings);

#endif
