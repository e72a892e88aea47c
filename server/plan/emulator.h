/* An emulator: what a test would tell at parameters where it was not run, with its error.
 *
 * A Gaussian process (Rasmussen & Williams 2006, chapters 2, 4 and 5) over the unit cube, Matern's covariance of order 5/2 with a
 * length for each parameter, about a plane whose coefficients are free (section 2.7, with a wide prior in place of its limit). The
 * noise of a run is its own standard error, times one factor for all runs, since a short run tells its error roughly and rather too
 * large, and the scatter from bed to bed, which is one number for all runs. Lengths, variance, factor and scatter are those of the greatest likelihood, which weak priors keep from running away where few runs say little. */
#ifndef EMULATOR_H
#define EMULATOR_H

#include <stdbool.h>
#include <stddef.h>

enum { EMULATOR_MOST_PARAMETERS = 4, EMULATOR_LEAST_POINTS = 2 };

typedef struct emulator {
    size_t parameters, points;
    double *x;                               /* (points,parameters) of the runs, owned, as all below */
    double *noise;                           /* (points) variance of each run's own error, over spread^2 */
    double *y;                               /* (points) values, less the middle, over the spread */
    double *factor;                          /* (points,points) Cholesky factor of their covariance */
    double *weight;                          /* (points) that covariance's inverse times y */
    double middle, spread;                   /* of the values */
    double length[EMULATOR_MOST_PARAMETERS]; /* of the cube's edges */
    double variance, scatter;                /* of the process, and from bed to bed: variances over spread^2 */
    double own;                              /* what the runs' own variances are multiplied by */
} emulator;

/* x (points,parameters) in [0, 1], y (points), error (points) standard errors, 0 where a run tells none. False: too few points, no
 * memory, or no covariance that can be factored; the emulator is empty then. Clear it either way. */
bool emulator_fit(emulator *emulator, size_t parameters, size_t points, const double *x, const double *y, const double *error);
void emulator_clear(emulator *emulator);

/* x (count,parameters); mean (count); variance (count) of the mean over beds, without noise, or NULL. False: no memory. */
bool emulator_predict(const emulator *emulator, size_t count, const double *x, double *mean, double *variance);
/* covariance (count,count) of those means, in full. */
bool emulator_covariance(const emulator *emulator, size_t count, const double *x, double *covariance);
/* The standard deviation from bed to bed, in the units of the values. */
double emulator_scatter(const emulator *emulator);
/* The standard deviation of a run that tells this standard error of its own about the mean over beds. */
double emulator_run_deviation(const emulator *emulator, double error);
/* Each run foretold by all others (Rasmussen & Williams, eqns 5.12): in units of the error foretold, its noise included. */
bool emulator_leave_one_out(const emulator *emulator, double *deviation);

#endif
