/* Claims about two spheres, or one and the wall: collisions with closed forms (core/NUMERICS.md), in the scene's
 * own step. */
#include "contact_forces.h"
#include "scene_by_hand.h"
#include "step.h"

/* ---- head-on ---- */

enum { STEPS_A_CONTACT = 1000 };

/* What a collision did, to hold against the closed forms. */
typedef struct collision {
    double speed_ratio;     /* relative normal speed after over before */
    double duration;        /* s during which a force acted */
    double largest_overlap; /* m */
    double residual;        /* m: alpha_0 at the end of the force */
} collision;

static double contact_time(double m_eff, const dem_contact_parameters *c)
{
    return M_PI / 2 * sqrt(m_eff / c->stiffness) * (1 + c->restitution);
}

static double remembered_overlap(const dem_scene *scene, const char *history)
{
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    const dem_state_array *a = state_array(&state, history);
    const double alpha_0 = a->rows ? ((const double *)a->data)[HISTORY_ALPHA_0] : 0.0;
    dem_state_clear(&state);
    return alpha_0;
}

/* Runs until the force has come and gone. `history`: where the contact is remembered. */
static collision collide(dem_scene *scene, size_t n, double approach, const char *history)
{
    double v[6], before[6];
    look_at(scene, NULL, v, NULL);
    const double normal_before = n == 2 ? v[0] - v[3] : v[0];
    collision c = { .residual = NAN };
    int64_t forced = 0;
    for (int64_t step = 0; step < 4 * STEPS_A_CONTACT; step++) {
        memcpy(before, v, sizeof v);
        advance(scene, 1);
        look_at(scene, NULL, v, NULL);
        if (v[0] != before[0]) forced++;
        else if (forced > 0) {
            c.residual = remembered_overlap(scene, history);
            break;
        }
    }
    CHECK_NEAR(normal_before, approach, 1e-15 * approach);
    c.speed_ratio = ((n == 2 ? v[3] - v[0] : -v[0])) / normal_before;
    c.duration = (double)forced * scene->definition.time_step;
    c.largest_overlap = dem_scene_maximum_overlap(scene) * scene->spheres.smallest_diameter;
    return c;
}

/* The trajectory of a piecewise linear spring, at STEPS_A_CONTACT steps: leap-frog's errors are of the order of
 * (omega dt)^2 <= (pi/1000)^2 = 1e-5, and the kinks (touch, turn, part) fall between steps. A step at either end may
 * or may not count to the duration. Single precision adds its rounding a thousand times over, at random. */
static void check_closed_forms(const collision *c, double m_eff, double approach, const dem_contact_parameters *law)
{
    const double e = law->restitution, dt = contact_time(m_eff, law) / STEPS_A_CONTACT;
    const double alpha = approach * sqrt(m_eff / law->stiffness);
    CHECK_NEAR(c->speed_ratio, e, 3e-5 + 30 * ROUNDING);
    CHECK_NEAR(c->duration, contact_time(m_eff, law), 2 * dt);
    CHECK_NEAR(c->largest_overlap, alpha, (1e-5 + 30 * ROUNDING) * alpha);
    CHECK_NEAR(c->residual, alpha * (1 - e * e), (2e-5 + 30 * ROUNDING) * alpha);
}

static const double approaches[] = { 0.03, 0.3, 3 }, restitutions[] = { 0.3, 0.5, 0.8, 0.95, 1.0 };
enum { APPROACHES = sizeof approaches / sizeof *approaches, RESTITUTIONS = sizeof restitutions / sizeof *restitutions };

static void head_on_spheres_part_with_e_and_the_closed_forms(void **unused)
{
    (void)unused;
    for (int a = 0; a < APPROACHES; a++)
        for (int b = 0; b < RESTITUTIONS; b++) {
            dem_scene_definition d = hand_definition(2);
            first_sphere_differs(&d, (dem_species){ .diameter = 0.006, .density = 1200 });
            d.contact.restitution = restitutions[b];
            d.contact.stiffness = 4e4;
            const double m_1 = species_mass(&d.species[0]), m_2 = species_mass(&d.species[1]), m_eff = m_1 * m_2 / (m_1 + m_2);
            d.time_step = contact_time(m_eff, &d.contact) / STEPS_A_CONTACT;
            dem_scene *scene = weightless_scene(&d);
            const double v = approaches[a], gap = 7.3 * v * d.time_step;
            place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                               .position = (double[]){ -0.002, 0.01, 0, 0.003 + gap, 0.01, 0 },
                                               .velocity = (double[]){ 0.25 * v, 0, 0, -0.75 * v, 0, 0 } });
            const collision c = collide(scene, 2, v, "pair_history");
            check_closed_forms(&c, m_eff, v, &d.contact);
            dem_scene_free(scene);
        }
}

/* Hertz's: largest overlap ((15/16) m v^2/(E* sqrt(R*)))^(2/5), a collision of 2.94328 of it over v (the integral of
 * dx/sqrt(1 - x^(5/2)) from 0 to 1, twice): m and R* are the scene's business, whether spheres are alike or not. */
static void head_on_spheres_of_hertz_overlap_as_long_and_as_far_as_he_says(void **unused)
{
    (void)unused;
    for (int differ = 0; differ < 2; differ++) {
        dem_scene_definition d = hand_definition(2);
        if (differ) first_sphere_differs(&d, (dem_species){ .diameter = 0.006, .density = 1200 });
        d.contact.law = DEM_HERTZ_MINDLIN;
        d.contact.restitution = 1;
        d.contact.particle = d.contact.wall = (dem_elasticity){ 5e7, 0.3 };
        const double r_1 = 0.002, r_2 = differ ? 0.003 : 0.002, v = 0.3, e_star = 5e7 / (2 * (1 - 0.09));
        const double m_1 = species_mass(&d.species[0]), m_2 = species_mass(&d.species[differ]), m_eff = m_1 * m_2 / (m_1 + m_2);
        const double overlap = pow(15.0 / 16 * m_eff * v * v / (e_star * sqrt(r_1 * r_2 / (r_1 + r_2))), 0.4);
        d.time_step = 2.94328 * overlap / v / STEPS_A_CONTACT;
        dem_scene *scene = weightless_scene(&d);
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                           .position = (double[]){ 0, 0.01, 0, r_1 + r_2 + 7.3 * v * d.time_step, 0.01, 0 },
                                           .velocity = (double[]){ 0.25 * v, 0, 0, -0.75 * v, 0, 0 } });
        const collision c = collide(scene, 2, v, "pair_history");
        CHECK_NEAR(c.speed_ratio, 1, 3e-5 + 30 * ROUNDING);
        CHECK_NEAR(c.duration, 2.94328 * overlap / v, 2 * d.time_step);
        CHECK_NEAR(c.largest_overlap, overlap, (1e-5 + 30 * ROUNDING) * overlap);
        dem_scene_free(scene);
    }
}

/* While a bed is filled, radii are below full size, and R* is what it will be. */
static void growing_spheres_of_hertz_press_each_other_as_grown_ones_do(void **unused)
{
    (void)unused;
    static const double overlap = 2e-5;
    for (int differ = 0; differ < 2; differ++) {
        dem_scene_definition d = hand_definition(2);
        if (differ) first_sphere_differs(&d, (dem_species){ .diameter = 0.006, .density = 1200 });
        d.contact.law = DEM_HERTZ_MINDLIN;
        d.contact.particle = d.contact.wall = (dem_elasticity){ 5e7, 0.3 };
        const double r_1 = 0.002, r_2 = differ ? 0.003 : 0.002, e_star = 5e7 / (2 * (1 - 0.09));
        for (double scale = 0.25; scale < 1; scale += 0.25) {
            dem_scene *scene = weightless_scene(&d);
            spheres *s = &scene->spheres;
            place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                               .position = (double[]){ 0, 0.01, 0, scale * (r_1 + r_2) - overlap, 0.01, 0 } });
            spheres_set_scale(s, scale);
            neighbor_list_invalidate(&scene->neighbors);
            assert_int_equal(scene_update_neighbors(scene), DEM_OK);
            vector4 strayed;
            contact_forces_between_spheres(&scene->neighbors, s, NULL, &scene->contact, 0, NULL, &strayed);
            double most = 0;
            for (size_t i = 0; i < s->mobile_count; i++) most = fmax(most, fabs((double)s->load[i][0]));
            /* 3/2 of the overlap's error: a few last digits of the radii */
            const double f = 4.0 / 3 * e_star * sqrt(r_1 * r_2 / (r_1 + r_2)) * pow(overlap, 1.5);
            CHECK_NEAR(most, f, 6 * ROUNDING * (r_1 + r_2) / overlap * f);
            dem_scene_free(scene);
        }
    }
}

static void a_sphere_leaves_the_wall_with_e_and_the_closed_forms(void **unused)
{
    (void)unused;
    for (int a = 0; a < APPROACHES; a++)
        for (int b = 0; b < RESTITUTIONS; b++) {
            dem_scene_definition d = hand_definition(1);
            d.contact.restitution = restitutions[b];
            d.contact.stiffness = 4e4;
            const double m = species_mass(&d.species[0]);
            d.time_step = contact_time(m, &d.contact) / STEPS_A_CONTACT;
            dem_scene *scene = weightless_scene(&d);
            const double v = approaches[a];
            place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                               .position = (double[]){ 0.098 - 7.3 * v * d.time_step, 0, 0 },
                                               .velocity = (double[]){ v, 0, 0 } });
            const collision c = collide(scene, 1, v, "wall_history");
            check_closed_forms(&c, m, v, &d.contact);
            dem_scene_free(scene);
        }
}

/* e = sqrt(w/(S v + w)), w = sqrt(K1/m_eff): test_contact_law.c derives it. Errors as check_closed_forms has them. */
static void with_variable_unloading_spheres_part_slower_the_faster_they_met(void **unused)
{
    (void)unused;
    for (int a = 0; a < APPROACHES; a++) {
        dem_scene_definition d = hand_definition(2);
        d.contact.stiffness = 4e4;
        d.contact.unloading_slope = 2e4;
        const double m_eff = species_mass(&d.species[0]) / 2, v = approaches[a], w = sqrt(d.contact.stiffness / m_eff);
        const double e = sqrt(w / (d.contact.unloading_slope * v + w));
        d.time_step = contact_time(m_eff, &d.contact) / STEPS_A_CONTACT;
        dem_scene *scene = weightless_scene(&d);
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                           .position = (double[]){ -0.002, 0.01, 0, 0.002 + 7.3 * v * d.time_step, 0.01, 0 },
                                           .velocity = (double[]){ 0.5 * v, 0, 0, -0.5 * v, 0, 0 } });
        const collision c = collide(scene, 2, v, "pair_history");
        CHECK_NEAR(c.speed_ratio, e, 3e-5 + 30 * ROUNDING);
        CHECK_NEAR(c.residual, v / w * (1 - e * e), (2e-5 + 30 * ROUNDING) * v / w);
        dem_scene_free(scene);
        scene = weightless_scene(&d);
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                           .position = (double[]){ 0.098 - 7.3 * v * d.time_step, 0, 0, 0, 0.05, 0.03 },
                                           .velocity = (double[]){ v, 0, 0, 0, 0, 0 } });
        const double w_wall = sqrt(d.contact.stiffness / (2 * m_eff));
        const collision wall = collide(scene, 1, v, "wall_history");
        CHECK_NEAR(wall.speed_ratio, sqrt(w_wall / (d.contact.unloading_slope * v + w_wall)), 3e-5 + 30 * ROUNDING);
        dem_scene_free(scene);
    }
}

/* With the steps that a run takes: equations.md saw 0.7994 to 0.8007 for 0.8 at 25 steps a contact. The bound is
 * (omega dt)^2/8 of either branch, at 20 steps, whatever part of a step is left before the touch. */
static void at_the_runs_own_time_step_e_holds_to_half_a_percent(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    const double m_eff = species_mass(&d.species[0]) / 2;
    d.time_step = dem_time_step(d.contact.stiffness, species_mass(&d.species[0]), d.contact.restitution);
    CHECK_NEAR(d.time_step, contact_time(m_eff, &d.contact) / DEM_STEPS_PER_CONTACT, 1e-12 * d.time_step);
    dem_scene *scene = weightless_scene(&d);
    for (int part = 0; part < 20; part++) {
        const double v = 0.4, gap = part / 20.0 * v * d.time_step;
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                           .position = (double[]){ -0.002, 0.01, 0, 0.002 + gap, 0.01, 0 },
                                           .velocity = (double[]){ v / 2, 0, 0, -v / 2, 0, 0 } });
        const collision c = collide(scene, 2, v, "pair_history");
        CHECK_NEAR(c.speed_ratio, 0.8, 0.004);
    }
    dem_scene_free(scene);
}

/* ---- oblique ---- */

typedef struct oblique {
    double v_n, v_t; /* m/s after: away from the wall, along it */
    double spin;     /* rad/s after, about the axis that friction turns */
    double e;        /* seen in this very collision */
} oblique;

/* Against the wall at +x, sliding along the drum's axis, in which the wall is flat. */
static oblique strike_wall(double v_n, double v_t, const dem_scene_definition *d)
{
    dem_scene *scene = weightless_scene(d);
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0.098 - 2.5 * v_n * d->time_step, 0, 0 },
                                       .velocity = (double[]){ v_n, 0, v_t } });
    advance(scene, 2 * STEPS_A_CONTACT);
    double v[3], w[3];
    look_at(scene, NULL, v, w);
    dem_scene_free(scene);
    /* Friction acts along -z at +x r: the torque is r x (-z) = +y. */
    return (oblique){ .v_n = -v[0], .v_t = v[2], .spin = w[1], .e = -v[0] / v_n };
}

/* v_x' = v_x - mu (1+e) v_z and omega' = 2.5 mu (1+e) v_z / r, the impulse of Coulomb's limit. The spin's arm is
 * r less half the overlap: at most alpha/(2 r) off, 0.02 % here. */
static void an_impact_that_slides_throughout_gives_the_impulse_of_coulomb(void **unused)
{
    (void)unused;
    static const double friction[] = { 0.05, 0.2, 0.4 };
    for (int k = 0; k < 3; k++) {
        dem_scene_definition d = hand_definition(1);
        d.contact.stiffness = 1e6;
        d.contact.wall_friction = friction[k];
        d.time_step = contact_time(species_mass(&d.species[0]), &d.contact) / STEPS_A_CONTACT;
        const double v_n = 0.1, v_t = 1.0, r = 0.002, alpha = v_n * sqrt(species_mass(&d.species[0]) / 1e6);
        const oblique after = strike_wall(v_n, v_t, &d);
        const double impulse = friction[k] * (1 + after.e) * v_n; /* m/s */
        CHECK_NEAR(after.e, 0.8, 3e-5 + 30 * ROUNDING);
        CHECK_NEAR(after.v_t, v_t - impulse, 1e-10 * v_t + 10 * ROUNDING * impulse);
        CHECK_BETWEEN(after.spin * r / (2.5 * impulse), 1 - alpha / (2 * r), 1 + 10 * ROUNDING);
    }
}

/* The other end: a sphere without tangential speed at its contact keeps it so. */
static void a_sphere_that_rolls_along_the_wall_is_not_slowed_by_an_impact(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(1);
    d.contact.stiffness = 1e6;
    d.time_step = contact_time(species_mass(&d.species[0]), &d.contact) / STEPS_A_CONTACT;
    dem_scene *scene = weightless_scene(&d);
    const double v_t = 0.5, v_n = 0.05;
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0.098 - 2.5 * v_n * d.time_step, 0, 0 },
                                       .velocity = (double[]){ v_n, 0, v_t },
                                       .spin = (double[]){ 0, v_t / 0.002, 0 } });
    advance(scene, 2 * STEPS_A_CONTACT);
    double v[3];
    look_at(scene, NULL, v, NULL);
    CHECK_NEAR(v[0], -0.8 * v_n, 1e-3 * v_n); /* it did strike */
    /* The arm shrinks by half the overlap, which leaves a slip of alpha/(2 r) = 1e-4 of the speed. */
    CHECK_NEAR(v[2], v_t, 2e-4 * v_t);
    dem_scene_free(scene);
}

/* ---- sliding into rolling ---- */

/* Set sliding along the axis on the lowest line of the drum, a plane in that direction. Impulse J of friction:
 * v = v_0 - J/m, omega = J r_a/I, rolling when v = r_a omega: v/v_0 = 1/(1 + 0.4 r^2/r_a^2), 5/7 for r_a = r. The
 * tangential spring still rings when slip ends, by mu g/omega_t (0.1 % of the speed): a mean over its periods. */
static void a_sphere_set_sliding_ends_rolling_at_five_sevenths(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(1);
    d.time_step = dem_time_step(d.contact.stiffness, species_mass(&d.species[0]), d.contact.restitution);
    dem_scene *scene = hand_scene(&d);
    const double r = 0.002, v_0 = 0.4, alpha = species_mass(&d.species[0]) * 9.81 / d.contact.stiffness;
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0, -0.098 - alpha, 0 },
                                       .velocity = (double[]){ 0, 0, v_0 } });
    /* slip ends after 2 v_0/(7 mu g) */
    const double slip_time = 2 * v_0 / (7 * d.contact.wall_friction * 9.81);
    double v[3], w[3];
    advance(scene, (int64_t)(0.5 * slip_time / d.time_step));
    look_at(scene, NULL, v, w);
    CHECK_NEAR(v[2], v_0 - d.contact.wall_friction * 9.81 * 0.5 * slip_time, 1e-3 * v_0); /* Coulomb's deceleration meanwhile */
    advance(scene, (int64_t)(0.7 * slip_time / d.time_step));
    double sum_v = 0, sum_slip = 0;
    enum { SAMPLES = 4000 };
    for (int k = 0; k < SAMPLES; k++) {
        advance(scene, 1);
        look_at(scene, NULL, v, w);
        sum_v += v[2];
        sum_slip += v[2] - w[0] * (r - alpha / 2); /* the contact is at -y */
    }
    const double r_a = r - alpha / 2, rolling = v_0 / (1 + 0.4 * r * r / (r_a * r_a));
    CHECK_NEAR(rolling / v_0, 5.0 / 7, 1e-4);
    CHECK_NEAR(sum_v / SAMPLES, rolling, 2e-4 * v_0);
    CHECK_NEAR(sum_slip / SAMPLES, 0, 2e-4 * v_0);
    dem_scene_free(scene);
}

/* ---- conservation ---- */

typedef struct conserved {
    double momentum[3], angular[3], scale_momentum, scale_angular;
} conserved;

static conserved conserved_of(const dem_scene *scene, const double mass[2], const double inertia[2])
{
    double x[6], v[6], w[6];
    look_at(scene, x, v, w);
    conserved c = { .scale_momentum = 0 };
    for (size_t i = 0; i < 2; i++) {
        const double *p = x + 3 * i, *u = v + 3 * i, *o = w + 3 * i;
        for (size_t k = 0; k < 3; k++) {
            const size_t a = (k + 1) % 3, b = (k + 2) % 3;
            c.momentum[k] += mass[i] * u[k];
            c.angular[k] += mass[i] * (p[a] * u[b] - p[b] * u[a]) + inertia[i] * o[k];
            c.scale_momentum += mass[i] * fabs(u[k]);
            c.scale_angular += inertia[i] * fabs(o[k]) + mass[i] * (fabs(p[a] * u[b]) + fabs(p[b] * u[a]));
        }
    }
    return c;
}

/* Both forces come of one number, so momentum keeps to rounding of the velocities' own double precision; in
 * leap-frog x(t) x v(t + dt/2) is conserved exactly too, but the arms r_a + r_b = distance are as exact as `real`. */
static void oblique_spinning_spheres_conserve_momentum_and_angular_momentum(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    first_sphere_differs(&d, (dem_species){ .diameter = 0.007, .density = 2500 });
    d.time_step = 4e-6;
    dem_scene *scene = weightless_scene(&d);
    const double mass[2] = { species_mass(&d.species[0]), species_mass(&d.species[1]) };
    const double inertia[2] = { 0.4 * mass[0] * 0.002 * 0.002, 0.4 * mass[1] * 0.0035 * 0.0035 };
    dice own = { 7 };
    double worst_spin_change = 0;
    for (int trial = 0; trial < 50; trial++) {
        double n[3], x[6] = { 0 }, v[6], w[6];
        dice_direction(&own, n);
        for (int k = 0; k < 3; k++) {
            x[k] = k == 0 ? 0.04 : 0;
            x[3 + k] = x[k] + 0.0057 * n[k]; /* distance of centres at touch: 0.0055 */
            v[k] = 0.4 * n[k] + dice_uniform(&own, -0.2, 0.2);
            v[3 + k] = -0.4 * n[k] + dice_uniform(&own, -0.2, 0.2);
            w[k] = dice_uniform(&own, -200, 200);
            w[3 + k] = dice_uniform(&own, -200, 200);
        }
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = x, .velocity = v, .spin = w });
        const conserved before = conserved_of(scene, mass, inertia);
        advance(scene, 1000);
        const conserved after = conserved_of(scene, mass, inertia);
        double w_after[6];
        look_at(scene, NULL, NULL, w_after);
        worst_spin_change = fmax(worst_spin_change, fabs(w_after[0] - w[0]));
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(after.momentum[k], before.momentum[k], 1e3 * DBL_EPSILON * before.scale_momentum);
            CHECK_NEAR(after.angular[k], before.angular[k], (1e3 * DBL_EPSILON + 4 * ROUNDING) * before.scale_angular);
        }
    }
    CHECK_BETWEEN(worst_spin_change, 10, 1e6); /* friction did act */
    dem_scene_free(scene);
}

static void across_the_period_is_as_inside(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    double end[2][12];
    for (int across = 0; across < 2; across++) {
        dem_scene *scene = weightless_scene(&d);
        /* the pair lies along z: about z = 0, or about z = length/2 */
        const double middle = across ? d.length / 2 : 0;
        double x[6] = { 0.01, 0.01, middle - 0.0021, 0.0105, 0.01, middle + 0.0021 - (across ? d.length : 0) };
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                           .position = x,
                                           .velocity = (double[]){ 0, 0, 0.2, 0.05, 0, -0.2 },
                                           .spin = (double[]){ 10, 20, 30, 0, -40, 0 } });
        advance(scene, 400);
        look_at(scene, NULL, end[across], end[across] + 6);
        dem_scene_free(scene);
    }
    CHECK_BETWEEN(end[0][5], 0.05, 0.2); /* they did bounce */
    /* The difference of positions is rounded elsewhere: 1e-17 m of an overlap of 1e-5 m, thrice as stiff forces. */
    for (int k = 0; k < 6; k++) CHECK_NEAR(end[1][k], end[0][k], 1e-10 * 0.2 + 100 * ROUNDING * 0.2);
    for (int k = 6; k < 12; k++) CHECK_NEAR(end[1][k], end[0][k], 1e-10 * 100 + 100 * ROUNDING * 100);
}

UNIT_TESTS(head_on_spheres_part_with_e_and_the_closed_forms, head_on_spheres_of_hertz_overlap_as_long_and_as_far_as_he_says,
           growing_spheres_of_hertz_press_each_other_as_grown_ones_do, a_sphere_leaves_the_wall_with_e_and_the_closed_forms,
           with_variable_unloading_spheres_part_slower_the_faster_they_met, at_the_runs_own_time_step_e_holds_to_half_a_percent,
           an_impact_that_slides_throughout_gives_the_impulse_of_coulomb,
           a_sphere_that_rolls_along_the_wall_is_not_slowed_by_an_impact, a_sphere_set_sliding_ends_rolling_at_five_sevenths,
           oblique_spinning_spheres_conserve_momentum_and_angular_momentum, across_the_period_is_as_inside)
