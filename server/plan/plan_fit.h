/* What is known after the runs so far: an emulator for each measure, and the posterior. */
#ifndef PLAN_FIT_H
#define PLAN_FIT_H

#include "emulator.h"
#include "plan_table.h"
#include "posterior.h"

/* Of the emulator's error within the posterior and the target's: below it more runs would tell nothing. */
#define PLAN_ENOUGH (1.0 / 3.0)
/* The answer draws the posterior anew, and more often, than the plan that found it enough: what is above it by a tenth then still is. */
#define PLAN_ENOUGH_SLACK 1.1

typedef struct plan_fit {
    const plan_request *request;
    const plan_table *table;
    emulator of[PLAN_MOST_MEASURES];        /* points 0: too few runs tell it */
    size_t told[PLAN_MOST_MEASURES];        /* runs that do */
    double usual_error[PLAN_MOST_MEASURES]; /* of a run of its own, root mean square; 0: none tells it */
    double error_in[PLAN_MOST_MEASURES];    /* root of the mean of the emulator's variance within the posterior */
    size_t values;                          /* fitted measures that have an emulator */
    measured_value measured[PLAN_MOST_MEASURES];
    size_t measure_of[PLAN_MOST_MEASURES]; /* (values) */
    bool is_complete;                      /* every fitted measure has an emulator */
    posterior posterior;
} plan_fit;

/* draws: of the posterior. False: no memory. Clear it either way. */
bool plan_fit_make(plan_fit *fit, const plan_request *request, const plan_table *table, size_t draws);
void plan_fit_clear(plan_fit *fit);

/* The emulators' errors are small beside those of the targets, or so by this factor. */
bool plan_fit_is_enough(const plan_fit *fit, double factor);
/* How far a run may be off the mean over beds: by its own error, or the usual one where it tells none (NaN), and by the scatter. */
double plan_fit_run_deviation(const plan_fit *fit, size_t measure, double error);
/* The standard deviation of a parameter over the draws, in its own units. */
double plan_fit_deviation(const plan_fit *fit, size_t parameter);

#endif
