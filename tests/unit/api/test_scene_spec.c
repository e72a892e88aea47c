/* Claims about what specifications say of particles, their shares and clusters, of contacts, and of beds to start from. */
#include "requests.h"

/* Spheres of 4 and 2 mm in equal volumes: 1 to 8 by number; with the small of half the density, 1 to 16 by mass. */
static void shares_by_volume_and_mass_become_shares_by_number(void **state)
{
    (void)state;
    static const char *const by[] = { "\"number\"", "\"volume\"", "\"mass\"" };
    static const double few[] = { 1.0 / 2, 1.0 / 9, 1.0 / 17 };
    for (int k = 0; k < 3; k++) {
        json_t *request = minimal_with("particles", "[{\"diameter\": 0.004, \"density\": 2000, \"share\": 0.5},"
                                                    " {\"diameter\": 0.002, \"density\": 1000, \"share\": 0.5}]");
        json_object_set_new(json_object_get(request, "inputs"), "share_by", json_loads(by[k], JSON_DECODE_ANY, NULL));
        job_spec spec = parse_or_fail(request);
        assert_true(fabs(spec.scene.species[0].share - few[k]) < 1e-15);
        assert_true(fabs(spec.scene.species[1].share - (1 - few[k])) < 1e-15);
        job_spec_clear(&spec);
    }
    /* of the 180 particles of the minimal bed */
    char *problems = problems_of(minimal_with("particles", "[{\"diameter\": 0.005, \"share\": 0.99999}, {\"diameter\": 0.0049, "
                                                           "\"share\": 0.00001}]"));
    assert_string_equal(problems,
                        "/inputs/particles/1/share: is 1e-05, which makes 0.0018 of 180 particles; must make at least one: "
                        "give a larger share or more particles\n");
    free(problems);
}

/* e^2 = 1/(1 + S alpha_max), alpha_max = 1 % of 5 mm: for e = 0.8, S = 0.5625/5e-5 = 11250 1/m. */
static void variable_unloading_takes_its_slope_from_the_restitution_or_the_other_way_round(void **state)
{
    (void)state;
    job_spec constant = parse_or_fail(load(minimal));
    assert_true(constant.scene.contact.unloading_slope == 0);
    job_spec spec = parse_or_fail(minimal_with("contact/unloading", "\"variable\""));
    assert_true(fabs(spec.scene.contact.unloading_slope - 11250) < 1e-6);
    assert_true(spec.scene.contact.restitution == 0.8 && spec.scene.time_step == constant.scene.time_step);
    job_spec_clear(&spec);
    json_t *request = minimal_with("contact/unloading", "\"variable\"");
    json_object_set_new(json_object_get(json_object_get(request, "inputs"), "contact"), "unloading_slope", json_real(11250));
    spec = parse_or_fail(request);
    assert_true(spec.scene.contact.unloading_slope == 11250 && fabs(spec.scene.contact.restitution - 0.8) < 1e-12);
    job_spec_clear(&spec);
    job_spec_clear(&constant);

    expect_problem("contact/unloading_slope", "11250",
                   "/inputs/contact/unloading_slope: is 11250 1/m, but unloading is \"constant\"; give restitution, or unloading "
                   "\"variable\"\n");
    expect_problem(
        "contact", "{\"unloading\": \"variable\", \"unloading_slope\": 1e7}",
        "/inputs/contact/unloading_slope: is 1e+07 1/m, which leaves the hardest impact expected a restitution of 0.0447; "
        "must be at most 1.98e+06 1/m here, for 0.1\n");
    expect_problem("contact", "{\"unloading\": \"variable\", \"unloading_slope\": 1e4, \"restitution\": 0.8}",
                   "/inputs/contact/unloading_slope: is given beside restitution; give one of the two\n");
    expect_problem("contact", "{\"unloading\": \"variable\", \"law\": \"spring-dashpot\"}",
                   "/inputs/contact/unloading: is \"variable\", but this law has no unloading branch; must be \"constant\", or the "
                   "law \"walton-braun\"\n");
}

static void contacts_resist_rolling_where_asked_for(void **state)
{
    (void)state;
    expect_problem("contact/rolling_friction", "1.5", "/inputs/contact/rolling_friction: is 1.5; must be in [0, 1]\n");
    expect_problem("wall", "{\"rolling_friction\": -0.1}", "/inputs/wall/rolling_friction: is -0.1; must be in [0, 1]\n");
    job_spec spec = parse_or_fail(minimal_with("contact/rolling_friction", "0.1"));
    assert_true(spec.scene.contact.rolling_friction == 0.1 && spec.scene.contact.wall_rolling_friction == 0);
    job_spec_clear(&spec);
    spec = parse_or_fail(minimal_with("wall", "{\"rolling_friction\": 0.2}"));
    assert_true(spec.scene.contact.rolling_friction == 0 && spec.scene.contact.wall_rolling_friction == 0.2);
    job_spec_clear(&spec);

    spec = parse_or_fail(minimal_with("contact/rolling_law", "\"constant\""));
    assert_true(spec.scene.contact.rolling_law == DEM_CONSTANT_TORQUE);
    job_spec_clear(&spec);
    spec = parse_or_fail(minimal_with("contact/rolling_law", "\"epsd-damped\""));
    assert_true(spec.scene.contact.rolling_law == DEM_EPSD_DAMPED && spec.scene.contact.rolling_damping == 0.3);
    job_spec_clear(&spec);
    expect_problem("contact/rolling_law", "\"cdt\"",
                   "/inputs/contact/rolling_law: is \"cdt\"; available: \"epsd\", \"epsd-damped\", \"constant\"\n");
    expect_problem("contact/rolling_damping", "1.2", "/inputs/contact/rolling_damping: is 1.2; must be in [0, 0.5]\n");
    expect_problem(
        "contact/rolling_damping", "0.2",
        "/inputs/contact/rolling_damping: is 0.2, but rolling_law is \"epsd\", which has no share of damping to choose; give "
        "rolling_law as \"epsd-damped\", too\n");
}

static void corrector_passes_are_one_unless_asked_for(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(load(minimal));
    assert_int_equal(spec.scene.corrector_passes, 1);
    job_spec_clear(&spec);
    spec = parse_or_fail(minimal_with("integration", "{\"corrector_passes\": 3}"));
    assert_int_equal(spec.scene.corrector_passes, 3);
    job_spec_clear(&spec);
    spec =
        parse_or_fail(load("{\"process\": \"heap\", \"inputs\": {\"tube\": {\"diameter\": 0.03}, \"plate\": {\"diameter\": 0.06},"
                           " \"particles\": [{\"diameter\": 0.003}], \"integration\": {\"corrector_passes\": 2}}}"));
    assert_int_equal(spec.scene.corrector_passes, 2);
    job_spec_clear(&spec);
    expect_problem("integration", "{\"corrector_passes\": 0}", "/inputs/integration/corrector_passes: is 0; must be in [1, 10]\n");
}

/* Two kinds in a drum of 50 by 20 mm; `list` in the place of particles one by one. */
static json_t *starting_with(const char *list)
{
    json_t *request = minimal_with("particles", "[{\"diameter\": 0.004}, {\"shape\": \"dumbbell\", \"diameter\": 0.003}]");
    json_t *start = json_pack("{s:o}", "particles", json_loads(list, JSON_DECODE_ANY, NULL));
    json_object_set_new(json_object_get(request, "inputs"), "start", start);
    return request;
}

static void a_list_of_particles_says_how_many_there_are_of_each(void **state)
{
    (void)state;
    job_spec spec = parse_or_fail(starting_with("[{\"position\": [0, -0.01, 0]}, {\"position\": [0.01, 0, 0], \"species\": 1, "
                                                "\"orientation\": [1, 0, 0, 1]}, {\"position\": [0, 0, 0.009]}]"));
    assert_true(spec.scene.is_placed);
    assert_int_equal(spec.scene.particle_count, 3);
    assert_true(spec.scene.species[0].share == 2.0 / 3 && spec.scene.species[1].share == 1.0 / 3);
    assert_true(spec.inputs.start.particles[1].orientation[3] == 1 && isnan(spec.inputs.start.particles[0].orientation[0]));
    char *text = job_spec_to_text(&spec), *brief = job_spec_to_brief(&spec);
    job_spec again = parse_or_fail(load(text));
    char *same = job_spec_to_text(&again);
    assert_string_equal(text, same);
    assert_non_null(strstr(brief, "\"particles\": 3"));
    free(text);
    free(same);
    free(brief);
    job_spec_clear(&again);
    job_spec_clear(&spec);
}

/* Hertz: the duration of an impact goes with speed to the power -1/5. Particles of a start that are slower than what the step
 * is chosen for leave it as it is; of faster ones, two may meet at the sum of their speeds. */
static void the_step_is_short_enough_for_the_speeds_of_a_start(void **state)
{
    (void)state;
    static const char *const lists[] = { "[{\"position\": [0, -0.01, 0]}, {\"position\": [0.01, 0, 0], \"species\": 1}]",
                                         "[{\"position\": [0, -0.01, 0], \"velocity\": [6, 0, 8]},"
                                         " {\"position\": [0.01, 0, 0], \"species\": 1, \"velocity\": [0, -30, 40]}]",
                                         "[{\"position\": [0, -0.01, 0], \"velocity\": [-12, 0, 16]},"
                                         " {\"position\": [0.01, 0, 0], \"species\": 1, \"velocity\": [0, 100, 0]}]" };
    double step[2][3];
    for (int law = 0; law < 2; law++)
        for (int k = 0; k < 3; k++) {
            json_t *request = starting_with(lists[k]), *inputs = json_object_get(request, "inputs");
            json_object_set_new(inputs, "contact", json_pack("{s:s}", "law", law ? "hertz-mindlin" : "spring-dashpot"));
            job_spec spec = parse_or_fail(request);
            step[law][k] = spec.scene.time_step;
            job_spec_clear(&spec);
        }
    assert_true(step[0][0] == step[0][1] && step[0][1] == step[0][2]); /* a linear spring's does not depend on speed */
    assert_true(step[1][1] < step[1][0]);
    assert_true(fabs(step[1][2] / step[1][1] / pow(0.5, 0.2) - 1) < 1e-12); /* 120 m/s instead of 60 */
}

static void expect_problems_of_start(const char *list, const char *expected)
{
    char *problems = problems_of(starting_with(list));
    if (strcmp(problems, expected) != 0) fail_msg("%s gives:\n%sexpected:\n%s", list, problems, expected);
    free(problems);
}

/* The drum's radius is 25 mm; 5 % of 4 mm are 0.2 mm. A dumbbell along x has its spheres 1.5 mm to either side; turned by
 * a quarter about z, above and below. */
static void particles_outside_the_drum_or_within_each_other_are_all_told(void **state)
{
    (void)state;
    expect_problems_of_start(
        "[{\"position\": [0, -0.0233, 0]}, {\"position\": [0, 0, 0]}, {\"position\": [0.0037, 0, 0]}, {\"position\": [0, 0, 0.02], "
        "\"velocity\": [0, 200, 0]}, {\"position\": [0, 0.01], \"species\": 2}]",
        "/inputs/start/particles/3/velocity/1: is 200 m/s; must be in [-100, 100] m/s\n"
        "/inputs/start/particles/4/position: is a list of 2; must be a list of three numbers, each in [-20, 20] m\n"
        "/inputs/start/particles/4/species: is 2; must be in [0, 1]: particles has 2 kinds\n"
        "/inputs/start/particles/0/position: puts a sphere of 0.004 m at 0.0233 m from the axis; must be at most 0.0232 m, inside "
        "the drum\n"
        "/inputs/start/particles/3/position: coincides with particle 1; each must have a place of its own\n"
        "/inputs/start/particles/2/position: overlaps particle 1 by 0.0003 m; must be at most 0.0002 m, 0.05 of the smaller "
        "diameter\n"
        "/inputs/start/particles/3/position: overlaps particle 2 by 0.0003 m; must be at most 0.0002 m, 0.05 of the smaller "
        "diameter\n");
    expect_problems_of_start("[{\"position\": [0, 0, 0], \"species\": 1}, {\"position\": [0, 0.0034, 0]}]",
                             ""); /* 3.7 mm from either of its spheres to the sphere's centre, of 3.5 needed */
    expect_problems_of_start(
        "[{\"position\": [0, 0, 0], \"species\": 1, \"orientation\": [1, 0, 0, 1]}, {\"position\": [0, 0.0034, 0]}]",
        "/inputs/start/particles/1/position: overlaps particle 0 by 0.0016 m; must be at most 0.00015 m, 0.05 of the smaller "
        "diameter\n");
}

static void a_start_is_one_thing_and_leaves_nothing_unsaid(void **state)
{
    (void)state;
    expect_problem("start", "{}", "/inputs/start: names 0 of job, file and particles; must name one of them\n");
    expect_problem("start", "{\"job\": 5}", "/inputs/start/job: is 5; must be a text of 1 to 27 bytes\n");
    expect_problem("start", "[]", "/inputs/start: is a list; must be an object or null\n");
    expect_problem("start", "{\"job\": \"x\", \"file\": \"y\"}",
                   "/inputs/start: names 2 of job, file and particles; must name one of them\n"
                   "/inputs/start/job: is \"x\"; must be the id of a job, as 20261122-014455-3f9a2c71\n");
    expect_problem("start", "{\"job\": \"20261122-014455-3f9a2c71\", \"snapshot\": 1, \"checkpoint\": true}",
                   "/inputs/start/snapshot: is given beside checkpoint; give one of the two\n");
    expect_problem("start", "{\"job\": \"20261122-014455-3f9a2c71\", \"checkpoint\": false}",
                   "/inputs/start/checkpoint: is false; must be true, or be left out\n");
    expect_problem(
        "start", "{\"file\": \"a.hdf\", \"snapshot\": 1}",
        "/inputs/start/snapshot: is given without start/job, and chooses among the beds of a job; name the job, or leave it out\n");
    expect_problem("start", "{\"job\": \"20261122-014455-3f9a2c71\"}",
                   "/inputs/particle_count: is missing; must be given where the bed that start names is not at hand to be "
                   "counted\n");
    expect_problem("start", "{\"particles\": [{\"position\": [0, 0, 0]}], \"job\": \"20261122-014455-3f9a2c71\"}",
                   "/inputs/start: names 2 of job, file and particles; must name one of them\n");
    expect_fine("start", "null");
}

/* A source with one bed: 100 particles of the minimal drum, which was made with another rate and friction. */
static json_t *find_the_bed(void *context, const start_inputs *start, double *particles, problem_list *problems)
{
    (void)context, (void)start, (void)problems;
    json_t *request = minimal_with("drum/rotation_rate", "1");
    job_spec spec = parse_or_fail(request);
    json_t *canonical = job_spec_to_json(&spec);
    job_spec_clear(&spec);
    *particles = 100;
    return canonical;
}

static void what_a_run_starts_from_must_be_of_the_same_drum_and_particles(void **state)
{
    (void)state;
    const start_source beds = { .find = find_the_bed };
    for (int differs = 0; differs < 2; differs++) {
        json_t *request = minimal_with("start", "{\"job\": \"20261122-014455-3f9a2c71\", \"snapshot\": 4}");
        json_t *inputs = json_object_get(request, "inputs");
        json_object_set_new(inputs, "contact", json_pack("{s:f}", "friction", 0.7));
        if (differs) {
            json_object_set_new(json_object_get(inputs, "drum"), "length", json_real(0.021));
            json_object_set_new(json_array_get(json_object_get(inputs, "particles"), 0), "density", json_real(1000));
            json_object_set_new(inputs, "wall", json_pack("{s:{s:f}}", "lining", "diameter", 0.002));
        }
        job_spec spec;
        problem_list problems;
        problem_list_init(&problems);
        const bool good = job_spec_parse_with(&beds, "drum", request, 1, &spec, &problems);
        assert_int_equal(good, !differs);
        if (good) {
            assert_int_equal(spec.scene.particle_count, 100);
            assert_true(spec.scene.is_placed && spec.scene.contact.friction == 0.7);
            job_spec_clear(&spec);
        } else {
            assert_int_equal(json_array_size(problems.errors), 3);
            const json_t *second = json_array_get(problems.errors, 1);
            assert_string_equal(json_string_value(json_object_get(second, "pointer")), "/inputs/particles/0/density");
            assert_string_equal(json_string_value(json_object_get(second, "detail")),
                                "is 1000; must be 2500, as in the bed that it starts from");
        }
        problem_list_clear(&problems);
        json_decref(request);
    }
}

/* Leaves at the third look. */
static bool leaves_soon(void *looks) { return ++*(int *)looks >= 3; }

static void clusters_are_not_looked_into_for_a_client_that_has_left(void **state)
{
    (void)state;
    int looks = 0;
    const client_watch client = { .has_left = leaves_soon, .client = &looks };
    const start_source beds = { .client = &client };
    for (int left = 0; left < 2; left++) {
        json_t *request = minimal_with("seed", "1"), *species = json_array();
        for (int s = 0; s < 4; s++)
            json_array_append_new(species, json_pack("{s:s, s:f, s:f}", "shape", "dumbbell", "diameter", 0.003, "share", 0.25));
        json_object_set_new(json_object_get(request, "inputs"), "particles", species);
        job_spec spec;
        problem_list problems;
        problem_list_init(&problems);
        assert_int_equal(job_spec_parse_with(left ? &beds : NULL, "drum", request, 1, &spec, &problems), !left);
        if (!left) job_spec_clear(&spec);
        assert_int_equal(json_array_size(problems.errors), left ? 2 : 0); /* the third and the fourth */
        problem_list_clear(&problems);
        json_decref(request);
    }
    assert_int_equal(looks, 4);
}

static void a_rate_may_be_given_in_revolutions_a_minute(void **state)
{
    (void)state;
    json_t *request = minimal_with("drum/rotation_rate_rpm", "15");
    json_object_del(json_object_get(json_object_get(request, "inputs"), "drum"), "rotation_rate");
    job_spec spec = parse_or_fail(request);
    assert_true(fabs(spec.inputs.rotation_rate - 1.5707963267948966) < 1e-15);
    char *text = job_spec_to_text(&spec); /* canonical: one spelling */
    assert_null(strstr(text, "rpm"));
    free(text);
    job_spec_clear(&spec);
    expect_problem("drum/rotation_rate_rpm", "15",
                   "/inputs/drum/rotation_rate_rpm: is given beside rotation_rate; give one of the two\n");
    expect_fine("drum/rotation_rate", "-3");
    expect_problem("drum/rotation_rate", "0",
                   "/inputs/drum/rotation_rate: is 0 rad/s; must be in [-500, 500] rad/s, and at least 0.001 in size\n");
}

static void shares_of_four_digits_sum_to_one(void **state)
{
    (void)state;
#define THREE(share)                                                                                                               \
    "[{\"diameter\": 0.005, \"share\": " share "}, {\"diameter\": 0.004, \"share\": " share "},"                                   \
    " {\"diameter\": 0.003, \"share\": " share "}]"
    expect_fine("particles", THREE("0.3333"));
    expect_fine("particles", THREE("0.33336"));
    expect_problem("particles", THREE("0.333"), "/inputs/particles: have shares that sum to 0.999; must sum to 1\n");
    job_spec spec = parse_or_fail(minimal_with("particles", THREE("0.3333")));
    assert_true(fabs(spec.scene.species[0].share + spec.scene.species[1].share + spec.scene.species[2].share - 1.0) < 1e-15);
    job_spec_clear(&spec);
}

/* A drum of 40 mm with 4 mm spheres and these members besides. */
static void expect_of_small_drum(const char *drum, const char *rest, const char *found)
{
    char text[900];
    snprintf(text, sizeof text,
             "{\"inputs\": {\"drum\": {\"diameter\": 0.04, \"length\": 0.012, \"rotation_rate\": 6%s},"
             " \"particles\": [{\"diameter\": 0.004}], \"duration\": {\"seconds\": 0.05}%s}}",
             drum, rest);
    char *problems = problems_of(load(text));
    if (*found ? !strstr(problems, found) : *problems) fail_msg("%s gives:\n%sexpected:\n%s", text, problems, found);
    free(problems);
}

#define AT(x, y) ", \"start\": {\"particles\": [{\"position\": [" x ", " y ", 0]}]}"
#define BARS ", \"lifters\": {\"count\": 4, \"height\": 0.008, \"width\": 0.008}"
#define LINING ", \"wall\": {\"lining\": {\"diameter\": 0.004}}"
#define SPARSE_LINING ", \"wall\": {\"lining\": {\"diameter\": 0.004, \"pitch\": 0.012}}"

static void what_can_not_be_packed_is_refused(void **state)
{
    (void)state;
    expect_of_small_drum("", ", \"fill_fraction\": 0.75" LINING,
                         "/inputs/fill_fraction: makes a fill of 0.75; must be at most 0.65");
    expect_of_small_drum("", ", \"fill_fraction\": 0.65" LINING, "");
    /* Spheres far apart in the lining leave no more room: where beds are made, its whole layer is left out. */
    expect_of_small_drum("", ", \"fill_fraction\": 0.7" SPARSE_LINING,
                         "/inputs/fill_fraction: makes a fill of 0.7; must be at most 0.6");
    expect_of_small_drum("", ", \"fill_fraction\": 0.65" SPARSE_LINING, "");
    expect_of_small_drum("", ", \"fill_fraction\": 0.95", "");
    expect_of_small_drum(BARS, ", \"fill_fraction\": 0.85", "beside these lifters");
    static const char cubes[] = "[{\"shape\": \"cube\", \"diameter\": 0.002}]";
    for (int refused = 0; refused < 2; refused++) {
        json_t *request = minimal_with("particles", cubes);
        json_object_set_new(json_object_get(request, "inputs"), "fill_fraction", json_real(refused ? 0.9 : 0.85));
        char *problems = problems_of(request);
        assert_true(refused ? strstr(problems, "must be at most 0.87") != NULL : *problems == '\0');
        free(problems);
    }
}

static void a_start_within_a_bar_or_the_lining_is_refused(void **state)
{
    (void)state;
    expect_of_small_drum(BARS, AT("0", "-0.014"), "particles/0/position: puts a sphere of 0.004 m 0.004 m into a lifter");
    expect_of_small_drum(BARS, AT("0.0055", "-0.014"), "into a lifter"); /* beside the bar, which ends at 4 mm: half a radius in */
    expect_of_small_drum(BARS, AT("0.0061", "-0.014"), "");
    expect_of_small_drum(BARS, AT("0", "-0.0099"), "");
    expect_of_small_drum("", LINING AT("0.0175", "0"), "into the lining");
    expect_of_small_drum("", LINING AT("0.0139", "0"), "");
    expect_of_small_drum("", ", \"start\": {\"particles\": [{\"position\": [0, 0, 0]}, {\"position\": [0, 0, 0]}]}",
                         "particles/1/position: coincides with particle 0");
}

UNIT_TESTS(shares_by_volume_and_mass_become_shares_by_number,
           variable_unloading_takes_its_slope_from_the_restitution_or_the_other_way_round,
           the_step_is_short_enough_for_the_speeds_of_a_start, contacts_resist_rolling_where_asked_for,
           corrector_passes_are_one_unless_asked_for, a_list_of_particles_says_how_many_there_are_of_each,
           particles_outside_the_drum_or_within_each_other_are_all_told, a_start_is_one_thing_and_leaves_nothing_unsaid,
           what_a_run_starts_from_must_be_of_the_same_drum_and_particles, clusters_are_not_looked_into_for_a_client_that_has_left,
           a_rate_may_be_given_in_revolutions_a_minute, shares_of_four_digits_sum_to_one, what_can_not_be_packed_is_refused,
           a_start_within_a_bar_or_the_lining_is_refused)
