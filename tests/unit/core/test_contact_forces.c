/* Claims about the loop over contacts: many at once, it gives what the scalar law of contact_law.h gives one by one,
 * and each of the two spheres gets its share. Every pair stands alone, so that one step shows its force (the change
 * of velocity) and its torque (of spin), and a saved state shows what it remembers. */
#include "contact_law.h"
#include "scene_by_hand.h"

enum { SIDE = 8, PAIRS = SIDE * SIDE * SIDE, SPHERES = 2 * PAIRS, ROUNDS = 2000 };

/* The special cases that a random contact never is. */
typedef enum special { ORDINARY, FIRST_TOUCH, JUST_APART, REVERSAL, UNLOADED, PERPENDICULAR, FULL_SLIP, AT_REST, KINDS } special;

typedef struct questions {
    special kind[PAIRS];
    double position[3 * SPHERES], velocity[3 * SPHERES], spin[3 * SPHERES], history[HISTORY_WIDTH * PAIRS];
    int32_t pair[2 * PAIRS];
} questions;

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int c = 0; c < 3; c++) out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

static double scalar_product(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* A unit vector at right angles to n. */
static void tangent_to(dice *d, const double n[3], double t[3])
{
    double other[3];
    dice_direction(d, other);
    cross(n, other, t);
    const double size = sqrt(scalar_product(t, t));
    for (int c = 0; c < 3; c++) t[c] /= size;
}

static double overlap_of(dice *d, special kind, double diameter)
{
    if (kind == FIRST_TOUCH) return diameter * pow(10, dice_uniform(d, -8, -5));
    if (kind == JUST_APART) return -diameter * pow(10, dice_uniform(d, -8, -4));
    return diameter * dice_uniform(d, 1e-4, 0.02);
}

static void ask(questions *q, size_t p, dice *d, const dem_scene_definition *definition)
{
    const dem_contact_parameters *law = &definition->contact;
    const double diameter = definition->species[0].diameter, k_1 = law->stiffness, k_2 = k_1 / law->restitution / law->restitution;
    const special kind = q->kind[p] = (int)dice_uniform(d, 0, 2 * KINDS) < KINDS ? ORDINARY : (int)dice_uniform(d, 0, KINDS);
    double n[3], h[3], middle[3];
    dice_direction(d, n);
    tangent_to(d, n, h);
    const size_t cell[3] = { p % SIDE, p / SIDE % SIDE, p / SIDE / SIDE };
    const double overlap = overlap_of(d, kind, diameter), speed = kind == AT_REST ? 0 : pow(10, dice_uniform(d, -4, 0));
    double *v = q->velocity + 6 * p, *w = q->spin + 6 * p, *x = q->position + 6 * p, *memory = q->history + HISTORY_WIDTH * p;
    for (int c = 0; c < 3; c++) {
        middle[c] = 0.014 * ((double)cell[c] - 0.5 * (SIDE - 1));
        x[c] = middle[c] - 0.5 * (diameter - overlap) * n[c];
        x[3 + c] = middle[c] + 0.5 * (diameter - overlap) * n[c];
        v[c] = dice_uniform(d, -speed, speed);
        v[3 + c] = dice_uniform(d, -speed, speed);
        w[c] = kind == PERPENDICULAR ? 0 : dice_uniform(d, -speed, speed) / diameter;
        w[3 + c] = kind == PERPENDICULAR ? 0 : dice_uniform(d, -speed, speed) / diameter;
    }
    /* what the contact remembers: a friction force in the tangent plane of a moment ago, a little off today's */
    const bool fresh = kind == FIRST_TOUCH || kind == JUST_APART;
    const double alpha_0 = fresh ? 0 : kind == UNLOADED ? 1.1 * overlap : overlap * (1 - k_1 / k_2) * dice_uniform(d, 0, 2);
    const double f_n = fmax(0, fmin(k_1 * overlap, k_2 * (overlap - alpha_0))), mu_n = law->friction * f_n;
    const double t = kind == FULL_SLIP ? 1 : dice_uniform(d, 0, 0.99);
    double t_star = dice_uniform(d, -1, 1);
    for (int c = 0; c < 3; c++)
        memory[HISTORY_T + c] = fresh              ? 0
                                : kind == UNLOADED ? 1e-3 * h[c]
                                                   : t * mu_n * (h[c] + 1e-3 * dice_uniform(d, -1, 1) * n[c]);
    if (kind == PERPENDICULAR || kind == REVERSAL) {
        double side[3];
        cross(n, h, side);
        for (int c = 0; c < 3; c++) {
            v[c] = 0;
            v[3 + c] = kind == PERPENDICULAR ? speed * side[c] : -speed * h[c];
        }
        if (kind == REVERSAL) t_star = t;
    }
    memory[HISTORY_T_STAR] = fresh ? 0 : t_star;
    memory[HISTORY_ALPHA_0] = alpha_0;
    q->pair[2 * p] = (int32_t)(2 * p);
    q->pair[2 * p + 1] = (int32_t)(2 * p + 1);
}

/* Where two spheres touch first: the square of that distance is a number of contact arithmetic, in units of the ring. */
static double touching_distance(const spheres *s, double radii)
{
    const real reach = (real)radii * (real)s->ring_units, reach2 = reach * reach;
    const double distance = sqrt((double)reach2) / s->ring_units;
    CHECK_NEAR(distance, radii, 2 * ROUNDING * radii);
    return distance;
}

/* What the scalar law says of one pair, its geometry computed here in double precision. */
typedef struct answer {
    double force[3];     /* N on the first */
    double arm[2], q[3]; /* torque = arm q */
    contact_history memory;
    double force_scale; /* N: of which rounding takes its share */
    double steepest;    /* N/m: of the unloading branch */
    double mu_n;        /* N */
    bool is_slipping;   /* T is within 1 % of its limit, or beyond */
    bool is_turning;    /* nearly at right angles to T: whether it turns is rounding's to say */
} answer;

static answer scalar_answer(const questions *q, size_t p, const double radius[2], double touching,
                            const dem_contact_parameters *law, double effective_mass, double dt)
{
    const double *x = q->position + 6 * p, *v = q->velocity + 6 * p, *w = q->spin + 6 * p, *memory = q->history + HISTORY_WIDTH * p;
    const double k_1 = law->stiffness, k_2 = k_1 / (law->restitution * law->restitution),
                 k_t = k_1 * law->tangential_stiffness_ratio;
    double n[3], rolling[3], s[3], v_r[3], speed = 0;
    for (int c = 0; c < 3; c++) n[c] = x[3 + c] - x[c];
    const double distance = sqrt(scalar_product(n, n)), overlap = touching - distance;
    answer a = { .arm = { radius[0] - overlap / 2, radius[1] - overlap / 2 } };
    for (int c = 0; c < 3; c++) {
        n[c] /= distance;
        s[c] = a.arm[0] * w[c] + a.arm[1] * w[3 + c];
        speed += fabs(v[c]) + fabs(v[3 + c]) + fabs(s[c]);
    }
    cross(s, n, rolling);
    for (int c = 0; c < 3; c++) v_r[c] = v[3 + c] - v[c] - rolling[c];
    const double v_n = scalar_product(v_r, n);
    real normal[3], ds[3];
    for (int c = 0; c < 3; c++) {
        normal[c] = (real)n[c];
        ds[c] = (real)((v_r[c] - v_n * n[c]) * dt);
        a.memory.t[c] = (real)memory[HISTORY_T + c];
    }
    a.memory.t_star = (real)memory[HISTORY_T_STAR];
    a.memory.alpha_0 = (real)memory[HISTORY_ALPHA_0];
    const double slope = law->unloading_slope;
    const real c_n = (real)(2 * law->latch_damping * sqrt(k_2 * effective_mass)), alpha = (real)overlap, closing = (real)-v_n;
    const double f_n = slope > 0 ? normal_force_of_slope(alpha, closing, (real)k_1, (real)slope, c_n, &a.memory.alpha_0)
                                 : normal_force(alpha, closing, (real)k_1, (real)k_2, c_n, &a.memory.alpha_0),
                 mu_n = law->friction * f_n;
    const double t_before[3] = { a.memory.t[0], a.memory.t[1], a.memory.t[2] };
    const double moved[3] = { ds[0], ds[1], ds[2] }, s_p = scalar_product(t_before, moved);
    friction_increment(normal, ds, (real)mu_n, (real)k_t, a.memory.t, &a.memory.t_star);
    const double t_after[3] = { a.memory.t[0], a.memory.t[1], a.memory.t[2] };
    const double size2 = scalar_product(t_before, t_before);
    a.is_turning =
        fabs(s_p) < 1e-3 * sqrt(size2 * scalar_product(moved, moved)) || fabs(scalar_product(t_before, t_after)) < 1e-3 * size2;
    a.mu_n = mu_n;
    a.is_slipping = sqrt(size2) > 0.99 * mu_n && mu_n > 0;
    for (int c = 0; c < 3; c++) a.force[c] = t_after[c] - f_n * n[c];
    cross(n, t_after, a.q);
    const double bent = slope * fmax(memory[HISTORY_ALPHA_0], (double)a.memory.alpha_0);
    a.steepest = slope > 0 ? k_1 * (1 + (bent + sqrt(bent * (bent + 4))) / 2) : k_2;
    a.force_scale = k_2 * fabs(overlap) + sqrt(size2) + k_t * speed * dt + (double)c_n * speed;
    return a;
}

/* Largest differences seen, in roundings of the scale; every kind of contact by itself. */
typedef struct difference {
    double force, torque, memory, momentum;
    size_t count;
} difference;

static void widest(double *largest, double seen) { *largest = fmax(*largest, isnan(seen) ? INFINITY : seen); }

static void compare_round(const questions *q, dem_scene *scene, difference seen[KINDS])
{
    static double v[3 * SPHERES], w[3 * SPHERES], memory[HISTORY_WIDTH * PAIRS];
    const dem_scene_definition *d = &scene->definition;
    const double m = species_mass(&d->species[0]), dt = d->time_step, inertia = 0.4 * m * 0.002 * 0.002;
    look_at(scene, NULL, v, w);
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    const dem_state_array *pair = state_array(&state, "pair"), *history = state_array(&state, "pair_history");
    memset(memory, 0, sizeof memory);
    for (size_t k = 0; k < pair->rows; k++) {
        const size_t p = (size_t)((const int32_t *)pair->data)[2 * k] / 2;
        memcpy(memory + HISTORY_WIDTH * p, (const double *)history->data + HISTORY_WIDTH * k, HISTORY_WIDTH * sizeof(double));
    }
    dem_state_clear(&state);

    for (size_t p = 0; p < PAIRS; p++) {
        const double radius[2] = { (double)scene->spheres.full_radius[2 * p], (double)scene->spheres.full_radius[2 * p + 1] };
        const answer a =
            scalar_answer(q, p, radius, touching_distance(&scene->spheres, radius[0] + radius[1]), &d->contact, m / 2, dt);
        difference *worst = &seen[a.is_slipping ? FULL_SLIP : q->kind[p]];
        /* The overlap comes from places in units of 2^-32 of less than 8 diameters, the change of velocity is one of doubles. */
        const double place = sizeof(real) == sizeof(float) ? 8 * 0.004 / 4294967296.0 : 0.004 * DBL_EPSILON;
        const double f_unit = ROUNDING * a.force_scale + place * a.steepest + DBL_EPSILON * m / dt;
        const double length = 0.002, t_unit = f_unit * length + DBL_EPSILON * inertia / dt * 250;
        const double *m_got = memory + HISTORY_WIDTH * p;
        for (size_t c = 0; c < 3; c++) {
            const size_t i = 6 * p + c, j = i + 3;
            const double f_i = m * (v[i] - q->velocity[i]) / dt, f_j = m * (v[j] - q->velocity[j]) / dt;
            widest(&worst->force, fabs(f_i - a.force[c]) / f_unit);
            widest(&worst->momentum, fabs(f_i + f_j) / (DBL_EPSILON * m / dt));
            widest(&worst->torque, fabs(inertia * (w[i] - q->spin[i]) / dt - a.arm[0] * a.q[c]) / t_unit);
            widest(&worst->torque, fabs(inertia * (w[j] - q->spin[j]) / dt - a.arm[1] * a.q[c]) / t_unit);
            widest(&worst->memory, fabs(m_got[HISTORY_T + c] - (double)a.memory.t[c]) / f_unit);
        }
        widest(&worst->memory, fabs(m_got[HISTORY_ALPHA_0] - (double)a.memory.alpha_0) * d->contact.stiffness / f_unit);
        if (!a.is_turning) widest(&worst->memory, fabs(m_got[HISTORY_T_STAR] - (double)a.memory.t_star) * a.mu_n / f_unit);
        worst->count++;
    }
}

/* Where T is near its limit, 1 - |T|/(mu N) has few digits left, and the cube root of a small number shows them: its
 * slope at the floor of 1e-6 is 3000. Elsewhere a dozen operations round, and half a rounding of a velocity counts. */
static void check_kind(special kind, const difference *seen)
{
    const double allowed = kind == FULL_SLIP ? 3000 : 16;
    CHECK_BETWEEN(seen->count, PAIRS, INFINITY);
    CHECK_BETWEEN(seen->force, 0, allowed);
    CHECK_BETWEEN(seen->torque, 0, allowed);
    CHECK_BETWEEN(seen->memory, 0, allowed);
    CHECK_BETWEEN(seen->momentum, 0, 1);
}

static void compare_many(double unloading_slope)
{
    static questions q;
    dem_scene_definition d = hand_definition(SPHERES);
    d.diameter = 0.3;
    d.length = 0.15;
    d.contact.unloading_slope = unloading_slope;
    d.contact.latch_damping = 0.3;
    dem_scene *scene = weightless_scene(&d);
    dice own = { 3 };
    difference seen[KINDS] = { { 0 } };
    for (int round = 0; round < ROUNDS; round++) {
        for (size_t p = 0; p < PAIRS; p++) ask(&q, p, &own, &d);
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                           .position = q.position,
                                           .velocity = q.velocity,
                                           .spin = q.spin,
                                           .pair_count = PAIRS,
                                           .pair = q.pair,
                                           .history = q.history });
        advance(scene, 1);
        compare_round(&q, scene, seen);
    }
    dem_scene_free(scene);
    for (int k = 0; k < KINDS; k++) check_kind((special)k, &seen[k]);
}

static void a_million_contacts_at_once_are_as_one_by_one(void **unused)
{
    (void)unused;
    compare_many(0);
}

/* Overlaps reach 2 % of 4 mm: K2 is up to 1.56 K1, as the constant one is. */
static void with_variable_unloading_too(void **unused)
{
    (void)unused;
    compare_many(7000);
}

UNIT_TESTS(a_million_contacts_at_once_are_as_one_by_one, with_variable_unloading_too)
