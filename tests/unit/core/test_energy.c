/* Claims about the torque that turns a drum and about where the energy goes, held against closed forms and against the
 * contacts one by one. */
#include "measure.h"
#include "scene_by_hand.h"
#include "small_drum.h"

static const double HAND_RADIUS = 0.1, R = 0.002; /* m: of hand_definition's drum and spheres */

/* ---- torque ---- */

/* A wall so fast that friction is full from the first step on: mu N at the middle of the overlap, N = K1 alpha. The
 * overlap is known to 1e-17 m, the rounding of a difference of 0.1 m: 1e-12 of itself. */
static void a_sphere_that_slides_on_the_wall_loads_the_drum_with_its_friction(void **unused)
{
    (void)unused;
    for (int way = -1; way <= 1; way += 2) {
        dem_scene_definition d = hand_definition(1);
        d.rotation_rate = 20.0 * way;
        dem_scene *scene = hand_scene(&d);
        const double alpha = 1e-5;
        const double rho = HAND_RADIUS - (double)(real)R + alpha; /* radii are kept as real */
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = (double[]){ 0.6 * rho, -0.8 * rho, 0 } });
        advance(scene, 1);
        CHECK_NEAR(scene->torque.count, 1, 0);
        const double expected = way * d.contact.wall_friction * d.contact.stiffness * alpha * (HAND_RADIUS + alpha / 2);
        CHECK_NEAR(scene->torque.sum / expected, 1, 20 * ROUNDING + 1e-11);
        double frame[DEM_FRAME_SCALARS];
        measure_drive_frame(scene, frame);
        CHECK_NEAR(frame[FRAME_TORQUE] / expected, 1, 20 * ROUNDING + 1e-11);
        measure_drive_frame(scene, frame);
        assert_true(isnan(frame[FRAME_TORQUE])); /* nothing new since */
        dem_scene_free(scene);
    }
}

/* Two spheres that press, slide and spin on each other far from the wall turn each other, not the drum. */
static void contacts_between_spheres_do_not_load_the_drum(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    dem_scene *scene = hand_scene(&d);
    const double x[] = { 0.03, 0.02, 0, 0.03 + 1.2 * R, 0.02 + 1.59 * R, 0.1 * R };
    const double v[] = { 1, -2, 0.5, -1, 0.3, 0 }, w[] = { 30, -50, 400, 10, 80, 300 };
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = x, .velocity = v, .spin = w });
    advance(scene, 1);
    const double pressed = d.contact.stiffness * 0.0033 * R; /* N: overlap 2 R - |x_2 - x_1| */
    const double force = (scene->spheres.velocity[0][0] - v[0]) / (d.time_step * sphere_inverse_mass(&scene->spheres, 0));
    assert_true(fabs(force) > 0.1 * pressed);
    CHECK_NEAR(scene->torque.sum, 0, 10 * ROUNDING * pressed * hypot(0.03, 0.02));
    dem_scene_free(scene);
}

static void the_weights_torque_is_that_of_the_centre_of_mass(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    dem_scene *scene = hand_scene(&d);
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = (double[]){ 0.05, -0.02, 0, -0.01, 0.03, 0.02 } });
    double frame[DEM_FRAME_SCALARS];
    measure_drive_frame(scene, frame);
    const double m = species_mass(&d.species[0]);
    CHECK_NEAR(frame[FRAME_WEIGHT_TORQUE], m * 9.81 * (0.05 - 0.01), 1e-12 * m);
    dem_scene_free(scene);
}

static dem_scene *turning_drum(const dem_scene_definition *d)
{
    dem_scene *scene = drum_scene(d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    return scene;
}

/* Angular momentum does not grow for ever: the drum carries the bed's weight, and both are measured by themselves. */
static void the_torque_of_a_steady_drum_carries_the_beds_weight(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    d.contact.wall_friction = 2; /* so that the bed does not slip, which would take eight revolutions for an error */
    follow_rules(&d, 0.03);
    dem_scene *scene = turning_drum(&d);
    enum { FRAMES = 120 };
    const size_t width = dem_frame_width(scene);
    double *frames = calloc(FRAMES * width, sizeof *frames);
    assert_non_null(frames);
    for (size_t k = 0; k < FRAMES; k++) {
        assert_int_equal(dem_frame_measure(scene, frames + k * width), DEM_OK);
        run(scene, (int64_t)(0.04 / d.time_step));
    }
    dem_drum_results r;
    assert_int_equal(dem_drum_results_measure(scene, frames, FRAMES, &r), DEM_OK);
    const double error = hypot(r.drive.torque.standard_error, r.drive.weight_torque.standard_error);
    CHECK_BETWEEN(error / r.drive.torque.mean, 0, 0.05); /* a claim worth making */
    CHECK_NEAR(r.drive.torque.mean, r.drive.weight_torque.mean, 3 * error);
    CHECK_NEAR(r.drive.power, r.drive.torque.mean * d.rotation_rate, 1e-12);
    CHECK_BETWEEN(r.drive.torque_number, 0.05, 4 / (3 * M_PI)); /* x of the centre of mass over R: less than a half disc's */
    free(frames);
    dem_scene_free(scene);
}

/* ---- energy ---- */

/* Latching springs lose (1 - e^2)/2 m_eff v^2 in a collision. The restitution of a contact of 1000 steps: two_bodies. */
static void a_collision_takes_in_what_restitution_leaves(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    const double speed = 0.5, m_eff = species_mass(&d.species[0]) / 2;
    d.contact.friction = 0;
    d.time_step = M_PI / 2 * sqrt(m_eff / d.contact.stiffness) * (1 + d.contact.restitution) / 1000;
    dem_scene *scene = weightless_scene(&d);
    const double x[] = { 0.03, 0.02, 0, 0.03 + 2 * R + 1e-7, 0.02, 0 }, v[] = { speed / 2, 0, 0, -speed / 2, 0, 0 };
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = x, .velocity = v });
    scene->audit.is_on = true;
    advance(scene, 1500);
    const double e = d.contact.restitution, lost = (1 - e * e) / 2 * m_eff * speed * speed;
    CHECK_NEAR(-scene->audit.contact_work / lost, 1, 1e-3); /* e to 1e-4 of itself, and e^2/(1 - e^2) = 1.8 times as much twice */
    CHECK_NEAR(scene->audit.wall_work, 0, 0);
    dem_scene_free(scene);
}

/* Everything that a step begins or ends with, as anybody may ask a scene for it. */
typedef struct look {
    double *x, *v, *w; /* (n,3) */
} look;

static look look_create(size_t n)
{
    double *all = calloc(9 * n, sizeof *all);
    assert_non_null(all);
    return (look){ all, all + 3 * n, all + 6 * n };
}

static void look_take(const dem_scene *scene, look *l)
{
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = l->x, .velocity = l->v, .angular_velocity = l->w });
}

typedef struct contact_energy {
    double into;   /* J a step, work done on the contacts */
    double stored; /* J, what their springs would give back */
} contact_energy;

/* Friction's spring unloads by K_T0 ((1 + t)/(1 + t*))^(1/3), t from t* = T/(mu N) to 0:
 * integral of T dT/K_T = (mu N)^2/K_T0 (1 + t*)^(1/3) (3/5 (1+u)^(5/3) - 3/2 (1+u)^(2/3)), from 0 to t*. */
static double friction_stored(double t, double mu_n, double k_t0)
{
    const double tau = fmin(1, t / mu_n), one = 1 + tau;
    return mu_n * mu_n / k_t0 * cbrt(one) * (0.6 * (one * cbrt(one * one) - 1) - 1.5 * (cbrt(one * one) - 1));
}

/* One contact: where from first to second, overlap; what it remembers after the step. slip: velocity of the first less that of
 * the second, closing: of which, along n, in the half step before; m_eff: kg. */
static void add_contact(contact_energy *sum, const dem_scene_definition *d, const double n[3], double alpha, const double *history,
                        double mu, const double slip[3], double closing, double m_eff)
{
    const double k_1 = d->contact.stiffness, k_2 = k_1 / (d->contact.restitution * d->contact.restitution);
    const double spring = fmin(k_1 * alpha, k_2 * (alpha - history[HISTORY_ALPHA_0]));
    const bool is_below = history[HISTORY_ALPHA_0] > (1 + 4 * ROUNDING) * alpha * (1 - k_1 / k_2); /* the largest overlap */
    const double dashpot = is_below ? 2 * d->contact.latch_damping * sqrt(k_2 * m_eff) * fmax(closing, 0) : 0;
    const double f_n = fmax(0, spring + dashpot);
    double power = 0, t2 = 0; /* on the first: (T - N n).(v_first - v_second) */
    for (int c = 0; c < 3; c++) {
        power += (history[HISTORY_T + c] - f_n * n[c]) * slip[c];
        t2 += history[HISTORY_T + c] * history[HISTORY_T + c];
    }
    sum->into -= power * d->time_step;
    sum->stored += fmax(0, spring) * fmax(0, spring) / (2 * k_2);
    if (f_n > 0) sum->stored += friction_stored(sqrt(t2), mu * f_n, k_1 * d->contact.tangential_stiffness_ratio);
}

static void point_velocity(const double *v, const double *w, const double n[3], double lever, double velocity[3])
{
    for (int c = 0; c < 3; c++) velocity[c] = v[c] + lever * (w[(c + 1) % 3] * n[(c + 2) % 3] - w[(c + 2) % 3] * n[(c + 1) % 3]);
}

/* The step from `before` to `after` contact by contact: forces from what the saved state remembers, geometry from the
 * places, velocities the mean of the half steps around. `now`: work space with the mean velocities. */
static contact_energy energy_of_contacts(dem_scene *scene, const dem_scene_definition *d, const look *before, const look *after)
{
    const size_t n = dem_scene_sphere_count(scene);
    const double m = species_mass(&d->species[0]), r = 0.5 * (double)(real)d->species[0].diameter, wall = 0.5 * d->diameter,
                 rate = d->rotation_rate;
    look mean = look_create(n);
    for (size_t k = 0; k < 3 * n; k++) {
        mean.v[k] = 0.5 * (before->v[k] + after->v[k]);
        mean.w[k] = 0.5 * (before->w[k] + after->w[k]);
    }
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    contact_energy sum = { 0 };
    const dem_state_array *pairs = state_array(&state, "pair"), *walls = state_array(&state, "wall_contact");
    const double *history = state_array(&state, "pair_history")->data;
    for (size_t k = 0; k < pairs->rows; k++, history += HISTORY_WIDTH) {
        const int32_t i = ((const int32_t *)pairs->data)[2 * k], j = ((const int32_t *)pairs->data)[2 * k + 1];
        double normal[3], distance2 = 0, a[3], b[3], slip[3], closing = 0;
        for (int c = 0; c < 3; c++) normal[c] = before->x[3 * j + c] - before->x[3 * i + c];
        normal[2] = remainder(normal[2], d->length);
        for (int c = 0; c < 3; c++) distance2 += normal[c] * normal[c];
        const double distance = sqrt(distance2), alpha = 2 * r - distance;
        if (alpha <= 0) continue;
        for (int c = 0; c < 3; c++) normal[c] /= distance;
        point_velocity(mean.v + 3 * i, mean.w + 3 * i, normal, r - alpha / 2, a);
        point_velocity(mean.v + 3 * j, mean.w + 3 * j, normal, alpha / 2 - r, b);
        for (int c = 0; c < 3; c++) {
            slip[c] = a[c] - b[c];
            closing += (before->v[3 * i + c] - before->v[3 * j + c]) * normal[c];
        }
        add_contact(&sum, d, normal, alpha, history, d->contact.friction, slip, closing, m / 2);
    }
    history = state_array(&state, "wall_history")->data;
    for (size_t k = 0; k < walls->rows; k++, history += HISTORY_WIDTH) {
        const int32_t i = ((const int32_t *)walls->data)[2 * k];
        const double *x = before->x + 3 * i, rho = hypot(x[0], x[1]), alpha = rho + r - wall;
        if (alpha <= 0) continue;
        const double normal[3] = { x[0] / rho, x[1] / rho, 0 };
        double a[3];
        point_velocity(mean.v + 3 * i, mean.w + 3 * i, normal, r - alpha / 2, a);
        const double speed = rate * (wall + alpha / 2), slip[3] = { a[0] + speed * normal[1], a[1] - speed * normal[0], a[2] };
        const double closing = before->v[3 * i] * normal[0] + before->v[3 * i + 1] * normal[1];
        add_contact(&sum, d, normal, alpha, history, d->contact.wall_friction, slip, closing, m);
    }
    dem_state_clear(&state);
    free(mean.x);
    return sum;
}

/* From rest into motion, 0.12 s: what the drum's torque does is in the particles' motion and height, or went into
 * contacts. The first balance is leap-frog's own and holds to the rounding of double; the second compares the sum over
 * spheres with that over contacts, whose forces are of single precision. What contacts took in and have not stored is
 * gone for good: it never comes back. */
static void the_drums_work_is_in_the_particles_or_in_the_contacts(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    d.rotation_rate = 10;
    d.contact.latch_damping = 0.3;
    follow_rules(&d, 0.03);
    dem_scene *scene = turning_drum(&d);
    look before = look_create(dem_scene_sphere_count(scene)), after = look_create(dem_scene_sphere_count(scene));
    scene->audit.is_on = true;
    const double at_first = energy_of_particles(&scene->spheres, scene->container.up, d.gravity, d.time_step);
    double into = 0, exchanged = 0, stored = 0, gone = -INFINITY, come_back = 0;
    look_take(scene, &after);
    const int steps = (int)(0.12 / d.time_step);
    for (int step = 0; step < steps; step++) {
        const look swap = before;
        before = after;
        after = swap;
        run(scene, 1);
        look_take(scene, &after);
        const contact_energy now = energy_of_contacts(scene, &d, &before, &after);
        const double gone_now = into + 0.5 * now.into - now.stored; /* on the step, where springs are known */
        gone = fmax(gone, gone_now);
        come_back = fmax(come_back, gone - gone_now);
        into += now.into;
        exchanged += fabs(now.into);
        stored = now.stored;
    }
    const energy_audit *audit = &scene->audit;
    const double gained = energy_of_particles(&scene->spheres, scene->container.up, d.gravity, d.time_step) - at_first;
    CHECK_NEAR(audit->contact_work, gained, 1e-12 * fabs(at_first));
    CHECK_NEAR(audit->wall_work - gained, into, 20 * ROUNDING * exchanged);
    CHECK_BETWEEN(into, 0.1 * audit->wall_work, audit->wall_work);
    CHECK_BETWEEN(stored, 0, 0.02 * into); /* the bed's own weight lies on springs: little beside what it lost */
    /* Leap-frog keeps a spring of 40 steps a swing to (2 pi/40)^2/24 of its energy, 1e-3. */
    CHECK_BETWEEN(come_back, 0, 1e-3 * stored);
    free(before.x < after.x ? before.x : after.x);
    free(before.x < after.x ? after.x : before.x);
    dem_scene_free(scene);
}

UNIT_TESTS(a_sphere_that_slides_on_the_wall_loads_the_drum_with_its_friction, contacts_between_spheres_do_not_load_the_drum,
           the_weights_torque_is_that_of_the_centre_of_mass, the_torque_of_a_steady_drum_carries_the_beds_weight,
           a_collision_takes_in_what_restitution_leaves, the_drums_work_is_in_the_particles_or_in_the_contacts)
