#include "posterior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "even_points.h"
#include "simplex.h"

enum { SWEEPS = 6, LAST_SWEEPS = 10, MOST_STAGES = 100 };

bool posterior_likelihood(const measured_value *measured, size_t values, size_t parameters, size_t count, const double *x,
                          double *likelihood)
{
    (void)parameters;
    double *mean = malloc(2 * count * sizeof *mean), *variance = mean ? mean + count : NULL;
    bool good = mean != NULL;
    memset(likelihood, 0, count * sizeof *likelihood);
    for (size_t v = 0; good && v < values; v++) {
        good = emulator_predict(measured[v].emulator, count, x, mean, variance);
        const double own = measured[v].error * measured[v].error;
        for (size_t c = 0; good && c < count; c++) {
            const double all = own + variance[c], apart = measured[v].value - mean[c];
            likelihood[c] -= 0.5 * (apart * apart / all + log(all / own));
        }
    }
    free(mean);
    return good;
}

/* The draws on their way, and room for those that are tried. */
typedef struct tempering {
    const measured_value *measured;
    size_t values, parameters, draws;
    double *x, *likelihood, *tried, *tried_likelihood, *others;
    double power;
    random_source dice;
} tempering;

/* Effective number of draws when the power grows by so much. */
static double draws_in_effect(const tempering *t, double more)
{
    double largest = -INFINITY, sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < t->draws; i++) largest = fmax(largest, t->likelihood[i]);
    for (size_t i = 0; i < t->draws; i++) {
        const double weight = exp(more * (t->likelihood[i] - largest));
        sum += weight;
        squares += weight * weight;
    }
    return sum * sum / squares;
}

/* So much more power that half of the draws stay in effect, or all that is left. */
static double next_power(const tempering *t)
{
    const double left = 1.0 - t->power, wanted = 0.5 * (double)t->draws;
    if (draws_in_effect(t, left) >= wanted) return left;
    double low = 0.0, high = left;
    for (int k = 0; k < 40; k++) {
        const double middle = 0.5 * (low + high);
        if (draws_in_effect(t, middle) >= wanted) low = middle;
        else high = middle;
    }
    return high;
}

/* As often as its weight says, at even distances from one random beginning (Kitagawa 1996). */
static void draw_anew(tempering *t, double more)
{
    const size_t d = t->parameters;
    double largest = -INFINITY, sum = 0.0, passed = 0.0;
    for (size_t i = 0; i < t->draws; i++) largest = fmax(largest, t->likelihood[i]);
    for (size_t i = 0; i < t->draws; i++) sum += exp(more * (t->likelihood[i] - largest));
    const double step = sum / (double)t->draws, first = random_uniform(&t->dice) * step;
    size_t from = 0;
    for (size_t i = 0; i < t->draws; i++) {
        const double until = first + (double)i * step;
        for (; from + 1 < t->draws; from++) {
            const double weight = exp(more * (t->likelihood[from] - largest));
            if (passed + weight > until) break;
            passed += weight;
        }
        memcpy(&t->tried[i * d], &t->x[from * d], d * sizeof *t->x);
        t->tried_likelihood[i] = t->likelihood[from];
    }
    memcpy(t->x, t->tried, t->draws * d * sizeof *t->x);
    memcpy(t->likelihood, t->tried_likelihood, t->draws * sizeof *t->likelihood);
}

/* Back into [0, 1], mirrored at its ends, so that a step and its way back are as likely. */
static double mirrored(double x)
{
    x = fabs(fmod(x, 2.0));
    return x > 1.0 ? 2.0 - x : x;
}

/* Steps of several lengths along the difference of two others, as they were before the sweep; now and then a whole difference,
 * which leads from island to island. */
static void propose(tempering *t, size_t i)
{
    static const double shares[] = { 1.0, 0.5, 0.2, 0.05 };
    const size_t d = t->parameters;
    const double *a = &t->others[random_below(&t->dice, t->draws) * d], *b = &t->others[random_below(&t->dice, t->draws) * d];
    const size_t kind = random_below(&t->dice, 5);
    const double along = kind == 4 ? 1.0 : shares[kind] * 2.38 / sqrt(2.0 * (double)d);
    for (size_t k = 0; k < d; k++)
        t->tried[i * d + k] = mirrored(t->x[i * d + k] + along * (a[k] - b[k]) + 1e-4 * random_normal(&t->dice));
}

static bool sweep(tempering *t)
{
    const size_t d = t->parameters;
    memcpy(t->others, t->x, t->draws * d * sizeof *t->x);
    for (size_t i = 0; i < t->draws; i++) propose(t, i);
    if (!posterior_likelihood(t->measured, t->values, d, t->draws, t->tried, t->tried_likelihood)) return false;
    for (size_t i = 0; i < t->draws; i++) {
        const double gain = t->power * (t->tried_likelihood[i] - t->likelihood[i]);
        if (!(log(1.0 - random_uniform(&t->dice)) < gain)) continue;
        memcpy(&t->x[i * d], &t->tried[i * d], d * sizeof *t->x);
        t->likelihood[i] = t->tried_likelihood[i];
    }
    return true;
}

static bool temper(tempering *t, uint64_t seed)
{
    const size_t d = t->parameters;
    for (size_t i = 0; i < t->draws; i++)
        for (size_t k = 0; k < d; k++) t->x[i * d + k] = even_point(seed, i, (unsigned)k);
    bool good = posterior_likelihood(t->measured, t->values, d, t->draws, t->x, t->likelihood);
    for (int stage = 0; good && t->power < 1.0; stage++) {
        const double more = stage < MOST_STAGES ? next_power(t) : 1.0 - t->power;
        draw_anew(t, more);
        t->power = fmin(t->power + more, 1.0);
        const int sweeps = t->power < 1.0 ? SWEEPS : LAST_SWEEPS;
        for (int k = 0; good && k < sweeps; k++) good = sweep(t);
    }
    return good;
}

typedef struct search {
    const measured_value *measured;
    size_t values, parameters;
} search;

static double unlikelihood(void *context, const double *x)
{
    const search *s = context;
    double likelihood;
    for (size_t k = 0; k < s->parameters; k++)
        if (!(x[k] >= 0.0 && x[k] <= 1.0)) return INFINITY;
    return posterior_likelihood(s->measured, s->values, s->parameters, 1, x, &likelihood) ? -likelihood : INFINITY;
}

/* The likeliest place: from the likeliest draw downhill. */
static void find_best(posterior *p, const measured_value *measured, size_t values)
{
    size_t best = 0;
    search s = { measured, values, p->parameters };
    for (size_t i = 1; i < p->draws; i++)
        if (p->likelihood[i] > p->likelihood[best]) best = i;
    memcpy(p->best, &p->x[best * p->parameters], p->parameters * sizeof *p->x);
    p->best_likelihood = -simplex_minimize(unlikelihood, &s, p->parameters, p->best, 0.01, 1e-7, 200);
}

bool posterior_draw(posterior *p, size_t parameters, const measured_value *measured, size_t values, size_t draws, uint64_t seed)
{
    *p = (posterior){ .draws = draws, .parameters = parameters };
    p->x = malloc(draws * parameters * sizeof *p->x);
    p->likelihood = malloc(draws * sizeof *p->likelihood);
    tempering t = { .measured = measured,
                    .values = values,
                    .parameters = parameters,
                    .draws = draws,
                    .x = p->x,
                    .likelihood = p->likelihood,
                    .dice = { mix_bits(seed + 1) } };
    t.tried = malloc(draws * parameters * sizeof *t.tried);
    t.others = malloc(draws * parameters * sizeof *t.others);
    t.tried_likelihood = malloc(draws * sizeof *t.tried_likelihood);
    const bool good = p->x && p->likelihood && t.tried && t.others && t.tried_likelihood && temper(&t, seed);
    if (good) find_best(p, measured, values);
    free(t.tried);
    free(t.others);
    free(t.tried_likelihood);
    return good;
}

void posterior_clear(posterior *p)
{
    free(p->x);
    free(p->likelihood);
    *p = (posterior){ .draws = 0 };
}
