/* Claims about the cost of a step: products of what was measured, by hand. */
#include "calibration.h"
#include "claims.h"

static calibration fake(void)
{
    return (calibration){ .processor = "a processor",
                          .program = "a program",
                          .made = "2026-01-02T03:04:05.000Z",
                          .cores = 4,
                          .sphere = { 10, 20, 30 },
                          .cluster = { 40, 50, 60 },
                          .size = { 100, 2000, 40000 },
                          .size_factor = { 1.5, 1, 2 },
                          .correction = 1 };
}

static calibration_load load_of(double spheres)
{
    return (calibration_load){ .spheres = spheres, .law = DEM_WALTON_BRAUN, .friction = 0.1, .threads = 1 };
}

static bool is_near(double a, double b) { return fabs(a - b) <= 1e-12 * fabs(b); } /* a few roundings of doubles */

static void a_step_costs_its_spheres_by_law_and_kind(void **state)
{
    (void)state;
    const calibration machine = fake();
    calibration_load load = load_of(2000);
    assert_true(is_near(calibration_seconds_a_step(&machine, &load), 2000 * 10e-9));
    load.law = DEM_HERTZ_MINDLIN;
    assert_true(is_near(calibration_seconds_a_step(&machine, &load), 2000 * 30e-9));
    load.of_particle = 4; /* what is measured: tetrahedra */
    assert_true(is_near(calibration_seconds_a_step(&machine, &load), 2000 * 60e-9));
    load.of_particle = 8; /* half as many bodies: between half of it and all of it */
    const double cubes = calibration_seconds_a_step(&machine, &load);
    assert_true(cubes > 2000 * 30e-9 && cubes < 2000 * 60e-9);
}

static void between_measured_sizes_cost_follows_the_logarithm(void **state)
{
    (void)state;
    const calibration machine = fake();
    calibration_load load = load_of(sqrt(2000.0 * 40000.0)); /* half way: a factor of 1.5 */
    assert_true(is_near(calibration_seconds_a_step(&machine, &load), load.spheres * 15e-9));
    load = load_of(10); /* below the smallest: as that */
    assert_true(is_near(calibration_seconds_a_step(&machine, &load), 10 * 15e-9));
    load = load_of(1e6);
    assert_true(is_near(calibration_seconds_a_step(&machine, &load), 1e6 * 20e-9));
}

static void only_cores_that_exist_count_as_threads(void **state)
{
    (void)state;
    const calibration machine = fake();
    calibration_load one = load_of(2000), four = one, many = one;
    four.threads = 4;
    many.threads = 256;
    const double alone = calibration_seconds_a_step(&machine, &one);
    assert_true(calibration_seconds_a_step(&machine, &many) == calibration_seconds_a_step(&machine, &four));
    /* no thread brings more than itself, and each brings something */
    assert_true(calibration_seconds_a_step(&machine, &four) >= alone / 4
                && calibration_seconds_a_step(&machine, &four) < alone / 2);
}

static void finished_runs_correct_what_is_said(void **state)
{
    (void)state;
    calibration machine = fake();
    const calibration_load load = load_of(2000);
    const double before = calibration_seconds_a_step(&machine, &load);
    machine.correction = 1.25;
    assert_true(is_near(calibration_seconds_a_step(&machine, &load), 1.25 * before));
}

static void a_file_is_read_as_it_was_written(void **state)
{
    (void)state;
    const calibration machine = fake();
    calibration again;
    json_t *document = calibration_to_json(&machine);
    assert_true(calibration_from_json(document, &again));
    assert_string_equal(again.processor, machine.processor);
    assert_string_equal(again.program, machine.program);
    assert_string_equal(again.made, machine.made);
    assert_memory_equal(again.sphere, machine.sphere, sizeof machine.sphere);
    assert_memory_equal(again.cluster, machine.cluster, sizeof machine.cluster);
    assert_memory_equal(again.size, machine.size, sizeof machine.size);
    assert_memory_equal(again.size_factor, machine.size_factor, sizeof machine.size_factor);
    assert_true(again.correction == 1 && again.cores >= 1);
    json_decref(document);
}

/* Damaged by hand or by another version: better the built-in figures than an estimate of nothing. */
static void what_is_no_calibration_is_not_used(void **state)
{
    (void)state;
    static const char *const damage[] = { "format", "processor", "nanoseconds_a_sphere_step", "sizes" };
    const calibration built_in = calibration_built_in(), machine = fake();
    calibration read;
    assert_false(calibration_from_json(NULL, &read));
    for (size_t k = 0; k < sizeof damage / sizeof damage[0]; k++) {
        json_t *document = calibration_to_json(&machine);
        json_object_del(document, damage[k]);
        assert_false(calibration_from_json(document, &read));
        assert_memory_equal(read.sphere, built_in.sphere, sizeof built_in.sphere);
        assert_int_equal(read.processor[0], 0);
        json_decref(document);
    }
    json_t *document = calibration_to_json(&machine);
    json_t *spheres = json_object_get(json_object_get(document, "nanoseconds_a_sphere_step"), "spheres");
    static const double absurd[] = { -1, 0, 1e-300, 1e-3, 1e9, 1e300 };
    for (size_t k = 0; k < sizeof absurd / sizeof absurd[0]; k++) {
        json_object_set_new(spheres, "walton-braun", json_real(absurd[k]));
        assert_false(calibration_from_json(document, &read));
        assert_memory_equal(read.sphere, built_in.sphere, sizeof built_in.sphere);
    }
    json_decref(document);
}

UNIT_TESTS(a_step_costs_its_spheres_by_law_and_kind, between_measured_sizes_cost_follows_the_logarithm,
           only_cores_that_exist_count_as_threads, finished_runs_correct_what_is_said, a_file_is_read_as_it_was_written,
           what_is_no_calibration_is_not_used)
