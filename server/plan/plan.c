#include "plan.h"

#include <math.h>
#include <string.h>

#include "answer.h"
#include "family.h"
#include "json_text.h"
#include "plan_cases.h"
#include "shape.h"
#include "spec_text.h"

enum { DRAWS_TO_PLAN = 600, DRAWS_TO_ANSWER = 2000, MOST_WORKERS = 256 };

typedef struct planning {
    const json_t *document; /* the request as it was posted */
    plan_request request;
    plan_table table;
    plan_budget budget;
    size_t workers;
} planning;

/* By the clock, so far and with the verification to come, were the workers at work all the time. */
static bool is_out_of_time(const planning *p)
{
    double sum = 0.0;
    for (size_t i = 0; i < p->table.count; i++) sum += plan_run_number(&p->table.run[i], "wall_seconds", 0.0);
    const double mean = p->table.count ? sum / (double)p->table.count : 0.0;
    const double to_come = mean * (double)(p->budget.sets * p->request.tests);
    return (sum + to_come) / (double)p->workers >= p->request.most_seconds;
}

static json_t *progress_of(const planning *p, const plan_fit *fit)
{
    json_t *errors = json_array();
    for (size_t v = 0; fit && v < fit->values; v++) {
        const size_t m = fit->measure_of[v];
        json_array_append_new(errors,
                              json_pack("{s:s, s:o, s:f}", "target", p->request.measure[m].name, "emulator_error",
                                        json_real_or_null(fit->error_in[m]), "wanted", PLAN_ENOUGH * fit->measured[v].error));
    }
    return json_pack("{s:I, s:I, s:I, s:o}", "runs", (json_int_t)p->table.count, "waiting", (json_int_t)p->table.waiting, "at_most",
                     (json_int_t)p->request.most_jobs, "emulators", errors);
}

/* errors: takes the reference of cases; NULL, with all of it, where there was no memory. */
static json_t *plan_of(const planning *p, const char *state, const char *stage, json_t *cases, const plan_fit *fit)
{
    if (!cases) return NULL;
    return json_pack("{s:s, s:s, s:o, s:o}", "state", state, "stage", stage, "cases", cases, "progress", progress_of(p, fit));
}

/* More runs of the tests, or NULL: they are enough, or there are no more to be had. */
static json_t *refine(const planning *p, const plan_fit *fit)
{
    const size_t used = p->table.count;
    if (plan_table_count(&p->table, STAGE_VERIFY) > 0 || used >= p->budget.explore || is_out_of_time(p)) return NULL;
    if (plan_fit_is_enough(fit, 1.0) || fit->values == 0) return NULL;
    const size_t left = p->budget.explore - used, count = left < p->workers ? left : p->workers;
    json_t *cases = plan_cases_refine(fit, p->document, count);
    if (json_array_size(cases) > 0) return plan_of(p, "runs", "refine", cases, fit);
    json_decref(cases);
    return NULL;
}

/* A test that nobody asked for is worth its runs where something is left to be settled. */
static json_t *verify(const planning *p, const plan_fit *fit, const double *sets, size_t count)
{
    shape found;
    if (!shape_measure(fit, &found)) return NULL;
    const bool with_own = !shape_is_identified(&found, p->request.parameters);
    return plan_of(p, "runs", "verify", plan_cases_verify(fit, p->document, sets, count, with_own), fit);
}

/* The answer, or the runs that verify it. */
static json_t *conclude(const planning *p)
{
    plan_fit fit;
    json_t *plan = NULL;
    if (plan_fit_make(&fit, &p->request, &p->table, DRAWS_TO_ANSWER)) {
        double sets[FAMILY_MOST * PLAN_MOST_PARAMETERS];
        const size_t count = family_choose(&fit, p->budget.sets, sets);
        const bool is_verified = plan_table_count(&p->table, STAGE_VERIFY) > 0;
        if (count > 0 && fit.values > 0 && !is_verified) {
            plan = verify(p, &fit, sets, count);
        } else {
            plan = plan_of(p, "done", "verify", json_array(), &fit);
            json_t *answer = plan ? answer_make(&fit, sets, is_verified ? count : 0) : NULL;
            if (plan && (!answer || json_object_set_new(plan, "answer", answer) != 0)) {
                json_decref(plan);
                plan = NULL;
            }
        }
    }
    plan_fit_clear(&fit);
    return plan;
}

static json_t *decide(const planning *p)
{
    if (p->table.waiting > 0)
        return plan_of(p, "waits", plan_stage_names[p->table.run[p->table.count - 1].stage], json_array(), NULL);
    if (p->table.count == 0) return plan_of(p, "runs", "start", plan_cases_start(&p->request, p->document, &p->budget), NULL);
    plan_fit fit;
    const bool is_made = plan_fit_make(&fit, &p->request, &p->table, DRAWS_TO_PLAN);
    json_t *plan = is_made ? refine(p, &fit) : NULL;
    plan_fit_clear(&fit);
    if (plan || !is_made) return plan;
    return conclude(p);
}

static bool read_workers(const json_t *workers, size_t *count, problem_list *problems)
{
    *count = 2;
    if (!workers) return true;
    if (json_is_integer(workers) && json_integer_value(workers) >= 1 && json_integer_value(workers) <= MOST_WORKERS) {
        *count = (size_t)json_integer_value(workers);
        return true;
    }
    problem_list_add(problems, "/workers", "must be a whole number in [1, %d]: how many jobs run at once", MOST_WORKERS);
    return false;
}

/* The problems of the request, below "/request". */
static void tell_of_request(const problem_list *found, problem_list *problems)
{
    size_t i;
    json_t *one;
    json_array_foreach(found->errors, i, one)
    {
        char place[2 * LONGEST_POINTER];
        snprintf(place, sizeof place, "/request%.250s", json_string_value(json_object_get(one, "pointer")));
        problem_list_add(problems, place, "%s", json_string_value(json_object_get(one, "detail")));
    }
}

json_t *plan_next(const json_t *document, problem_list *problems)
{
    static const char *const known[] = { "request", "runs", "workers", NULL };
    planning p = { .document = json_object_get(document, "request") };
    problem_list found;
    json_t *plan = NULL;
    if (!json_is_object(document) || !p.document) {
        problem_list_add(problems, "", "must be an object with \"request\" and, once there are some, \"runs\"");
        return NULL;
    }
    refuse_unknown_members(document, "", known, problems);
    if (!problem_list_init(&found)) return NULL;
    const bool is_request = plan_request_parse(p.document, &p.request, &found);
    tell_of_request(&found, problems);
    problem_list_clear(&found);
    if (read_workers(json_object_get(document, "workers"), &p.workers, problems) && is_request
        && plan_table_read(&p.request, json_object_get(document, "runs"), &p.table, problems)) {
        p.budget = plan_budget_make(&p.request);
        plan = decide(&p);
    }
    plan_table_clear(&p.table);
    plan_request_clear(&p.request);
    return plan;
}
