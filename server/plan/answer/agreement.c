#include "agreement.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "even_points.h"

enum { PLACES = 2048 };
#define FARTHEST 3.0

/* The incomplete gamma function from a half or from 1 upwards (Abramowitz & Stegun 26.4.4 and 26.4.5). */
double chi_square_beyond(double chi_square, int degrees)
{
    const double half = 0.5 * chi_square;
    double order = degrees % 2 ? 0.5 : 1.0;
    double sum = degrees % 2 ? erfc(sqrt(half)) : exp(-half);
    for (; 2.0 * order < degrees - 0.5; order += 1.0) sum += half > 0.0 ? exp(order * log(half) - half - lgamma(order + 1.0)) : 0.0;
    return fmin(sum, 1.0);
}

/* Over places that fill the range, and over the draws, which lie where the posterior is pressed against an end. */
static bool find_nearest(const plan_fit *fit, size_t v, const double *x, size_t count, double *mean, agreement *a)
{
    const measured_value *measured = &fit->measured[v];
    double *variance = mean + count;
    if (!emulator_predict(measured->emulator, count, x, mean, variance)) return false;
    for (size_t i = 0; i < count; i++) {
        const double z = fabs(mean[i] - measured->value) / sqrt(measured->error * measured->error + variance[i]);
        if (!(z < a->reach[v].z)) continue;
        a->reach[v].z = z;
        a->reach[v].nearest = mean[i];
    }
    a->reach[v].is_out = a->reach[v].z > FARTHEST;
    a->is_out = a->is_out || a->reach[v].is_out;
    return true;
}

static bool measure_reach(const plan_fit *fit, agreement *a)
{
    const posterior *p = &fit->posterior;
    const size_t d = p->parameters, count = PLACES + p->draws;
    double *x = malloc(count * (d + 2) * sizeof *x);
    bool good = x != NULL;
    for (size_t i = 0; good && i < PLACES; i++)
        for (size_t k = 0; k < d; k++) x[i * d + k] = even_point(fit->request->seed, i, (unsigned)k);
    if (good) memcpy(x + PLACES * d, p->x, p->draws * d * sizeof *x);
    for (size_t v = 0; good && v < fit->values; v++) {
        a->reach[v].z = INFINITY;
        good = find_nearest(fit, v, x, count, x + count * d, a);
    }
    free(x);
    return good;
}

bool agreement_measure(const plan_fit *fit, agreement *a)
{
    *a = (agreement){ .degrees = (int)fit->values - (int)fit->request->parameters };
    if (a->degrees < 1) a->degrees = 1;
    for (size_t v = 0; v < fit->values; v++) {
        double mean, variance;
        if (!emulator_predict(fit->measured[v].emulator, 1, fit->posterior.best, &mean, &variance)) return false;
        a->chi_square += pow(mean - fit->measured[v].value, 2.0) / (pow(fit->measured[v].error, 2.0) + variance);
    }
    a->probability = chi_square_beyond(a->chi_square, a->degrees);
    a->is_contradicted = a->probability < LEAST_PROBABILITY;
    return measure_reach(fit, a);
}
