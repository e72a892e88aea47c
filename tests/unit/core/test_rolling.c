/* Claims about rolling friction: the increment by itself against its closed forms (core/NUMERICS.md), many contacts at
 * once against one, and bodies that roll, spin and rest in the scene's own step. */
#include "array.h"
#include "contact_block.h"
#include "contact_constants.h"
#include "scene_by_hand.h"
#include "small_drum.h"

static const double K_T = 800, LIMIT = 0.4; /* N/m, N */
static const real UP[3] = { 0, 0, 1 };

/* ---- one contact ---- */

/* Turns by `way` (m, R* times the angle) in x; returns the work done on the contact, by the trapezoid rule. */
static double turn_by(real roll[3], double way, int steps, double limit)
{
    double work = 0;
    for (int k = 0; k < steps; k++) {
        const real before = roll[0], ds[3] = { (real)(way / steps), 0, 0 };
        rolling_increment(UP, ds, (real)limit, (real)K_T, roll);
        work -= 0.5 * (double)(before + roll[0]) * (way / steps);
    }
    return work;
}

/* A thousand sums, each rounded by half a unit of the last place. */
static void the_moment_grows_along_its_spring_and_yields_at_its_limit(void **unused)
{
    (void)unused;
    const double yields = LIMIT / K_T, tolerance = 1000 * ROUNDING * LIMIT;
    real roll[3] = { 0 };
    turn_by(roll, 0.6 * yields, 1000, LIMIT);
    CHECK_NEAR(roll[0], -0.6 * LIMIT, tolerance);
    turn_by(roll, 2 * yields, 1000, LIMIT);
    CHECK_NEAR(roll[0], -LIMIT, 4 * ROUNDING * LIMIT);
    turn_by(roll, -0.5 * yields, 1000, LIMIT); /* back along the spring, from where it had yielded to */
    CHECK_NEAR(roll[0], -0.5 * LIMIT, tolerance);
    turn_by(roll, -9 * yields, 1000, LIMIT);
    CHECK_NEAR(roll[0], LIMIT, 4 * ROUNDING * LIMIT);
    turn_by(roll, 0, 1, 0.25 * LIMIT); /* the load is taken off */
    CHECK_NEAR(roll[0], 0.25 * LIMIT, 4 * ROUNDING * LIMIT);
    turn_by(roll, 0, 1, 0);
    assert_true(roll[0] == 0 && roll[1] == 0 && roll[2] == 0);
}

/* Beyond its limit a rolling contact takes mu_r N a metre, less what its spring stores. */
static void a_long_way_takes_the_limit_a_metre(void **unused)
{
    (void)unused;
    real roll[3] = { 0 };
    const double way = 0.05, stored = LIMIT * LIMIT / (2 * K_T);
    CHECK_NEAR(turn_by(roll, way, 20000, LIMIT), LIMIT * way - stored, 1e-4 * LIMIT * way);
}

static void closed_paths_never_give_energy(void **unused)
{
    (void)unused;
    dice d = { 29 };
    enum { LEGS = 7, STEPS = 200 };
    for (int trial = 0; trial < 2000; trial++) {
        real roll[3] = { 0 };
        const double size = LIMIT / K_T * pow(10, dice_uniform(&d, -1, 1));
        double from[2] = { 0, 0 }, net = 0, gross = 0;
        for (int leg = 0; leg < LEGS; leg++) {
            const bool home = leg + 1 == LEGS;
            double step[2];
            for (int c = 0; c < 2; c++) {
                const double to = home ? 0 : dice_uniform(&d, -size, size);
                step[c] = (to - from[c]) / STEPS;
                from[c] = to;
            }
            for (int k = 0; k < STEPS; k++) {
                const real before[3] = { roll[0], roll[1], 0 }, ds[3] = { (real)step[0], (real)step[1], 0 };
                rolling_increment(UP, ds, (real)LIMIT, (real)K_T, roll);
                const double work = -0.5 * ((double)(before[0] + roll[0]) * step[0] + (double)(before[1] + roll[1]) * step[1]);
                net += work;
                gross += fabs(work);
            }
        }
        /* what is left in the spring at the end was put in; rounding of 1400 sums */
        CHECK_BETWEEN(net, -1400 * ROUNDING * gross, INFINITY);
    }
}

static void a_turning_contact_turns_its_moment_and_keeps_its_magnitude(void **unused)
{
    (void)unused;
    real roll[3] = { (real)0.3, (real)0.1, 0 };
    const real nothing[3] = { 0 };
    for (int k = 0; k <= 90; k++) { /* a quarter turn about y, in steps of a degree */
        const real n[3] = { (real)sin(k * M_PI / 180), 0, (real)cos(k * M_PI / 180) };
        rolling_increment(n, nothing, (real)LIMIT, (real)K_T, roll);
    }
    /* sqrt(1 + e^2) = 1 + e^2/2 - e^4/8, e = pi/180 of a step at most: 1e-8 each, and a few roundings */
    const double tolerance = 90 * (1.2e-8 + 4 * ROUNDING);
    CHECK_NEAR(roll[0], 0, tolerance);
    CHECK_NEAR(sqrt((double)roll[1] * (double)roll[1] + (double)roll[2] * (double)roll[2]), sqrt(0.1), tolerance);
}

/* As friction's: a slope at rest is held up by it for as long as it is looked at. */
static void a_contact_at_rest_keeps_its_moment_for_ever(void **unused)
{
    (void)unused;
    const real n[3] = { (real)0.36, (real)0.48, (real)0.8 }, nothing[3] = { 0 };
    for (double size = 0.01; size < 0.4; size *= 1.3) {
        real roll[3] = { (real)(0.8 * size), (real)(-0.6 * size), 0 };
        for (int k = 0; k < 100000; k++) rolling_increment(n, nothing, (real)LIMIT, (real)K_T, roll);
        CHECK_NEAR(sqrt((double)dot(roll, roll)), size, 1e-5 * size);
    }
}

/* A body of inertia I_r on the spring alone swings as a pendulum with the share zeta of critical damping: each swing is
 * exp(-2 pi zeta/sqrt(1 - zeta^2)) of the one before. Written as forces on the arm R*, I_r is rolling_root^2. */
static void a_damped_spring_loses_the_share_of_critical_damping_until_it_yields(void **unused)
{
    (void)unused;
    for (double zeta = 0.1; zeta < 0.8; zeta += 0.2) {
        const double root = 0.003, c = 2 * zeta * sqrt(K_T) * root, omega = sqrt(K_T) / root, dt = 1e-4 / omega;
        real roll[3] = { 0 }, total[3];
        double v = 1e-3 * LIMIT / (c + 1), way = 0, tops[2];
        int found = 0;
        for (double before = v; found < 2; before = v) {
            const real ds[3] = { (real)(v * dt), 0, 0 }, speed[3] = { (real)v, 0, 0 };
            const bool yields = rolling_increment(UP, ds, (real)LIMIT, (real)K_T, roll);
            rolling_with_dashpot(roll, speed, 0, (real)LIMIT, (real)c, false, yields, total);
            way += v * dt;
            v += dt * (double)total[0] / (root * root);
            if (v <= 0 && before > 0) tops[found++] = way;
        }
        /* 1e4 steps a radian, rounded in each: the spring in single precision keeps six digits of a swing */
        CHECK_NEAR(tops[1] / tops[0], exp(-2 * M_PI * zeta / sqrt(1 - zeta * zeta)), 2e-2);
    }
    real roll[3] = { (real)LIMIT, 0, 0 }, total[3];
    const real ds[3] = { (real)(-LIMIT / K_T), 0, 0 }, speed[3] = { -1, 0, 0 };
    const bool yields = rolling_increment(UP, ds, (real)LIMIT, (real)K_T, roll);
    rolling_with_dashpot(roll, speed, 0, (real)LIMIT, 5, false, yields, total);
    assert_true(yields && total[0] == roll[0]); /* no dashpot beyond */
}

/* While it turns, whatever its spring was left with, a contact bears the limit against the relative spin; of one that twists, too,
 * as much as the rolling part is of all the spin. */
static void a_constant_torque_is_the_limit_against_the_relative_spin(void **unused)
{
    (void)unused;
    dice d = { 57 };
    for (int trial = 0; trial < 2000; trial++) {
        const double angle = dice_uniform(&d, 0, 2 * M_PI), turns = dice_uniform(&d, 0, 2 * M_PI), share = dice_uniform(&d, 0.1, 1);
        const real roll[3] = { (real)(LIMIT * cos(angle)), (real)(LIMIT * sin(angle)), 0 };
        const real v[3] = { (real)(share * cos(turns)), (real)(share * sin(turns)), 0 }, twist = (real)sqrt(1 - share * share);
        real total[3];
        rolling_with_dashpot(roll, v, twist, (real)LIMIT, (real)(1e5 * LIMIT), true, true, total);
        /* the spring is 1e-4 of the dashpot at the least share */
        CHECK_NEAR(total[0], -LIMIT * share * cos(turns), 3e-4 * LIMIT);
        CHECK_NEAR(total[1], -LIMIT * share * sin(turns), 3e-4 * LIMIT);
    }
}

/* 7/5 m R^2 over R*^2, of both ends: 14/5 m of two alike, 7/5 m at a wall. */
static void the_inertia_of_rolling_is_that_about_the_contact(void **unused)
{
    (void)unused;
    const double m = 3e-5, r = 0.002;
    CHECK_NEAR(rolling_root_of(1 / m, r, 1 / m, r, r / 2), sqrt(2.8 * m), 4 * ROUNDING * sqrt(m));
    CHECK_NEAR(rolling_root_of(1 / m, r, 0, 0, r), sqrt(1.4 * m), 4 * ROUNDING * sqrt(m));
    const double inertia = 1.4 / (1 / (m * r * r) + 1 / (8 * m * 4 * r * r)), effective = 2 * r / 3;
    CHECK_NEAR(rolling_root_of(1 / m, r, 1 / (8 * m), 2 * r, effective), sqrt(inertia) / effective, 8 * ROUNDING * sqrt(m));
}

/* ---- many at once ---- */

/* Random blocks of contacts, half of them apart. */
static void compare_block(dice *d, dem_contact_law law, dem_rolling_law rolling)
{
    static const double dt = 1e-5;
    const dem_contact_parameters contact = {
        .law = law, .stiffness = 4000, .tangential_stiffness_ratio = 0.5, .rolling_law = rolling, .rolling_damping = 0.7
    };
    contact_list list;
    assert_int_equal(contact_list_init(&list, true, CONSTANTS_OF_EACH), DEM_OK);
    contact_block *b = array_create(1, sizeof *b);
    real k_t[BLOCK], roll[BLOCK][3];
    for (int k = 0; k < BLOCK; k++) {
        double n[3];
        dice_direction(d, n);
        list.radius[k] = (real)dice_uniform(d, 5e-4, 2e-3);
        list.rolling_friction[k] = (real)dice_uniform(d, 0, 1);
        list.rolling_root[k] = (real)dice_uniform(d, 1e-3, 1e-2);
        b->f_n[k] = (real)fmax(0, dice_uniform(d, -0.1, 0.1));
        k_t[k] = law == DEM_WALTON_BRAUN ? 2000 : (real)dice_uniform(d, 1000, 3000);
        b->k_t[k] = k_t[k];
        const double full = b->f_n[k] * list.rolling_friction[k];
        for (int c = 0; c < 3; c++) {
            b->n[c][k] = (real)n[c];
            b->spin[c][k] = (real)dice_uniform(d, -100, 100);
            roll[k][c] = list.roll[c][k] = (real)(full * dice_uniform(d, -1, 1));
        }
    }
    contact_block_roll(b, &list, 0, &contact, dt);
    for (int k = 0; k < BLOCK; k++) {
        const real n[3] = { b->n[0][k], b->n[1][k], b->n[2][k] }, spin[3] = { b->spin[0][k], b->spin[1][k], b->spin[2][k] };
        const real twist = dot(spin, n), limit = list.rolling_friction[k] * b->f_n[k];
        real ds[3], v[3], total[3];
        for (int c = 0; c < 3; c++) {
            v[c] = (spin[c] - twist * n[c]) * list.radius[k];
            ds[c] = (spin[c] - twist * n[c]) * list.radius[k] * (real)dt;
        }
        const bool yields = rolling_increment(n, ds, limit, k_t[k], roll[k]);
        const double zeta = rolling == DEM_EPSD ? 0 : rolling == DEM_EPSD_DAMPED ? 0.7 : DAMPING_OF_CONSTANT_TORQUE;
        const double damping = 2 * zeta * sqrt((double)k_t[k]) * (double)list.rolling_root[k];
        rolling_with_dashpot(roll[k], v, twist * list.radius[k], limit, (real)damping, rolling == DEM_CONSTANT_TORQUE, yields,
                             total);
        /* a dozen roundings of the force, and of what is taken from the spin along n */
        const double spring = limit + k_t[k] * 200 * list.radius[k] * dt, f_unit = 16 * ROUNDING * spring;
        const double t_unit = 16 * ROUNDING * (spring + damping * 200 * list.radius[k]);
        /* which side of yielding it is on may be rounding's to say */
        const double size = sqrt((double)dot(roll[k], roll[k]));
        const bool is_at_limit = fabs(size - limit) < 4 * f_unit;
        for (int c = 0; c < 3; c++) {
            CHECK_NEAR(list.roll[c][k], roll[k][c], b->f_n[k] > 0 ? f_unit : 0);
            if (is_at_limit && rolling == DEM_EPSD_DAMPED && !yields) continue;
            CHECK_NEAR(b->moment[c][k], total[c] * list.radius[k], b->f_n[k] > 0 ? t_unit * list.radius[k] : 0);
        }
    }
    free(b);
    contact_list_clear(&list);
}

static void many_contacts_at_once_are_as_one_by_one(void **unused)
{
    (void)unused;
    dice d = { 41 };
    for (int round = 0; round < 600; round++) compare_block(&d, (dem_contact_law)(round % 3), (dem_rolling_law)(round / 3 % 3));
}

/* ---- bodies ---- */

/* Every contact law with every law of rolling. */
enum { KINDS = 9 };

static dem_scene_definition rolling_definition(size_t n, int kind)
{
    dem_scene_definition d = hand_definition(n);
    d.contact.law = (dem_contact_law)(kind % 3);
    d.contact.rolling_law = (dem_rolling_law)(kind / 3);
    d.contact.rolling_damping = 0.3;
    d.contact.particle = d.contact.wall = (dem_elasticity){ 5e6, 0.3 };
    d.contact.rolling_friction = d.contact.wall_rolling_friction = 0.1;
    d.length = 0.5; /* the parked spheres fall beside it */
    return d;
}

/* Overlap at which a sphere of 4 mm is carried with the force f. */
static double overlap_of(const dem_contact_parameters *c, double f)
{
    const double e_star = c->particle.youngs_modulus / (2 * (1 - c->particle.poissons_ratio * c->particle.poissons_ratio));
    return c->law == DEM_HERTZ_MINDLIN ? pow(3 * f / (4 * e_star * sqrt(0.002)), 2.0 / 3) : f / c->stiffness;
}

/* Coasting along the lowest line of the drum, a plane in that direction. Friction F and the moment M = mu_r R m g give
 * m a = F and I a/R = M - F R, hence F = 5/7 M/R: a = 5/7 mu_r g, and it stops after v/a. The lever R - alpha/2, of
 * which alpha/(2 R) = 1e-4 are missing, or 1e-3 for Hertz-Mindlin, and the way of 1e-6 m until the spring yields. */
static void a_rolling_sphere_is_slowed_by_five_sevenths_of_mu_r_g_and_stops(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < KINDS; kind++) {
        dem_scene_definition d = rolling_definition(1, kind);
        dem_scene *scene = hand_scene(&d);
        const double v_0 = 0.06, alpha = overlap_of(&d.contact, species_mass(&d.species[0]) * d.gravity), a = 5.0 / 7 * 0.1 * 9.81;
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                           .position = (double[]){ 0, -0.098 - alpha, 0 },
                                           .velocity = (double[]){ 0, 0, v_0 },
                                           .spin = (double[]){ v_0 / (0.002 - alpha / 2), 0, 0 } });
        double x[3], v[3], w[3];
        const double half = 0.5 * v_0 / a;
        advance(scene, (int64_t)(half / d.time_step));
        look_at(scene, x, v, w);
        CHECK_NEAR((v_0 - v[2]) / half, a, 3e-3 * a);
        CHECK_NEAR(x[2], v_0 * half - a * half * half / 2, 2e-3 * v_0 * half);
        advance(scene, (int64_t)(1.5 * half / d.time_step));
        look_at(scene, x, v, w);
        CHECK_NEAR(x[2], v_0 * v_0 / (2 * a), 3e-3 * v_0 * v_0 / (2 * a));
        /* the spring that held it swings: at most as fast as its energy, the limit's (mu_r N)^2/(2 K_T), allows */
        CHECK_BETWEEN(fabs(v[2]), 0, 0.01 * v_0);
        /* with a dashpot it loses that within some swings: neither jitter nor creep is left, but for rounding */
        if (d.contact.rolling_law != DEM_EPSD) {
            const double before = x[2];
            advance(scene, (int64_t)(half / d.time_step));
            look_at(scene, x, v, w);
            CHECK_NEAR(v[2], 0, 1e-4 * v_0);
            CHECK_NEAR(w[0], 0, 1e-4 * v_0 / 0.002);
            CHECK_NEAR(x[2], before, 1e-6);
        }
        dem_scene_free(scene);
    }
}

static double tangential_stiffness(const dem_contact_parameters *c, double overlap)
{
    const double g_star = c->particle.youngs_modulus / (4 * (2 - c->particle.poissons_ratio) * (1 + c->particle.poissons_ratio));
    return c->law == DEM_HERTZ_MINDLIN ? 8 * g_star * sqrt(0.002 * overlap) : c->stiffness * c->tangential_stiffness_ratio;
}

/* Set down at an angle on the wall of the resting drum, R* = R, it stays while tan(angle) < mu_r, else it goes: m a =
 * m g sin - F and I a/R = F R - M give a = 5/7 g (sin - mu_r cos). The springs of friction and rolling are slack at first,
 * by mu_r N/K_T each at most, and it comes out of them with a speed that 5/7 g sin over this way gives at most. Where it
 * stays, that is then lost to -a; the drum's curvature takes 5 g t^2/(84 rho) = 1.5 % of the way down. */
static void a_sphere_on_a_slope_stays_if_the_slope_is_below_mu_r(void **unused)
{
    (void)unused;
    static const double share[] = { 0.45, 0.7, 0.95, 1.05, 1.5 };
    for (int kind = 0; kind < KINDS; kind++) {
        for (int k = 0; k < 5; k++) {
            dem_scene_definition d = rolling_definition(1, kind);
            dem_scene *scene = hand_scene(&d);
            const double angle = atan(share[k] * 0.1), g = d.gravity, time = 0.05, f = species_mass(&d.species[0]) * g * cos(angle);
            const double alpha = overlap_of(&d.contact, f), rho = 0.098 + alpha;
            place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                               .position = (double[]){ rho * sin(angle), -rho * cos(angle), 0 } });
            advance(scene, (int64_t)(time / d.time_step));
            double x[3];
            look_at(scene, x, NULL, NULL);
            const double way = rho * (angle - atan2(x[0], -x[1])), a = 5.0 / 7 * g * (sin(angle) - 0.1 * cos(angle));
            const double slack = 2 * 0.1 * f / tangential_stiffness(&d.contact, alpha),
                         speed2 = 2 * 5.0 / 7 * g * sin(angle) * slack;
            if (a < 0) CHECK_BETWEEN(way, 0, slack + speed2 / (-2 * a));
            if (a < 0 && d.contact.rolling_law != DEM_EPSD) { /* at rest: it does not creep down the slope */
                double later[3], v[3];
                advance(scene, (int64_t)(time / d.time_step));
                look_at(scene, later, v, NULL);
                CHECK_NEAR(rho * (angle - atan2(later[0], -later[1])), way, 2e-7);
                CHECK_NEAR(hypot(v[0], v[1]), 0, 1e-5);
            }
            if (a > 0) CHECK_BETWEEN(way, 0.98 * a * time * time / 2, a * time * time / 2 + sqrt(speed2) * time);
            dem_scene_free(scene);
        }
    }
}

/* In a spinning drum without weight, a sphere that goes round with the wall as one body rolls on nothing; nor does one
 * pressed on a lining. A moment against its spin in space would take it all within a step or two of 1e-4 s. */
static void what_turns_with_the_wall_as_one_body_feels_no_moment(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < KINDS; kind++) {
        dem_scene_definition d = rolling_definition(1, kind);
        d.rotation_rate = 20;
        dem_scene *scene = weightless_scene(&d);
        const double f = species_mass(&d.species[0]) * 400 * 0.098, rho = 0.098 + overlap_of(&d.contact, f);
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                           .position = (double[]){ 0, -rho, 0 },
                                           .velocity = (double[]){ 20 * rho, 0, 0 },
                                           .spin = (double[]){ 0, 0, 20 } });
        advance(scene, (int64_t)(0.2 / d.time_step));
        double w[3];
        look_at(scene, NULL, NULL, w);
        /* half a step between place and velocity makes it ring by (rate dt)/2 = 1e-4 */
        CHECK_NEAR(w[2], 20, 1e-2);
        dem_scene_free(scene);
    }
}

/* Two spheres pressed together that spin against each other: what one loses, the other gets, whatever their sizes. The
 * spin along the line of centres is left alone. */
static void between_two_spheres_moments_are_opposite_and_spare_the_twist(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < KINDS; kind++) {
        for (int differ = 0; differ < 2; differ++) {
            dem_scene_definition d = rolling_definition(2, kind);
            d.contact.friction = 0; /* then rolling friction alone turns them */
            if (differ) first_sphere_differs(&d, (dem_species){ .diameter = 0.007, .density = 2500 });
            dem_scene *scene = weightless_scene(&d);
            const double r[2] = { 0.002, differ ? 0.0035 : 0.002 }, v = 0.05;
            double inertia[2], w_before[6] = { 30, 40, -20, 10, -25, 60 }, w[6];
            for (int k = 0; k < 2; k++) inertia[k] = 0.4 * species_mass(&d.species[differ ? k : 0]) * r[k] * r[k];
            place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                               .position = (double[]){ 0, 0, 0, r[0] + r[1], 0, 0 },
                                               .velocity = (double[]){ v, 0, 0, -v, 0, 0 },
                                               .spin = w_before });
            advance(scene, 2000);
            look_at(scene, NULL, NULL, w);
            double change = 0;
            for (int c = 0; c < 3; c++) {
                const double gain = inertia[0] * (w[c] - w_before[c]), loss = inertia[1] * (w_before[3 + c] - w[3 + c]);
                CHECK_NEAR(gain, loss, 100 * ROUNDING * inertia[0] * 100);
                change = fmax(change, fabs(w[c] - w_before[c]));
            }
            CHECK_NEAR(w[0], w_before[0], 1e-3); /* the line of centres hardly turns */
            /* the impulse 2 m_eff v (1 + e) of the impact times mu_r R*, if it yields throughout; at least a third of it */
            const double m[2] = { inertia[0] / (0.4 * r[0] * r[0]), inertia[1] / (0.4 * r[1] * r[1]) };
            const double most = 0.1 * r[0] * r[1] / (r[0] + r[1]) * 2 * v * 1.8 * m[0] * m[1] / (m[0] + m[1]) / inertia[0];
            CHECK_BETWEEN(change, most / 3, 1.01 * most);
            dem_scene_free(scene);
        }
    }
}

/* ---- whole runs ---- */

static dem_scene_definition rolling_drum(int kind)
{
    dem_scene_definition d = small_drum();
    d.lining = (dem_lining){ .diameter = 0.002, .pitch = 0.004 };
    d.particle_count = 120;
    d.rotation_rate = 12;
    d.contact.rolling_friction = 0.2;
    d.contact.wall_rolling_friction = 0.1;
    follow_rules(&d, 0.03);
    d.contact.law = (dem_contact_law)(kind % 3);
    d.contact.rolling_law = (dem_rolling_law)(kind / 3);
    d.contact.rolling_damping = 0.3;
    d.contact.particle = d.contact.wall = (dem_elasticity){ 2e6, 0.3 };
    return d;
}

static dem_state state_of(const dem_scene *scene)
{
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    return state;
}

/* From the state, which is cleared, a number of steps on. */
static dem_state state_after(const dem_scene_definition *d, dem_state *from, int64_t steps)
{
    dem_scene *scene = drum_scene(d);
    assert_int_equal(dem_scene_restore(scene, from), DEM_OK);
    dem_state_clear(from);
    run(scene, steps);
    const dem_state state = state_of(scene);
    dem_scene_free(scene);
    return state;
}

static bool remembers_moments(dem_state *state, const char *history)
{
    const dem_state_array *a = state_array(state, history);
    bool some = false;
    for (size_t k = 0; k < a->rows; k++) some = some || ((const double *)a->data)[HISTORY_WIDTH * k + HISTORY_ROLL] != 0;
    return some;
}

static void runs_have_the_same_bits_for_any_threads_and_after_a_restart(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < KINDS; kind++) {
        dem_scene_definition d = rolling_drum(kind);
        dem_scene *scene = drum_scene(&d);
        run_to_phase(scene, DEM_PHASE_RUNNING);
        dem_state begin[2] = { state_of(scene), state_of(scene) };
        run(scene, 900);
        dem_state once = state_of(scene);
        dem_scene_free(scene);
        assert_true(remembers_moments(&once, "pair_history") && remembers_moments(&once, "wall_history"));
        for (int k = 0; k < 2; k++) {
            d.threads = 1 + k;
            dem_state half_way = state_after(&d, &begin[k], 277), again = state_after(&d, &half_way, 900 - 277);
            assert_true(states_are_equal(&once, &again));
            dem_state_clear(&again);
        }
        dem_state_clear(&once);
    }
}

UNIT_TESTS(the_moment_grows_along_its_spring_and_yields_at_its_limit, a_long_way_takes_the_limit_a_metre,
           closed_paths_never_give_energy, a_turning_contact_turns_its_moment_and_keeps_its_magnitude,
           a_contact_at_rest_keeps_its_moment_for_ever, a_damped_spring_loses_the_share_of_critical_damping_until_it_yields,
           a_constant_torque_is_the_limit_against_the_relative_spin, the_inertia_of_rolling_is_that_about_the_contact,
           many_contacts_at_once_are_as_one_by_one, a_rolling_sphere_is_slowed_by_five_sevenths_of_mu_r_g_and_stops,
           a_sphere_on_a_slope_stays_if_the_slope_is_below_mu_r, what_turns_with_the_wall_as_one_body_feels_no_moment,
           between_two_spheres_moments_are_opposite_and_spare_the_twist,
           runs_have_the_same_bits_for_any_threads_and_after_a_restart)
