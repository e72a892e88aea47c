/* Claims about how far a run says that it is: the share grows while the bed grows and settles and the test runs, is the same
 * after an interruption, and is as large as the time that passed says. */
#include "claims.h"
#include "dem_rules.h"
#include "progress.h"

static const char drum[] = "{\"inputs\": {\"drum\": {\"diameter\": 0.03, \"length\": 0.0095, \"rotation_rate\": 6}, "
                           "\"particles\": [{\"diameter\": 0.003}], \"particle_count\": 60, \"contact\": {\"maximum_overlap\": "
                           "0.05}, \"duration\": {\"seconds\": 0.15}}}";
static const char heap[] =
    "{\"inputs\": {\"tube\": {\"diameter\": 0.016, \"lift_speed\": 0.1}, \"particles\": [{\"diameter\": 0.003}], "
    "\"particle_count\": 100, \"contact\": {\"friction\": 0.5, \"maximum_overlap\": 0.05}}}";
static const char loose_cubes[] =
    "{\"inputs\": {\"drum\": {\"diameter\": 0.066, \"length\": 0.025, \"rotation_rate\": 6}, \"contact\": {\"maximum_overlap\": "
    "0.05}, "
    "\"particles\": [{\"shape\": \"cube\", \"diameter\": 0.003}], \"particle_count\": 12, \"duration\": {\"seconds\": 0.1}}}";

static job_spec spec_of(const char *process, const char *text)
{
    json_t *request = json_loads(text, 0, NULL);
    job_spec spec;
    problem_list problems;
    assert_true(problem_list_init(&problems));
    if (!job_spec_parse(process, request, 1, &spec, &problems)) fail_msg("%s", json_dumps(problems.errors, 0));
    problem_list_clear(&problems);
    json_decref(request);
    return spec;
}

/* As if more than the second between two reports had passed. */
static double percent_now(progress *run, const dem_scene *scene)
{
    progress_report report;
    run->last_report -= 2.0;
    assert_true(progress_is_due(run, &scene, 1, &report));
    assert_true(report.percent >= 0.0 && report.percent <= 100.0);
    return report.percent;
}

/* Advances by so many steps, forty times, and holds each report to the one before; returns the last. */
static double advance(progress *run, const job_spec *spec, dem_scene *scene, int64_t steps, double percent)
{
    const schedule plan = schedule_of(spec);
    for (int k = 0; k < 40; k++) {
        assert_int_equal(dem_scene_advance(scene, steps / 40 + 1), DEM_OK);
        const double now = percent_now(run, scene);
        progress interrupted;
        progress_init(&interrupted, spec, &plan, (const dem_scene *const[]){ scene }, 0.0);
        const double after_interruption = percent_now(&interrupted, scene);
        if (!(now > percent)) fail_msg("%.15g %% after %.15g %% at step %ld", now, percent, (long)dem_scene_step_count(scene));
        assert_true(after_interruption == now);
        percent = now;
    }
    return percent;
}

/* The last percent at the estimated end of the run. */
static double percent_at_the_estimated_end(const char *process, const char *text, bool and_beyond)
{
    job_spec spec = spec_of(process, text);
    const double steps = job_spec_estimate(&spec, NULL).steps;
    const int64_t settling = (int64_t)(dem_settling_time(&spec.scene) / spec.scene.time_step);
    dem_scene *scene;
    assert_int_equal(dem_scene_create(&spec.scene, &scene), DEM_OK);
    const schedule plan = schedule_of(&spec);
    progress run;
    progress_init(&run, &spec, &plan, (const dem_scene *const[]){ scene }, 0.0);
    double percent = 0.0;
    while (dem_scene_run_start(scene) < 0) percent = advance(&run, &spec, scene, settling / 4, percent);
    const int64_t left = dem_scene_run_start(scene) + (int64_t)steps - settling - dem_scene_step_count(scene);
    percent = advance(&run, &spec, scene, left, percent);
    if (and_beyond) assert_true(advance(&run, &spec, scene, (int64_t)(0.2 * steps), percent) <= 100.0);
    dem_scene_free(scene);
    job_spec_clear(&spec);
    return percent;
}

static void a_drums_progress_grows_to_the_whole(void **state)
{
    (void)state;
    assert_true(percent_at_the_estimated_end("drum", drum, false) > 99.0);
    assert_true(percent_at_the_estimated_end("drum", loose_cubes, false) > 99.0);
}

/* It may take longer than estimated, and ends before the time that it may take at most. */
static void a_heaps_progress_grows_with_what_it_is_estimated_to_take(void **state)
{
    (void)state;
    const double percent = percent_at_the_estimated_end("heap", heap, true);
    assert_true(percent > 80.0 && percent < 100.0);
}

UNIT_TESTS(a_drums_progress_grows_to_the_whole, a_heaps_progress_grows_with_what_it_is_estimated_to_take)
