/* The next cases to run: requests of jobs, each with what makes it a run of this calibration. */
#ifndef PLAN_CASES_H
#define PLAN_CASES_H

#include "next_runs.h"
#include "plan_fit.h"

/* How the jobs that a calibration may take are spent. */
typedef struct plan_budget {
    size_t points;   /* of the start, each run by every fitted test */
    size_t repeated; /* of them, those that are run a second time */
    size_t explore;  /* jobs of start and refining */
    size_t sets;     /* that are verified, each by every test; 0: nothing is left for it */
} plan_budget;

plan_budget plan_budget_make(const plan_request *request);

/* Lists of cases; new references, NULL: no memory. document: the request, whose name and label jobs are labelled with. */
json_t *plan_cases_start(const plan_request *request, const json_t *document, const plan_budget *budget);
json_t *plan_cases_refine(const plan_fit *fit, const json_t *document, size_t count);
/* sets (count,parameters) in the unit cube. */
json_t *plan_cases_verify(const plan_fit *fit, const json_t *document, const double *sets, size_t count);

#endif
