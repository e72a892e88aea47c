#include "plan_budget.h"

#include <assert.h>
#include <math.h>

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

static job_estimate estimate_of(const plan_request *request, size_t test, const calibration *machine)
{
    job_estimate estimate = { .steps = 0.0 };
    problem_list problems;
    job_spec spec;
    if (!problem_list_init(&problems)) return estimate;
    if (plan_middle_spec(request, test, &spec, &problems)) {
        estimate = job_spec_estimate(&spec, machine);
        job_spec_clear(&spec);
    }
    problem_list_clear(&problems);
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
        sum.snapshot_bytes += jobs * fmax(one.snapshot_bytes, 0.0);
        sum.disk_bytes += jobs * job_estimate_disk_bytes(&one);
    }
    return sum;
}

json_t *plan_estimate_to_json(const plan_estimate *estimate)
{
    char words[TIME_IN_WORDS_SIZE];
    time_in_words(estimate->wall_seconds, words);
    return json_pack("{s:I, s:I, s:f, s:s, s:I}", "jobs", (json_int_t)(estimate->jobs + 0.5), "steps", (json_int_t)estimate->steps,
                     "wall_seconds", estimate->wall_seconds, "wall_time", words, "snapshot_bytes",
                     (json_int_t)estimate->snapshot_bytes);
}
