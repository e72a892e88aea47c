#include "emulator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear_algebra.h"
#include "simplex.h"

/* Variance of the plane's coefficients: ten times the spread of the values is as good as any. */
#define PLANE_VARIANCE 100.0
/* Keeps the factor from failing where runs say the same without noise. */
#define JITTER 1e-8
enum { MOST_EVALUATIONS = 300 };

/* Of the logarithms of length, variance, scatter and the factor of own variances: where the weak priors are centred, and how wide they are. */
static const double length_prior[2] = { -0.22, 1.0 }, variance_prior[2] = { -0.7, 2.0 }, scatter_prior[2] = { -5.0, 3.0 },
                    own_prior[2] = { 0.0, 1.0 };

static double covariance_of(const emulator *e, const double *a, const double *b)
{
    double squared = 0.0, plane = 1.0;
    for (size_t k = 0; k < e->parameters; k++) {
        const double apart = (a[k] - b[k]) / e->length[k];
        squared += apart * apart;
        plane += (2.0 * a[k] - 1.0) * (2.0 * b[k] - 1.0);
    }
    const double r = sqrt(5.0 * squared);
    return e->variance * (1.0 + r + r * r / 3.0) * exp(-r) + PLANE_VARIANCE * plane;
}

/* The factor of the runs' covariance and their weights. */
static bool factor(emulator *e)
{
    const size_t n = e->points;
    for (size_t j = 0; j < n; j++) {
        for (size_t i = j; i < n; i++) e->factor[j * n + i] = covariance_of(e, &e->x[i * e->parameters], &e->x[j * e->parameters]);
        e->factor[j * n + j] += e->own * e->noise[j] + e->scatter + JITTER;
    }
    if (!cholesky_factor(n, e->factor)) return false;
    memcpy(e->weight, e->y, n * sizeof *e->weight);
    cholesky_solve(n, e->factor, 1, e->weight);
    return true;
}

static void take_logarithms(emulator *e, const double *x)
{
    for (size_t k = 0; k < e->parameters; k++) e->length[k] = exp(x[k]);
    e->variance = exp(x[e->parameters]);
    e->scatter = exp(x[e->parameters + 1]);
    e->own = exp(x[e->parameters + 2]);
}

static double penalty(double x, const double prior[2]) { return 0.5 * (x - prior[0]) * (x - prior[0]) / (prior[1] * prior[1]); }

/* Less the logarithm of the likelihood (Rasmussen & Williams, eqn 2.30) and of the priors. */
static double misfit(void *context, const double *x)
{
    emulator *e = context;
    double sum = penalty(x[e->parameters], variance_prior) + penalty(x[e->parameters + 1], scatter_prior)
                 + penalty(x[e->parameters + 2], own_prior);
    for (size_t k = 0; k < e->parameters; k++) sum += penalty(x[k], length_prior);
    if (!(sum < 500.0)) return INFINITY;
    take_logarithms(e, x);
    if (!factor(e)) return INFINITY;
    for (size_t i = 0; i < e->points; i++) sum += log(e->factor[i * e->points + i]) + 0.5 * e->y[i] * e->weight[i];
    return sum;
}

/* From two beginnings: values that vary with the parameters, and values that scatter. */
static bool fit_likeliest(emulator *e)
{
    double best[SIMPLEX_MOST_DIMENSIONS] = { 0.0 }, least = INFINITY;
    for (int beginning = 0; beginning < 2; beginning++) {
        double x[SIMPLEX_MOST_DIMENSIONS];
        for (size_t k = 0; k < e->parameters; k++) x[k] = beginning ? 0.7 : -0.5;
        x[e->parameters] = beginning ? -2.0 : 0.0;
        x[e->parameters + 1] = beginning ? -1.5 : -6.0;
        x[e->parameters + 2] = 0.0;
        const double value = simplex_minimize(misfit, e, e->parameters + 3, x, 0.8, 1e-4, MOST_EVALUATIONS);
        if (value < least) memcpy(best, x, sizeof best);
        least = fmin(least, value);
    }
    take_logarithms(e, best);
    return isfinite(least) && factor(e);
}

static bool allocate(emulator *e)
{
    e->x = calloc(e->points * e->parameters, sizeof *e->x);
    e->noise = calloc(e->points, sizeof *e->noise);
    e->y = calloc(e->points, sizeof *e->y);
    e->factor = calloc(e->points * e->points, sizeof *e->factor);
    e->weight = calloc(e->points, sizeof *e->weight);
    return e->x && e->noise && e->y && e->factor && e->weight;
}

bool emulator_fit(emulator *e, size_t parameters, size_t points, const double *x, const double *y, const double *error)
{
    *e = (emulator){ .parameters = parameters, .points = points, .spread = 1.0 };
    if (points < EMULATOR_LEAST_POINTS || !allocate(e)) {
        emulator_clear(e);
        return false;
    }
    memcpy(e->x, x, points * parameters * sizeof *x);
    double squares = 0.0, errors = 0.0;
    for (size_t i = 0; i < points; i++) e->middle += y[i] / (double)points;
    for (size_t i = 0; i < points; i++) squares += (y[i] - e->middle) * (y[i] - e->middle) / (double)points;
    for (size_t i = 0; i < points; i++) errors += error[i] * error[i] / (double)points;
    /* Values that are all the same have no spread of their own, but what their errors say. */
    const double floor = 1e-9 * fmax(fabs(e->middle), 1e-300);
    e->spread = fmax(sqrt(fmax(squares, errors)), floor);
    for (size_t i = 0; i < points; i++) {
        e->y[i] = (y[i] - e->middle) / e->spread;
        e->noise[i] = error[i] * error[i] / (e->spread * e->spread);
    }
    if (fit_likeliest(e)) return true;
    emulator_clear(e);
    return false;
}

void emulator_clear(emulator *e)
{
    free(e->x);
    free(e->noise);
    free(e->y);
    free(e->factor);
    free(e->weight);
    *e = (emulator){ .points = 0 };
}

double emulator_scatter(const emulator *e) { return sqrt(e->scatter) * e->spread; }

double emulator_run_deviation(const emulator *e, double error) { return hypot(sqrt(e->own) * error, emulator_scatter(e)); }

/* (points,count): covariance of each run with each place. To be freed; NULL: no memory. */
static double *covariance_with_runs(const emulator *e, size_t count, const double *x)
{
    double *covariance = malloc(e->points * count * sizeof *covariance);
    for (size_t c = 0; covariance && c < count; c++)
        for (size_t i = 0; i < e->points; i++)
            covariance[c * e->points + i] = covariance_of(e, &e->x[i * e->parameters], &x[c * e->parameters]);
    return covariance;
}

bool emulator_predict(const emulator *e, size_t count, const double *x, double *mean, double *variance)
{
    double *with_runs = covariance_with_runs(e, count, x);
    if (!with_runs) return false;
    for (size_t c = 0; c < count; c++) {
        double sum = 0.0;
        for (size_t i = 0; i < e->points; i++) sum += with_runs[c * e->points + i] * e->weight[i];
        mean[c] = e->middle + e->spread * sum;
    }
    if (variance) triangle_solve(e->points, e->factor, count, with_runs);
    for (size_t c = 0; variance && c < count; c++) {
        const double *known = &with_runs[c * e->points], *place = &x[c * e->parameters];
        double left = covariance_of(e, place, place);
        for (size_t i = 0; i < e->points; i++) left -= known[i] * known[i];
        variance[c] = fmax(left, 0.0) * e->spread * e->spread;
    }
    free(with_runs);
    return true;
}

bool emulator_covariance(const emulator *e, size_t count, const double *x, double *covariance)
{
    double *known = covariance_with_runs(e, count, x);
    if (!known) return false;
    triangle_solve(e->points, e->factor, count, known);
    for (size_t a = 0; a < count; a++)
        for (size_t b = 0; b <= a; b++) {
            double left = covariance_of(e, &x[a * e->parameters], &x[b * e->parameters]);
            for (size_t i = 0; i < e->points; i++) left -= known[a * e->points + i] * known[b * e->points + i];
            covariance[a * count + b] = covariance[b * count + a] = left * e->spread * e->spread;
        }
    free(known);
    return true;
}

bool emulator_leave_one_out(const emulator *e, double *deviation)
{
    const size_t n = e->points;
    double *inverse = malloc(n * n * sizeof *inverse);
    if (inverse) memcpy(inverse, e->factor, n * n * sizeof *inverse);
    const bool known = inverse && cholesky_invert(n, inverse);
    /* Left out: y - mean is weight / inverse_ii, with variance 1 / inverse_ii. */
    for (size_t i = 0; known && i < n; i++) deviation[i] = e->weight[i] / sqrt(inverse[i * n + i]);
    free(inverse);
    return known;
}
