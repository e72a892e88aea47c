/* Claims about reading, checking and writing a job's specification. */
#include "dem_rules.h"
#include "requests.h"

static void a_minimal_request_gets_every_default(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(load(minimal));
    assert_string_equal(spec.process, "drum");
    assert_true(spec.scene.fill_fraction == 0.5 && spec.scene.gravity == 9.81);
    assert_true(spec.scene.contact.friction == 0.3 && spec.scene.contact.wall_friction == 0.5);
    assert_true(spec.scene.contact.restitution == 0.8 && spec.scene.contact.tangential_stiffness_ratio == 0.8);
    assert_true(spec.maximum_overlap == 0.01 && spec.snapshot_interval == 0.1);
    assert_true(spec.scene.species[0].density == 2500 && spec.scene.species[0].share == 1);
    assert_true(spec.scene.lining.diameter == 0);
    assert_int_equal(spec.scene.threads, 1);
    assert_int_equal(spec.scene.seed, 42);
    /* 0.5 x pi/4 x 0.05^2 x 0.02 m3 at a solid fraction of 0.6, over pi/6 x 0.005^3 m3: 180 */
    assert_int_equal(spec.scene.particle_count, 180);
    /* 1.25 revolutions at 3 rad/s */
    assert_true(fabs(spec.duration - 1.25 * 2 * 3.14159265358979 / 3) < 1e-12);
    assert_true(spec.sample_interval > 0 && spec.sample_interval <= 0.05);
    job_spec_clear(&spec);
}

static void a_canonical_spec_is_read_and_written_with_the_same_bytes(void **state)
{
    (void)state;
    const char *const variations[][2] = {
        { "seed", "9007199254740991" },
        { "particle_count", "77" },
        { "contact/stiffness", "4000" },
        { "duration/seconds", "0.7" },
        { "snapshots/interval", "0" },
        { "contact/friction", "0.1" },
        { "share_by", "\"mass\"" },
        { "contact", "{\"unloading\": \"variable\", \"unloading_slope\": 1e4}" },
        { "integration/corrector_passes", "2" },
        { "precision", "\"double\"" },
        { "wall/lining", "{\"diameter\": 0.002}" },
        { "contact/friction", "-0.0" },
        { "particles", "[{\"diameter\":0.003,\"share\":0.1},{\"diameter\":0.004,\"share\":0.2},{\"diameter\":0.005,"
                       "\"share\":0.7000000001}]" },
        { "particles", "[{\"diameter\":0.003},{\"diameter\":0.004},{\"diameter\":0.005}]" },
    };
    for (size_t v = 0; v < sizeof variations / sizeof variations[0]; v++) {
        json_t *request = minimal_with(variations[v][0], variations[v][1]);
        json_object_set_new(request, "label", load("{\"project\": \"caf\\u00e9\", \"row\": 3, \"mu\": 0.1}"));
        job_spec first = parse_or_fail(request);
        char *text = job_spec_to_text(&first);
        job_spec second = parse_or_fail(load(text));
        char *again = job_spec_to_text(&second);
        assert_string_equal(text, again);
        assert_memory_equal(&first.scene, &second.scene, sizeof first.scene);
        assert_true(first.duration == second.duration && first.sample_interval == second.sample_interval);
        free(text);
        free(again);
        job_spec_clear(&first);
        job_spec_clear(&second);
    }
}

static void a_number_out_of_range_is_named_with_value_unit_and_range(void **state)
{
    (void)state;
    expect_problem("wall/lining", "{\"diameter\": 0.0068}",
                   "/inputs/wall/lining/diameter: is 0.0068 m; must be at most 0.00625 m, 1/8 of the drum's diameter\n"
                   "/inputs/wall/lining/diameter: is 0.0068 m; must be at most 0.00666667 m, 1/3 of the periodic axis\n");
    expect_problem("fill_fraction", "1.4", "/inputs/fill_fraction: is 1.4; must be in (0, 0.95]\n");
    expect_problem("fill_fraction", "0", "/inputs/fill_fraction: is 0; must be in (0, 0.95]\n");
    expect_problem("drum/diameter", "30", "/inputs/drum/diameter: is 30 m; must be in [0.001, 20] m\n");
    expect_problem("drum/rotation_rate", "-0.0001",
                   "/inputs/drum/rotation_rate: is -0.0001 rad/s; must be in [-500, 500] rad/s, and at least 0.001 in size\n");
    expect_problem("contact/friction", "true", "/inputs/contact/friction: is true; must be a number in [0, 5]\n");
    expect_problem("contact/friction", "null", "/inputs/contact/friction: is null; must be a number in [0, 5]\n");
    expect_problem("contact/friction", "1e300", "/inputs/contact/friction: is 1e+300; must be in [0, 5]\n");
    expect_problem("particles/0/density", "\"2500\"",
                   "/inputs/particles/0/density: is \"2500\"; must be a number in [1, 30000] kg/m3\n");
}

static void the_ends_of_a_range_are_inside_or_not_as_written(void **state)
{
    (void)state;
    expect_fine("contact/friction", "0");
    expect_fine("contact/friction", "5");
    expect_fine("fill_fraction", "0.95");
    expect_fine("particles/0/share", "1");
    expect_problem("particles/0/share", "0", "/inputs/particles/0/share: is 0; must be in (0, 1]\n");
    expect_problem("contact/friction", "5.0000001", "/inputs/contact/friction: is 5.0000001; must be in [0, 5]\n");
}

static void a_number_that_has_lost_its_digits_is_refused(void **state)
{
    (void)state;
    expect_problem("contact/friction", "1e-310",
                   "/inputs/contact/friction: is 9.99999999999997e-311; too close to 0 "
                   "to be kept, must be in [0, 5]\n");
}

static void whole_numbers_are_asked_for_where_they_are_needed(void **state)
{
    (void)state;
    expect_problem("threads", "1.5", "/inputs/threads: is 1.5; must be a whole number in [1, 256]\n");
    expect_problem("threads", "0", "/inputs/threads: is 0; must be in [1, 256]\n");
    expect_problem("seed", "9007199254740992", "/inputs/seed: is 9007199254740992; must be in [0, 9007199254740991]\n");
    expect_problem("seed", "-1", "/inputs/seed: is -1; must be in [0, 9007199254740991]\n");
    expect_problem("particle_count", "7", "/inputs/particle_count: is 7; must be in [8, 5000000]\n");
    expect_fine("particle_count", "8.0");
}

static void unknown_members_are_refused_with_the_nearest_name(void **state)
{
    (void)state;
    expect_problem("contact/frictoin", "0.1", "/inputs/contact/frictoin: is not an input; did you mean inputs/contact/friction?\n");
    expect_problem("friction", "0.1", "/inputs/friction: is not an input; did you mean inputs/contact/friction?\n");
    expect_problem("duration/until_standard_error", "0.3",
                   "/inputs/duration/until_standard_error: is not an input; did you mean "
                   "inputs/duration/until_standard_error_deg?\n");
    json_t *request = load(minimal);
    json_object_set_new(json_object_get(request, "inputs"), "a/b~c", json_null());
    char *problems = problems_of(request);
    assert_non_null(strstr(problems, "/inputs/a~1b~0c: is not an input"));
    free(problems);
}

static void what_is_not_available_yet_is_refused_with_what_is(void **state)
{
    (void)state;
    expect_problem("drum/ends", "\"disc\"", "/inputs/drum/ends: is \"disc\"; available: \"periodic\", \"walls\"\n");
    expect_problem("particles/0/shape", "\"cone\"",
                   "/inputs/particles/0/shape: is \"cone\"; available: \"sphere\", "
                   "\"dumbbell\", \"tetrahedron\", \"cube\", or an object\n");
    expect_problem("contact/law", "\"hertz\"",
                   "/inputs/contact/law: is \"hertz\"; available: \"walton-braun\", \"spring-dashpot\", \"hertz-mindlin\"\n");
    json_t *request = load(minimal);
    json_object_set_new(request, "process", json_string("heap"));
    char *problems = problems_of(request);
    assert_string_equal(problems, "/process: is \"heap\"; was sent to the process \"drum\"\n");
    free(problems);
}

/* The drum of `minimal` is 50 mm across, with 5 mm spheres. */
static void a_drum_may_have_end_walls_and_lifters_with_frictions_of_their_own(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(minimal_with("drum/ends", "\"walls\""));
    assert_true(spec.scene.ends.are_walls);
    assert_true(spec.scene.ends.friction == spec.scene.contact.wall_friction);
    assert_true(spec.scene.ends.rolling_friction == 0);
    assert_true(spec.scene.lifters.count == 0);
    job_spec_clear(&spec);
    spec = parse_or_fail(minimal_with("drum/lifters", "{\"count\": 6, \"height\": 0.004, \"width\": 0.003, \"friction\": 0.7}"));
    assert_false(spec.scene.ends.are_walls);
    assert_int_equal(spec.scene.lifters.count, 6);
    assert_true(spec.scene.lifters.height == 0.004 && spec.scene.lifters.width == 0.003 && spec.scene.lifters.friction == 0.7);
    job_spec_clear(&spec);

    expect_problem(
        "wall/end_friction", "0.2",
        "/inputs/wall/end_friction: is 0.2, but the drum's ends are periodic; give /inputs/drum/ends as \"walls\", too\n");
    expect_problem(
        "wall/end_rolling_friction", "0.2",
        "/inputs/wall/end_rolling_friction: is 0.2, but the drum's ends are periodic; give /inputs/drum/ends as \"walls\", too\n");
    /* 25 mm less 1.5 times 5 mm */
    expect_problem("drum/lifters", "{\"count\": 4, \"height\": 0.02, \"width\": 0.003}",
                   "/inputs/drum/lifters/height: is 0.02 m; must be at most 0.0175 m, the drum's radius less 1.5 of the largest "
                   "particle diameters\n");
    /* corners: 2 sqrt(25^2 - 20^2) = 30 mm; apart, 8 of them: 1.99 * 20 tan(pi/8) = 16.486 mm */
    expect_problem(
        "drum/lifters", "{\"count\": 1, \"height\": 0.005, \"width\": 0.031}",
        "/inputs/drum/lifters/width: is 0.031 m; must be at most 0.03 m, for that many bars of that height to lie within the "
        "drum and apart\n");
    expect_problem(
        "drum/lifters", "{\"count\": 8, \"height\": 0.005, \"width\": 0.017}",
        "/inputs/drum/lifters/width: is 0.017 m; must be at most 0.0164857 m, for that many bars of that height to lie within "
        "the drum and apart\n");
    expect_problem("drum/lifters", "{\"count\": 65, \"height\": 0.004}",
                   "/inputs/drum/lifters/count: is 65; must be in [1, 64]\n/inputs/drum/lifters/width: is missing; must be a "
                   "number in [1e-05, 10] m\n");
    json_t *both = minimal_with("drum/lifters", "{\"count\": 2, \"height\": 0.004, \"width\": 0.003}");
    json_object_set_new(json_object_get(both, "inputs"), "wall", json_pack("{s:{s:f}}", "lining", "diameter", 0.003));
    char *problems = problems_of(both);
    assert_string_equal(problems, "/inputs/drum/lifters: are 2 bars in a drum with a lining; give one of the two\n");
    free(problems);
}

/* Volume of two touching spheres of 2 mm and 3 mm: 4.19 and 14.14 mm3. */
static void a_cluster_of_named_or_given_spheres_is_one_particle(void **state)
{
    (void)state;
    static const char *const given = "[{\"shape\": {\"spheres\": [{\"position\": [0, 0, 0], \"diameter\": 0.002},"
                                     "{\"position\": [0, 0.0025, 0], \"diameter\": 0.003}]}}]";
    static const char *const by_default =
        "[{\"diameter\": 0.003, \"shape\": {\"spheres\": [{\"position\": [0, 0, 0], \"diameter\": 0.002},"
        "{\"position\": [0, 0.0025, 0]}]}}]";
    for (int k = 0; k < 2; k++) {
        job_spec spec = parse_or_fail(minimal_with("particles", k ? by_default : given));
        const dem_cluster *cluster = &spec.scene.species[0].cluster;
        assert_int_equal(cluster->sphere_count, 2);
        assert_true(fabs(cluster->volume - 3.14159265358979 / 6 * (8e-9 + 27e-9)) < 1e-20);
        assert_true(fabs(cluster->reach - 0.0025 * 27 / 35 - 0.001) < 1e-12); /* the centre divides the distance 27 : 8 */
        char *text = job_spec_to_text(&spec);
        json_t *again = json_loads(text, 0, NULL);
        job_spec second = parse_or_fail(again);
        char *text_again = job_spec_to_text(&second);
        assert_string_equal(text, text_again); /* canonical */
        assert_memory_equal(&spec.scene, &second.scene, sizeof spec.scene);
        free(text);
        free(text_again);
        job_spec_clear(&spec);
        job_spec_clear(&second);
    }
    /* a fill counts bodies, by their volume; stiffness grows with their mass */
    job_spec sphere = parse_or_fail(minimal_with("particles", "[{\"diameter\": 0.002}]"));
    job_spec cube = parse_or_fail(minimal_with("particles", "[{\"diameter\": 0.002, \"shape\": \"cube\"}]"));
    assert_true(fabs((double)sphere.scene.particle_count / (double)cube.scene.particle_count - 8) < 0.05);
    assert_true(cube.scene.contact.stiffness > 8 * sphere.scene.contact.stiffness);
    job_spec_clear(&sphere);
    job_spec_clear(&cube);
}

static void a_cluster_that_is_no_body_is_refused_with_the_sphere_at_fault(void **state)
{
    (void)state;
    static const struct {
        const char *spheres, *problem;
    } bad[] = {
        { "[{\"position\": [0, 0, 0]}, {\"position\": [0, 0.0051, 0]}]",
          "/1: is joined to sphere 0 by no chain of touching spheres; a cluster must be one body" },
        { "[{\"position\": [0, 0, 0]}, {\"position\": [0, 0, 0]}]", "/1: lies within sphere 0; each sphere of a cluster must reach "
                                                                    "beyond every other" },
        { "[{\"position\": [0, 0.001, 0], \"diameter\": 0.003}, {\"position\": [0, 0, 0]}]",
          "/0: lies within sphere 1; each sphere of a cluster must reach beyond every other" },
        { "[{\"position\": [0, 0]}]", "/0/position: is a list of 2; must be a list of three numbers, each in [-1, 1] m" },
        { "[{\"diameter\": 0.003}]", "/0/position: is missing; must be a list of three numbers, each in [-1, 1] m" },
        { "[{\"position\": [0, \"x\", 2]}]", "/0/position/1: is \"x\"; must be a number in [-1, 1] m\n"
                                             "/inputs/particles/0/shape/spheres/0/position/2: is 2 m; must be in [-1, 1] m" },
        { "[{\"position\": [0, 0, 0], \"diameter\": 1.5}]", "/0/diameter: is 1.5 m; must be in [1e-05, 1] m" },
        { "[]", ": has 0 entries; must have 1 to 64" },
    };
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        char shape[300], expected[300];
        snprintf(shape, sizeof shape, "{\"spheres\": %s}", bad[k].spheres);
        snprintf(expected, sizeof expected, "/inputs/particles/0/shape/spheres%s\n", bad[k].problem);
        expect_problem("particles/0/shape", shape, expected);
    }
    expect_problem("particles", "[{\"shape\": {\"spheres\": [{\"position\": [0, 0, 0]}]}}]",
                   "/inputs/particles/0/shape/spheres/0: has no diameter; must have one, in m, or the particle must\n");
    expect_problem("particles", "[{\"shape\": \"cube\"}]",
                   "/inputs/particles/0/diameter: is missing; must be a number in [1e-05, 1] m\n");
    expect_problem("particles/0/shape", "{}", "/inputs/particles/0/shape/spheres: is missing; must be a list of objects\n");
    expect_problem(
        "particles/0/shape", "\"tetrahedron\"",
        "/inputs/drum/diameter: is 0.05 m; must be at least 0.0889898 m, 8 of the "
        "largest particle diameter\n/inputs/drum/length: is 0.02 m; must be at least 0.0333712 m, 3 of the largest particle "
        "diameter\n");
}

static void a_run_may_be_asked_for_its_answer(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(minimal_with("duration", "{\"until_standard_error_deg\": 0.3}"));
    assert_true(spec.until_standard_error == 0.3 && spec.inputs.at_most_revolutions == 10);
    job_spec_clear(&spec);
    expect_problem("duration", "{\"until_standard_error_deg\": 0.3, \"seconds\": 2}",
                   "/inputs/duration/seconds: is given beside until_standard_error_deg; give one of the two\n");
    expect_problem("duration", "{\"at_most_revolutions\": 3}",
                   "/inputs/duration/at_most_revolutions: is 3 revolutions, but bounds "
                   "nothing without until_standard_error_deg; give that too, or revolutions\n");
}

static void each_law_takes_its_own_elasticity(void **state)
{
    (void)state;
    expect_problem("contact", "{\"law\": \"hertz-mindlin\", \"stiffness\": 4000}",
                   "/inputs/contact/stiffness: is 4000 N/m, but "
                   "hertz-mindlin takes youngs_modulus (Pa) or maximum_overlap\n");
    expect_problem("contact", "{\"youngs_modulus\": 1e7}",
                   "/inputs/contact/youngs_modulus: is 1e+07 Pa, but this law takes stiffness "
                   "(N/m) or maximum_overlap; youngs_modulus is for hertz-mindlin\n");
    job_spec spec =
        parse_or_fail(minimal_with("contact", "{\"law\": \"hertz-mindlin\", \"youngs_modulus\": 5e7, \"poissons_ratio\": 0.25}"));
    assert_true(spec.scene.contact.law == DEM_HERTZ_MINDLIN && spec.scene.contact.particle.youngs_modulus > 4.999e7
                && spec.scene.contact.particle.youngs_modulus < 5.001e7 && spec.scene.contact.wall.poissons_ratio == 0.25);
    job_spec_clear(&spec);
    spec = parse_or_fail(minimal_with("contact", "{\"law\": \"spring-dashpot\"}"));
    assert_true(spec.scene.contact.law == DEM_SPRING_DASHPOT);
    job_spec_clear(&spec);
}

/* Duration of a collision (pi/2) sqrt(m/(2 K1)) (1 + e), of spheres of mass m. */
static void the_time_step_is_the_share_of_a_collision_that_is_asked_for(void **state)
{
    (void)state;
    const int counts[] = { 10, 20, 50 };
    for (int k = 0; k < 3; k++) {
        char contact[80];
        snprintf(contact, sizeof contact, "{\"stiffness\": 4000, \"restitution\": 0.5, \"steps_per_contact\": %d}", counts[k]);
        job_spec spec = parse_or_fail(minimal_with("contact", contact));
        const double collision = DEM_PI / 2 * sqrt(0.5 * dem_species_mass(&spec.scene.species[0]) / 4000) * 1.5;
        assert_true(fabs(spec.scene.time_step * counts[k] / collision - 1) < 1e-12);
        job_spec_clear(&spec);
    }
    const struct {
        const char *contact;
        double steps;
    } usual[] = { { "{\"restitution\": 0.7}", 14 },
                  { "{\"restitution\": 0.69}", 20 },
                  { "{\"restitution\": 0.8, \"law\": \"spring-dashpot\"}", 20 },
                  { "{\"restitution\": 0.8, \"law\": \"hertz-mindlin\"}", 20 },
                  { "{\"restitution\": 0.5, \"steps_per_contact\": 14}", 14 } };
    for (size_t k = 0; k < sizeof usual / sizeof usual[0]; k++) {
        job_spec spec = parse_or_fail(minimal_with("contact", usual[k].contact));
        assert_true(spec.inputs.steps_per_contact == usual[k].steps);
        job_spec_clear(&spec);
    }
    expect_problem("contact", "{\"steps_per_contact\": 9}", "/inputs/contact/steps_per_contact: is 9; must be in [10, 200]\n");
}

static void one_of_two_alternatives_is_enough_and_both_are_too_much(void **state)
{
    (void)state;
    json_t *request = minimal_with("contact/stiffness", "4000");
    json_object_set_new(json_object_get(json_object_get(request, "inputs"), "contact"), "maximum_overlap", json_real(0.01));
    char *problems = problems_of(request);
    assert_string_equal(problems, "/inputs/contact/stiffness: is given beside maximum_overlap; give one of the two\n");
    free(problems);
    job_spec spec = parse_or_fail(minimal_with("contact/stiffness", "4000"));
    assert_true(spec.scene.contact.stiffness == 4000 && spec.maximum_overlap == 0);
    job_spec_clear(&spec);
    spec = parse_or_fail(minimal_with("particle_count", "180"));
    assert_true(fabs(spec.scene.fill_fraction - 0.5) < 1e-9); /* as the minimal drum half full has 180 */
    job_spec_clear(&spec);
}

static void all_problems_are_listed_at_once(void **state)
{
    (void)state;
    char *problems = problems_of(load("{\"inputs\": {\"drum\": {\"length\": -1, \"ends\": \"open\"}, \"particles\": [{}, "
                                      "{\"diameter\": 0.003, \"colour\": \"red\"}], \"fill_fraction\": 2, \"seed\": \"x\","
                                      "\"duration\": 5}, \"label\": [], \"extra\": 1}"));
    static const char *const expected[] = {
        "/inputs/drum/diameter: is missing",
        "/inputs/drum/length: is -1 m",
        "/inputs/drum/ends: is \"open\"",
        "/inputs/drum/rotation_rate: is missing",
        "/inputs/particles/0/diameter: is missing",
        "/inputs/particles/1/colour: is not an input",
        "/inputs/fill_fraction: is 2;",
        "/inputs/seed: is \"x\"",
        "/inputs/duration: is 5; must be an object",
        "/label: is a list",
        "/extra: is not",
    };
    size_t lines = 0;
    for (const char *c = problems; *c; c++) lines += *c == '\n';
    for (size_t e = 0; e < sizeof expected / sizeof expected[0]; e++)
        if (!strstr(problems, expected[e])) fail_msg("no \"%s\" in:\n%s", expected[e], problems);
    assert_int_equal(lines, sizeof expected / sizeof expected[0]);
    free(problems);
}

static void combinations_that_make_no_sense_are_refused(void **state)
{
    (void)state;
    expect_problem("drum/diameter", "0.039",
                   "/inputs/drum/diameter: is 0.039 m; must be at least 0.04 m, 8 of the largest particle diameter\n");
    expect_problem("drum/length", "0.0149",
                   "/inputs/drum/length: is 0.0149 m; must be at least 0.015 m, 3 of the largest particle diameter\n");
    expect_problem("fill_fraction", "0.01", "/inputs/fill_fraction: is 0.01, which makes 4 particles; must make 8 to 5000000\n");
    expect_problem("particle_count", "400",
                   "/inputs/particle_count: is 400, a fill fraction of 1.11; must be at most "
                   "342, a fill fraction of 0.95\n");
    expect_problem("particles", "[{\"diameter\": 0.005, \"share\": 0.5}, {\"diameter\": 0.004, \"share\": 0.4}]",
                   "/inputs/particles: have shares that sum to 0.9; must sum to 1\n");
    expect_problem("particles", "[{\"diameter\": 0.005, \"share\": 0.5}, {\"diameter\": 0.004}]",
                   "/inputs/particles: have a valid share in 1 of 2 entries; give it in all or in none\n");
    expect_problem("particles", "[]", "/inputs/particles: has 0 entries; must have 1 to 16\n");
    char *problems = problems_of(minimal_with("duration/seconds", "1e6"));
    assert_non_null(strstr(problems, "/inputs/duration/seconds: makes "));
    assert_non_null(strstr(problems, "/inputs/snapshots/interval: is 0.1 s, 1e+07 snapshots"));
    free(problems);
    problems = problems_of(minimal_with("contact/stiffness", "0.01"));
    assert_non_null(strstr(problems, "/inputs/contact/stiffness: is 0.01 N/m, too soft"));
    free(problems);
}

static void labels_are_short_texts_and_numbers(void **state)
{
    (void)state;
    json_t *request = load(minimal);
    json_object_set_new(request, "label", load("{\"a\": {\"b\": 1}, \"c\": true, \"fine\": \"yes\"}"));
    char *problems = problems_of(request);
    assert_non_null(strstr(problems, "/label/a: is an object; must be a number or a text of at most 200 bytes"));
    assert_non_null(strstr(problems, "/label/c: is true; must be a number or a text of at most 200 bytes"));
    assert_null(strstr(problems, "fine"));
    free(problems);
    char long_text[300];
    memset(long_text, 'x', sizeof long_text - 1);
    long_text[sizeof long_text - 1] = '\0';
    request = load(minimal);
    json_object_set_new(request, "label", json_pack("{s:s}", "note", long_text));
    problems = problems_of(request);
    assert_string_equal(problems, "/label/note: is a text of 299 bytes; must have at most 200\n");
    free(problems);
}

/* A message cut within a character would be no JSON string and the problem would be lost. */
static void a_long_message_is_cut_between_characters(void **state)
{
    (void)state;
    for (size_t shift = 0; shift < 4; shift++) {
        char text[2000];
        size_t length = 0;
        while (length < shift) text[length++] = 'a';
        while (length + 3 < sizeof text) {
            memcpy(text + length, "\xe2\x82\xac", 3);
            length += 3;
        }
        text[length] = '\0';
        problem_list problems;
        problem_list_init(&problems);
        problem_list_add(&problems, "/x", "%s", text);
        assert_non_null(problems.errors);
        assert_int_equal(json_array_size(problems.errors), 1);
        problem_list_clear(&problems);
        assert_false(problem_list_is_empty(&problems)); /* lost is not empty */
    }
}

/* Peaks of resident memory, and processor time without other load, of one 1 mm sphere in a drum of 2 m, and of 20,000. */
static void the_estimate_is_near_what_runs_of_few_and_of_many_took(void **state)
{
    (void)state;
    static const char few[] = "{\"inputs\": {\"drum\": {\"diameter\": 2.0, \"length\": 0.1, \"rotation_rate\": 1}, \"particles\": "
                              "[{\"diameter\": 0.001}], \"particle_count\": 1, \"start\": {\"particles\": [{\"position\": "
                              "[0, -0.9994, 0]}]}, \"duration\": {\"seconds\": 0.1}}}";
    static const char many[] =
        "{\"inputs\": {\"drum\": {\"diameter\": 0.2, \"length\": 0.03, \"rotation_rate\": 3}, \"particles\": "
        "[{\"diameter\": 0.003}], \"duration\": {\"seconds\": 0.05}}}";
    job_spec one = parse_or_fail(load(few)), bed = parse_or_fail(load(many));
    const job_estimate a = job_spec_estimate(&one, NULL), b = job_spec_estimate(&bed, NULL);
    assert_true(fabs(b.memory_bytes / 36.8e6 - 1) < 0.2 && a.memory_bytes < 20e6 && a.wall_seconds < 0.5);
    job_spec_clear(&one);
    job_spec_clear(&bed);
}

/* Falls through the drum that making the bed took, a mean over two or three seeds: few grains roll for long. */
static void the_estimate_of_settling_follows_how_few_grains_there_are(void **state)
{
    (void)state;
    static const struct {
        const char *drum, *particles;
        double falls;
    } runs[] = {
        { "\"diameter\": 0.5, \"length\": 0.02", "{\"diameter\": 0.005}], \"particle_count\": 10", 4.9 },
        { "\"diameter\": 0.5, \"length\": 0.05", "{\"diameter\": 0.005}], \"particle_count\": 100", 2.9 },
        { "\"diameter\": 0.05, \"length\": 0.05", "{\"diameter\": 0.005}], \"particle_count\": 100", 3.0 },
        { "\"diameter\": 0.1, \"length\": 0.0138", "{\"diameter\": 0.003}]", 1.34 },
        { "\"diameter\": 0.1, \"length\": 0.035", "{\"diameter\": 0.005, \"shape\": \"tetrahedron\"}]", 2.74 },
    };
    for (size_t k = 0; k < sizeof runs / sizeof runs[0]; k++) {
        char text[400];
        snprintf(text, sizeof text,
                 "{\"inputs\": {\"drum\": {%s, \"rotation_rate\": 1}, \"particles\": [%s, \"duration\": "
                 "{\"seconds\": 0.1}}}",
                 runs[k].drum, runs[k].particles);
        job_spec spec = parse_or_fail(load(text));
        const double settling = job_spec_estimate(&spec, NULL).simulated_seconds - 0.1;
        assert_true(fabs(settling / sqrt(spec.scene.diameter / spec.scene.gravity) / runs[k].falls - 1) < 0.2);
        job_spec_clear(&spec);
    }
}

/* Peaks of resident memory and steps of three runs: two heaps, of which one has few grains on a wide plate, where the last of
 * them roll until the time is up, and a cylinder that is filled. The figures of the estimate come from such runs, too: this
 * holds the estimate to what was seen, and says nothing of runs that are unlike these. */
static void the_estimate_is_near_what_heaps_and_fills_took(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double steps, bytes;
    } runs[] = {
        { "{\"process\": \"heap\", \"inputs\": {\"tube\": {\"diameter\": 0.025, \"lift_speed\": 0.08}, \"plate\": {\"diameter\": "
          "0.05}, "
          "\"particles\": [{\"diameter\": 0.002}], \"particle_count\": 1500, \"contact\": {\"steps_per_contact\": 20, "
          "\"maximum_overlap\": 0.05, "
          "\"friction\": "
          "0.6}}}",
          32698, 16.9e6 },
        { "{\"process\": \"heap\", \"inputs\": {\"tube\": {\"diameter\": 0.006, \"lift_speed\": 0.05}, \"plate\": {\"diameter\": "
          "2}, "
          "\"particles\": [{\"diameter\": 0.001}], \"particle_count\": 200, \"contact\": {\"steps_per_contact\": 20, "
          "\"maximum_overlap\": 0.05}}}",
          166557, 16.0e6 },
        { "{\"process\": \"fill\", \"inputs\": {\"cylinder\": {\"diameter\": 0.06}, \"stream\": {\"diameter\": 0.03, \"rate\": "
          "2000, "
          "\"impact_speed\": 1.5}, \"particles\": [{\"diameter\": 0.004}], \"particle_count\": 3000, \"contact\": "
          "{\"steps_per_contact\": 20, \"maximum_overlap\": 0.05}}}",
          168809, 18.5e6 },
    };
    for (size_t k = 0; k < sizeof runs / sizeof runs[0]; k++) {
        job_spec spec = parse_or_fail(load(runs[k].spec));
        const job_estimate estimate = job_spec_estimate(&spec, NULL);
        assert_true(fabs(estimate.steps / runs[k].steps - 1) < 0.2 && fabs(estimate.memory_bytes / runs[k].bytes - 1) < 0.2);
        job_spec_clear(&spec);
    }
}

static void the_estimate_grows_with_what_is_asked(void **state)
{
    (void)state;
    job_spec small = parse_or_fail(load(minimal)), large = parse_or_fail(minimal_with("duration/revolutions", "100"));
    const job_estimate a = job_spec_estimate(&small, NULL), b = job_spec_estimate(&large, NULL);
    /* 80 times the revolutions, beside the settling that both have */
    assert_true(b.steps > 40 * a.steps && b.steps < 80 * a.steps);
    const double a_step = a.wall_seconds / a.steps, b_step = b.wall_seconds / b.steps;
    assert_true(b_step < a_step && b_step > 0.8 * a_step); /* what a run costs by itself is shared by more steps */
    assert_true(b.snapshot_bytes > a.snapshot_bytes && a.memory_bytes > 15.7e6);
    job_spec_clear(&small);
    job_spec_clear(&large);
}

static void the_description_has_every_default_and_range_that_the_parser_has(void **state)
{
    (void)state;
    assert_null(process_description("hopper"));
    json_t *description = process_description("drum");
    json_t *friction = json_object_get(
        json_object_get(
            json_object_get(json_object_get(json_object_get(json_object_get(description, "inputs"), "contact"), "schema"),
                            "properties"),
            "friction"),
        "maximum");
    assert_true(json_number_value(friction) == 5);
    const char *const outputs[] = { "repose", "regime", "segregation", "packing", "run" };
    for (size_t o = 0; o < 5; o++) assert_non_null(json_object_get(json_object_get(description, "outputs"), outputs[o]));
    json_decref(description);
}

UNIT_TESTS(a_minimal_request_gets_every_default, a_canonical_spec_is_read_and_written_with_the_same_bytes,
           a_number_out_of_range_is_named_with_value_unit_and_range, the_ends_of_a_range_are_inside_or_not_as_written,
           a_number_that_has_lost_its_digits_is_refused, whole_numbers_are_asked_for_where_they_are_needed,
           unknown_members_are_refused_with_the_nearest_name, what_is_not_available_yet_is_refused_with_what_is,
           a_drum_may_have_end_walls_and_lifters_with_frictions_of_their_own, a_cluster_of_named_or_given_spheres_is_one_particle,
           a_cluster_that_is_no_body_is_refused_with_the_sphere_at_fault, a_run_may_be_asked_for_its_answer,
           each_law_takes_its_own_elasticity, the_time_step_is_the_share_of_a_collision_that_is_asked_for,
           one_of_two_alternatives_is_enough_and_both_are_too_much, all_problems_are_listed_at_once,
           combinations_that_make_no_sense_are_refused, labels_are_short_texts_and_numbers,
           a_long_message_is_cut_between_characters, the_estimate_is_near_what_runs_of_few_and_of_many_took,
           the_estimate_of_settling_follows_how_few_grains_there_are, the_estimate_is_near_what_heaps_and_fills_took,
           the_estimate_grows_with_what_is_asked, the_description_has_every_default_and_range_that_the_parser_has)
