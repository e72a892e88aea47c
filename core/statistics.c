#include "statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST_BLOCKS = 8 };

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

/* Standard error of the mean from blocks of `length` samples; a tail shorter than a block is left out. */
static double block_error(const double *x, size_t count, size_t length, size_t *blocks)
{
    double sum = 0.0, squares = 0.0;
    size_t n = 0;
    for (size_t start = 0; start + length <= count; start += length) {
        const double mean = statistics_mean(x + start, length);
        if (isnan(mean)) continue;
        sum += mean;
        squares += mean * mean;
        n++;
    }
    *blocks = n;
    if (n < 2) return NAN;
    const double variance = (squares - sum * sum / (double)n) / (double)(n - 1);
    return sqrt(fmax(variance, 0.0) / (double)n);
}

double statistics_standard_error(const double *x, size_t count)
{
    double largest = NAN;
    for (size_t length = 1; length <= count / LEAST_BLOCKS; length *= 2) {
        size_t blocks;
        const double error = block_error(x, count, length, &blocks);
        if (blocks >= LEAST_BLOCKS) largest = fmax(largest, error);
    }
    return largest;
}

double statistics_correlation_length(const double *x, size_t count)
{
    size_t blocks;
    const double naive = block_error(x, count, 1, &blocks), error = statistics_standard_error(x, count);
    return naive > 0 ? (error / naive) * (error / naive) : 1.0;
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

double statistics_theil_sen(const double *x, const double *y, size_t count)
{
    if (count < 2) return NAN;
    double *slopes = malloc(count * (count - 1) / 2 * sizeof *slopes);
    if (!slopes) return NAN;
    size_t n = 0;
    for (size_t a = 0; a < count; a++)
        for (size_t b = a + 1; b < count; b++)
            if (x[a] != x[b]) slopes[n++] = (y[b] - y[a]) / (x[b] - x[a]);
    const double median = statistics_median(slopes, n);
    free(slopes);
    return median;
}
