/* Claims about the stream that fills a cylinder: who enters when, where and how fast, and that it can be taken up again. */
#include "dem_cluster.h"
#include "dem_stream.h"
#include "grounded.h"
#include "scene.h"
#include "small_drum.h"

/* 30 mm across, 3 mm spheres, entering through the middle third at 1 m/s. */
static dem_scene_definition small_fill(size_t particles, double rate)
{
    dem_scene_definition d = small_drum();
    d.container = DEM_CYLINDER;
    d.diameter = 0.03;
    d.length = 0.1;
    d.rotation_rate = 0;
    d.ends.friction = 0.5;
    d.stream = (dem_stream){ .rate = rate, .diameter = 0.012, .impact_speed = 1.0 };
    d.particle_count = particles;
    return d;
}

/* Stiffness for an overlap of 3 % at the impact. */
static void stiffen(dem_scene_definition *d)
{
    double lightest = INFINITY, heaviest = 0, smallest = INFINITY;
    for (size_t k = 0; k < d->species_count; k++) {
        dem_cluster_complete(&d->species[k].cluster);
        lightest = fmin(lightest, dem_species_contact_mass(&d->species[k]));
        heaviest = fmax(heaviest, dem_species_mass(&d->species[k]));
        smallest = fmin(smallest, dem_species_smallest_sphere(&d->species[k]));
    }
    d->contact.stiffness = dem_stiffness_for_overlap(d->stream.impact_speed, heaviest, 0.03 * smallest);
    d->time_step = dem_time_step(d->contact.stiffness, lightest, d->contact.restitution);
}

static void particles_enter_when_they_are_due(void **state)
{
    (void)state;
    dem_scene_definition d = small_fill(12, 200);
    stiffen(&d);
    dem_scene *scene = drum_scene(&d);
    assert_int_equal(dem_scene_phase(scene), DEM_PHASE_RUNNING);
    assert_int_equal(dem_scene_particle_count(scene), 1);
    while (dem_scene_time(scene) < 0.1) {
        run(scene, 20);
        /* Particle p at p/200 s, at the first step from then on. */
        const double due = floor(dem_scene_time(scene) * 200 + 1e-9) + 1;
        assert_int_equal(dem_scene_particle_count(scene), (size_t)fmin(due, 12));
    }
    dem_scene_free(scene);
}

static void a_particle_meets_the_level_of_the_bed_at_the_speed_asked_for(void **state)
{
    (void)state;
    dem_scene_definition d = small_fill(1, 100);
    stiffen(&d);
    dem_scene *scene = drum_scene(&d);
    double position[3], velocity[3], before = INFINITY, speed = 0;
    const dem_particle_arrays arrays = { .position = position, .velocity = velocity };
    dem_scene_particles(scene, &arrays);
    CHECK_NEAR(position[2], dem_stream_inlet_height(&d, 0), 1e-15);
    assert_true(hypot(position[0], position[1]) <= 0.5 * d.stream.diameter - 0.0015 + 1e-15);
    for (int k = 0; k < 100000; k++) {
        run(scene, 1);
        dem_scene_particles(scene, &arrays);
        if (position[2] > before) break;
        before = position[2];
        if (position[2] > 0) speed = position[2] > 0.0015 ? -velocity[2] : speed;
    }
    /* It touches the floor one radius above the level, so it is slower by 2 g r: 3 % in square, and by a step's fall. */
    CHECK_NEAR(speed * speed, 1 - 2 * 9.81 * 0.0015, 2 * 9.81 * 1.1 * d.time_step);
    dem_scene_free(scene);
}

static void nobody_enters_into_another_and_all_arrive(void **state)
{
    (void)state;
    dem_scene_definition d = small_fill(300, 0);
    d.stream.rate = dem_stream_most_rate(&d);
    stiffen(&d);
    dem_scene *scene = drum_scene(&d);
    const double end = 300 / d.stream.rate;
    while (dem_scene_time(scene) < 1.05 * end) run(scene, 100);
    /* At the rate that the rule allows nobody waits for long. */
    assert_int_equal(dem_scene_particle_count(scene), 300);
    /* An overlap at entering would be a push of more than the impact's. */
    CHECK_BETWEEN(dem_scene_maximum_overlap(scene), 0.005, 0.06);
    dem_scene_free(scene);
}

static dem_scene_definition mixed_fill(void)
{
    dem_scene_definition d = small_fill(120, 500);
    d.species_count = 3;
    d.species[0].share = 0.5;
    for (size_t k = 1; k < 3; k++) {
        d.species[k] = (dem_species){ .diameter = 0.002, .density = 2500, .share = 0.25 };
        dem_cluster_of_shape(&d.species[k].cluster, k == 1 ? DEM_TETRAHEDRON : DEM_CUBE, 0.002);
    }
    stiffen(&d);
    return d;
}

static void species_come_mixed_in_proportion(void **state)
{
    (void)state;
    const dem_scene_definition d = mixed_fill();
    dem_scene *scene = drum_scene(&d);
    while (dem_scene_particle_count(scene) < 60) run(scene, 100);
    size_t count[3] = { 0 };
    for (size_t p = 0; p < 60; p++) count[particle_species(&scene->spheres, p)]++;
    /* 60 of 120, half of them spheres: 30, hypergeometric deviation sqrt(60/4 * 60/119) = 2.7; four of these. */
    CHECK_BETWEEN((double)count[0], 30 - 11, 30 + 11);
    CHECK_BETWEEN((double)count[1], 15 - 10, 15 + 10);
    while (dem_scene_particle_count(scene) < 120) run(scene, 100);
    memset(count, 0, sizeof count);
    for (size_t p = 0; p < 120; p++) count[particle_species(&scene->spheres, p)]++;
    assert_true(count[0] == 60 && count[1] == 30 && count[2] == 30);
    assert_int_equal(dem_scene_sphere_count(scene), 60 + 30 * 4 + 30 * 8);
    dem_scene_free(scene);
}

static void assert_same_state(const dem_scene *a, const dem_scene *b)
{
    dem_state x, y;
    assert_int_equal(dem_scene_save(a, &x), DEM_OK);
    assert_int_equal(dem_scene_save(b, &y), DEM_OK);
    assert_int_equal(x.array_count, y.array_count);
    for (size_t k = 0; k < x.array_count; k++) {
        assert_int_equal(x.array[k].rows, y.array[k].rows);
        const size_t size = x.array[k].element == DEM_INT32 ? 4 : 8;
        if (x.array[k].rows) assert_memory_equal(x.array[k].data, y.array[k].data, x.array[k].rows * x.array[k].columns * size);
    }
    dem_state_clear(&x);
    dem_state_clear(&y);
}

static void a_fill_has_the_same_bits_for_any_threads_and_after_a_restart(void **state)
{
    (void)state;
    for (int mixed = 0; mixed < 2; mixed++) {
        dem_scene_definition d = mixed ? mixed_fill() : small_fill(150, 600);
        stiffen(&d);
        dem_scene *whole = drum_scene(&d);
        while (dem_scene_particle_count(whole) < 40) run(whole, 100); /* in the midst of the stream */
        const int64_t middle = dem_scene_step_count(whole);
        dem_state saved;
        assert_int_equal(dem_scene_save(whole, &saved), DEM_OK);
        run(whole, 9000);
        assert_true(dem_scene_particle_count(whole) > 45); /* more entered since */
        for (int threads = 1; threads <= 3; threads++) {
            d.threads = threads;
            dem_scene *again = drum_scene(&d);
            if (threads == 2) assert_int_equal(dem_scene_restore(again, &saved), DEM_OK);
            else run(again, middle);
            for (int k = 0; k < 90; k++) run(again, 100);
            assert_same_state(whole, again);
            dem_scene_free(again);
        }
        /* A state of another number of spheres than any particles have is refused. */
        if (mixed) {
            dem_scene *other = drum_scene(&d);
            for (size_t k = 0; k < saved.array_count; k++)
                if (strcmp(saved.array[k].name, "position") == 0) saved.array[k].rows = 100000;
            assert_int_equal(dem_scene_restore(other, &saved), DEM_STATE_MISMATCH);
            dem_scene_free(other);
        }
        dem_state_clear(&saved);
        dem_scene_free(whole);
    }
}

/* A tower of three on the floor, the third a twentieth of a grain above the second, and one a grain above it in flight. */
static void what_rests_on_the_floor_is_told_from_what_falls(void **state)
{
    (void)state;
    dem_scene_definition d = small_fill(4, 1e6);
    d.stream.diameter = 0.03;
    stiffen(&d);
    dem_scene *scene = drum_scene(&d);
    while (dem_scene_particle_count(scene) < 4) run(scene, 1);
    const double r = 0.0015, height[4] = { 8.15 * r, r, 3 * r, 5.1 * r };
    for (size_t p = 0; p < 4; p++) sphere_set_place(&scene->spheres, p, (double[3]){ 0.001, 0.002, height[p] });
    bool is_grounded[4];
    assert_int_equal(grounded_find(scene, 2 * r, is_grounded), DEM_OK);
    assert_true(!is_grounded[0] && is_grounded[1] && is_grounded[2] && is_grounded[3]);
    /* Without the second nothing holds the third. */
    sphere_set_place(&scene->spheres, 2, (double[3]){ 0.008, 0.002, 3 * r });
    assert_int_equal(grounded_find(scene, 2 * r, is_grounded), DEM_OK);
    assert_true(is_grounded[1] && !is_grounded[0] && !is_grounded[2] && !is_grounded[3]);
    dem_scene_free(scene);
}

static void streams_that_make_no_sense_are_refused(void **state)
{
    (void)state;
    for (int wrong = 0; wrong < 4; wrong++) {
        dem_scene_definition d = small_fill(10, 100);
        stiffen(&d);
        if (wrong == 0) d.stream.diameter = 0.031;  /* wider than the cylinder */
        if (wrong == 1) d.stream.diameter = 0.0029; /* narrower than a particle */
        if (wrong == 2) d.stream.impact_speed = 0.9 * dem_stream_least_impact_speed(&d);
        if (wrong == 3) d.container = DEM_DRUM;
        dem_scene *scene = NULL;
        assert_int_equal(dem_scene_create(&d, &scene), DEM_BAD_PARAMETER);
        assert_null(scene);
    }
}

UNIT_TESTS(particles_enter_when_they_are_due, a_particle_meets_the_level_of_the_bed_at_the_speed_asked_for,
           nobody_enters_into_another_and_all_arrive, species_come_mixed_in_proportion,
           a_fill_has_the_same_bits_for_any_threads_and_after_a_restart, what_rests_on_the_floor_is_told_from_what_falls,
           streams_that_make_no_sense_are_refused)
