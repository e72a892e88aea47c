#include "plan_cases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "even_points.h"
#include "json_text.h"
#include "process_type.h"

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

json_t *plan_cases_verify(const plan_fit *fit, const json_t *document, const double *sets, size_t count, bool with_own)
{
    const plan_request *request = fit->request;
    json_t *cases = json_array();
    plan_run run = { .stage = STAGE_VERIFY, .number = plan_table_next_number(fit->table) };
    bool good = cases != NULL;
    for (run.set = 0; run.set < count; run.set++)
        for (run.test = 0; good && run.test < request->tests; run.test++)
            if (with_own || !request->test[run.test].is_own)
                good = add_case(cases, request, document, &sets[run.set * request->parameters], &run);
    return whole_or_null(cases, good);
}
