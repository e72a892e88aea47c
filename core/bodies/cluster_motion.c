#include "leap_frog.h"

/* A cluster's step is one long chain of dependent operations. Taken apart into passes over some clusters, the processor
 * works on several of them at a time; the passes over orientations alone go by whole vectors. */
enum { SOME = 16 };

/* One cluster between the passes. */
typedef struct motion {
    vector4 before[3], after[3]; /* the rows of A (Eq 11): the body's axes along those of space, before and after the step */
    vector4 force, torque;       /* N, N m about the centre, along the axes of space */
    vector4 velocity, omega;     /* m/s, rad/s at the next half step, along the axes of space */
    vector4 place;               /* m */
} motion;

/* Their orientations, number by number. */
typedef struct orientations {
    double q[4][SOME];
    double spin[3][SOME]; /* rad/s, along the axes of the body */
    double a[9][SOME];    /* A, row by row */
} orientations;

static void orientations_load(orientations *all, const cluster_body *body, size_t count)
{
    for (size_t b = 0; b < SOME; b++) {
        const quaternion q = b < count ? body[b].orientation : (quaternion){ 0, 0, 0, 1 };
        all->q[0][b] = q.q1;
        all->q[1][b] = q.q2;
        all->q[2][b] = q.q3;
        all->q[3][b] = q.q4;
    }
}

static void matrices_make(orientations *restrict all)
{
    for (size_t b = 0; b < SOME; b++) {
        double a[3][3];
        quaternion_matrix((quaternion){ all->q[0][b], all->q[1][b], all->q[2][b], all->q[3][b] }, a);
        all->a[0][b] = a[0][0];
        all->a[1][b] = a[0][1];
        all->a[2][b] = a[0][2];
        all->a[3][b] = a[1][0];
        all->a[4][b] = a[1][1];
        all->a[5][b] = a[1][2];
        all->a[6][b] = a[2][0];
        all->a[7][b] = a[2][1];
        all->a[8][b] = a[2][2];
    }
}

static void orientations_advance(orientations *restrict all, double dt)
{
    for (size_t b = 0; b < SOME; b++) {
        const double spin[3] = { all->spin[0][b], all->spin[1][b], all->spin[2][b] };
        const quaternion q = { all->q[0][b], all->q[1][b], all->q[2][b], all->q[3][b] }, next = quaternion_advance(q, spin, dt);
        all->q[0][b] = next.q1;
        all->q[1][b] = next.q2;
        all->q[2][b] = next.q3;
        all->q[3][b] = next.q4;
    }
}

static void axes_of(const orientations *all, size_t b, vector4 axis[3])
{
    for (int k = 0; k < 3; k++) axis[k] = (vector4){ all->a[3 * k][b], all->a[3 * k + 1][b], all->a[3 * k + 2][b] };
}

/* A vector along the body's axes, turned into those of space. */
WIDE_INLINE vector4 along_space(const vector4 axis[3], const double x[3])
{
    return vector4_fused(vector4_all(x[2]), axis[2], vector4_fused(vector4_all(x[1]), axis[1], vector4_all(x[0]) * axis[0]));
}

WIDE_INLINE vector4 cross_product(vector4 a, vector4 b)
{
    const vector4 turned = a * __builtin_shufflevector(b, b, 1, 2, 0, 3) - __builtin_shufflevector(a, a, 1, 2, 0, 3) * b;
    return __builtin_shufflevector(turned, turned, 1, 2, 0, 3);
}

static double scalar_product(vector4 a, vector4 b)
{
    const vector4 p = a * b;
    return p[0] + p[1] + p[2];
}

/* Force, and torque about the centre, from the loads of a cluster's spheres, in order. */
static void collect(const leap_frog *leap, spheres *s, const cluster_body *body, motion *m)
{
    const cluster_shape *shape = &s->clusters.shape[body->species];
    m->force = m->torque = (vector4){ 0 };
    for (size_t k = 0; k < shape->sphere_count; k++) {
        row8 *load = &s->load[(size_t)body->first_sphere + k];
        const vector4 f = row8_force(load), r = leap->scale_now * along_space(m->before, shape->place[k]);
        m->force += f;
        m->torque += row8_torque(load);
        m->torque += cross_product(r, f);
        *load = (row8){ 0 };
    }
}

/* The spin at the next half step, along the axes of space and (spin) of the body. */
static void turn(const leap_frog *leap, const cluster_shape *shape, cluster_body *body, motion *m, double spin[3])
{
    if (shape->is_isotropic) { /* Euler's products vanish; no need to turn back and forth */
        const vector4 now = { body->spin[0], body->spin[1], body->spin[2] };
        m->omega = vector4_fused(vector4_all(leap->dt * (1.0 / shape->inertia[0])), m->torque, vector4_all(leap->keep) * now);
        for (int c = 0; c < 3; c++) {
            body->spin[c] = m->omega[c];
            spin[c] = scalar_product(m->before[c], m->omega);
        }
        return;
    }
    double torque[3];
    for (int c = 0; c < 3; c++) {
        torque[c] = scalar_product(m->before[c], m->torque);
        body->spin[c] *= leap->keep;
    }
    euler_advance(body->spin, body->spin_change, torque, shape->inertia, leap->dt, leap->corrector_passes);
    memcpy(spin, body->spin, sizeof body->spin);
    m->omega = along_space(m->before, spin);
}

static void push(const leap_frog *leap, const cluster_shape *shape, cluster_body *body, motion *m)
{
    const vector4 per_mass = vector4_all(leap->dt * (1.0 / shape->mass));
    m->velocity = vector4_fused(per_mass, m->force, vector4_fused(vector4_all(leap->keep), body->velocity, -leap->gravity_dt));
    m->place = vector4_fused(vector4_all(leap->dt), m->velocity, (vector4){ body->x[0], body->x[1], body->x[2] });
    body->velocity = m->velocity;
    const vector4 wrapped = m->place - leap->period * vector4_rint(m->place * leap->inverse_period);
    for (int c = 0; c < 3; c++) body->x[c] = wrapped[c];
}

/* A spin is along the same axes of space before and after the rotation that it causes, so it may be turned into them by
 * either orientation. A sphere's velocity is its displacement over dt: exactly what the friction spring integrates, and
 * what neighbor lists bound. */
static vector4 carry_spheres(const leap_frog *leap, spheres *s, const cluster_body *body, const motion *m,
                             const half_row *picked_velocity)
{
    const cluster_shape *shape = &s->clusters.shape[body->species];
    const size_t first = (size_t)body->first_sphere;
    const vector4 per_dt = vector4_all(1 / leap->dt), now = vector4_all(leap->scale_now), next = vector4_all(leap->scale_next);
    vector4 to[3], change[3], largest = { 0 };
    for (int c = 0; c < 3; c++) {
        to[c] = next * m->after[c];
        change[c] = per_dt * (to[c] - now * m->before[c]);
    }
    for (size_t k = 0; k < shape->sphere_count; k++) {
        const double *x = shape->place[k];
        const vector4 x0 = vector4_all(x[0]), x1 = vector4_all(x[1]), x2 = vector4_all(x[2]);
        const vector4 place = vector4_fused(x2, to[2], vector4_fused(x1, to[1], vector4_fused(x0, to[0], m->place)));
        const vector4 v = vector4_fused(x2, change[2], vector4_fused(x1, change[1], vector4_fused(x0, change[0], m->velocity)));
        const vector4 astray = v - vector4_of(&picked_velocity[first + k]);
        s->velocity[first + k] = v;
        s->angular_velocity[first + k] = m->omega;
        s->place[first + k] = sphere_move(leap, &s->row[first + k], &s->rest[first + k], place, v, m->omega);
        largest = vector4_greater_size(largest, astray);
    }
    return largest;
}

vector4 clusters_advance(const leap_frog *all, spheres *s, const half_row *picked_velocity, size_t from, size_t to)
{
    const leap_frog leap = *all; /* in registers, which no store to a sphere can change */
    motion m[SOME];
    orientations turned;
    vector4 largest = { 0 };
    for (size_t begin = from; begin < to; begin += SOME) {
        cluster_body *body = &s->clusters.body[begin];
        const size_t count = begin + SOME < to ? SOME : to - begin;
        orientations_load(&turned, body, count);
        matrices_make(&turned);
        for (size_t b = 0; b < count; b++) {
            axes_of(&turned, b, m[b].before);
            collect(&leap, s, &body[b], &m[b]);
        }
        for (size_t b = 0; b < SOME; b++) {
            double spin[3] = { 0 };
            if (b < count) turn(&leap, &s->clusters.shape[body[b].species], &body[b], &m[b], spin);
            for (int c = 0; c < 3; c++) turned.spin[c][b] = spin[c];
        }
        for (size_t b = 0; b < count; b++) push(&leap, &s->clusters.shape[body[b].species], &body[b], &m[b]);
        orientations_advance(&turned, leap.dt);
        matrices_make(&turned);
        for (size_t b = 0; b < count; b++) {
            body[b].orientation = (quaternion){ turned.q[0][b], turned.q[1][b], turned.q[2][b], turned.q[3][b] };
            axes_of(&turned, b, m[b].after);
            largest = vector4_greater_size(largest, carry_spheres(&leap, s, &body[b], &m[b], picked_velocity));
        }
    }
    return largest;
}
