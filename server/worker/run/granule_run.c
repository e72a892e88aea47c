#include "granule_run.h"

#include <math.h>
#include <stdio.h>

#include "failure_report.h"
#include "granule_result.h"
#include "progress.h"
#include "worker_log.h"

static bool tell_start(const job_context *job)
{
    return event_log_add(job->events, json_pack("{s:s, s:i, s:b, s:i, s:f, s:i}", "event", "start", "attempt",
                                                job->options->attempt, "resumed", 0, "step", 0, "time", 0.0, "particles", 1));
}

enum worker_exit granule_run(const job_context *job)
{
    const double started = monotonic_seconds();
    if (!tell_start(job)) return WORKER_DISK;
    dem_granule_result solved;
    const dem_status status = dem_granule_solve(&job->spec->granule, &solved);
    if (status != DEM_OK) return failure_report(job->events, status, NULL);
    const run_facts facts = {
        .particles = 1, .wall_seconds = monotonic_seconds() - started, .threads = 1, .attempt = job->options->attempt
    };
    granule_result result;
    granule_result_set(&result, &solved, &facts);
    worker_log("least omega^2 R/g %.9g, found in %.3f s", solved.minimum_omega2, facts.wall_seconds);
    return job_run_write_result(job->spec, job->events, granule_result_to_json(&result));
}

static double number_at(const json_t *result, const char *name)
{
    const json_t *value = json_object_get(json_object_get(result, "granule"), name);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

void granule_summary(const json_t *result, const char *folder)
{
    const char *regime = json_string_value(json_object_get(json_object_get(result, "regime"), "name"));
    printf("least rate        %.6g rad/s, omega^2 R/g = %.9g +- %.1g\n", number_at(result, "minimum_rotation_rate"),
           number_at(result, "minimum_omega2"), number_at(result, "error"));
    printf("slip at that rate %.4g rad a revolution, from %.2f degrees above the horizontal\n",
           number_at(result, "slip_per_revolution"), number_at(result, "slip_onset_deg"));
    if (regime) printf("at the rate given %s\n", regime);
    printf("file              %s/%s\n", folder, JOB_RESULT_FILE);
}
