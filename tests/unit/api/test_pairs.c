/* Claims about what specifications say of materials and of pairs of them. */
#include "dem_rules.h"
#include "pair_rules.h"
#include "requests.h"

#define TWO_MATERIALS                                                                                                              \
    "\"materials\": {\"glass\": {\"density\": 2500}, \"steel\": {\"density\": 7800}}, "                                            \
    "\"particles\": [{\"diameter\": 0.005, \"material\": \"glass\", \"share\": 0.5}, "                                             \
    "{\"diameter\": 0.004, \"material\": \"steel\", \"share\": 0.5}]"

static void without_pairs_materials_are_densities_alone(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with("{" TWO_MATERIALS "}"));
    assert_false(spec.scene.has_pairs);
    assert_true(spec.scene.species[0].density == 2500 && spec.scene.species[1].density == 7800);
    job_spec by_hand = parse_or_fail(request_with("{\"particles\": [{\"diameter\": 0.005, \"density\": 2500, \"share\": 0.5}, "
                                                  "{\"diameter\": 0.004, \"density\": 7800, \"share\": 0.5}]}"));
    assert_true(spec.scene.time_step == by_hand.scene.time_step && spec.scene.contact.stiffness == by_hand.scene.contact.stiffness);
    job_spec_clear(&by_hand);
    job_spec_clear(&spec);
}

static void a_pair_says_what_differs_either_way_round_and_the_rest_stays(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with(
        "{" TWO_MATERIALS
        ", \"contact\": {\"friction\": 0.2, \"restitution\": 0.7, \"stiffness\": 9000}, \"wall\": {\"friction\": 0.4, "
        "\"material\": \"steel\"}, \"pairs\": [{\"between\": [\"steel\", \"glass\"], \"friction\": 0.33, \"stiffness\": 20000}, "
        "{\"between\": [\"glass\", \"wall\"], \"restitution\": 0.5}, {\"between\": [\"steel\", \"steel\"], \"friction\": 0.11}]}"));
    const dem_scene_definition *d = &spec.scene;
    const dem_pair *wall = &d->pair[0][DEM_MAXIMUM_SPECIES + DEM_WALL], *steel = &d->pair[1][DEM_MAXIMUM_SPECIES + DEM_WALL];
    assert_true(d->has_pairs);
    assert_true(d->pair[0][0].friction == 0.2 && d->pair[0][0].stiffness == 9000 && d->pair[0][0].restitution == 0.7);
    assert_true(d->pair[0][1].friction == 0.33 && d->pair[1][0].friction == 0.33 && d->pair[0][1].restitution == 0.7);
    /* the wall is of steel: glass meets it as it meets steel, but for what is said of the wall itself; steel as steel */
    assert_true(wall->friction == 0.33 && wall->stiffness == 20000 && wall->restitution == 0.5);
    assert_true(steel->friction == 0.11 && steel->stiffness == 9000);
    job_spec_clear(&spec);
}

/* s, t_c of latching springs: a quarter of a swing by K1, and one by K1/e^2. */
static double contact_duration(double mass, double stiffness, double restitution)
{
    return DEM_PI / 2 * sqrt(mass / stiffness) * (1 + restitution);
}

static void each_pair_has_the_steps_that_its_own_restitution_needs(void **state)
{
    (void)state;
    const double glass = dem_sphere_mass(0.005, 2500), steel = dem_sphere_mass(0.004, 7800),
                 unlike = glass * steel / (glass + steel);
    const double least = contact_duration(0.5 * glass, 9000, 0.8); /* of what touches at 9000 N/m, at 0.8 */
    const struct {
        const char *pairs;
        double step; /* s */
    } cases[] = {
        { "{\"between\": [\"glass\", \"steel\"], \"friction\": 0.3}", least / 14 },
        /* the wall is met by twice the mass, for sqrt(2) 1.6/1.8 of the time, 20 steps of which are 0.88 of that */
        { "{\"between\": [\"glass\", \"wall\"], \"restitution\": 0.6}", contact_duration(glass, 9000, 0.6) / 20 },
        { "{\"between\": [\"glass\", \"wall\"], \"restitution\": 0.6, \"stiffness\": 5000}", least / 14 },
        { "{\"between\": [\"steel\", \"wall\"], \"restitution\": 0.65}", least / 14 },
        { "{\"between\": [\"glass\", \"glass\"], \"restitution\": 0.6}", contact_duration(0.5 * glass, 9000, 0.6) / 20 },
        { "{\"between\": [\"glass\", \"steel\"], \"restitution\": 0.3, \"stiffness\": 20000}",
          contact_duration(unlike, 20000, 0.3) / 20 },
        { "{\"between\": [\"glass\", \"steel\"], \"restitution\": 0.3, \"stiffness\": 2000}", least / 14 },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char inputs[800];
        snprintf(inputs, sizeof inputs,
                 "{" TWO_MATERIALS ", \"contact\": {\"restitution\": 0.8, \"stiffness\": 9000}, \"pairs\": [%s]}", cases[k].pairs);
        job_spec spec = parse_or_fail(request_with(inputs));
        assert_true(fabs(spec.scene.time_step / cases[k].step - 1) < 1e-12);
        char *text = job_spec_to_text(&spec); /* which says the number of steps, and must mean the same to the bit */
        job_spec same = parse_or_fail(load(text));
        assert_true(same.scene.time_step == spec.scene.time_step);
        free(text);
        job_spec_clear(&same);
        job_spec_clear(&spec);
    }
}

static void what_no_two_bodies_have_sets_no_step(void **state)
{
    (void)state; /* all pairs say more than the contact of the rest, which nothing is left of */
    job_spec spec = parse_or_fail(request_with(
        "{\"materials\": {\"glass\": {\"density\": 2500}}, \"particles\": [{\"diameter\": 0.005, \"material\": \"glass\"}], "
        "\"contact\": {\"restitution\": 0.3, \"stiffness\": 9000}, \"pairs\": [{\"between\": [\"glass\", \"glass\"], "
        "\"restitution\": 0.9}, {\"between\": [\"glass\", \"wall\"], \"restitution\": 0.9}]}"));
    assert_true(spec.inputs.steps_per_contact == 14);
    assert_true(fabs(spec.scene.time_step / (contact_duration(0.5 * dem_sphere_mass(0.005, 2500), 9000, 0.9) / 14) - 1) < 1e-12);
    job_spec_clear(&spec);
}

/* 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 is the core's; here: whose moduli stand in which pair. */
static void moduli_are_those_of_the_two_materials(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with(
        "{\"materials\": {\"soft\": {\"youngs_modulus\": 5e6, \"poisson_ratio\": 0.2}, \"hard\": {\"youngs_modulus\": 5e8}}, "
        "\"particles\": [{\"diameter\": 0.005, \"material\": \"soft\"}], \"contact\": {\"law\": \"hertz-mindlin\"}, "
        "\"wall\": {\"material\": \"hard\"}}"));
    const dem_pair *wall = &spec.scene.pair[0][DEM_MAXIMUM_SPECIES + DEM_WALL];
    assert_true(spec.scene.has_pairs && wall->elasticity[0].youngs_modulus == 5e6 && wall->elasticity[1].youngs_modulus == 5e8);
    assert_true(wall->elasticity[0].poissons_ratio == 0.2 && wall->elasticity[1].poissons_ratio == 0.3);
    assert_true(spec.scene.contact.particle.youngs_modulus == 5e6); /* of one species: the contact of all */
    char *text = job_spec_to_text(&spec);
    assert_non_null(strstr(text, "poissons_ratio"));
    json_t *again = load(text);
    job_spec same = parse_or_fail(again);
    char *text_again = job_spec_to_text(&same);
    assert_string_equal(text, text_again);
    free(text_again);
    free(text);
    job_spec_clear(&same);
    job_spec_clear(&spec);
}

static void each_pair_of_other_restitution_has_a_slope_of_its_own(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with("{" TWO_MATERIALS ", \"contact\": {\"unloading\": \"variable\"}, "
                                               "\"pairs\": [{\"between\": [\"steel\", \"glass\"], \"restitution\": 0.5}]}"));
    const dem_scene_definition *d = &spec.scene; /* S goes with 1/e^2 - 1: 3 over 0.5625 */
    assert_true(fabs(d->pair[0][1].unloading_slope / d->pair[0][0].unloading_slope - 3 / 0.5625) < 1e-9);
    job_spec_clear(&spec);
}

static void wrong_names_are_told_with_those_there_are(void **state)
{
    (void)state;
    expect_problems(
        "{" TWO_MATERIALS ", \"pairs\": [{\"between\": [\"glass\", \"steel\"]}, {\"between\": [\"steel\", \"glass\"]}, "
        "{\"between\": [\"glas\", \"wall\"]}, {\"between\": [\"wall\", \"wall\"]}, {\"between\": [\"glass\", \"ends\"]}, "
        "{\"between\": [\"glass\"], \"friction\": -1}, {}]}",
        "/inputs/pairs/5/between: is a list of 1; must be a list of two names\n"
        "/inputs/pairs/5/friction: is -1; must be in [0, 5]\n"
        "/inputs/pairs/6/between: is missing; must be a list of two names\n"
        "/inputs/pairs/1/between: is \"steel\" and \"glass\", which /inputs/pairs/0 is, too; give a pair once\n"
        "/inputs/pairs/2/between/0: is \"glas\", a name that nobody has; available: \"glass\", \"steel\", \"wall\"\n"
        "/inputs/pairs/3/between: is \"wall\" and \"wall\", which never touch; one must be a material of particles\n"
        "/inputs/pairs/4/between/1: is \"ends\", which this container has not; available: \"glass\", \"steel\", \"wall\"\n");
    expect_problems(
        "{\"materials\": {\"lining\": {}, \"a\": 3, \"b\": {\"density\": 0, \"colour\": 1}}, \"particles\": [{\"diameter\": 0.005, "
        "\"material\": \"c\"}], \"wall\": {\"material\": \"d\"}}",
        "/inputs/materials/a: is 3; must be an object\n"
        "/inputs/materials/b/density: is 0 kg/m3; must be in [1, 30000] kg/m3\n"
        "/inputs/materials/b/colour: is not an input; available here: density, youngs_modulus, poissons_ratio, poisson_ratio\n"
        "/inputs/materials: has a member \"lining\", which is the name of a surface; name it otherwise\n"
        "/inputs/particles/0/material: is \"c\"; available: \"lining\", \"a\", \"b\"\n"
        "/inputs/wall/material: is \"d\"; available: \"lining\", \"a\", \"b\"\n");
    expect_problems(
        "{\"materials\": {\"a\": {\"youngs_modulus\": 1e7}, \"b\": {}}, \"particles\": [{\"diameter\": 0.005, \"material\": "
        "\"a\"}, "
        "{\"diameter\": 0.005, \"material\": \"b\"}], \"contact\": {\"law\": \"hertz-mindlin\"}, "
        "\"pairs\": [{\"between\": [\"a\", \"b\"], \"stiffness\": 100}]}",
        "/inputs/pairs/0/stiffness: is 100 N/m, but hertz-mindlin takes the youngs_modulus (Pa) of materials\n"
        "/inputs/materials/b/youngs_modulus: is missing; must be given beside that of other materials, for particles 1\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_pairs_materials_are_densities_alone),
        cmocka_unit_test(a_pair_says_what_differs_either_way_round_and_the_rest_stays),
        cmocka_unit_test(each_pair_has_the_steps_that_its_own_restitution_needs),
        cmocka_unit_test(what_no_two_bodies_have_sets_no_step),
        cmocka_unit_test(moduli_are_those_of_the_two_materials),
        cmocka_unit_test(each_pair_of_other_restitution_has_a_slope_of_its_own),
        cmocka_unit_test(wrong_names_are_told_with_those_there_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
