#include "statistics.h"

#include "array.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

double statistics_mean(const double *x, size_t count)
{
    double sum = 0.0;
    size_t n = 0;
    for (size_t k = 0; k < count; k++)
        if (!isnan(x[k])) {
            sum += x[k];
            n++;
        }
    return n ? sum / (double)n : NAN;
}

static double squares_about(const double *x, size_t count, double mean, size_t *n)
{
    double sum = 0.0;
    *n = 0;
    for (size_t k = 0; k < count; k++)
        if (!isnan(x[k])) {
            sum += (x[k] - mean) * (x[k] - mean);
            ++*n;
        }
    return sum;
}

double statistics_deviation(const double *x, size_t count)
{
    size_t n;
    const double sum = squares_about(x, count, statistics_mean(x, count), &n);
    return n > 1 ? sqrt(sum / (double)(n - 1)) : NAN;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double statistics_median(double *x, size_t count)
{
    size_t n = 0;
    for (size_t k = 0; k < count; k++)
        if (!isnan(x[k])) x[n++] = x[k];
    if (n == 0) return NAN;
    qsort(x, n, sizeof *x, ascending);
    return n % 2 ? x[n / 2] : 0.5 * (x[n / 2 - 1] + x[n / 2]);
}

/* Pairs of neighbors are averaged until no more than this many values are left: it changes nothing of the mean's error, and
 * the sums below stay short however long the series. */
enum { LEAST_VALUES = 8, MOST_VALUES = 4096 };

static size_t average_pairs(double *x, size_t count)
{
    for (size_t k = 0; k < count / 2; k++) x[k] = statistics_mean(x + 2 * k, 2);
    if (count % 2) x[count / 2] = x[count - 1];
    return count / 2 + count % 2;
}

/* Covariance of x, about its mean, with itself `lag` later. */
static double autocovariance(const double *x, size_t count, double mean, size_t lag)
{
    double sum = 0.0, n = 0.0;
    for (size_t k = 0; k + lag < count; k++)
        if (!isnan(x[k]) && !isnan(x[k + lag])) {
            sum += (x[k] - mean) * (x[k + lag] - mean);
            n += 1;
        }
    return n > 0 ? sum / n : 0.0;
}

/* Wolff's window: where the lags that are left out matter as little as the noise of those taken in. tau: so far, in values;
 * 1.5 is the ratio of exponential to integrated time that he takes for safe. */
static bool is_window(double tau, size_t lag, double n)
{
    const double w = (double)lag, decay = tau > 0.5 ? 1.5 / log((2 * tau + 1) / (2 * tau - 1)) : 1e-9;
    return exp(-w / decay) < decay / sqrt(w * n);
}

/* Share of a series that the lags taken in may cover, so that the correction below stays finite. */
static const double MOST_SHARE = 0.75;

/* Variance of the mean of the n values that are there, from Wolff's window or from one of `memory` lags, whichever gives more. */
static double variance_of_mean(const double *x, size_t count, double n, size_t memory)
{
    const double mean = statistics_mean(x, count), naive = autocovariance(x, count, mean, 0);
    if (!(naive > 0)) return 0.0;
    /* A series that swings back is not credited with it: no less than independent values. */
    double sum = naive, terms = 1, largest = naive * n / (n - 1);
    bool is_over = false;
    for (size_t lag = 1; lag < count / 2 && (!is_over || lag <= memory); lag++) {
        sum += 2 * autocovariance(x, count, mean, lag);
        terms += 2;
        const bool ends = !is_over && (is_window(0.5 * sum / naive, lag, n) || lag + 1 >= count / 2);
        /* Each covariance was taken about the mean of the series rather than the true one, which makes it too small by the
         * variance of that mean, and their sum by the share terms / n. */
        if (ends || lag == memory) largest = fmax(largest, sum / (1 - fmin(terms / n, MOST_SHARE)));
        is_over = is_over || ends;
    }
    return largest / n;
}

double statistics_standard_error_of_memory(const double *x, size_t count, size_t memory)
{
    size_t n = 0;
    for (size_t k = 0; k < count; k++) n += !isnan(x[k]);
    if (n < LEAST_VALUES) return NAN;
    double *values = array_create(count, sizeof *values);
    if (!values) return NAN;
    memcpy(values, x, count * sizeof *values);
    while (count > MOST_VALUES) {
        count = average_pairs(values, count);
        memory /= 2;
    }
    n = 0;
    for (size_t k = 0; k < count; k++) n += !isnan(values[k]);
    const size_t most = count / 4; /* lags that a series can tell of */
    const double variance = variance_of_mean(values, count, (double)n, memory < most ? memory : most);
    free(values);
    return sqrt(variance);
}

double statistics_standard_error(const double *x, size_t count) { return statistics_standard_error_of_memory(x, count, 0); }

double statistics_correlation_length(const double *x, size_t count, size_t memory)
{
    const double deviation = statistics_deviation(x, count), error = statistics_standard_error_of_memory(x, count, memory);
    size_t n = 0;
    for (size_t k = 0; k < count; k++) n += !isnan(x[k]);
    return deviation > 0 ? (double)n * (error / deviation) * (error / deviation) : 1.0;
}

size_t statistics_transient(const double *x, size_t count)
{
    enum { BATCH = 5 };
    const size_t batches = count / BATCH;
    size_t best_cut = 0;
    double best = INFINITY;
    for (size_t cut = 0; 2 * cut <= batches; cut++) {
        const size_t start = cut * BATCH;
        size_t n;
        const double mean = statistics_mean(x + start, count - start);
        const double squares = squares_about(x + start, count - start, mean, &n);
        const double marginal = n > 0 ? squares / ((double)n * (double)n) : INFINITY;
        if (marginal < best) {
            best = marginal;
            best_cut = start;
        }
    }
    return best_cut;
}

line_fit statistics_line(const double *x, const double *y, size_t count, double correlation)
{
    double n = 0, sx = 0, sy = 0;
    for (size_t k = 0; k < count; k++)
        if (!isnan(x[k]) && !isnan(y[k])) {
            n += 1;
            sx += x[k];
            sy += y[k];
        }
    line_fit fit = { NAN, NAN, NAN, (size_t)n };
    if (n < 2) return fit;
    const double mx = sx / n, my = sy / n;
    double xx = 0, xy = 0, residual2 = 0;
    for (size_t k = 0; k < count; k++)
        if (!isnan(x[k]) && !isnan(y[k])) {
            xx += (x[k] - mx) * (x[k] - mx);
            xy += (x[k] - mx) * (y[k] - my);
        }
    if (!(xx > 0)) return fit;
    fit.slope = xy / xx;
    fit.intercept = my - fit.slope * mx;
    for (size_t k = 0; k < count; k++)
        if (!isnan(x[k]) && !isnan(y[k])) {
            const double r = y[k] - fit.intercept - fit.slope * x[k];
            residual2 += r * r;
        }
    if (n > 2) fit.slope_error = sqrt(residual2 / (n - 2) / xx * fmax(correlation, 1.0));
    return fit;
}

trend statistics_trend(const double *x, const double *y, size_t count, size_t memory, double *residual)
{
    const line_fit plain = statistics_line(x, y, count, 1.0);
    for (size_t k = 0; k < count; k++) residual[k] = y[k] - plain.intercept - plain.slope * x[k];
    const double correlation = statistics_correlation_length(residual, count, memory);
    return (trend){ statistics_line(x, y, count, correlation), correlation, statistics_deviation(residual, count) };
}

/* Fisher's expansion about the normal deviate: 0.02 low at 3 degrees of freedom, by less above. */
double statistics_student_95(double freedom)
{
    const double z = 1.959964, z2 = z * z, n = freedom;
    return z
           * (1 + (z2 + 1) / (4 * n) + ((5 * z2 + 16) * z2 + 3) / (96 * n * n)
              + (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n));
}

double statistics_theil_sen(const double *x, const double *y, size_t count)
{
    if (count < 2) return NAN;
    double *slopes = array_create(count * (count - 1) / 2, sizeof *slopes);
    if (!slopes) return NAN;
    size_t n = 0;
    for (size_t a = 0; a < count; a++)
        for (size_t b = a + 1; b < count; b++)
            if (x[a] != x[b]) slopes[n++] = (y[b] - y[a]) / (x[b] - x[a]);
    const double median = statistics_median(slopes, n);
    free(slopes);
    return median;
}
