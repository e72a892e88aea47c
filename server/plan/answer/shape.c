#include "shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "even_points.h"
#include "linear_algebra.h"

enum { LINKED = 400, PRIOR_POINTS = 1024 };
/* Draws belong together when steps of less than this lead from one to the other: of the cube, and of the usual step. */
#define LEAST_GAP 0.05
#define GAP_IN_STEPS 12.0
#define LEAST_SHARE 0.05
#define IDENTIFIED 0.5

static int by_size(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

double sorted_quantile(const double *sorted, size_t count, double share)
{
    const double place = share * (double)(count - 1);
    const size_t before = (size_t)place;
    if (before + 1 >= count) return sorted[count - 1];
    return sorted[before] + (place - (double)before) * (sorted[before + 1] - sorted[before]);
}

double *sorted_along(const double *x, size_t count, size_t parameters, const double *vector)
{
    double *along = calloc(count, sizeof *along);
    for (size_t i = 0; along && i < count; i++)
        for (size_t k = 0; k < parameters; k++) along[i] += x[i * parameters + k] * vector[k];
    if (along) qsort(along, count, sizeof *along, by_size);
    return along;
}

/* What the middle 95 of 100 take. */
static bool width_along(const double *x, size_t count, size_t parameters, const double *vector, double *width)
{
    double *sorted = sorted_along(x, count, parameters, vector);
    if (!sorted) return false;
    *width = sorted_quantile(sorted, count, 0.975) - sorted_quantile(sorted, count, 0.025);
    free(sorted);
    return true;
}

static void covariance_of_draws(const posterior *p, double *covariance)
{
    const size_t d = p->parameters;
    double mean[PLAN_MOST_PARAMETERS] = { 0.0 };
    for (size_t i = 0; i < p->draws; i++)
        for (size_t k = 0; k < d; k++) mean[k] += p->x[i * d + k] / (double)p->draws;
    memset(covariance, 0, d * d * sizeof *covariance);
    for (size_t i = 0; i < p->draws; i++)
        for (size_t a = 0; a < d; a++)
            for (size_t b = 0; b < d; b++)
                covariance[a * d + b] += (p->x[i * d + a] - mean[a]) * (p->x[i * d + b] - mean[b]) / (double)p->draws;
}

static bool measure_directions(const plan_fit *fit, shape *s)
{
    const posterior *p = &fit->posterior;
    const size_t d = p->parameters;
    double vectors[PLAN_MOST_PARAMETERS * PLAN_MOST_PARAMETERS], values[PLAN_MOST_PARAMETERS];
    double prior[PRIOR_POINTS * PLAN_MOST_PARAMETERS];
    covariance_of_draws(p, vectors);
    if (!symmetric_eigen(d, vectors, values)) return false;
    for (size_t i = 0; i < PRIOR_POINTS; i++)
        for (size_t k = 0; k < d; k++) prior[i * d + k] = even_point(fit->request->seed, i, (unsigned)k);
    for (size_t v = 0; v < d; v++) {
        shape_direction *direction = &s->direction[v];
        double width, all;
        memcpy(direction->vector, &vectors[v * d], d * sizeof *vectors);
        direction->known_to = sqrt(fmax(values[v], 0.0));
        if (!width_along(p->x, p->draws, d, direction->vector, &width)
            || !width_along(prior, PRIOR_POINTS, d, direction->vector, &all))
            return false;
        direction->share = width / all;
        direction->is_identified = direction->share < IDENTIFIED;
    }
    return true;
}

/* The shortest tree that joins some of the draws (Prim): for each but the first the length of its link and whom it is linked to. */
static void link_draws(const double *x, size_t d, double *length, size_t *link)
{
    bool is_in[LINKED] = { true };
    for (size_t i = 0; i < LINKED; i++) length[i] = i ? INFINITY : 0.0;
    size_t newest = 0;
    for (size_t n = 1; n < LINKED; n++) {
        size_t nearest = 0;
        double least = INFINITY;
        for (size_t i = 0; i < LINKED; i++) {
            if (is_in[i]) continue;
            double squares = 0.0;
            for (size_t k = 0; k < d; k++) squares += pow(x[i * d + k] - x[newest * d + k], 2.0);
            if (sqrt(squares) < length[i]) {
                length[i] = sqrt(squares);
                link[i] = newest;
            }
            if (length[i] < least) {
                least = length[i];
                nearest = i;
            }
        }
        newest = nearest;
        is_in[newest] = true;
    }
}

static void add_island(shape *s, const double *x, size_t d, const size_t *root, size_t of)
{
    size_t count = 0;
    double middle[PLAN_MOST_PARAMETERS] = { 0.0 };
    for (size_t i = 0; i < LINKED; i++) {
        if (root[i] != of) continue;
        for (size_t k = 0; k < d; k++) middle[k] += x[i * d + k];
        count++;
    }
    if ((double)count < LEAST_SHARE * LINKED || s->islands == MOST_ISLANDS) return;
    for (size_t k = 0; k < d; k++) s->island[s->islands][k] = middle[k] / (double)count;
    s->island_share[s->islands++] = (double)count / LINKED;
}

/* Links that are too long are cut; what has a twentieth of the draws is an island. */
static void find_islands(const posterior *p, shape *s)
{
    const size_t d = p->parameters;
    double x[LINKED * PLAN_MOST_PARAMETERS], length[LINKED], sorted[LINKED];
    size_t link[LINKED] = { 0 }, root[LINKED];
    for (size_t i = 0; i < LINKED; i++) memcpy(&x[i * d], &p->x[(i * p->draws / LINKED) * d], d * sizeof *x);
    link_draws(x, d, length, link);
    memcpy(sorted, length, sizeof sorted);
    qsort(sorted, LINKED, sizeof *sorted, by_size);
    const double gap = fmax(LEAST_GAP, GAP_IN_STEPS * sorted_quantile(sorted, LINKED, 0.5));
    for (size_t i = 0; i < LINKED; i++) {
        root[i] = i;
        while (root[i] != 0 && length[root[i]] <= gap) root[i] = link[root[i]];
    }
    for (size_t i = 0; i < LINKED; i++)
        if (root[i] == i) add_island(s, x, d, root, i);
    if (s->islands == 0) s->islands = 1;
}

bool shape_measure(const plan_fit *fit, shape *s)
{
    *s = (shape){ .islands = 0 };
    find_islands(&fit->posterior, s);
    return measure_directions(fit, s);
}

bool shape_is_identified(const shape *s, size_t parameters)
{
    bool is_identified = s->islands < 2;
    for (size_t d = 0; d < parameters; d++) is_identified = is_identified && s->direction[d].is_identified;
    return is_identified;
}
