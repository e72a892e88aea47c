/* The runs that tell most about the posterior.
 *
 * After a run at a place, the variance of an emulator at another place falls by their covariance squared over the variance at the
 * first, noise included (Cohn 1996, Neural Networks 9, 1071; Seo et al. 2000). Chosen is the run, a test at one of the posterior's
 * draws, that takes most away from the variances at all draws, each in units of its target's, for the work that the test takes; and
 * then the next, as if the first were done. */
#ifndef NEXT_RUNS_H
#define NEXT_RUNS_H

#include "plan_fit.h"

typedef struct next_run {
    size_t test;
    double x[PLAN_MOST_PARAMETERS];
} next_run;

/* runs (count). Returns how many were found: fewer where all places have failed before, or no memory is left. */
size_t next_runs_choose(const plan_fit *fit, size_t count, next_run *runs);

#endif
