#include "family.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "agreement.h"
#include "json_text.h"

static int by_size(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

/* The likelihood that 95 of 100 draws exceed; -infinite without memory. */
static double least_likelihood(const posterior *p)
{
    double *sorted = malloc(p->draws * sizeof *sorted);
    if (!sorted) return -INFINITY;
    memcpy(sorted, p->likelihood, p->draws * sizeof *sorted);
    qsort(sorted, p->draws, sizeof *sorted, by_size);
    const double least = sorted[p->draws / 20];
    free(sorted);
    return least;
}

static void deviations(const posterior *p, double *deviation)
{
    for (size_t k = 0; k < p->parameters; k++) {
        double sum = 0.0, squares = 0.0;
        for (size_t i = 0; i < p->draws; i++) sum += p->x[i * p->parameters + k] / (double)p->draws;
        for (size_t i = 0; i < p->draws; i++) squares += pow(p->x[i * p->parameters + k] - sum, 2.0) / (double)p->draws;
        deviation[k] = fmax(sqrt(squares), 1e-9);
    }
}

/* Squared, in deviations, from the nearest of the sets. */
static double distance(const posterior *p, const double *deviation, const double *x, const double *sets, size_t count)
{
    double nearest = INFINITY;
    for (size_t s = 0; s < count; s++) {
        double sum = 0.0;
        for (size_t k = 0; k < p->parameters; k++) sum += pow((x[k] - sets[s * p->parameters + k]) / deviation[k], 2.0);
        nearest = fmin(nearest, sum);
    }
    return nearest;
}

size_t family_choose(const plan_fit *fit, size_t wanted, double *sets)
{
    const posterior *p = &fit->posterior;
    const size_t d = p->parameters;
    double deviation[PLAN_MOST_PARAMETERS];
    if (wanted == 0) return 0;
    if (wanted > FAMILY_MOST) wanted = FAMILY_MOST;
    deviations(p, deviation);
    const double least = least_likelihood(p);
    memcpy(sets, p->best, d * sizeof *sets);
    for (size_t count = 1; count < wanted; count++) {
        size_t farthest = 0;
        double most = -1.0;
        for (size_t i = 0; i < p->draws; i++) {
            const double apart = p->likelihood[i] < least ? -1.0 : distance(p, deviation, &p->x[i * d], sets, count);
            if (!(apart > most)) continue;
            most = apart;
            farthest = i;
        }
        memcpy(&sets[count * d], &p->x[farthest * d], d * sizeof *sets);
    }
    return wanted;
}

const plan_run *family_run(const plan_fit *fit, size_t set, size_t test)
{
    for (size_t i = 0; i < fit->table->count; i++) {
        const plan_run *run = &fit->table->run[i];
        if (run->stage == STAGE_VERIFY && run->set == set && run->test == test) return run;
    }
    return NULL;
}

json_t *parameters_to_json(const plan_request *request, const double *x)
{
    json_t *parameters = json_object();
    for (size_t p = 0; p < request->parameters; p++)
        json_object_set_new(parameters, request->parameter[p].pointer, json_real(plan_from_cube(&request->parameter[p], x[p])));
    return parameters;
}

/* z: by how many errors the run is off what the emulator foretold; null where nothing was foretold or the run failed. */
static json_t *result_of(const plan_fit *fit, const double *x, const plan_run *run, size_t m)
{
    const emulator *e = &fit->of[m];
    double value = NAN, error = NAN, mean = NAN, variance = NAN;
    if (!run || !plan_run_tells(run, &fit->request->measure[m], &value, &error)) value = error = NAN;
    if (e->points > 0 && !emulator_predict(e, 1, x, &mean, &variance)) return NULL;
    const double all = e->points > 0 && !isnan(value) ? plan_fit_run_deviation(fit, m, error) : error;
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:o}", "target", fit->request->measure[m].name, "result", json_real_or_null(value),
                     "standard_error", json_real_or_null(all), "predicted", json_real_or_null(mean), "predicted_standard_error",
                     json_real_or_null(sqrt(variance)), "z", json_real_or_null((value - mean) / sqrt(all * all + variance)));
}

bool family_compare(const plan_fit *fit, const double *sets, size_t count, family_check *check)
{
    *check = (family_check){ .runs = 0 };
    for (size_t s = 0; s < count; s++)
        for (size_t v = 0; v < fit->values; v++) {
            const size_t m = fit->measure_of[v];
            const plan_run *run = family_run(fit, s, fit->request->measure[m].test);
            double value, error, mean, variance;
            if (!run || !plan_run_tells(run, &fit->request->measure[m], &value, &error)) continue;
            if (!emulator_predict(&fit->of[m], 1, &sets[s * fit->request->parameters], &mean, &variance)) return false;
            const double all = pow(plan_fit_run_deviation(fit, m, error), 2.0) + variance;
            const double square = (value - mean) * (value - mean) / all;
            check->chi_square += square;
            check->worst = fmax(check->worst, square);
            check->runs++;
        }
    check->is_refuted = check->runs > 1 && chi_square_beyond(check->chi_square - check->worst, check->runs - 1) < LEAST_PROBABILITY;
    return true;
}

json_t *family_to_json(const plan_fit *fit, const double *sets, size_t count)
{
    json_t *family = json_array();
    for (size_t s = 0; s < count; s++) {
        const double *x = &sets[s * fit->request->parameters];
        json_t *results = json_array();
        for (size_t m = 0; m < fit->request->measures; m++)
            json_array_append_new(results, result_of(fit, x, family_run(fit, s, fit->request->measure[m].test), m));
        json_array_append_new(family,
                              json_pack("{s:o, s:o}", "parameters", parameters_to_json(fit->request, x), "results", results));
    }
    return family;
}

/* What the posterior foretells: by the emulator where the runs of a fitted test tell the hold-out, too. */
static bool foretell_by_emulator(const plan_fit *fit, size_t m, double *mean, double *deviation)
{
    const posterior *p = &fit->posterior;
    double *means = malloc(p->draws * sizeof *means), sum = 0.0, squares = 0.0;
    const bool good = means && emulator_predict(&fit->of[m], p->draws, p->x, means, NULL);
    for (size_t i = 0; good && i < p->draws; i++) sum += means[i];
    *mean = sum / (double)p->draws;
    for (size_t i = 0; good && i < p->draws; i++) squares += (means[i] - *mean) * (means[i] - *mean);
    *deviation = sqrt(squares / (double)p->draws + fit->error_in[m] * fit->error_in[m]);
    free(means);
    return good;
}

/* Otherwise by the runs of the family: their mean, and how far they lie apart. */
static bool foretell_by_family(const plan_fit *fit, size_t m, size_t count, double *mean, double *deviation)
{
    double sum = 0.0, squares = 0.0;
    int runs = 0;
    for (size_t s = 0; s < count; s++) {
        double value, error;
        const plan_run *run = family_run(fit, s, fit->request->measure[m].test);
        if (!run || !plan_run_tells(run, &fit->request->measure[m], &value, &error)) continue;
        sum += value;
        squares += value * value;
        runs++;
    }
    if (runs < 2) return false;
    *mean = sum / runs;
    *deviation = sqrt(fmax(squares - sum * sum / runs, 0.0) / (runs - 1));
    return true;
}

json_t *validation_to_json(const plan_fit *fit, size_t count)
{
    json_t *validation = json_array();
    for (size_t m = 0; m < fit->request->measures; m++) {
        const plan_measure *measure = &fit->request->measure[m];
        double mean, deviation;
        if (measure->use != PLAN_HELD_OUT) continue;
        const bool by_emulator = fit->of[m].points > 0;
        const bool known =
            by_emulator ? foretell_by_emulator(fit, m, &mean, &deviation) : foretell_by_family(fit, m, count, &mean, &deviation);
        if (!known) mean = deviation = NAN;
        json_array_append_new(
            validation, json_pack("{s:s, s:f, s:f, s:o, s:o, s:o, s:s}", "target", measure->name, "value", measure->value,
                                  "standard_error", measure->error, "predicted", json_real_or_null(mean),
                                  "predicted_standard_error", json_real_or_null(deviation), "z",
                                  json_real_or_null((mean - measure->value) / hypot(deviation, measure->error)), "predicted_by",
                                  !known        ? "nothing"
                                  : by_emulator ? "the emulator over the posterior"
                                                : "the runs of the family"));
    }
    return validation;
}
