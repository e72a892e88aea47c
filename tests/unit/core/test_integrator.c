/* Claims about leap-frog: order, exact cases, time's direction. */
#include "scene_by_hand.h"

/* ---- order ---- */

/* Two spheres that just touch, e = 1: overlap = (v/omega) sin(omega t) until they part, omega = sqrt(K1/m_eff). The
 * error of the overlap after a third of the collision, in `steps` steps. */
static double error_of_overlap(int steps)
{
    dem_scene_definition d = hand_definition(2);
    d.contact.restitution = 1;
    d.contact.friction = 0;
    const double omega = sqrt(d.contact.stiffness / (species_mass(&d.species[0]) / 2)), end = M_PI / 3 / omega, v = 0.4;
    d.time_step = end / steps;
    dem_scene *scene = weightless_scene(&d);
    double x[6];
    const double touch = (double)scene->spheres.full_radius[0] + (double)scene->spheres.full_radius[1];
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0.03, 0, 0, 0.03 + touch, 0, 0 },
                                       .velocity = (double[]){ v / 2, 0, 0, -v / 2, 0, 0 } });
    advance(scene, steps);
    look_at(scene, x, NULL, NULL);
    dem_scene_free(scene);
    return (touch - (x[3] - x[0])) - v / omega * sin(M_PI / 3);
}

/* Single precision: overlaps of 1e-5 m with 1e-7 of rounding, against an error of 1e-4 of them. */
static void half_the_step_gives_a_quarter_of_the_error(void **unused)
{
    (void)unused;
    for (int steps = 10; steps <= 40; steps *= 2) {
        const double ratio = error_of_overlap(steps) / error_of_overlap(2 * steps);
        CHECK_BETWEEN(ratio, 3.8, 4.2);
    }
}

/* ---- exact cases ---- */

/* Under a constant force leap-frog is exact for velocities at the half step: y = y_0 + v t - g t^2/2 with v the
 * velocity at t = 0, half a step's fall after what the scene keeps. */
static void free_fall_is_exact(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(1);
    dem_scene *scene = hand_scene(&d);
    const double dt = d.time_step, u = 0.3;
    const int steps = 5000;
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0.02, 0.03, 0.01 },
                                       .velocity = (double[]){ 0.1, u, -0.05 },
                                       .spin = (double[]){ 1, 2, 3 } });
    advance(scene, steps);
    double x[3], v[3], w[3];
    look_at(scene, x, v, w);
    const double t = steps * dt, v_0 = u - 0.5 * dt * 9.81;
    /* five thousand sums of numbers near 0.1, each rounded */
    const double tolerance = 5000 * DBL_EPSILON * 0.1;
    CHECK_NEAR(x[0], 0.02 + 0.1 * t, tolerance);
    CHECK_NEAR(x[1], 0.03 + v_0 * t - 0.5 * 9.81 * t * t, tolerance);
    CHECK_NEAR(x[2], 0.01 - 0.05 * t, tolerance);
    CHECK_NEAR(v[1], u - 9.81 * t, 10 * tolerance);
    for (int c = 0; c < 3; c++) CHECK_NEAR(w[c], c + 1.0, 0); /* nothing turns a sphere in flight */
    dem_scene_free(scene);
}

/* The axis is a circle: 0.1 m long, a flight of 0.25 m ends 0.05 m on, within [-length/2, length/2). */
static void places_stay_within_one_period(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    dem_scene *scene = weightless_scene(&d);
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0.02, 0, 0.03, -0.02, 0, -0.03 },
                                       .velocity = (double[]){ 0, 0, 5, 0, 0, -5 } });
    double x[6];
    for (int k = 0; k < 500; k++) {
        advance(scene, 10);
        look_at(scene, x, NULL, NULL);
        CHECK_BETWEEN(x[2], -0.05, 0.05);
        CHECK_BETWEEN(x[5], -0.05, 0.05);
    }
    CHECK_NEAR(x[2], -0.02, 1e-12);
    CHECK_NEAR(x[5], 0.02, 1e-12);
    dem_scene_free(scene);
}

/* Leap-frog runs backwards through its own places. The last velocity led from the last place but one to the last;
 * reversed, and put half a step before that last place but one, it leads back to the one before, and so on: an
 * elastic collision without friction returns to its start to rounding. */
static void a_collision_turned_round_returns_to_its_start(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    d.contact.restitution = 1;
    d.contact.friction = 0;
    dem_scene *scene = weightless_scene(&d);
    const double start[6] = { 0.03, 0, 0, 0.0341, 0.0005, 0.0007 }, v_0[6] = { 0.3, 0.1, 0, -0.3, 0, 0.1 };
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = start, .velocity = v_0 });
    enum { STEPS = 60 };
    double x[6], v[6];
    advance(scene, STEPS - 1);
    look_at(scene, x, NULL, NULL);
    advance(scene, 1);
    look_at(scene, NULL, v, NULL);
    CHECK_BETWEEN(fabs(v[0] - v_0[0]), 0.05, 1); /* half way: they do push each other */
    for (int k = 0; k < 6; k++) v[k] = -v[k];
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = x, .velocity = v });
    advance(scene, STEPS - 1);
    look_at(scene, x, NULL, NULL);
    /* Rounding of forces, over the forces' 60 steps: 1e-5 m of overlap in all. */
    for (int k = 0; k < 6; k++) CHECK_NEAR(x[k], start[k], 1e-15 + 60 * ROUNDING * 1e-5);
    dem_scene_free(scene);
}

UNIT_TESTS(half_the_step_gives_a_quarter_of_the_error, free_fall_is_exact, places_stay_within_one_period,
           a_collision_turned_round_returns_to_its_start)
