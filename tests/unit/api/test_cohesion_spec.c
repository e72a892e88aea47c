/* Claims about what specifications say of cohesion. */
#include "dem_rules.h"
#include "requests.h"

static void a_spec_without_cohesion_says_nothing_of_it(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(load(minimal));
    assert_true(spec.scene.contact.cohesion_law == DEM_NO_COHESION);
    char *text = job_spec_to_text(&spec);
    assert_null(strstr(text, "cohesion"));
    free(text);
    job_spec_clear(&spec);
}

static void a_bond_number_is_a_pull_in_weights_of_the_mean_particle(void **state)
{
    (void)state;
    job_spec spec =
        parse_or_fail(request_with("{\"contact\": {\"cohesion\": {\"bond_number\": 3}}, \"wall\": {\"cohesion\": {\"law\": "
                                   "\"constant\", \"pull_off\": 1e-4}}}"));
    const double weight = dem_sphere_mass(0.005, 2500) * 9.81;
    assert_true(spec.scene.contact.cohesion_law == DEM_CONSTANT_PULL);
    assert_true(fabs(spec.scene.contact.cohesion.strength / (3 * weight) - 1) < 1e-12);
    assert_true(spec.scene.contact.wall_cohesion.strength == 1e-4);
    json_t *words = job_spec_understood(&spec, NULL);
    assert_true(fabs(json_number_value(json_object_get(words, "bond_number")) - 3) < 1e-9);
    json_decref(words);
    char *text = job_spec_to_text(&spec);
    json_t *again = load(text);
    job_spec same = parse_or_fail(again);
    char *text_again = job_spec_to_text(&same);
    assert_string_equal(text, text_again);
    free(text);
    free(text_again);
    job_spec_clear(&same);
    job_spec_clear(&spec);
}

/* Where K1 is chosen for an overlap, the pull alone makes half of it at most: F/K1 = 0.005 d/2. */
static void contacts_are_stiff_enough_for_the_pull(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with(
        "{\"contact\": {\"maximum_overlap\": 0.01, \"cohesion\": {\"pull_off\": 1}}, \"duration\": {\"revolutions\": 0.5}}"));
    assert_true(fabs(1 / spec.scene.contact.stiffness / (0.005 * 0.005) - 1) < 1e-9);
    job_spec_clear(&spec);
}

static void a_pair_may_cohere_more_or_not_at_all(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with(
        "{\"materials\": {\"a\": {}, \"b\": {}}, \"particles\": [{\"diameter\": 0.005, \"material\": \"a\"}, {\"diameter\": 0.005, "
        "\"material\": \"b\"}], \"contact\": {\"law\": \"hertz-mindlin\", \"cohesion\": {\"law\": \"jkr\", \"surface_energy\": "
        "0.01}}, "
        "\"pairs\": [{\"between\": [\"a\", \"b\"], \"cohesion\": {\"law\": \"jkr\", \"surface_energy\": 0}}, {\"between\": [\"a\", "
        "\"wall\"], \"cohesion\": {\"law\": \"jkr\", \"surface_energy\": 0.02}}]}"));
    const dem_scene_definition *d = &spec.scene;
    assert_true(d->pair[0][0].cohesion.strength == 0.01 && d->pair[0][1].cohesion.strength == 0
                && d->pair[1][1].cohesion.strength == 0.01);
    assert_true(d->pair[0][DEM_MAXIMUM_SPECIES + DEM_WALL].cohesion.strength == 0.02);
    assert_true(d->pair[1][DEM_MAXIMUM_SPECIES + DEM_WALL].cohesion.strength == 0);
    job_spec_clear(&spec);
}

static void what_can_t_cohere_is_refused_with_the_reason(void **state)
{
    (void)state;
    expect_problems(
        "{\"contact\": {\"cohesion\": {\"law\": \"jkr\", \"surface_energy\": 0.01, \"pull_off\": 1}}, \"wall\": {\"cohesion\": "
        "{\"law\": "
        "\"liquid-bridge\", \"surface_tension\": -1}}}",
        "/inputs/wall/cohesion/surface_tension: is -1 N/m; must be in [0, 10] N/m\n"
        "/inputs/contact/cohesion/law: is \"jkr\", which is the theory of an elastic contact, but springs are linear; must be "
        "another, or "
        "the contact's law \"hertz-mindlin\"\n"
        "/inputs/contact/cohesion/pull_off: is 1, but the law is \"jkr\", which does not take it\n"
        "/inputs/wall/cohesion/law: is \"liquid-bridge\"; must be \"jkr\", as all that coheres has one law\n"
        "/inputs/wall/cohesion/liquid_volume: is missing; \"liquid-bridge\" needs it\n");
    expect_problems(
        "{\"contact\": {\"law\": \"spring-dashpot\", \"cohesion\": {\"law\": \"sjkr\", \"energy_density\": 1000}}}",
        "/inputs/contact/cohesion/law: is \"sjkr\", whose pull grows as the overlap does, as the push of a linear spring: that "
        "would make "
        "contacts softer, and not cohere; must be another, or the contact's law \"hertz-mindlin\"\n");
    expect_problems(
        "{\"contact\": {\"cohesion\": {\"law\": \"liquid-bridge\", \"surface_tension\": 0.07, \"liquid_volume\": 1e-8}}}",
        "/inputs/contact/cohesion: acts over gaps of 0.00215 m; must act over at most 0.001 m, 0.2 of the smallest diameter\n");
    expect_problems("{\"contact\": {\"cohesion\": 3}}", "/inputs/contact/cohesion: is 3; must be an object or null\n");
    /* what is refused elsewhere is all that is said */
    expect_problems("{\"gravity\": -1, \"contact\": {\"cohesion\": {\"bond_number\": 2}}}",
                    "/inputs/gravity: is -1 m/s2; must be in [0.01, 1000] m/s2\n");
    expect_problems("{\"contact\": {\"cohesion\": {\"pull_off\": 1, \"bond_number\": 2}}}",
                    "/inputs/contact/cohesion/pull_off: is given beside bond_number; give one of the two\n");
    expect_problems(
        "{\"contact\": {\"cohesion\": {\"law\": \"glue\"}}}",
        "/inputs/contact/cohesion/law: is \"glue\"; available: \"constant\", \"sjkr\", \"sjkr2\", \"jkr\", \"liquid-bridge\"\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spec_without_cohesion_says_nothing_of_it),
        cmocka_unit_test(a_bond_number_is_a_pull_in_weights_of_the_mean_particle),
        cmocka_unit_test(contacts_are_stiff_enough_for_the_pull),
        cmocka_unit_test(a_pair_may_cohere_more_or_not_at_all),
        cmocka_unit_test(what_can_t_cohere_is_refused_with_the_reason),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
