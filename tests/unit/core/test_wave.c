/* Claims about several steps in one pass: they are the same steps, to the last bit, also where they have to stop on the
 * way. The oracle: the same run, told to take one step at a time. */
#include "scene.h"
#include "small_drum.h"
#include "wave.h"

enum { MOST_STEPS = 3 * HORIZON, BEFORE_SORT = 8192 - 500 };

/* Eight diameters across and a hundred long: some 3000 spheres, so that steps follow each other along it. */
static dem_scene_definition slender_drum(void)
{
    dem_scene_definition d = small_drum();
    d.diameter = 0.024;
    d.length = 0.3;
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, d.species_count);
    return d;
}

/* Sizes, moments of both ends, rolling: whatever a contact may have. */
static dem_scene_definition slender_mixture(void)
{
    dem_scene_definition d = slender_drum();
    d.species_count = 2;
    d.species[0].share = 0.7;
    d.species[1] = (dem_species){ .diameter = 0.004, .density = 2500, .share = 0.3 };
    d.contact.rolling_friction = d.contact.wall_rolling_friction = 0.1;
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, d.species_count);
    return d;
}

static dem_scene *scene_in_waves(const dem_scene_definition *d, double margin)
{
    dem_scene *scene = drum_scene(d);
    scene->spheres.in_waves = true;
    if (margin > 0) scene->neighbors.least_margin = scene->neighbors.most_margin = scene->neighbors.margin = margin;
    return scene;
}

static void check_same_bits(const dem_scene *a, const dem_scene *b)
{
    const spheres *s = &a->spheres, *t = &b->spheres;
    const size_t n = s->mobile_count;
    assert_int_equal(a->step_count, b->step_count);
    assert_memory_equal(s->id, t->id, n * sizeof *s->id);
    assert_memory_equal(s->place, t->place, n * sizeof *s->place);
    assert_memory_equal(s->velocity, t->velocity, n * sizeof *s->velocity);
    assert_memory_equal(s->angular_velocity, t->angular_velocity, n * sizeof *s->angular_velocity);
    assert_memory_equal(&a->maximum_overlap, &b->maximum_overlap, sizeof a->maximum_overlap);
    assert_memory_equal(&a->torque, &b->torque, sizeof a->torque);
    assert_memory_equal(&a->container.angle, &b->container.angle, sizeof a->container.angle);
}

typedef struct tally {
    int64_t steps, in_waves; /* of these, in waves */
    int64_t stopped;         /* waves that had to be picked for again on their way */
} tally;

/* `calls` times up to MOST_STEPS steps, of another number each time. */
static tally compare(dem_scene *waves, dem_scene *single, int calls)
{
    tally t = { 0 };
    for (int call = 0; call < calls; call++) {
        for (int left = 1 + call * 7 % MOST_STEPS; left > 0;) {
            const int steps = wave_length(waves, left);
            const int64_t picks = waves->neighbors.inner_picks;
            run(waves, steps);
            for (int k = 0; k < steps; k++) run(single, 1);
            t.steps += steps;
            if (steps > 1) t.in_waves += steps;
            t.stopped += waves->neighbors.inner_picks - picks > 1;
            left -= steps;
        }
        if (call % 20 == 0) check_same_bits(waves, single);
    }
    check_same_bits(waves, single);
    return t;
}

/* While it falls, through the change of phase, and as it turns, across a sort. */
static tally check_drum(dem_scene_definition *d, double margin)
{
    follow_rules(d, 0.04);
    dem_scene *waves = scene_in_waves(d, margin), *single = scene_in_waves(d, margin);
    run_to_phase(waves, DEM_PHASE_SETTLING);
    run_to_phase(single, DEM_PHASE_SETTLING);
    tally sum = compare(waves, single, 100);
    run_to_phase(waves, DEM_PHASE_RUNNING);
    run(waves, BEFORE_SORT - (dem_scene_step_count(waves) - dem_scene_run_start(waves)));
    while (dem_scene_step_count(single) < dem_scene_step_count(waves)) run(single, 1);
    const tally t = compare(waves, single, 100);
    assert_true(dem_scene_step_count(waves) - dem_scene_run_start(waves) > 8192);
    sum.steps += t.steps;
    sum.in_waves += t.in_waves;
    sum.stopped += t.stopped;
    dem_scene_free(waves);
    dem_scene_free(single);
    return sum;
}

static void waves_have_the_same_bits_as_single_steps(void **unused)
{
    (void)unused;
    dem_scene_definition d = slender_drum();
    const tally t = check_drum(&d, 0);
    assert_true(t.in_waves > t.steps / 2);
}

static void of_a_rolling_mixture_between_end_walls_too(void **unused)
{
    (void)unused;
    dem_scene_definition d = slender_mixture();
    d.ends.are_walls = true;
    d.ends.friction = 0.3;
    const tally t = check_drum(&d, 0);
    assert_true(t.in_waves > t.steps / 2);
}

static void by_every_law(void **unused)
{
    (void)unused;
    const dem_contact_law laws[] = { DEM_SPRING_DASHPOT, DEM_HERTZ_MINDLIN };
    for (int k = 0; k < 2; k++) {
        dem_scene_definition d = slender_drum();
        follow_rules(&d, 0.04);
        d.contact.law = laws[k];
        if (laws[k] == DEM_HERTZ_MINDLIN) d.contact.particle = d.contact.wall = (dem_elasticity){ 1e7, 0.3 };
        dem_scene *waves = scene_in_waves(&d, 2e-6), *single = scene_in_waves(&d, 2e-6);
        run_to_phase(waves, DEM_PHASE_SETTLING);
        run_to_phase(single, DEM_PHASE_SETTLING);
        const tally t = compare(waves, single, 200);
        assert_true(t.stopped > t.steps / 100);
        dem_scene_free(waves);
        dem_scene_free(single);
    }
}

/* A margin so narrow that the first collision on the way, or the first step, uses it up. */
static void waves_that_stop_on_their_way_have_the_same_bits(void **unused)
{
    (void)unused;
    const double margins[] = { 1e-9, 2e-7, 2e-6, 1e-6 };
    for (int k = 0; k < 4; k++) {
        dem_scene_definition d = k % 2 ? slender_mixture() : slender_drum();
        const tally t = check_drum(&d, margins[k]);
        assert_true(t.stopped > t.steps / 100);
    }
}

/* The same failure at the same step, as no step behind it counts. */
static void a_drum_that_is_too_soft_stops_as_in_single_steps(void **unused)
{
    (void)unused;
    dem_scene_definition d = slender_drum();
    follow_rules(&d, 0.04);
    dem_scene *waves = scene_in_waves(&d, 0), *single = scene_in_waves(&d, 0);
    run_to_phase(waves, DEM_PHASE_RUNNING);
    run_to_phase(single, DEM_PHASE_RUNNING);
    waves->contact.stiffness /= 3000;
    single->contact.stiffness /= 3000;
    dem_status status = DEM_OK;
    while (status == DEM_OK) status = dem_scene_advance(waves, 1000);
    assert_int_equal(status, DEM_OVERLAP_TOO_LARGE);
    for (status = DEM_OK; status == DEM_OK;) status = dem_scene_advance(single, 1);
    const dem_failure *a = dem_scene_failure(waves), *b = dem_scene_failure(single);
    assert_int_equal(a->status, b->status);
    assert_int_equal(a->step, b->step);
    assert_int_equal(a->particle, b->particle);
    assert_int_equal(a->other, b->other);
    CHECK_NEAR(a->value, b->value, 1e-12);
    dem_scene_free(waves);
    dem_scene_free(single);
}

/* What a wave would not foresee keeps to single steps. */
static void what_moves_otherwise_takes_single_steps(void **unused)
{
    (void)unused;
    dem_scene_definition d = slender_drum();
    d.threads = 2;
    follow_rules(&d, 0.04);
    dem_scene *scene = scene_in_waves(&d, 0);
    run_to_phase(scene, DEM_PHASE_SETTLING);
    run(scene, 10);
    for (int k = 0; k < 20; k++) {
        run(scene, 1);
        assert_int_equal(wave_length(scene, 1000), 1);
    }
    dem_scene_free(scene);
    d.threads = 1;
    scene = scene_in_waves(&d, 0);
    assert_int_equal(wave_length(scene, 1000), 1); /* it grows */
    run_to_phase(scene, DEM_PHASE_RUNNING);
    run(scene, 10);
    int longest = 0;
    for (int k = 0; k < 20; k++) {
        run(scene, 1);
        const int length = wave_length(scene, 1000);
        longest = length > longest ? length : longest;
        scene->definition.rotation_rate *= 2; /* the wall's velocity is another from the next step on */
        assert_int_equal(wave_length(scene, 1000), 1);
        scene->definition.rotation_rate /= 2;
    }
    assert_true(longest > 3);
    dem_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_have_the_same_bits_as_single_steps),
        cmocka_unit_test(of_a_rolling_mixture_between_end_walls_too),
        cmocka_unit_test(by_every_law),
        cmocka_unit_test(waves_that_stop_on_their_way_have_the_same_bits),
        cmocka_unit_test(a_drum_that_is_too_soft_stops_as_in_single_steps),
        cmocka_unit_test(what_moves_otherwise_takes_single_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
