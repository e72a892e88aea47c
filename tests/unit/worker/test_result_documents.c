/* Claims about the results documents of a drum and of a granule. */
#include "claims.h"
#include "drum_result.h"
#include "granule_result.h"

static void what_was_not_measured_is_null(void **state)
{
    (void)state;
    drum_result result;
    drum_result_init(&result);
    json_t *document = drum_result_to_json(&result);
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
    json_t *document = drum_result_to_json(&result);
    json_t *repose = json_object_get(document, "repose"), *regime = json_object_get(document, "regime");
    assert_true(json_real_value(json_object_get(repose, "angle_deg")) == 22.5);
    assert_true(json_real_value(json_object_get(json_object_get(repose, "other_methods"), "chord")) == 23.5);
    assert_null(json_object_get(json_object_get(repose, "other_methods"), "surface-fit"));
    assert_true(json_real_value(json_object_get(json_object_get(regime, "predicted"), "stationary_eq33")) == 2.5);
    assert_string_equal(json_string_value(json_object_get(regime, "name")), "rolling");
    assert_int_equal(json_integer_value(json_object_get(json_object_get(document, "run"), "seed")), 9007199254740991);
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

UNIT_TESTS(what_was_not_measured_is_null, results_stand_under_their_own_names, a_granules_results_are_null_where_no_rate_was_given)
