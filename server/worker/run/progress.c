#include "progress.h"

#include <math.h>
#include <time.h>

#include "dem_rules.h"

#define SECONDS_BETWEEN_REPORTS 1.0
/* Weight of the newest second in the speed: a run's speed changes as its bed loosens, but not by the second. */
#define NEWEST_WEIGHT 0.3
#define SHORT_RUN_SECONDS 0.05
/* Large beds take several steps in one pass, if they may. */
#define LONGEST_RUN_SECONDS 1.0
enum { FEWEST_STEPS = 20 };

double monotonic_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int64_t steps_of_all(const dem_scene *const *scene, size_t beds)
{
    int64_t steps = 0;
    for (size_t k = 0; k < beds; k++) steps += dem_scene_step_count(scene[k]);
    return steps;
}

void progress_init(progress *run, const job_spec *spec, const schedule *plan, const dem_scene *const *scene, double earlier_seconds)
{
    const job_estimate estimate = job_spec_estimate(spec, NULL);
    const double now = monotonic_seconds(), settling = dem_settling_time(&spec->scene) / spec->scene.time_step;
    const bool may_end_early = spec->scene.container != DEM_DRUM;
    *run = (progress){
        .started = now,
        .last_report = now,
        .earlier_seconds = earlier_seconds,
        .spheres = (double)dem_scene_sphere_count(scene[0]),
        .may_end_early = may_end_early,
        .settling_steps = settling,
        .rotation_steps = may_end_early ? fmax(1.0, estimate.steps - settling) : (double)plan->rotation_steps,
        .last_step = steps_of_all(scene, spec->bed_count),
        .beds_at_once = job_beds_at_once(spec),
    };
}

/* Share of a part of the run of which so many of the steps expected are done: nine tenths as the estimate has it, and
 * what takes longer comes ever nearer to the end of its part. */
static double share_of_expected(double done) { return done < 0.9 ? done : 1.0 - 0.1 * exp(-(done - 0.9) / 0.1); }

/* A number between 0 and 1 that follows from the scene's phase and step alone and grows with them, whatever the bed really
 * took: making the bed and the rest of the run have the shares of the whole that they are estimated to have. */
static double share_done(const progress *run, const dem_scene *scene)
{
    const double whole = run->settling_steps + run->rotation_steps, of_settling = run->settling_steps / whole;
    const double step = (double)dem_scene_step_count(scene), start = (double)dem_scene_run_start(scene);
    if (start < 0) return run->settling_steps > 0 ? of_settling * share_of_expected(step / run->settling_steps) : 0.0;
    const double done = (step - start) / run->rotation_steps;
    return of_settling + (1.0 - of_settling) * (run->may_end_early ? share_of_expected(done) : fmin(done, 1.0));
}

bool progress_is_due(progress *run, const dem_scene *const *scene, size_t beds, progress_report *report)
{
    const double now = monotonic_seconds(), passed = now - run->last_report;
    if (passed < SECONDS_BETWEEN_REPORTS) return false;
    const int64_t step = steps_of_all(scene, beds);
    const double speed = (double)(step - run->last_step) / passed;
    run->steps_per_second =
        run->steps_per_second > 0.0 ? (1.0 - NEWEST_WEIGHT) * run->steps_per_second + NEWEST_WEIGHT * speed : speed;
    run->last_step = step;
    run->last_report = now;

    double share = 0.0;
    for (size_t k = 0; k < beds; k++) share += share_done(run, scene[k]) / (double)beds;
    *report = (progress_report){
        .percent = 100.0 * share,
        .eta_seconds = (double)beds * (1.0 - share) * (run->settling_steps + run->rotation_steps) / run->steps_per_second,
        .particle_steps_per_second = run->spheres * run->steps_per_second,
    };
    return true;
}

double progress_wall_seconds(const progress *run) { return run->earlier_seconds + monotonic_seconds() - run->started; }

int64_t progress_short_run(const progress *run)
{
    /* A cautious guess until the first report. */
    const double one = run->steps_per_second / run->beds_at_once;
    const double speed = one > 0.0 ? one : 1e6 / fmax(run->spheres, 1.0);
    const double fewest = fmax(1.0, fmin(FEWEST_STEPS, speed * LONGEST_RUN_SECONDS));
    return (int64_t)fmax(fewest, fmin(1e6, speed * SHORT_RUN_SECONDS));
}
