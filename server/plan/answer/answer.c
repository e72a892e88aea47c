#include "answer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "card.h"
#include "family.h"
#include "json_text.h"
#include "next_test.h"
#include "words.h"

enum { MOST_SAMPLES = 1000 };

static const char *status_of(const findings *f)
{
    if (f->agreement.is_out || f->agreement.is_contradicted) return "unreachable";
    if (!plan_fit_is_enough(f->fit, PLAN_ENOUGH_SLACK) || f->check.is_refuted) return "unfinished";
    return shape_is_identified(&f->shape, f->fit->request->parameters) ? "identified" : "ridge";
}

static json_t *best_of(const findings *f)
{
    const plan_fit *fit = f->fit;
    json_t *targets = json_array();
    for (size_t v = 0; v < fit->values; v++) {
        const plan_measure *measure = &fit->request->measure[fit->measure_of[v]];
        double mean, variance;
        if (!emulator_predict(fit->measured[v].emulator, 1, fit->posterior.best, &mean, &variance)) mean = variance = NAN;
        json_array_append_new(targets,
                              json_pack("{s:s, s:f, s:f, s:o, s:o, s:o}", "target", measure->name, "value", measure->value,
                                        "value_standard_error", measure->error, "predicted", json_real_or_null(mean),
                                        "standard_error", json_real_or_null(sqrt(variance)), "z",
                                        json_real_or_null((mean - measure->value) / hypot(measure->error, sqrt(variance)))));
    }
    return json_pack("{s:o, s:o, s:f, s:i, s:f}", "parameters", parameters_to_json(fit->request, fit->posterior.best), "targets",
                     targets, "chi_square", f->agreement.chi_square, "degrees_of_freedom", f->agreement.degrees, "probability",
                     f->agreement.probability);
}

static json_t *interval(const plan_parameter *parameter, const double *sorted, size_t count, double outside)
{
    const double low = sorted_quantile(sorted, count, 0.5 * outside), high = sorted_quantile(sorted, count, 1.0 - 0.5 * outside);
    return json_pack("[f, f]", plan_from_cube(parameter, low), plan_from_cube(parameter, high));
}

static json_t *credible_of(const plan_fit *fit)
{
    const posterior *p = &fit->posterior;
    json_t *credible = json_object();
    for (size_t k = 0; k < p->parameters; k++) {
        double axis[PLAN_MOST_PARAMETERS] = { 0.0 };
        axis[k] = 1.0;
        double *sorted = sorted_along(p->x, p->draws, p->parameters, axis);
        const plan_parameter *parameter = &fit->request->parameter[k];
        if (sorted)
            json_object_set_new(credible, parameter->pointer,
                                json_pack("{s:o, s:o, s:f, s:f}", "68", interval(parameter, sorted, p->draws, 0.32), "95",
                                          interval(parameter, sorted, p->draws, 0.05), "median",
                                          plan_from_cube(parameter, sorted_quantile(sorted, p->draws, 0.5)), "standard_deviation",
                                          plan_fit_deviation(fit, k)));
        free(sorted);
    }
    return credible;
}

/* Of the values, in the parameters' order: rows of lists. */
static json_t *covariance_of(const plan_fit *fit)
{
    const posterior *p = &fit->posterior;
    const size_t d = p->parameters;
    double mean[PLAN_MOST_PARAMETERS] = { 0.0 }, sum[PLAN_MOST_PARAMETERS][PLAN_MOST_PARAMETERS] = { { 0.0 } };
    for (size_t i = 0; i < p->draws; i++)
        for (size_t k = 0; k < d; k++) mean[k] += plan_from_cube(&fit->request->parameter[k], p->x[i * d + k]) / (double)p->draws;
    for (size_t i = 0; i < p->draws; i++) {
        double apart[PLAN_MOST_PARAMETERS];
        for (size_t k = 0; k < d; k++) apart[k] = plan_from_cube(&fit->request->parameter[k], p->x[i * d + k]) - mean[k];
        for (size_t a = 0; a < d; a++)
            for (size_t b = 0; b < d; b++) sum[a][b] += apart[a] * apart[b] / (double)p->draws;
    }
    json_t *rows = json_array();
    for (size_t a = 0; a < d; a++) {
        json_t *row = json_array();
        for (size_t b = 0; b < d; b++) json_array_append_new(row, json_real(sum[a][b]));
        json_array_append_new(rows, row);
    }
    return rows;
}

static json_t *samples_of(const plan_fit *fit)
{
    const posterior *p = &fit->posterior;
    const size_t count = p->draws < MOST_SAMPLES ? p->draws : MOST_SAMPLES;
    json_t *samples = json_array();
    for (size_t i = 0; i < count; i++) {
        json_t *sample = json_array();
        for (size_t k = 0; k < p->parameters; k++)
            json_array_append_new(
                sample, json_real(plan_from_cube(&fit->request->parameter[k], p->x[(i * p->draws / count) * p->parameters + k])));
        json_array_append_new(samples, sample);
    }
    return samples;
}

static json_t *directions_of(const findings *f)
{
    json_t *directions = json_array();
    for (size_t d = 0; d < f->fit->request->parameters; d++) {
        const shape_direction *one = &f->shape.direction[d];
        json_t *vector = json_object();
        for (size_t p = 0; p < f->fit->request->parameters; p++)
            json_object_set_new(vector, f->fit->request->parameter[p].pointer, json_real(one->vector[p]));
        json_array_append_new(directions,
                              json_pack("{s:o, s:f, s:f, s:b, s:o}", "vector", vector, "known_to", one->known_to, "share_of_range",
                                        one->share, "identified", one->is_identified, "words", words_of_direction(f, d)));
    }
    return directions;
}

static json_t *sensitivity_to_json(const findings *f)
{
    json_t *all = json_array();
    for (size_t m = 0; m < f->fit->request->measures; m++) {
        if (f->fit->of[m].points == 0) continue;
        json_t *first = json_object(), *total = json_object();
        for (size_t p = 0; p < f->fit->request->parameters; p++) {
            json_object_set_new(first, f->fit->request->parameter[p].pointer, json_real(f->sensitivity[m].first[p]));
            json_object_set_new(total, f->fit->request->parameter[p].pointer, json_real(f->sensitivity[m].total[p]));
        }
        json_array_append_new(all, json_pack("{s:s, s:o, s:o, s:f}", "target", f->fit->request->measure[m].name, "first_order",
                                             first, "total", total, "spread", f->sensitivity[m].spread));
    }
    return all;
}

/* A pair of targets may have the same name, so that it is a list. */
static json_t *reach_of(const findings *f)
{
    json_t *all = json_array();
    for (size_t v = 0; v < f->fit->values; v++) {
        const size_t m = f->fit->measure_of[v];
        json_array_append_new(all, json_pack("{s:s, s:[f, f], s:f, s:f, s:b}", "target", f->fit->request->measure[m].name, "range",
                                             f->sensitivity[m].lowest, f->sensitivity[m].highest, "nearest",
                                             f->agreement.reach[v].nearest, "z", f->agreement.reach[v].z, "reached",
                                             !f->agreement.reach[v].is_out));
    }
    return all;
}

/* Of each target's emulator: what share of the runs lies within the errors that all others foretell for it, and the scatter. */
static json_t *emulators_of(const plan_fit *fit)
{
    json_t *all = json_array();
    for (size_t v = 0; v < fit->values; v++) {
        const emulator *e = fit->measured[v].emulator;
        double *deviation = malloc(e->points * sizeof *deviation), within[2] = { 0.0, 0.0 };
        const bool good = deviation && emulator_leave_one_out(e, deviation);
        for (size_t i = 0; good && i < e->points; i++) {
            within[0] += (fabs(deviation[i]) < 0.9945) / (double)e->points; /* of a normal number's 68 % */
            within[1] += (fabs(deviation[i]) < 1.96) / (double)e->points;
        }
        free(deviation);
        const size_t m = fit->measure_of[v];
        json_array_append_new(all, json_pack("{s:s, s:I, s:f, s:f, s:f, s:{s:f, s:f}}", "target", fit->request->measure[m].name,
                                             "runs", (json_int_t)e->points, "error", fit->error_in[m], "wanted",
                                             PLAN_ENOUGH * fit->measured[v].error, "bed_to_bed", emulator_scatter(e),
                                             "leave_one_out", "68", within[0], "95", within[1]));
    }
    return all;
}

static json_t *cost_of(const plan_table *table)
{
    double work = 0.0, seconds = 0.0;
    json_int_t failed = 0;
    for (size_t i = 0; i < table->count; i++) {
        const plan_run *run = &table->run[i];
        work += plan_run_work(run);
        seconds += plan_run_number(run, "wall_seconds", 0.0) * plan_run_number(run, "threads", 1.0);
        failed += run->has_failed;
    }
    return json_pack("{s:I, s:I, s:f, s:f}", "jobs", (json_int_t)table->count, "failed", failed, "sphere_steps", work,
                     "processor_seconds", seconds);
}

/* What is said of the posterior, where there is one. */
static void add_posterior(json_t *answer, const findings *f, const double *sets, size_t count)
{
    json_object_set_new(answer, "best", best_of(f));
    json_object_set_new(answer, "credible", credible_of(f->fit));
    json_object_set_new(answer, "covariance", covariance_of(f->fit));
    json_object_set_new(answer, "samples", samples_of(f->fit));
    json_object_set_new(answer, "directions", directions_of(f));
    json_object_set_new(answer, "islands", json_integer((json_int_t)f->shape.islands));
    json_object_set_new(answer, "family", family_to_json(f->fit, sets, count));
    json_object_set_new(answer, "sensitivity", sensitivity_to_json(f));
    json_object_set_new(answer, "reach", reach_of(f));
    json_object_set_new(answer, "next_test", next_test_to_json(f->fit, &f->shape, sets, count));
    json_object_set_new(answer, "validation", validation_to_json(f->fit, count));
    json_object_set_new(answer, "emulators", emulators_of(f->fit));
    json_t *card = card_to_json(f->fit, json_object_get(answer, "credible")), *snippets = snippets_to_json(f->fit);
    if (card) json_object_set_new(answer, "card", card);
    if (snippets) json_object_set_new(answer, "snippets", snippets);
}

json_t *answer_make(const plan_fit *fit, const double *sets, size_t count)
{
    findings *f = calloc(1, sizeof *f);
    bool good = f != NULL;
    if (good) *f = (findings){ .fit = fit, .status = "unfinished", .verified = count };
    for (size_t m = 0; good && m < fit->request->measures; m++)
        if (fit->of[m].points > 0) good = sensitivity_measure(&fit->of[m], fit->request->seed, &f->sensitivity[m]);
    good = good && shape_measure(fit, &f->shape) && agreement_measure(fit, &f->agreement)
           && family_compare(fit, sets, count, &f->check);
    json_t *answer = NULL;
    if (good) {
        json_t *parameters = json_array();
        for (size_t p = 0; p < fit->request->parameters; p++)
            json_array_append_new(parameters, json_string(fit->request->parameter[p].pointer));
        if (fit->values > 0) f->status = status_of(f);
        answer = json_pack("{s:s, s:o, s:o}", "status", f->status, "words", words_of_answer(f), "parameters", parameters);
        if (fit->values > 0) add_posterior(answer, f, sets, count);
        json_object_set_new(answer, "cost", cost_of(fit->table));
    }
    free(f);
    return answer;
}
