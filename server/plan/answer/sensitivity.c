#include "sensitivity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "even_points.h"

enum { POINTS = 2048 };

/* x (POINTS,d): the first half of an even point in 2 d dimensions, or the second, with one parameter taken from the other half. */
static void lay_out(size_t d, uint64_t seed, bool is_second, size_t exchanged, double *x)
{
    for (size_t i = 0; i < POINTS; i++)
        for (size_t k = 0; k < d; k++) x[i * d + k] = even_point(seed, i, (unsigned)(k + (is_second != (k == exchanged) ? d : 0)));
}

static void take_range(const double *values, sensitivity *s)
{
    for (size_t i = 0; i < POINTS; i++) {
        s->lowest = fmin(s->lowest, values[i]);
        s->highest = fmax(s->highest, values[i]);
    }
}

/* a, b (POINTS) are centred. */
static void indices(const double *a, const double *b, const double *mixed, double variance, double *first, double *total)
{
    double product = 0.0, squares = 0.0;
    for (size_t i = 0; i < POINTS; i++) {
        product += b[i] * (mixed[i] - a[i]);
        squares += (a[i] - mixed[i]) * (a[i] - mixed[i]);
    }
    *first = fmin(fmax(product / POINTS / variance, 0.0), 1.0);
    *total = fmin(0.5 * squares / POINTS / variance, 1.0);
}

bool sensitivity_measure(const emulator *e, uint64_t seed, sensitivity *s)
{
    const size_t d = e->parameters;
    *s = (sensitivity){ .lowest = INFINITY, .highest = -INFINITY };
    double *x = malloc(POINTS * (d + 3) * sizeof *x);
    if (!x) return false;
    double *a = x + POINTS * d, *b = a + POINTS, *mixed = b + POINTS, middle = 0.0, variance = 0.0;
    lay_out(d, seed, false, d, x);
    bool good = emulator_predict(e, POINTS, x, a, NULL);
    lay_out(d, seed, true, d, x);
    good = good && emulator_predict(e, POINTS, x, b, NULL);
    take_range(a, s);
    take_range(b, s);
    for (size_t i = 0; i < POINTS; i++) middle += 0.5 * (a[i] + b[i]) / POINTS;
    for (size_t i = 0; i < POINTS; i++) {
        a[i] -= middle;
        b[i] -= middle;
        variance += 0.5 * (a[i] * a[i] + b[i] * b[i]) / POINTS;
    }
    s->spread = sqrt(variance);
    for (size_t k = 0; good && k < d && variance > 0.0; k++) {
        lay_out(d, seed, false, k, x);
        good = emulator_predict(e, POINTS, x, mixed, NULL);
        for (size_t i = 0; i < POINTS; i++) mixed[i] -= middle;
        indices(a, b, mixed, variance, &s->first[k], &s->total[k]);
    }
    free(x);
    return good;
}
