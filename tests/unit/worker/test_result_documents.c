/* Claims about the results documents of a drum and of a granule. */
#include "claims.h"
#include "drum_result.h"
#include "granule_result.h"

static void what_was_not_measured_is_null(void **state)
{
    (void)state;
    drum_result result;
    drum_result_init(&result);
    json_t *document = drum_result_to_json(&result, 1);
    assert_true(json_is_null(json_object_get(json_object_get(document, "repose"), "angle_deg")));
    assert_true(json_is_null(json_object_get(json_object_get(document, "regime"), "name")));
    assert_true(json_is_null(json_object_get(json_object_get(document, "run"), "steps")));
    json_decref(document);
}

static void results_stand_under_their_own_names(void **state)
{
    (void)state;
    drum_result result;
    drum_result_init(&result);
    result.measured.repose.angle[DEM_SURFACE_FIT].mean_deg = 22.5;
    result.measured.repose.angle[DEM_CHORD].mean_deg = 23.5;
    result.measured.regime.predicted_stationary = 2.5;
    result.measured.regime.regime = DEM_ROLLING;
    result.has_regime = true;
    result.run.seed = 9007199254740991.0;
    json_t *document = drum_result_to_json(&result, 1);
    json_t *repose = json_object_get(document, "repose"), *regime = json_object_get(document, "regime");
    assert_true(json_real_value(json_object_get(repose, "angle_deg")) == 22.5);
    assert_true(json_real_value(json_object_get(json_object_get(repose, "other_methods"), "chord")) == 23.5);
    assert_null(json_object_get(json_object_get(repose, "other_methods"), "surface-fit"));
    assert_true(json_real_value(json_object_get(json_object_get(regime, "predicted"), "stationary_eq33")) == 2.5);
    assert_string_equal(json_string_value(json_object_get(regime, "name")), "rolling");
    assert_int_equal(json_integer_value(json_object_get(json_object_get(document, "run"), "seed")), 9007199254740991);
    json_decref(document);
}

/* A drum's results of its own numbers: of bed k, mean k and so on. */
static drum_result bed_of(int k, dem_regime regime, double error)
{
    drum_result r;
    drum_result_init(&r);
    r.measured.repose.angle[DEM_SURFACE_FIT] = (dem_angle){ 20 + k, error, 10 - k, 30 + k };
    r.measured.repose.angle[DEM_CHORD] = (dem_angle){ 21 + k, error, NAN, NAN };
    r.measured.repose.frames = 100;
    r.measured.repose.verdict = DEM_TOO_FEW;
    r.measured.repose.slumps.count = k == 1 ? NAN : 2;
    r.measured.regime.regime = regime;
    r.measured.regime.is_certain = true;
    r.has_regime = true;
    r.run = (run_facts){ .steps = 1000 + k, .maximum_overlap = 0.01 * k, .seed = 7 + k, .particles = 500, .ended_by = "duration" };
    return r;
}

static double number_at(const json_t *document, const char *output, const char *name)
{
    return json_number_value(json_object_get(json_object_get(document, output), name));
}

static void several_beds_are_told_as_their_rows_say(void **state)
{
    (void)state;
    drum_result bed[3] = { bed_of(0, DEM_SLUMPING, 3), bed_of(1, DEM_ROLLING, 3), bed_of(2, DEM_ROLLING, 3) };
    json_t *document = drum_result_to_json(bed, 3);
    const json_t *repose = json_object_get(document, "repose"), *beds = json_object_get(repose, "beds");
    CHECK_NEAR(number_at(document, "repose", "angle_deg"), 21, 1e-12);
    CHECK_NEAR(number_at(document, "repose", "standard_error_deg"), 3 / sqrt(3), 1e-12);
    CHECK_NEAR(json_number_value(json_object_get(json_object_get(repose, "other_methods"), "chord")), 22, 1e-12);
    CHECK_NEAR(json_number_value(json_object_get(json_object_get(repose, "other_methods_standard_error_deg"), "chord")), sqrt(3),
               1e-12);
    CHECK_NEAR(number_at(document, "repose", "minimum_deg"), 8, 0);
    CHECK_NEAR(number_at(document, "repose", "maximum_deg"), 32, 0);
    assert_int_equal(number_at(document, "repose", "frames"), 300);
    assert_int_equal(json_integer_value(json_object_get(json_object_get(repose, "slumps"), "count")), 4);
    assert_int_equal(number_at(document, "run", "steps"), 3003);
    assert_int_equal(number_at(document, "run", "particles"), 500);
    CHECK_NEAR(number_at(document, "run", "maximum_overlap"), 0.02, 0);
    assert_int_equal(number_at(document, "run", "seed"), 7);
    assert_string_equal(json_string_value(json_object_get(repose, "verdict")), "too-few");
    assert_string_equal(json_string_value(json_object_get(json_object_get(document, "regime"), "name")), "rolling");
    assert_true(json_is_false(json_object_get(json_object_get(document, "regime"), "certain")));
    assert_int_equal(json_array_size(beds), 3);
    for (size_t k = 0; k < 3; k++) {
        const json_t *one = json_array_get(beds, k);
        assert_int_equal(json_integer_value(json_object_get(one, "seed")), 7 + k);
        CHECK_NEAR(json_number_value(json_object_get(one, "angle_deg")), 20 + (double)k, 0);
    }
    json_decref(document);
}

static const json_t *at(const json_t *document, const char *output, const char *group, const char *name)
{
    const json_t *object = json_object_get(document, output);
    return json_object_get(group ? json_object_get(object, group) : object, name);
}

static void a_granules_results_are_null_where_no_rate_was_given(void **state)
{
    (void)state;
    dem_granule_definition d = {
        .friction = 1.0, .radius = 0.1, .gravity = 9.81, .rotation_rate = NAN, .revolutions = 2, .tolerance = 1e-9
    };
    dem_granule_result solved;
    granule_result result;
    const run_facts run = { .particles = 1, .wall_seconds = 0.25, .threads = 1, .attempt = 2 };
    for (int asked = 0; asked < 2; asked++) {
        if (asked) d.rotation_rate = sqrt(1.2 * 9.81 / 0.1); /* below the least, 1.319 */
        assert_int_equal(dem_granule_solve(&d, &solved), DEM_OK);
        granule_result_set(&result, &solved, &run);
        json_t *document = granule_result_to_json(&result);
        assert_true(json_real_value(at(document, "granule", NULL, "minimum_omega2")) == solved.minimum_omega2);
        assert_true(json_real_value(at(document, "granule", "fits", "sliding_eq34")) == solved.sliding_eq34);
        assert_true(json_real_value(at(document, "granule", "deviations", "sliding_eq34")) == solved.sliding_deviation_eq34);
        /* 24 degrees: where cos/(1.319 - sin) reaches 1 */
        assert_true(fabs(json_real_value(at(document, "granule", NULL, "slip_onset_deg")) - 24) < 0.5);
        assert_int_equal(json_integer_value(at(document, "run", NULL, "attempt")), 2);
        if (asked) assert_string_equal(json_string_value(at(document, "regime", NULL, "name")), "raining");
        else assert_true(json_is_null(at(document, "regime", NULL, "name")));
        assert_true(asked ? json_is_false(at(document, "regime", "evidence", "keeps_contact"))
                          : json_is_null(at(document, "regime", "evidence", "keeps_contact")));
        assert_true(json_is_null(at(document, "regime", "evidence", "slip_per_revolution"))); /* none completed */
        json_decref(document);
    }
}

UNIT_TESTS(what_was_not_measured_is_null, results_stand_under_their_own_names, several_beds_are_told_as_their_rows_say,
           a_granules_results_are_null_where_no_rate_was_given)
