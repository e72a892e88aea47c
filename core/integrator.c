#include "integrator.h"

#include "contact_forces.h"

/* What one step does to every particle alike. */
typedef struct leap_frog {
    vector4 gravity_dt, period, inverse_period; /* the last two along z alone */
    vector4 ring_units;
    double dt, keep;
    int corrector_passes;
} leap_frog;

/* x within one period, and into the row. */
static inline vector4 sphere_move(const leap_frog *leap, sphere_row *row, vector4 x, vector4 v, vector4 omega)
{
    x -= leap->period * vector4_rint(x * leap->inverse_period);
    sphere_row_store(row, x * leap->ring_units, v, omega);
    return x;
}

static inline double largest_of(double a, double b) { return a > b ? a : b; }

/* Force, and torque about the centre, from the loads of a cluster's spheres, in order. */
static void cluster_load(const cluster_shape *shape, const row8 *load, const vector4 *offset, vector4 *force, vector4 *torque)
{
    *force = vector4_low(&load[0]);
    *torque = vector4_high(&load[0]);
    for (size_t k = 0; k < shape->sphere_count; k++) {
        const vector4 f = vector4_low(&load[k]), r = offset[k];
        if (k > 0) {
            *force += f;
            *torque += vector4_high(&load[k]);
        }
        *torque += (vector4){ r[1] * f[2] - r[2] * f[1], r[2] * f[0] - r[0] * f[2], r[0] * f[1] - r[1] * f[0] };
    }
}

/* The cluster's spin at the next half step, along the axes of space and of the body. */
static void cluster_turn(const leap_frog *leap, const cluster_shape *shape, cluster_body *body, double a[3][3], vector4 torque,
                         double in_space[3], double in_body[3])
{
    const double n[3] = { torque[0], torque[1], torque[2] };
    if (shape->is_isotropic) { /* Euler's products vanish; no need to turn back and forth */
        for (int c = 0; c < 3; c++)
            in_space[c] = body->spin[c] = __builtin_fma(leap->dt * (1.0 / shape->inertia[0]), n[c], leap->keep * body->spin[c]);
        to_body(a, in_space, in_body);
        return;
    }
    double n_p[3];
    to_body(a, n, n_p);
    for (int c = 0; c < 3; c++) body->spin[c] *= leap->keep;
    euler_advance(body->spin, body->spin_change, n_p, shape->inertia, leap->dt, leap->corrector_passes);
    memcpy(in_body, body->spin, sizeof body->spin);
    to_space(a, in_body, in_space);
}

/* Eqns 3-23 for one cluster and its spheres. A spin is along the same axes of space before and after the rotation that
 * it causes, so it may be turned into them by either orientation. A sphere's velocity is its displacement over dt:
 * exactly what the friction spring integrates, and what neighbor lists bound. */
static void cluster_advance(const leap_frog *leap, spheres *s, cluster_body *body, double scale_now, double scale_next)
{
    const cluster_shape *shape = &s->clusters.shape[body->species];
    const size_t first = (size_t)body->first_sphere;
    double a[3][3], in_space[3], in_body[3];
    vector4 offset[DEM_MAXIMUM_CLUSTER], force, torque;
    quaternion_matrix(body->orientation, a);
    for (size_t k = 0; k < shape->sphere_count; k++) offset[k] = cluster_offset(shape, k, a, scale_now);
    cluster_load(shape, &s->load[first], offset, &force, &torque);

    const vector4 keep = leap->keep - (vector4){ 0 }, dt = leap->dt - (vector4){ 0 },
                  per_mass = leap->dt * (1.0 / shape->mass) - (vector4){ 0 };
    const vector4 v = vector4_fused(per_mass, force, vector4_fused(keep, body->velocity, -leap->gravity_dt));
    cluster_turn(leap, shape, body, a, torque, in_space, in_body);
    const vector4 omega = { in_space[0], in_space[1], in_space[2] };
    body->velocity = v;
    body->orientation = quaternion_advance(body->orientation, in_body, leap->dt);
    const vector4 x = vector4_fused(dt, v, (vector4){ body->x[0], body->x[1], body->x[2] });
    const vector4 wrapped = x - leap->period * vector4_rint(x * leap->inverse_period);
    for (int c = 0; c < 3; c++) body->x[c] = wrapped[c];

    quaternion_matrix(body->orientation, a);
    for (size_t k = 0; k < shape->sphere_count; k++) {
        const vector4 r = cluster_offset(shape, k, a, scale_next), v_k = v + (r - offset[k]) / leap->dt;
        s->velocity[first + k] = v_k;
        s->angular_velocity[first + k] = omega;
        s->place[first + k] = sphere_move(leap, &s->row[first + k], x + r, v_k, omega);
    }
}

/* The same for all clusters; returns the bound for their spheres. */
static double clusters_advance(spheres *s, const leap_frog *leap, double scale_next, const vector4 *picked_velocity, int threads)
{
    const double scale_now = s->scale;
    double largest_x = 0.0, largest_y = 0.0, largest_z = 0.0;
#pragma omp parallel for schedule(static) reduction(max : largest_x, largest_y, largest_z) num_threads(threads) if (threads > 1)
    for (size_t b = 0; b < s->clusters.count; b++) {
        cluster_body *body = &s->clusters.body[b];
        cluster_advance(leap, s, body, scale_now, scale_next);
        const size_t first = (size_t)body->first_sphere, end = first + s->clusters.shape[body->species].sphere_count;
        for (size_t i = first; i < end; i++) {
            const vector4 d = s->velocity[i] - picked_velocity[i], d2 = d * d;
            largest_x = largest_of(largest_x, d2[0]);
            largest_y = largest_of(largest_y, d2[1]);
            largest_z = largest_of(largest_z, d2[2]);
        }
    }
    return sqrt(largest_x + largest_y + largest_z);
}

/* Eqns 3 and 4 for some spheres. A sphere's inertia is the same about every axis, so Euler's products (Eq 5) vanish and
 * its spin advances as its velocity does. Returns the largest of each component of (v - picked_velocity)^2. */
static vector4 some_spheres_advance(const leap_frog *leap, spheres *s, const row8 *restrict load, const vector4 *picked_velocity,
                                    size_t from, size_t to)
{
    const double *restrict inverse_mass = s->inverse_mass, *restrict inverse_inertia = s->inverse_inertia;
    vector4 *restrict velocity = s->velocity, *restrict spin = s->angular_velocity, *restrict place = s->place;
    sphere_row *restrict row = s->row;
    const vector4 keep = leap->keep - (vector4){ 0 }, dt = leap->dt - (vector4){ 0 };
    vector4 largest = { 0 };
    for (size_t i = from; i < to; i++) {
        const vector4 per_mass = leap->dt * inverse_mass[i] - (vector4){ 0 },
                      per_inertia = leap->dt * inverse_inertia[i] - (vector4){ 0 };
        const vector4 v =
            vector4_fused(per_mass, vector4_low(&load[i - from]), vector4_fused(keep, velocity[i], -leap->gravity_dt));
        const vector4 omega = vector4_fused(per_inertia, vector4_high(&load[i - from]), keep * spin[i]);
        const vector4 astray = v - picked_velocity[i];
        velocity[i] = v;
        spin[i] = omega;
        place[i] = sphere_move(leap, &row[i], vector4_fused(dt, v, place[i]), v, omega);
        largest = vector4_greater(largest, astray * astray);
    }
    return largest;
}

/* Some spheres' sums over their contacts, then their steps: by the hundred, each has few instructions from start to end,
 * so that the processor works on several spheres at a time. */
static vector4 spheres_advance(const leap_frog *leap, spheres *s, const neighbor_list *list, size_t from, size_t to)
{
    enum { SOME = 64 };
    row8 load[SOME];
    vector4 largest = { 0 };
    for (size_t i = from; i < to; i += SOME) {
        const size_t end = i + SOME < to ? i + SOME : to;
        for (size_t k = i; k < end; k++) load[k - i] = contact_forces_of(list, k);
        largest = vector4_greater(largest, some_spheres_advance(leap, s, load, list->picked_velocity, i, end));
    }
    return largest;
}

double integrator_advance(spheres *s, const neighbor_list *list, const container *drum, const body_forces *body, double dt,
                          int threads)
{
    const double g_dt = body->gravity * dt, *up = drum->up;
    const leap_frog leap = { .gravity_dt = { up[0] * g_dt, up[1] * g_dt, up[2] * g_dt },
                             .period = { 0.0, 0.0, drum->period },
                             .inverse_period = { 0.0, 0.0, drum->inverse_period },
                             .ring_units = s->ring_units,
                             .dt = dt,
                             .keep = 1.0 - body->drag * dt,
                             .corrector_passes = s->clusters.corrector_passes };
    const size_t count = s->single_count;
    double x = 0.0, y = 0.0, z = 0.0;
#pragma omp parallel for schedule(static) reduction(max : x, y, z) num_threads(threads) if (threads > 1)
    for (int part = 0; part < threads; part++) {
        const vector4 largest =
            spheres_advance(&leap, s, list, part_start(count, part, threads), part_start(count, part + 1, threads));
        x = largest_of(x, largest[0]);
        y = largest_of(y, largest[1]);
        z = largest_of(z, largest[2]);
    }
    const double singles = sqrt(x + y + z);
    if (s->clusters.count == 0) return singles;
    contact_forces_sum(list, s, count, threads);
    return largest_of(singles, clusters_advance(s, &leap, body->scale, list->picked_velocity, threads));
}
