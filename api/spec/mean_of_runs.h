/* One number of several runs of the same case: the mean, and the standard error of that mean.
 *
 * Two estimates of the error stand beside each other. The scatter of n runs, s/sqrt(n) with s^2 = sum (x - mean)^2/(n - 1),
 * knows everything that differs between runs, but of few runs it may be tiny by chance: it is widened by Student's t for
 * n - 1 degrees of freedom, so that the mean lies within one standard error as often (68.27 %) as for many runs
 * (JCGM 100:2008, table G.2). The runs' own errors, from block averages in time, know nothing of what differs between
 * runs, but tell how far runs must scatter at least. Of repeats the larger of the two is taken, and error_from says which.
 *
 * Of beds that run side by side until their mean is known well enough, the larger would be 1.7 times the true error for two
 * beds, and they would run three times as long. There the runs' own errors are taken, unless the scatter contradicts them
 * (Birge 1932, Phys. Rev. 40, 207): where sum (x - mean)^2 over the mean square of these errors is more than chi-square with
 * n - 1 degrees of freedom exceeds in one of twenty cases, or where a bed has no error of its own, it is the larger of the two, as above. */
#ifndef MEAN_OF_RUNS_H
#define MEAN_OF_RUNS_H

#include <jansson.h>

typedef struct mean_of_runs {
    int64_t count;
    double mean, squares;     /* squares: sum of (x - mean)^2 */
    int64_t errors;           /* runs with an error of their own, */
    double squares_of_errors; /* and the sum of its squares */
} mean_of_runs;

/* A struct of zeros has no runs. run_error: of this run alone; NaN: it has none. */
void mean_of_runs_add(mean_of_runs *mean, double value, double run_error);

/* {"mean", "standard_error", "error_from", "count"}. Two digits of the error, and the mean as far as these reach; an error
 * of 0 or none leaves the mean as it is. New reference. */
json_t *mean_of_runs_to_json(const mean_of_runs *mean);

/* Standard error of the mean of beds, by the second rule; NaN: nobody can know. */
double mean_of_beds_error(const mean_of_runs *mean);

/* Factor on the standard error that two-sided 68.27 % of Student's distribution asks for. degrees: of freedom, 1 or more. */
double student_factor(int64_t degrees);

#endif
