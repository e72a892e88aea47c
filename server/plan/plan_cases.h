/* The next cases to run: requests of jobs, each with what makes it a run of this calibration. */
#ifndef PLAN_CASES_H
#define PLAN_CASES_H

#include "next_runs.h"
#include "plan_budget.h"
#include "plan_fit.h"

/* Lists of cases; new references, NULL: no memory. document: the request, whose name and label jobs are labelled with. */
json_t *plan_cases_start(const plan_request *request, const json_t *document, const plan_budget *budget);
json_t *plan_cases_refine(const plan_fit *fit, const json_t *document, size_t count);
/* sets (count,parameters) in the unit cube. with_own: also by tests that nobody asked for. */
json_t *plan_cases_verify(const plan_fit *fit, const json_t *document, const double *sets, size_t count, bool with_own);

#endif
