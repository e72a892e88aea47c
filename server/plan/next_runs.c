#include "next_runs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLACES = 200 };

typedef struct choosing {
    const plan_fit *fit;
    double x[PLACES * PLAN_MOST_PARAMETERS];
    double *covariance[PLAN_MOST_MEASURES]; /* (PLACES,PLACES) for each fitted value; NULL: it is known well enough */
    double noise[PLAN_MOST_MEASURES];       /* variance of a run about the mean over beds */
    double work[PLAN_MOST_TESTS];           /* of a run of the test, in units of the mean over all; */
} choosing;

static void spread_places(choosing *c)
{
    const posterior *p = &c->fit->posterior;
    for (size_t i = 0; i < PLACES; i++)
        memcpy(&c->x[i * p->parameters], &p->x[(i * p->draws / PLACES) * p->parameters], p->parameters * sizeof *p->x);
}

/* Mean work of the test's runs, by counts; 1 where none tells. */
static void weigh_tests(choosing *c)
{
    const plan_table *table = c->fit->table;
    double sum[PLAN_MOST_TESTS] = { 0.0 }, all = 0.0;
    size_t runs[PLAN_MOST_TESTS] = { 0 }, of_all = 0;
    for (size_t i = 0; i < table->count; i++) {
        const double work = plan_run_work(&table->run[i]);
        if (!(work > 0.0)) continue;
        sum[table->run[i].test] += work;
        runs[table->run[i].test]++;
        all += work;
        of_all++;
    }
    for (size_t t = 0; t < c->fit->request->tests; t++)
        c->work[t] = runs[t] ? (sum[t] / (double)runs[t]) / (all / (double)of_all) : 1.0;
}

static bool covariances(choosing *c)
{
    const plan_fit *fit = c->fit;
    bool is_needed = false;
    for (size_t v = 0; v < fit->values; v++)
        is_needed = is_needed || fit->error_in[fit->measure_of[v]] > PLAN_ENOUGH * fit->measured[v].error;
    for (size_t v = 0; v < fit->values; v++) {
        const emulator *e = fit->measured[v].emulator;
        if (is_needed && fit->error_in[fit->measure_of[v]] <= PLAN_ENOUGH * fit->measured[v].error) continue;
        c->covariance[v] = malloc(sizeof(double) * PLACES * PLACES);
        if (!c->covariance[v] || !emulator_covariance(e, PLACES, c->x, c->covariance[v])) return false;
        c->noise[v] = pow(emulator_run_deviation(e, fit->usual_error[fit->measure_of[v]]), 2.0);
    }
    return true;
}

/* Tells any of the targets. */
static bool has_told(const plan_fit *fit, const plan_run *run)
{
    double value, error;
    for (size_t m = 0; m < fit->request->measures; m++)
        if (fit->request->measure[m].use == PLAN_FITTED && plan_run_tells(run, &fit->request->measure[m], &value, &error))
            return true;
    return false;
}

/* Where the nearest run of the test has told nothing, another would not. */
static bool fails_there(const plan_fit *fit, size_t test, const double *x)
{
    double nearest = INFINITY;
    bool has_failed = false;
    for (size_t i = 0; i < fit->table->count; i++) {
        const plan_run *run = &fit->table->run[i];
        if (run->test != test || run->stage == STAGE_VERIFY) continue;
        double apart = 0.0;
        for (size_t k = 0; k < fit->request->parameters; k++) apart += (run->x[k] - x[k]) * (run->x[k] - x[k]);
        if (apart < nearest) has_failed = !has_told(fit, run);
        nearest = fmin(nearest, apart);
    }
    return has_failed;
}

static double gain_of(const choosing *c, size_t test, size_t place)
{
    double gain = 0.0;
    for (size_t v = 0; v < c->fit->values; v++) {
        if (!c->covariance[v] || c->fit->request->measure[c->fit->measure_of[v]].test != test) continue;
        const double *row = &c->covariance[v][place * PLACES], error = c->fit->measured[v].error;
        double sum = 0.0;
        for (size_t j = 0; j < PLACES; j++) sum += row[j] * row[j];
        gain += sum / (row[place] + c->noise[v] + 1e-12 * error * error) / (error * error);
    }
    return gain / c->work[test];
}

/* As if the run were done: its value is not needed for what the variances become. */
static void take_as_done(choosing *c, size_t test, size_t place)
{
    double row[PLACES];
    for (size_t v = 0; v < c->fit->values; v++) {
        if (!c->covariance[v] || c->fit->request->measure[c->fit->measure_of[v]].test != test) continue;
        const double error = c->fit->measured[v].error;
        memcpy(row, &c->covariance[v][place * PLACES], sizeof row);
        const double all = row[place] + c->noise[v] + 1e-12 * error * error;
        for (size_t i = 0; i < PLACES; i++)
            for (size_t j = 0; j < PLACES; j++) c->covariance[v][i * PLACES + j] -= row[i] * row[j] / all;
    }
}

static bool choose_one(choosing *c, next_run *run)
{
    double most = 0.0;
    size_t best = 0;
    for (size_t t = 0; t < c->fit->request->tests; t++) {
        if (c->fit->request->test[t].use != PLAN_FITTED) continue;
        for (size_t i = 0; i < PLACES; i++) {
            const double gain = gain_of(c, t, i);
            if (!(gain > most) || fails_there(c->fit, t, &c->x[i * c->fit->request->parameters])) continue;
            most = gain;
            best = i;
            run->test = t;
        }
    }
    if (!(most > 0.0)) return false;
    memcpy(run->x, &c->x[best * c->fit->request->parameters], c->fit->request->parameters * sizeof *run->x);
    take_as_done(c, run->test, best);
    return true;
}

size_t next_runs_choose(const plan_fit *fit, size_t count, next_run *runs)
{
    choosing *c = calloc(1, sizeof *c);
    if (!c) return 0;
    c->fit = fit;
    spread_places(c);
    weigh_tests(c);
    size_t chosen = 0;
    if (covariances(c))
        while (chosen < count && choose_one(c, &runs[chosen])) chosen++;
    for (size_t v = 0; v < fit->values; v++) free(c->covariance[v]);
    free(c);
    return chosen;
}
