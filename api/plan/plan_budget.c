#include "plan_budget.h"

#include <assert.h>
#include <math.h>

#include "job_spec.h"

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

/* A test's job in the middle of the ranges: of a logarithmic one, the middle of the logarithm. */
static job_estimate estimate_of(const plan_request *request, size_t test, const calibration *machine)
{
    double values[PLAN_MOST_PARAMETERS];
    for (size_t p = 0; p < request->parameters; p++) {
        const plan_parameter *parameter = &request->parameter[p];
        values[p] = parameter->is_log ? sqrt(parameter->low * parameter->high) : 0.5 * (parameter->low + parameter->high);
    }
    json_t *job = plan_test_request(request, test, values);
    job_estimate estimate = { .steps = 0.0 };
    problem_list problems;
    job_spec spec;
    if (problem_list_init(&problems) && job && job_spec_parse(NULL, job, 1, &spec, &problems)) {
        estimate = job_spec_estimate(&spec, machine);
        job_spec_clear(&spec);
    }
    problem_list_clear(&problems);
    json_decref(job);
    return estimate;
}

plan_estimate plan_estimate_make(const plan_request *request, const calibration *machine)
{
    const plan_budget budget = plan_budget_make(request);
    const double fitted = (double)tests_for(request, true);
    plan_estimate sum = { .jobs = 0.0 };
    for (size_t t = 0; t < request->tests; t++) {
        const job_estimate one = estimate_of(request, t, machine);
        const double explored = request->test[t].use == PLAN_FITTED ? (double)budget.explore / fitted : 0.0;
        const double jobs = explored + (double)budget.sets;
        sum.jobs += jobs;
        sum.steps += jobs * fmax(one.steps, 0.0);
        sum.wall_seconds += jobs * fmax(one.wall_seconds, 0.0);
    }
    return sum;
}
