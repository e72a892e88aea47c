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

void progress_init(progress *run, const job_spec *spec, const schedule *plan, const dem_scene *scene, double earlier_seconds)
{
    const dem_drum_definition *drum = &spec->drum;
    const double now = monotonic_seconds();
    *run = (progress){
        .started = now,
        .last_report = now,
        .earlier_seconds = earlier_seconds,
        .spheres = (double)dem_scene_sphere_count(scene),
        .settling_steps_expected = dem_settling_time_estimate(drum->diameter, drum->gravity) / drum->time_step,
        .rotation_steps = (double)plan->rotation_steps,
        .last_step = dem_scene_step_count(scene),
    };
}

/* Steps of the whole run: once rotation has begun they are known, before that they are a guess that grows when
 * the bed takes longer to settle. */
static double total_steps(const progress *run, const dem_scene *scene)
{
    const int64_t rotation_start = dem_scene_rotation_start(scene);
    if (rotation_start >= 0) return (double)rotation_start + run->rotation_steps;
    return fmax(run->settling_steps_expected, (double)dem_scene_step_count(scene)) + run->rotation_steps;
}

bool progress_is_due(progress *run, const dem_scene *scene, progress_report *report)
{
    const double now = monotonic_seconds(), passed = now - run->last_report;
    if (passed < SECONDS_BETWEEN_REPORTS) return false;
    const int64_t step = dem_scene_step_count(scene);
    const double speed = (double)(step - run->last_step) / passed;
    run->steps_per_second =
        run->steps_per_second > 0.0 ? (1.0 - NEWEST_WEIGHT) * run->steps_per_second + NEWEST_WEIGHT * speed : speed;
    run->last_step = step;
    run->last_report = now;

    const double total = total_steps(run, scene);
    run->last_percent = fmax(run->last_percent, 100.0 * (double)step / total);
    *report = (progress_report){
        .percent = run->last_percent,
        .eta_seconds = (total - (double)step) / run->steps_per_second,
        .particle_steps_per_second = run->spheres * run->steps_per_second,
    };
    return true;
}

double progress_wall_seconds(const progress *run) { return run->earlier_seconds + monotonic_seconds() - run->started; }

int64_t progress_short_run(const progress *run)
{
    /* A cautious guess until the first report. */
    const double speed = run->steps_per_second > 0.0 ? run->steps_per_second : 1e6 / fmax(run->spheres, 1.0);
    const double fewest = fmax(1.0, fmin(FEWEST_STEPS, speed * LONGEST_RUN_SECONDS));
    return (int64_t)fmax(fewest, fmin(1e6, speed * SHORT_RUN_SECONDS));
}
