/* Claims about what specifications say of sizes that are distributed. */
#include "dem_sizes.h"
#include "requests.h"
#include "size_rules.h"

#define SIZES(members) "{\"particles\": [{\"size_distribution\": {" members "}}]}"
#define AT "/inputs/particles/0/size_distribution"

static void ends_that_are_not_given_leave_all_but_a_thousandth_on_either_side(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with(SIZES("\"type\": \"lognormal\", \"by\": \"number\", \"median\": {\"value\": 4, "
                                                     "\"unit\": \"mm\"}, \"geometric_deviation\": 1.1")));
    const dem_sizes *sizes = &spec.scene.species[0].sizes;
    const double deviations = 3.090232306167813; /* of a normal distribution, above which is a thousandth */
    assert_true(sizes->law == DEM_LOGNORMAL && !sizes->by_volume);
    CHECK_NEAR(sizes->minimum, 0.004 * pow(1.1, -deviations), 1e-9);
    CHECK_NEAR(sizes->maximum, 0.004 * pow(1.1, deviations), 1e-9);
    CHECK_NEAR(sizes_cut_below(sizes), 0.001, 1e-9);
    CHECK_NEAR(sizes_cut_above(sizes), 0.001, 1e-9);
    char *text = job_spec_to_text(&spec);
    job_spec same = parse_or_fail(load(text));
    char *again = job_spec_to_text(&same);
    assert_string_equal(text, again);
    free(text);
    free(again);
    job_spec_clear(&same);
    job_spec_clear(&spec);
}

/* K1 = m_max v^2/(0.01 d_min)^2 and the step goes with sqrt(m_min/K1): of the smallest and the largest that may be drawn. */
static void stiffness_and_step_are_those_of_the_extremes(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with(SIZES("\"type\": \"uniform\", \"minimum\": 0.003, \"maximum\": 0.005")));
    job_spec two = parse_or_fail(
        request_with("{\"particles\": [{\"diameter\": 0.003, \"share\": 0.5}, {\"diameter\": 0.005, \"share\": 0.5}]}"));
    CHECK_NEAR(spec.scene.contact.stiffness / two.scene.contact.stiffness, 1, 1e-12);
    CHECK_NEAR(spec.scene.time_step / two.scene.time_step, 1, 1e-12);
    /* by mass evenly from a to b: the mean of 1/d^3 by mass is (1/a^2 - 1/b^2)/(2 (b - a)) */
    const double a = 0.003, b = 0.005, volume = M_PI / 6 * 2 * (b - a) / (1 / (a * a) - 1 / (b * b));
    CHECK_NEAR(dem_mean_volume(spec.scene.species, 1) / volume, 1, 1e-6);
    job_spec_clear(&spec);
    job_spec_clear(&two);
}

static void shares_of_sieves_are_summed_up(void **state)
{
    (void)state;
    job_spec spec =
        parse_or_fail(request_with(SIZES("\"type\": \"table\", \"sizes\": [0.003, 0.004, 0.005], \"shares\": [0.25, 0.75]")));
    const dem_sizes *sizes = &spec.scene.species[0].sizes;
    assert_true(sizes->sieve_count == 3 && sizes->below[0] == 0 && sizes->below[1] == 0.25 && sizes->below[2] == 1);
    assert_true(sizes->minimum == 0.003 && sizes->maximum == 0.005 && sizes->by_volume);
    job_spec_clear(&spec);
}

static void what_a_law_lacks_or_has_no_use_for_is_told(void **state)
{
    (void)state;
    expect_problems(SIZES("\"type\": \"lognormal\", \"median\": 0.004"),
                    AT "/geometric_deviation: is missing; lognormal takes median and geometric_deviation\n");
    expect_problems(SIZES("\"type\": \"normal\", \"mean\": 0.004, \"deviation\": 0.0004, \"spread\": 3"),
                    AT "/spread: is given; normal takes mean and deviation\n");
    expect_problems(SIZES("\"type\": \"uniform\", \"minimum\": 0.003"),
                    AT "/maximum: is missing; uniform takes minimum and maximum\n");
    expect_problems(SIZES("\"type\": \"table\", \"sizes\": [0.003, 0.004]"),
                    AT ": has neither cumulative nor shares; give one of the two\n");
    expect_problems(SIZES("\"type\": \"table\", \"sizes\": [0.003, 0.004, 0.005], \"cumulative\": [0, 1]"),
                    AT "/cumulative: has 2 numbers; must have 3: as many as sizes\n");
    expect_problems(SIZES("\"type\": \"table\", \"sizes\": [0.003, 0.005, 0.004], \"cumulative\": [0, 0.5, 1]"),
                    AT "/sizes/2: is 0.004, after 0.005; must be more: sizes ascend\n");
    expect_problems(SIZES("\"type\": \"table\", \"sizes\": [0.003, 0.004, 0.005], \"cumulative\": [0, 0.5, 0.4]"),
                    AT "/cumulative/2: is 0.4, after 0.5; must not fall: it is the share of all that is smaller\n");
    expect_problems(SIZES("\"type\": \"table\", \"sizes\": [0.003, 0.004, 0.005], \"shares\": [0.5, 0.4]"),
                    AT "/shares: sum to 0.9; must sum to 1\n");
    expect_problems("{\"particles\": [{\"diameter\": 0.004, \"size_distribution\": {\"type\": \"uniform\", \"minimum\": 0.003, "
                    "\"maximum\": 0.004}}]}",
                    "/inputs/particles/0/diameter: is given beside size_distribution; give one of the two\n");
    expect_problems("{\"particles\": [{\"shape\": \"cube\", \"size_distribution\": {\"type\": \"uniform\", \"minimum\": 0.003, "
                    "\"maximum\": 0.004}}]}",
                    AT ": is given beside a shape; sizes are distributed of spheres alone\n");
}

static void ranges_and_kinds_are_held(void **state)
{
    (void)state;
    expect_problems(SIZES("\"type\": \"lognormal\", \"median\": 0.004, \"geometric_deviation\": 1"),
                    AT "/geometric_deviation: is 1; must be in (1, 10]\n");
    expect_problems(SIZES("\"type\": \"gauss\""),
                    AT "/type: is \"gauss\"; available: \"lognormal\", \"normal\", \"rosin-rammler\", \"uniform\", \"table\"\n");
    expect_problems("{\"particles\": [{\"size_distribution\": 3}]}", AT ": is 3; must be an object or null\n");
    expect_problems(SIZES("\"type\": \"uniform\", \"minimum\": 0.004, \"maximum\": 0.003"),
                    AT "/maximum: leaves sizes from 0.004 m to 0.003 m; the minimum must be below the maximum\n");
    expect_problems(SIZES("\"type\": \"normal\", \"mean\": 0.004, \"deviation\": 0.003"),
                    AT "/minimum: is -0.0052707 m, as nothing else was given; must be in [1e-05, 1] m\n");
    expect_problems(SIZES("\"type\": \"normal\", \"mean\": 0.004, \"deviation\": 0.0001, \"minimum\": 0.0045, \"maximum\": 0.005"),
                    AT ": has 2.87e-07 of it between 0.0045 m and 0.005 m, where it is cut; must have at least 0.01\n");
    expect_problems(SIZES("\"type\": \"table\", \"sizes\": [0.003], \"cumulative\": \"all\""),
                    AT "/sizes: is a list of 1; must be a list of 2 to 64 numbers, each in [1e-05, 1] m\n" AT
                       "/cumulative: is \"all\"; must be a list of 2 to 64 numbers, each in [0, 1]\n");
    expect_problems(
        SIZES("\"type\": \"uniform\", \"minimum\": 0.0002, \"maximum\": 0.005"),
        "/inputs/particles: have diameters from 0.0002 m to 0.005 m; the largest must be at most 20 of the smallest: at "
        "this ratio a run takes 1.75 times as many steps as at that\n");
}

/* What no year is enough for is refused with the estimate. */
static void sizes_that_make_a_run_hopeless_are_refused_with_the_estimate(void **state)
{
    (void)state;
    char *said = problems_of(load(
        "{\"inputs\": {\"drum\": {\"diameter\": 0.5, \"length\": 0.1, \"rotation_rate\": 1}, \"duration\": {\"revolutions\": 50}, "
        "\"particles\": [{\"size_distribution\": {\"type\": \"uniform\", \"minimum\": 0.0006, \"maximum\": 0.011}}]}}"));
    assert_non_null(strstr(said, AT ": has sizes from 0.0006 m to 0.011 m, of which the smallest make a time step of "));
    assert_non_null(strstr(said, "must take at most a year: cut it at a larger minimum"));
    free(said);
}

/* Which kind a placed sphere is of follows from its diameter. */
static void placed_spheres_have_diameters(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(request_with(
        "{\"particles\": [{\"diameter\": 0.002}, {\"size_distribution\": {\"type\": \"uniform\", \"minimum\": 0.003, \"maximum\": "
        "0.005}}], \"start\": {\"particles\": [{\"position\": [0, 0, 0], \"diameter\": 0.004}, {\"position\": [0.006, 0, 0], "
        "\"diameter\": 0.002}, {\"position\": [-0.006, 0, 0], \"species\": 1, \"diameter\": 0.003}]}}"));
    const start_particle *p = spec.inputs.start.particles;
    assert_true(p[0].species == 1 && p[1].species == 0 && p[2].species == 1);
    job_spec_clear(&spec);
    expect_problems("{\"particles\": [{\"size_distribution\": {\"type\": \"uniform\", \"minimum\": 0.003, \"maximum\": 0.005}}], "
                    "\"start\": {\"particles\": [{\"position\": [0, 0, 0]}, {\"position\": [0.01, 0, 0], \"diameter\": 0.006}, "
                    "{\"position\": [-0.01, 0, 0], \"species\": 0, \"diameter\": 0.006}]}}",
                    "/inputs/start/particles/0/diameter: is missing; must be given, since the particle's kind has a size "
                    "distribution\n"
                    "/inputs/start/particles/1/diameter: is 0.006 m; must be what one of the kinds of particles has, and 0 of them "
                    "have it\n"
                    "/inputs/start/particles/2/diameter: is 0.006 m; must be in [0.003, 0.005] m, as its kind is\n");
}

UNIT_TESTS(ends_that_are_not_given_leave_all_but_a_thousandth_on_either_side, stiffness_and_step_are_those_of_the_extremes,
           shares_of_sieves_are_summed_up, what_a_law_lacks_or_has_no_use_for_is_told, ranges_and_kinds_are_held,
           sizes_that_make_a_run_hopeless_are_refused_with_the_estimate, placed_spheres_have_diameters)
