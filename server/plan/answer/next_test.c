#include "next_test.h"

#include <math.h>
#include <stdlib.h>

#include "family.h"
#include "json_text.h"

enum { LEAST_RUNS = 4, TRUTHS = 40 };

/* An emulator of the measure from the family's runs. False: too few of them tell it. */
static bool emulate(const plan_fit *fit, size_t m, const double *sets, size_t count, emulator *e)
{
    const size_t d = fit->request->parameters;
    double x[FAMILY_MOST * PLAN_MOST_PARAMETERS], y[FAMILY_MOST], error[FAMILY_MOST];
    size_t told = 0;
    for (size_t s = 0; s < count; s++) {
        const plan_run *run = family_run(fit, s, fit->request->measure[m].test);
        if (!run || !plan_run_tells(run, &fit->request->measure[m], &y[told], &error[told])) continue;
        for (size_t k = 0; k < d; k++) x[told * d + k] = sets[s * d + k];
        if (isnan(error[told])) error[told] = 0.0;
        told++;
    }
    return told >= LEAST_RUNS && told > d + 1 && emulator_fit(e, d, told, x, y, error);
}

/* The standard deviation along a direction of draws weighted by how well they agree with a value. */
static double deviation_given(const posterior *p, const double *along, const double *mean, const double *variance, double error,
                              double value)
{
    double sum = 0.0, first = 0.0, second = 0.0;
    for (size_t i = 0; i < p->draws; i++) {
        const double all = error * error + variance[i], apart = value - mean[i];
        const double weight = exp(-0.5 * apart * apart / all) / sqrt(all);
        sum += weight;
        first += weight * along[i];
        second += weight * along[i] * along[i];
    }
    return sum > 0.0 ? sqrt(fmax(second / sum - first * first / (sum * sum), 0.0)) : 0.0;
}

/* By what share the deviation along the vector would fall, in the mean over truths among the draws. NaN: no memory. */
static double shrinks_by(const plan_fit *fit, const emulator *e, double error, const shape_direction *direction)
{
    const posterior *p = &fit->posterior;
    double *mean = malloc(3 * p->draws * sizeof *mean), ratio = NAN;
    double *variance = mean ? mean + p->draws : NULL, *along = mean ? variance + p->draws : NULL;
    if (mean && emulator_predict(e, p->draws, p->x, mean, variance)) {
        for (size_t i = 0; i < p->draws; i++) {
            along[i] = 0.0;
            for (size_t k = 0; k < p->parameters; k++) along[i] += p->x[i * p->parameters + k] * direction->vector[k];
        }
        const double noise = e->scatter * e->spread * e->spread;
        ratio = 0.0;
        for (size_t t = 0; t < TRUTHS; t++)
            ratio += deviation_given(p, along, mean, variance, sqrt(error * error + noise), mean[t * p->draws / TRUTHS])
                     / (direction->known_to * TRUTHS);
    }
    free(mean);
    return 1.0 - ratio;
}

static double seconds_of(const plan_fit *fit, size_t test)
{
    double sum = 0.0;
    int runs = 0;
    for (size_t i = 0; i < fit->table->count; i++) {
        const double seconds = plan_run_number(&fit->table->run[i], "wall_seconds", NAN);
        if (fit->table->run[i].test != test || isnan(seconds)) continue;
        sum += seconds;
        runs++;
    }
    return runs ? sum / runs : NAN;
}

/* Keeps the list by falling share. */
static void insert(json_t *list, json_t *one)
{
    size_t place = 0;
    const double share = json_number_value(json_object_get(one, "would_shrink"));
    while (place < json_array_size(list)
           && json_number_value(json_object_get(json_array_get(list, place), "would_shrink")) >= share)
        place++;
    json_array_insert_new(list, place, one);
}

json_t *next_test_to_json(const plan_fit *fit, const shape *s, const double *sets, size_t count)
{
    json_t *list = json_array();
    const plan_request *request = fit->request;
    const shape_direction *worst = &s->direction[request->parameters - 1];
    for (size_t m = 0; list && m < request->measures; m++) {
        const plan_measure *measure = &request->measure[m];
        emulator own = { .points = 0 };
        if (measure->use != PLAN_PROPOSED) continue;
        const emulator *e = fit->of[m].points > 0 ? &fit->of[m] : emulate(fit, m, sets, count, &own) ? &own : NULL;
        if (e) {
            const json_t *job = request->test[measure->test].request;
            const double share = shrinks_by(fit, e, measure->error, worst);
            insert(list,
                   json_pack("{s:s, s:O, s:O, s:s, s:f, s:o, s:o}", "name", measure->name, "process",
                             json_object_get(job, "process"), "inputs", json_object_get(job, "inputs"), "result", measure->pointer,
                             "standard_error", measure->error, "would_shrink", json_real_or_null(fmax(share, 0.0)),
                             "estimated_seconds", json_real_or_null(seconds_of(fit, measure->test))));
        }
        emulator_clear(&own);
    }
    return list;
}
