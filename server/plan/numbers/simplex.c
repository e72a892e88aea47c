#include "simplex.h"

#include <math.h>
#include <string.h>

typedef struct simplex {
    size_t dimensions;
    simplex_function function;
    void *context;
    int left; /* evaluations */
    double corner[SIMPLEX_MOST_DIMENSIONS + 1][SIMPLEX_MOST_DIMENSIONS], value[SIMPLEX_MOST_DIMENSIONS + 1];
} simplex;

static double evaluate(simplex *s, const double *x)
{
    s->left--;
    const double value = s->function(s->context, x);
    return isnan(value) ? INFINITY : value;
}

/* By growing value: insertion, which keeps equal ones in their order. */
static void sort(simplex *s)
{
    for (size_t i = 1; i <= s->dimensions; i++)
        for (size_t j = i; j > 0 && s->value[j] < s->value[j - 1]; j--) {
            double corner[SIMPLEX_MOST_DIMENSIONS];
            const double value = s->value[j];
            memcpy(corner, s->corner[j], sizeof corner);
            memcpy(s->corner[j], s->corner[j - 1], sizeof corner);
            memcpy(s->corner[j - 1], corner, sizeof corner);
            s->value[j] = s->value[j - 1];
            s->value[j - 1] = value;
        }
}

/* The worst corner, seen from the middle of the others: 1 is itself, -1 its mirror image. */
static double try_at(simplex *s, double distance, double *x)
{
    for (size_t k = 0; k < s->dimensions; k++) {
        double middle = 0.0;
        for (size_t i = 0; i < s->dimensions; i++) middle += s->corner[i][k] / (double)s->dimensions;
        x[k] = middle + distance * (s->corner[s->dimensions][k] - middle);
    }
    return evaluate(s, x);
}

static void replace_worst(simplex *s, const double *x, double value)
{
    memcpy(s->corner[s->dimensions], x, s->dimensions * sizeof *x);
    s->value[s->dimensions] = value;
}

static void shrink(simplex *s)
{
    for (size_t i = 1; i <= s->dimensions; i++) {
        for (size_t k = 0; k < s->dimensions; k++) s->corner[i][k] = 0.5 * (s->corner[i][k] + s->corner[0][k]);
        s->value[i] = evaluate(s, s->corner[i]);
    }
}

static void move_worst(simplex *s)
{
    double mirrored[SIMPLEX_MOST_DIMENSIONS], other[SIMPLEX_MOST_DIMENSIONS];
    const size_t worst = s->dimensions;
    const double value = try_at(s, -1.0, mirrored);
    if (value < s->value[0]) {
        const double farther = try_at(s, -2.0, other);
        replace_worst(s, farther < value ? other : mirrored, fmin(farther, value));
    } else if (value < s->value[worst - 1]) {
        replace_worst(s, mirrored, value);
    } else {
        const double nearer = try_at(s, value < s->value[worst] ? -0.5 : 0.5, other);
        if (nearer < fmin(value, s->value[worst])) replace_worst(s, other, nearer);
        else shrink(s);
    }
}

double simplex_minimize(simplex_function function, void *context, size_t dimensions, double *x, double step, double tolerance,
                        int evaluations)
{
    simplex s = { .dimensions = dimensions, .function = function, .context = context, .left = evaluations };
    for (size_t i = 0; i <= dimensions; i++) {
        memcpy(s.corner[i], x, dimensions * sizeof *x);
        if (i > 0) s.corner[i][i - 1] += step;
        s.value[i] = evaluate(&s, s.corner[i]);
    }
    sort(&s);
    while (s.left > 0 && !(s.value[dimensions] - s.value[0] < tolerance)) {
        move_worst(&s);
        sort(&s);
    }
    memcpy(x, s.corner[0], dimensions * sizeof *x);
    return s.value[0];
}
