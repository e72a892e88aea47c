/* How the jobs that a calibration may take are spent, and what they take. */
#ifndef PLAN_BUDGET_H
#define PLAN_BUDGET_H

#include "calibration.h"
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
    double jobs, steps, wall_seconds;
} plan_estimate;

/* machine NULL: by built-in figures. */
plan_estimate plan_estimate_make(const plan_request *request, const calibration *machine);

#endif
