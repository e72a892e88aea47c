#include "plan_cases.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "even_points.h"
#include "json_text.h"
#include "process_type.h"

enum { POINTS_A_PARAMETER = 8, MOST_SETS = 9 };

static size_t tests_for(const plan_request *request, bool fitted_alone)
{
    size_t count = 0;
    for (size_t t = 0; t < request->tests; t++) count += !fitted_alone || request->test[t].use == PLAN_FITTED;
    return count;
}

/* Five sets for up to two parameters, seven for three, nine for four; the start comes first, and where few jobs are allowed, it
 * takes seven in ten of them; or all, where those would be fewer points than an emulator begins with. */
plan_budget plan_budget_make(const plan_request *request)
{
    const size_t jobs = (size_t)request->most_jobs, fitted = tests_for(request, true), all = tests_for(request, false);
    assert(fitted > 0 && all > 0); /* a request without targets is refused */
    const size_t d = request->parameters, repeats = (size_t)request->repeats;
    plan_budget budget = { .points = POINTS_A_PARAMETER * d, .repeated = repeats > 1 ? 0 : d + 1 };
    if (repeats == 1) budget.points -= budget.repeated;
    const size_t wanted = (budget.points * repeats + budget.repeated) * fitted;
    if (10 * wanted > 7 * jobs) {
        budget.repeated = 0;
        budget.points = 7 * jobs / (10 * fitted * repeats);
        if (budget.points < d + 3) budget.points = jobs / (fitted * repeats);
        if (budget.points == 0) budget.points = 1;
    }
    const size_t start = (budget.points * repeats + budget.repeated) * fitted;
    budget.sets = d <= 2 ? 5 : d == 3 ? 7 : MOST_SETS;
    const size_t left = jobs > start ? (jobs - start) / all : 0;
    if (budget.sets > left) budget.sets = left;
    budget.explore = jobs > budget.sets * all ? jobs - budget.sets * all : 0;
    return budget;
}

/* Until its angle is known twice as well as the best of its targets, where the process can do so and the test doesn't say how long
 * it takes. */
static void shorten(const plan_request *request, size_t test, const process_type *type, json_t *inputs)
{
    double least = INFINITY;
    for (size_t m = 0; m < request->measures; m++)
        if (request->measure[m].test == test && strncmp(request->measure[m].pointer, "/repose/", 8) == 0)
            least = fmin(least, 0.5 * request->measure[m].error);
    if (!isfinite(least) || json_object_get(inputs, "duration")) return;
    const spec_field *until = spec_field_find(type->inputs, SPEC_DURATION, "until_standard_error_deg");
    if (!until) return;
    json_object_set_new(inputs, "duration",
                        json_pack("{s:f}", "until_standard_error_deg", fmin(fmax(least, until->minimum), until->maximum)));
}

static json_t *label_of(const json_t *document, const char *name)
{
    const json_t *given = json_object_get(document, "label"), *name_of_all = json_object_get(document, "name");
    json_t *label = json_is_object(given) ? json_deep_copy(given) : json_object();
    if (json_is_string(name_of_all)) json_object_set(label, "calibration", (json_t *)name_of_all);
    json_object_set_new(label, "case", json_string(name));
    return label;
}

/* Every run has a bed of its own: the seed follows from the calibration's and the run's number. */
static json_t *case_of(const plan_request *request, const json_t *document, const plan_run *run)
{
    char name[64];
    json_t *job = plan_test_request(request, run->test, run->value), *values = json_object();
    if (!job || !values) {
        json_decref(job);
        json_decref(values);
        return NULL;
    }
    const process_type *type = process_type_find(json_string_value(json_object_get(job, "process")));
    json_t *inputs = json_object_get(job, "inputs");
    const uint64_t seed = mix_bits(mix_bits(request->seed + 1) + (uint64_t)run->number) & LARGEST_WHOLE_NUMBER;
    if (spec_field_find(type->inputs, SPEC_INPUTS, "seed")) json_object_set_new(inputs, "seed", json_integer((json_int_t)seed));
    shorten(request, run->test, type, inputs);
    snprintf(name, sizeof name, "%s %lld, test %zu", plan_stage_names[run->stage], (long long)run->number, run->test);
    json_object_set_new(job, "label", label_of(document, name));
    for (size_t p = 0; p < request->parameters; p++)
        json_object_set_new(values, request->parameter[p].pointer, json_real(run->value[p]));
    return json_pack("{s:I, s:s, s:I, s:I, s:o, s:o}", "number", (json_int_t)run->number, "stage", plan_stage_names[run->stage],
                     "test", (json_int_t)run->test, "set", (json_int_t)run->set, "parameters", values, "request", job);
}

/* Adds the case at a place of the unit cube; the run's number goes on. */
static bool add_case(json_t *cases, const plan_request *request, const json_t *document, const double *x, plan_run *run)
{
    for (size_t p = 0; p < request->parameters; p++) run->value[p] = plan_from_cube(&request->parameter[p], x[p]);
    json_t *one = case_of(request, document, run);
    run->number++;
    return one && json_array_append_new(cases, one) == 0;
}

static json_t *whole_or_null(json_t *cases, bool is_whole)
{
    if (is_whole) return cases;
    json_decref(cases);
    return NULL;
}

/* A point with all its tests, and then the next; the first ones once more at the end. */
json_t *plan_cases_start(const plan_request *request, const json_t *document, const plan_budget *budget)
{
    json_t *cases = json_array();
    plan_run run = { .stage = STAGE_START };
    bool good = cases != NULL;
    for (size_t i = 0; i < budget->points + budget->repeated; i++) {
        double x[PLAN_MOST_PARAMETERS];
        for (size_t k = 0; k < request->parameters; k++) x[k] = even_point(request->seed, i % budget->points, (unsigned)k);
        for (int repeat = 0; repeat < request->repeats; repeat++)
            for (run.test = 0; good && run.test < request->tests; run.test++)
                if (request->test[run.test].use == PLAN_FITTED) good = add_case(cases, request, document, x, &run);
    }
    return whole_or_null(cases, good);
}

json_t *plan_cases_refine(const plan_fit *fit, const json_t *document, size_t count)
{
    json_t *cases = json_array();
    next_run *next = calloc(count + 1, sizeof *next);
    plan_run run = { .stage = STAGE_REFINE, .number = plan_table_next_number(fit->table) };
    bool good = cases && next;
    const size_t chosen = good ? next_runs_choose(fit, count, next) : 0;
    for (size_t i = 0; good && i < chosen; i++) {
        run.test = next[i].test;
        good = add_case(cases, fit->request, document, next[i].x, &run);
    }
    free(next);
    return whole_or_null(cases, good);
}

json_t *plan_cases_verify(const plan_fit *fit, const json_t *document, const double *sets, size_t count)
{
    const plan_request *request = fit->request;
    json_t *cases = json_array();
    plan_run run = { .stage = STAGE_VERIFY, .number = plan_table_next_number(fit->table) };
    bool good = cases != NULL;
    for (run.set = 0; run.set < count; run.set++)
        for (run.test = 0; good && run.test < request->tests; run.test++)
            good = add_case(cases, request, document, &sets[run.set * request->parameters], &run);
    return whole_or_null(cases, good);
}
