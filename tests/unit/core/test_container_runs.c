/* Claims about beds in containers other than the periodic drum: made clear of every wall, no contact with a wall missed,
 * particles kept on their side of it, the same bits however run, and those that fall off a plate lost. */
#include "container_by_hand.h"
#include "small_drum.h"
#include "step.h"

enum { CONTAINERS = 8 };

/* 3 mm spheres, soft, to be quick: a drum with ends, one with lifters too, a cylinder, a tube that is raised over a plate
 * with a rim, one over a bare plate not much wider, and vessels: a flat floor with a hole, a hopper, a slot with a hopper. */
static dem_scene_definition bed_in(int which)
{
    dem_scene_definition d = small_drum();
    d.particle_count = 200;
    switch (which) {
    case 1: d.lifters = (dem_lifters){ .count = 5, .height = 0.006, .width = 0.004, .friction = 0.6 }; /* fall through */
    case 0:
        d.rotation_rate = 12;
        d.ends = (dem_drum_ends){ .are_walls = true, .friction = 0.4 };
        break;
    case 2:
        d.container = DEM_CYLINDER;
        d.length = 0.05;
        d.ends.friction = 0.4;
        break;
    case 5:
    case 6:
    case 7:
        d.container = DEM_VESSEL;
        d.diameter = 0.025;
        d.length = 0.08;
        d.orifice = (dem_orifice){ .opening = 0.012, .depth = which == 7 ? 0.015 : 0, .half_angle = which == 5 ? 0 : 0.6 };
        d.ends.friction = 0.4;
        d.rotation_rate = 0;
        break;
    default:
        d.container = DEM_TUBE_ON_PLATE;
        d.diameter = 0.02;
        d.length = 0.06;
        d.lift = (dem_lift){ .speed = 0.2, .start = 0.005 };
        d.plate = (dem_plate){ .diameter = which == 3 ? 0.05 : 0.026, .rim_height = which == 3 ? 0.006 : 0, .friction = 0.4 };
        d.rotation_rate = 0;
    }
    follow_rules(&d, 0.03);
    return d;
}

static dem_scene *bed_scene(const dem_scene_definition *d)
{
    dem_scene *scene = drum_scene(d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    return scene;
}

/* ---- filling ---- */

static void check_clear(const dem_scene *scene, double overlap)
{
    const spheres *s = &scene->spheres;
    for (size_t i = 0; i < s->mobile_count; i++)
        CHECK_BETWEEN(container_overlap(&scene->container, sphere_place(s, i), sphere_radius(s, i)), -INFINITY, overlap);
}

static void beds_are_made_clear_of_all_walls(void **unused)
{
    (void)unused;
    for (int which = 0; which < CONTAINERS; which++)
        for (int joined = 0; joined < 1 + which % 2; joined++) { /* dumbbells among lifters, and in a tube */
            dem_scene_definition d = bed_in(which);
            if (joined) {
                d.particle_count /= 3;
                d.species[0].cluster =
                    (dem_cluster){ .sphere_count = 2, .sphere = { { .diameter = 0.002 }, { { 0.0015 }, .diameter = 0.002 } } };
                d.time_step /= 2;
            }
            dem_scene *scene = drum_scene(&d);
            assert_int_equal(dem_scene_particle_count(scene), d.particle_count);
            check_clear(scene, 0);
            /* while they grow, and at rest: no more than the softness asked for */
            while (dem_scene_phase(scene) < DEM_PHASE_RUNNING) {
                run(scene, 500);
                check_clear(scene, 0.1 * 0.003);
            }
            assert_int_equal(dem_scene_lost_count(scene), 0);
            dem_scene_free(scene);
        }
}

static void more_than_a_container_holds_does_not_fit(void **unused)
{
    (void)unused;
    for (int which = 0; which < CONTAINERS; which++) {
        dem_scene_definition d = bed_in(which);
        d.particle_count = 3000;
        dem_scene *scene = NULL;
        assert_int_equal(dem_scene_create(&d, &scene), DEM_DOES_NOT_FIT);
    }
}

/* ---- contacts with walls ---- */

/* Every step, all spheres against all walls: a sphere nearer than its radius is in the list. */
static size_t check_all_listed(const dem_scene *scene)
{
    const spheres *s = &scene->spheres;
    const neighbor_list *list = &scene->neighbors;
    size_t touching = 0;
    for (size_t i = 0; i < s->mobile_count; i++)
        for (int k = 0; k < scene->container.wall_count; k++) {
            if (wall_seen_from(&scene->container.wall[k], sphere_place(s, i)).distance >= sphere_radius(s, i)) continue;
            bool listed = false;
            for (size_t slot = list->wall_start[i]; slot < list->wall_start[i + 1]; slot++)
                listed = listed || list->walls.second[slot] == k;
            if (!listed) fail_msg("step %lld: sphere %zu at wall %d is not listed", (long long)scene->step_count, i, k);
            touching++;
        }
    return touching;
}

static void no_contact_with_a_wall_is_missed_at_any_step(void **unused)
{
    (void)unused;
    for (int which = 0; which < CONTAINERS; which++) {
        const dem_scene_definition d = bed_in(which);
        dem_scene *scene = bed_scene(&d);
        size_t touching = 0;
        for (int k = 0; k < 2000; k++) {
            run(scene, 1);
            touching += check_all_listed(scene);
        }
        CHECK_BETWEEN((double)touching / 2000, 5, 1000); /* there was something to miss */
        CHECK_BETWEEN((double)scene->neighbors.inner_picks, 2000 / HORIZON, 0.5 * (double)scene->step_count);
        dem_scene_free(scene);
    }
}

/* The tube rises through the bed: a particle changes sides only beneath its edge. */
static void a_rising_tube_lets_particles_out_beneath_it_alone(void **unused)
{
    (void)unused;
    const dem_scene_definition d = bed_in(3);
    dem_scene *scene = bed_scene(&d);
    const size_t n = d.particle_count;
    const container_wall *tube = &scene->container.wall[0];
    bool *was_inside = calloc(n, sizeof *was_inside);
    assert_non_null(was_inside);
    for (size_t i = 0; i < n; i++) was_inside[i] = true;
    size_t left = 0;
    while (tube->low < 0.03) {
        run(scene, 5);
        for (size_t i = 0; i < n; i++) {
            const double *x = sphere_place(&scene->spheres, i), rho = hypot(x[0], x[1]);
            const bool is_inside = rho < tube->radius;
            if (is_inside == was_inside[i]) continue;
            /* a centre in the shell's own surface is at its edge at least half a radius below it, or has failed */
            CHECK_BETWEEN(x[2], 0, tube->low + 1e-9);
            was_inside[i] = is_inside;
            left++;
        }
    }
    CHECK_BETWEEN((double)left, 0.3 * (double)n, (double)n * 3);
    assert_int_equal(dem_scene_lost_count(scene), 0);
    free(was_inside);
    dem_scene_free(scene);
}

/* Dumbbells thrown above the tube's height and toward its wall: over an edge there they would fall outside, or lie across it
 * and ride up with the tube. */
static void no_dumbbell_goes_over_the_wall_of_a_tube(void **unused)
{
    (void)unused;
    enum { THROWN = 8 };
    dem_scene_definition d = bed_in(4);
    d.particle_count = THROWN;
    d.plate.diameter = 0.05;
    d.species[0].cluster =
        (dem_cluster){ .sphere_count = 2, .sphere = { { { -0.001 }, .diameter = 0.002 }, { { 0.001 }, .diameter = 0.002 } } };
    d.time_step /= 4;
    dem_scene *scene = drum_scene(&d);
    dem_placed_particle thrown[THROWN] = { 0 };
    for (int k = 0; k < THROWN; k++) {
        const double e[2] = { cos(2 * M_PI * k / THROWN), sin(2 * M_PI * k / THROWN) };
        thrown[k] = (dem_placed_particle){ .position = { 0.006 * e[0], 0.006 * e[1], 0.05 },
                                           .velocity = { 0.1 * e[0], 0.1 * e[1], 0.8 + 0.05 * k },
                                           .orientation = { 1, 0, 0, 0 } };
    }
    assert_int_equal(dem_scene_place(scene, thrown, THROWN, 0), DEM_OK);
    double highest = 0;
    while (dem_scene_time(scene) < 0.15) {
        run(scene, 50);
        for (size_t p = 0; p < THROWN; p++) {
            const double *x = particle_place(&scene->spheres, p);
            if (x[2] > scene->container.wall[0].low) CHECK_BETWEEN(hypot(x[0], x[1]), 0, scene->container.wall[0].radius);
            highest = fmax(highest, x[2]);
        }
    }
    CHECK_BETWEEN(highest, d.length + 0.2 * 0.1 + 0.005, 1); /* they were above the part that it was made with */
    assert_int_equal(dem_scene_lost_count(scene), 0);
    dem_scene_free(scene);
}

/* ---- lost ---- */

static void what_falls_off_a_plate_is_lost_and_counted(void **unused)
{
    (void)unused;
    const dem_scene_definition d = bed_in(4);
    dem_scene *scene = bed_scene(&d);
    size_t before = 0, seen = 0;
    while (dem_scene_time(scene) < 0.3) {
        run(scene, 500);
        const size_t lost = dem_scene_lost_count(scene);
        assert_true(lost >= before);
        before = lost;
        seen = 0;
        for (size_t p = 0; p < d.particle_count; p++) {
            const double *x = particle_place(&scene->spheres, p);
            seen += particle_is_lost(scene, p);
            if (particle_is_lost(scene, p)) {
                const vector4 v = scene->spheres.velocity[p];
                CHECK_NEAR(fabs(v[0]) + fabs(v[1]) + fabs(v[2]), 0, 0);
                CHECK_BETWEEN(x[2], -1, -0.02);
            } else {
                CHECK_BETWEEN(x[2], -0.02, 0.1);
            }
        }
        assert_int_equal(seen, lost);
    }
    CHECK_BETWEEN((double)before, 50, (double)d.particle_count);
    int32_t *contacts = calloc(d.particle_count, sizeof *contacts);
    dem_scene_particles(scene, &(dem_particle_arrays){ .contacts = contacts });
    for (size_t p = 0; p < d.particle_count; p++)
        if (particle_is_lost(scene, p)) assert_int_equal(contacts[p], 0);
    free(contacts);
    dem_scene_free(scene);
}

/* Dumbbells tip over the edge: the sphere that is past it falls, and swings beneath the plate while the other is above. */
static void clusters_that_tip_over_the_edge_of_a_plate_are_lost(void **unused)
{
    (void)unused;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        dem_scene_definition d = bed_in(4);
        d.seed = seed;
        d.particle_count = 120;
        d.species[0].cluster =
            (dem_cluster){ .sphere_count = 2, .sphere = { { .diameter = 0.002 }, { { 0.002 }, .diameter = 0.002 } } };
        d.time_step /= 2;
        dem_scene *scene = bed_scene(&d);
        while (dem_scene_time(scene) < 0.4) run(scene, 500);
        const double edge = 0.5 * d.plate.diameter;
        size_t below = 0;
        for (size_t i = 0; i < scene->spheres.mobile_count; i++) {
            const double *x = sphere_place(&scene->spheres, i);
            const bool is_lost = particle_is_lost(scene, particle_of_sphere(&scene->spheres, i));
            below += x[2] < -0.02;
            if (!is_lost && hypot(x[0], x[1]) < edge) CHECK_BETWEEN(x[2], 0, 0.1);
        }
        assert_int_equal(below, 2 * dem_scene_lost_count(scene));
        CHECK_BETWEEN((double)below, 20, 240);
        dem_scene_free(scene);
    }
}

/* ---- the same bits ---- */

static bool same_bits(const dem_scene *a, const dem_scene *b)
{
    dem_state x, y;
    assert_int_equal(dem_scene_save(a, &x), DEM_OK);
    assert_int_equal(dem_scene_save(b, &y), DEM_OK);
    bool same = x.array_count == y.array_count;
    for (size_t k = 0; same && k < x.array_count; k++) {
        const dem_state_array *p = &x.array[k], *q = &y.array[k];
        const size_t size = p->element == DEM_INT32 ? 4 : 8;
        same = p->rows == q->rows && memcmp(p->data, q->data, p->rows * p->columns * size) == 0;
    }
    dem_state_clear(&x);
    dem_state_clear(&y);
    return same && dem_scene_lost_count(a) == dem_scene_lost_count(b);
}

static dem_scene *continued_from(const dem_scene *scene, const dem_scene_definition *d)
{
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    dem_scene *next = drum_scene(d);
    assert_int_equal(dem_scene_restore(next, &state), DEM_OK);
    dem_state_clear(&state);
    return next;
}

/* With 1, 2 and 3 threads, and continued from states saved on the way, at steps that no list was made at. */
static void every_container_gives_the_same_bits_however_it_is_run(void **unused)
{
    (void)unused;
    enum { STEPS = 5000, PART = 713 };
    for (int which = 0; which < CONTAINERS; which++) {
        dem_scene_definition d = bed_in(which);
        dem_scene *start = bed_scene(&d), *whole = continued_from(start, &d), *parts = continued_from(start, &d);
        for (int threads = 2; threads <= 3; threads++) {
            d.threads = threads;
            dem_scene *one = continued_from(whole, &d);
            run(whole, 300);
            run(one, 300);
            if (!same_bits(whole, one)) fail_msg("container %d: %d threads differ from one", which, threads);
            dem_scene_free(one);
        }
        d.threads = 1;
        run(whole, STEPS - 600);
        for (int64_t done = 0; done < STEPS; done += PART) {
            run(parts, PART < STEPS - done ? PART : STEPS - done);
            dem_scene *next = continued_from(parts, &d);
            dem_scene_free(parts);
            parts = next;
        }
        if (!same_bits(whole, parts)) fail_msg("container %d: continued runs differ", which);
        if (which >= 4) CHECK_BETWEEN((double)dem_scene_lost_count(whole), 1, 200); /* some were lost on the way */
        dem_scene_free(start);
        dem_scene_free(whole);
        dem_scene_free(parts);
    }
}

UNIT_TESTS(beds_are_made_clear_of_all_walls, more_than_a_container_holds_does_not_fit, no_contact_with_a_wall_is_missed_at_any_step,
           a_rising_tube_lets_particles_out_beneath_it_alone, no_dumbbell_goes_over_the_wall_of_a_tube,
           what_falls_off_a_plate_is_lost_and_counted, clusters_that_tip_over_the_edge_of_a_plate_are_lost,
           every_container_gives_the_same_bits_however_it_is_run)
