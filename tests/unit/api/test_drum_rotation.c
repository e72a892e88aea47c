/* Claims about the specification of a drum that turns in stages, is tilted, or has bars that lean. */
#include "dem_rules.h"
#include "requests.h"

/* The minimal drum with this in the place of its rotation_rate. */
static json_t *staged(const char *stages)
{
    json_t *request = minimal_with("drum/rotation", stages);
    json_object_del(json_object_get(json_object_get(request, "inputs"), "drum"), "rotation_rate");
    return request;
}

static void expect_of_stages(const char *stages, const char *expected)
{
    char *problems = problems_of(staged(stages));
    if (strcmp(problems, expected) != 0) fail_msg("%s gives:\n%sexpected:\n%s", stages, problems, expected);
    free(problems);
}

static void stages_say_how_long_the_drum_turns_and_at_which_rates(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(staged("[{\"rate\": 2, \"revolutions\": 1}, {\"rate\": 0, \"seconds\": 0.5}, "
                                         "{\"rate\": -4, \"seconds\": 2}]"));
    assert_int_equal(spec.scene.stage_count, 3);
    assert_true(fabs(spec.scene.stage[0].seconds - DEM_PI) < 1e-12 && spec.scene.stage[0].rate == 2);
    assert_true(spec.scene.stage[1].rate == 0 && spec.scene.stage[1].seconds == 0.5);
    assert_true(spec.scene.stage[2].rate == -4 && spec.scene.stage[2].seconds == 2);
    assert_true(fabs(spec.duration - (DEM_PI + 2.5)) < 1e-12);
    assert_true(spec.rotation_rate == -4 && spec.scene.rotation_rate == 4 && !spec.is_mirrored);
    /* frames enough for each: 64 in half a second */
    assert_true(spec.sample_interval <= 0.5 / 64);
    /* the canonical specification is read as itself */
    json_t *canonical = job_spec_to_json(&spec);
    job_spec again = parse_or_fail(json_incref(canonical));
    json_t *twice = job_spec_to_json(&again);
    assert_true(json_equal(canonical, twice));
    json_decref(canonical);
    json_decref(twice);
    job_spec_clear(&again);
    job_spec_clear(&spec);
}

/* The first that turns decides which image runs: of a staircase the other way, the mirror image of the staircase. */
static void stages_that_begin_the_other_way_run_as_the_mirror_image(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(staged("[{\"rate\": 0, \"seconds\": 1}, {\"rate\": -2, \"seconds\": 1}, "
                                         "{\"rate\": 3, \"seconds\": 1}]"));
    assert_true(spec.is_mirrored && spec.scene.stage[1].rate == 2 && spec.scene.stage[2].rate == -3);
    job_spec_clear(&spec);
}

static void stages_that_make_no_sense_are_refused_all_at_once(void **state)
{
    (void)state;
    expect_of_stages("[]", "/inputs/drum/rotation: has 0 entries; must have 1 to 64\n");
    expect_of_stages(
        "[{\"rate\": 0, \"revolutions\": 1}, {\"rate\": 1}, {\"rate\": 0.0001, \"seconds\": 1}]",
        "/inputs/drum/rotation/0: has a rate of 0 and revolutions, which take for ever; give its seconds\n"
        "/inputs/drum/rotation/1: has neither revolutions nor seconds in their ranges; must say by one of them how long it "
        "is\n"
        "/inputs/drum/rotation/2/rate: is 0.0001 rad/s; must be 0 or at least 0.001 rad/s in size\n");
    expect_of_stages("[{\"rate\": 0, \"seconds\": 1}]",
                     "/inputs/drum/rotation: has no stage in which the drum turns; must have one at least\n");
    expect_of_stages("[{\"rate\": 600, \"seconds\": 1}]",
                     "/inputs/drum/rotation/0/rate: is 600 rad/s; must be in [-500, 500] rad/s\n");
    expect_of_stages("[{\"rate\": 2, \"seconds\": 1, \"revolutions\": 1}]",
                     "/inputs/drum/rotation/0/revolutions: is given beside seconds; give one of the two\n");
    expect_problem("drum/rotation", "[{\"rate\": 2, \"seconds\": 1}]",
                   "/inputs/drum/rotation_rate: is given beside rotation; give one of the two\n");
    json_t *both = staged("[{\"rate\": 2, \"seconds\": 1}]");
    json_object_set_new(json_object_get(both, "inputs"), "duration", json_pack("{s:f}", "revolutions", 1.25));
    char *problems = problems_of(both);
    assert_string_equal(problems,
                        "/inputs/duration/revolutions: is given beside /inputs/drum/rotation, whose stages say how long the "
                        "drum turns; give one of the two\n");
    free(problems);
}

static void a_drum_with_ends_may_be_tilted(void **state)
{
    (void)state;
    json_t *request = minimal_with("drum/tilt_deg", "30");
    json_object_set_new(json_object_get(json_object_get(request, "inputs"), "drum"), "ends", json_string("walls"));
    job_spec spec = parse_or_fail(request);
    assert_true(fabs(spec.scene.tilt - DEM_PI / 6) < 1e-15);
    job_spec_clear(&spec);
    expect_problem(
        "drum/tilt_deg", "30",
        "/inputs/drum/tilt_deg: is 30 degrees, but the drum's ends are periodic, so that nothing holds the bed along the "
        "axis; give /inputs/drum/ends as \"walls\", too\n");
    expect_problem("drum/tilt_deg", "61", "/inputs/drum/tilt_deg: is 61 degrees; must be in [0, 60] degrees\n");
    expect_fine("drum/tilt_deg", "0");
}

/* The drum of `minimal` is 50 mm across, with 5 mm spheres: at 45 degrees a bar's top is 17.68 mm less its height from the axis along
 * its own direction, of which 7.5 mm must be left. */
static void bars_may_lean(void **state)
{
    (void)state;
    static const char bars[] = "{\"count\": 3, \"height\": %s, \"width\": 0.002, \"angle_deg\": %s}";
    char text[200];
    snprintf(text, sizeof text, bars, "0.006", "45");
    job_spec spec = parse_or_fail(minimal_with("drum/lifters", text));
    assert_true(fabs(spec.scene.lifters.angle - DEM_PI / 4) < 1e-15);
    job_spec_clear(&spec);
    json_t *back = minimal_with("drum/lifters", text);
    json_object_set_new(json_object_get(json_object_get(back, "inputs"), "drum"), "rotation_rate", json_real(-3));
    spec = parse_or_fail(back);
    assert_true(fabs(spec.scene.lifters.angle + DEM_PI / 4) < 1e-15); /* the mirror image */
    job_spec_clear(&spec);
    snprintf(text, sizeof text, bars, "0.0105", "45");
    expect_problem(
        "drum/lifters", text,
        "/inputs/drum/lifters/height: is 0.0105 m; must be at most 0.0101777 m, the radius times the cosine of angle_deg "
        "less 1.5 of the largest particle diameters\n");
    snprintf(text, sizeof text, bars, "0.004", "-61");
    expect_problem("drum/lifters", text, "/inputs/drum/lifters/angle_deg: is -61 degrees; must be in [-60, 60] degrees\n");
    /* 40 of them, 3.9 mm from foot to foot, lean by 45 degrees: the gap across is no more than 2.8 mm */
    expect_fine("drum/lifters", "{\"count\": 40, \"height\": 0.003, \"width\": 0.001, \"angle_deg\": 45}");
    char *problems =
        problems_of(minimal_with("drum/lifters", "{\"count\": 40, \"height\": 0.003, \"width\": 0.0028, \"angle_deg\": 45}"));
    assert_non_null(strstr(problems, "/inputs/drum/lifters/width: is 0.0028 m; must be at most "));
    free(problems);
}

UNIT_TESTS(stages_say_how_long_the_drum_turns_and_at_which_rates, stages_that_begin_the_other_way_run_as_the_mirror_image,
           stages_that_make_no_sense_are_refused_all_at_once, a_drum_with_ends_may_be_tilted, bars_may_lean)
