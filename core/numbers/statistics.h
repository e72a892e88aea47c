/* Statistics of correlated series. NaNs are skipped everywhere. */
#ifndef STATISTICS_H
#define STATISTICS_H

#include <stddef.h>

double statistics_mean(const double *x, size_t count);
double statistics_deviation(const double *x, size_t count); /* standard deviation, n - 1 */
double statistics_median(double *x, size_t count);          /* reorders x */

/* Standard error of the mean of a correlated series, from the sum of its autocovariances over a window that the series
 * chooses itself (Wolff 2004, Eqns 31 and 52). Within 5 % of the truth for series of ten correlation lengths or more,
 * too small for shorter ones (0.86 of it at five). NaN for fewer than 8 values. */
double statistics_standard_error(const double *x, size_t count);

/* The same of a series whose values are known to come back, weaker, within `memory` values: it may pass through zero before
 * that, where the window would end. The autocovariances up to there are summed, too (over no more than a quarter of the series),
 * and the larger error counts. */
double statistics_standard_error_of_memory(const double *x, size_t count, size_t memory);

/* How many values of the series tell as much of the mean as one independent value: n (SE / deviation)^2; about 1 when
 * uncorrelated. memory: as above, 0 where none is known. */
double statistics_correlation_length(const double *x, size_t count, size_t memory);

/* Where the initial transient of a series ends: the cut that minimises the marginal standard error of what
 * remains, in batches of five (MSER-5, White 1997), at most half of the series. */
size_t statistics_transient(const double *x, size_t count);

/* Least-squares line y = intercept + slope x. slope_error: from the residuals, widened for their correlation
 * over `correlation` samples. Returns the number of points used; below 2 the slope is NaN. */
typedef struct line_fit {
    double intercept, slope, slope_error;
    size_t points;
} line_fit;
line_fit statistics_line(const double *x, const double *y, size_t count, double correlation);

/* The line, its error widened by the correlation of what is left of y about it, and what is left. residual: (count). */
typedef struct trend {
    line_fit line;
    double correlation; /* length, in values, of the residuals */
    double deviation;   /* of the residuals */
} trend;
trend statistics_trend(const double *x, const double *y, size_t count, size_t memory, double *residual);

/* Student's t that 95 of 100 values stay within on either side, of 3 degrees of freedom or more. */
double statistics_student_95(double freedom);

/* Median of the slopes of all pairs (Theil 1950, Sen 1968); NaN for fewer than 2 points or out of memory. */
double statistics_theil_sen(const double *x, const double *y, size_t count);

#endif
