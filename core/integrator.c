#include "integrator.h"

/* What one step does to every particle alike. */
typedef struct leap_frog {
    vector4 gravity_dt, period, inverse_period; /* the last two along z alone */
    double dt, keep;
    int corrector_passes;
} leap_frog;

/* Eqns 3 and 4 for one sphere. A sphere's inertia is the same about every axis, so Euler's products (Eq 5) vanish
 * and its spin advances as its velocity does. */
static inline void sphere_advance(const leap_frog *leap, const row8 *load, double inverse_mass, double inverse_inertia,
                                  vector4 *velocity, vector4 *spin, sphere_row *row)
{
    const vector4 v = leap->keep * *velocity + (leap->dt * inverse_mass) * vector4_low(load) - leap->gravity_dt;
    const vector4 omega = leap->keep * *spin + (leap->dt * inverse_inertia) * vector4_high(load);
    *velocity = v;
    *spin = omega;
    vector4 x = vector4_place(row->x) + leap->dt * v;
    x -= leap->period * vector4_rint(x * leap->inverse_period);
    sphere_row_store(row, x, v, omega);
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
            in_space[c] = body->spin[c] = leap->keep * body->spin[c] + (leap->dt * (1.0 / shape->inertia[0])) * n[c];
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

    const vector4 v = leap->keep * body->velocity + (leap->dt * (1.0 / shape->mass)) * force - leap->gravity_dt;
    cluster_turn(leap, shape, body, a, torque, in_space, in_body);
    const vector4 omega = { in_space[0], in_space[1], in_space[2] };
    body->velocity = v;
    body->orientation = quaternion_advance(body->orientation, in_body, leap->dt);
    const vector4 x = (vector4){ body->x[0], body->x[1], body->x[2] } + leap->dt * v;
    const vector4 wrapped = x - leap->period * vector4_rint(x * leap->inverse_period);
    for (int c = 0; c < 3; c++) body->x[c] = wrapped[c];

    quaternion_matrix(body->orientation, a);
    for (size_t k = 0; k < shape->sphere_count; k++) {
        const vector4 r = cluster_offset(shape, k, a, scale_next), v_k = v + (r - offset[k]) / leap->dt;
        vector4 place = x + r;
        place -= leap->period * vector4_rint(place * leap->inverse_period);
        s->velocity[first + k] = v_k;
        s->angular_velocity[first + k] = omega;
        sphere_row_store(&s->row[first + k], place, v_k, omega);
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

double integrator_advance(spheres *s, const container *drum, const body_forces *body, const vector4 *picked_velocity, double dt,
                          int threads)
{
    const double g_dt = body->gravity * dt, *up = drum->up;
    const leap_frog leap = { .gravity_dt = { up[0] * g_dt, up[1] * g_dt, up[2] * g_dt },
                             .period = { 0.0, 0.0, drum->period },
                             .inverse_period = { 0.0, 0.0, drum->inverse_period },
                             .dt = dt,
                             .keep = 1.0 - body->drag * dt,
                             .corrector_passes = s->clusters.corrector_passes };
    const row8 *restrict load = s->load;
    const double *restrict inverse_mass = s->inverse_mass, *restrict inverse_inertia = s->inverse_inertia;
    vector4 *restrict velocity = s->velocity, *restrict spin = s->angular_velocity;
    sphere_row *restrict row = s->row;
    const size_t count = s->single_count;
    double largest_x = 0.0, largest_y = 0.0, largest_z = 0.0;
#pragma omp parallel for schedule(static) reduction(max : largest_x, largest_y, largest_z) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < count; i++) {
        sphere_advance(&leap, &load[i], inverse_mass[i], inverse_inertia[i], &velocity[i], &spin[i], &row[i]);
        const vector4 d = velocity[i] - picked_velocity[i], d2 = d * d;
        largest_x = largest_of(largest_x, d2[0]);
        largest_y = largest_of(largest_y, d2[1]);
        largest_z = largest_of(largest_z, d2[2]);
    }
    const double singles = sqrt(largest_x + largest_y + largest_z);
    if (s->clusters.count == 0) return singles;
    return largest_of(singles, clusters_advance(s, &leap, body->scale, picked_velocity, threads));
}
