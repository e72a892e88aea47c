#include <math.h>

#include "plan_budget.h"

static void check_test(const plan_request *request, size_t test, const calibration *machine, const post_limits *limits,
                       problem_list *problems, problem_list *warnings)
{
    problem_list wrong, unusual;
    job_spec spec;
    if (!problem_list_init(&wrong)) return;
    if (problem_list_init(&unusual) && plan_middle_spec(request, test, &spec, &wrong)) {
        const job_estimate one = job_spec_estimate(&spec, machine);
        if (limits) job_check_limits(limits, "/inputs", NAN, one.particles, NAN, spec.threads, &wrong);
        if (limits) job_resources_check_allowed(spec.resources, &limits->resources, &wrong);
        job_spec_warn(&spec, machine, &unusual);
        plan_tell(request, test, &wrong, problems);
        plan_tell(request, test, &unusual, warnings);
        job_spec_clear(&spec);
    }
    problem_list_clear(&unusual);
    problem_list_clear(&wrong);
}

void plan_check(const plan_request *request, const calibration *machine, const post_limits *limits, double free_bytes,
                problem_list *problems, problem_list *warnings)
{
    const plan_estimate all = plan_estimate_make(request, machine);
    for (size_t t = 0; t < request->tests; t++) check_test(request, t, machine, limits, problems, warnings);
    if (limits) job_check_limits(limits, "/base/inputs", all.wall_seconds, NAN, all.snapshot_bytes, NAN, problems);
    job_check_disk(all.disk_bytes, free_bytes, "/base/inputs/snapshots/interval", problems);
}
