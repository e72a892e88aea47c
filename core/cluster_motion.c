#include "leap_frog.h"

/* A cluster's step is one long chain of dependent operations. Taken apart into passes over some clusters, the processor
 * works on several of them at a time. */
enum { SOME = 16 };

/* One cluster between the passes. */
typedef struct motion {
    vector4 before[3], after[3]; /* the rows of A (Eq 11): the body's axes along those of space, before and after the step */
    vector4 force, torque;       /* N, N m about the centre, along the axes of space */
    vector4 velocity, omega;     /* m/s, rad/s at the next half step, along the axes of space */
    double spin[3];              /* rad/s, along the axes of the body */
    vector4 place;               /* m */
} motion;

static void axes_of(quaternion q, vector4 axis[3])
{
    double a[3][3];
    quaternion_matrix(q, a);
    for (int k = 0; k < 3; k++) axis[k] = (vector4){ a[k][0], a[k][1], a[k][2] };
}

/* A vector along the body's axes, turned into those of space. */
WIDE_INLINE vector4 along_space(const vector4 axis[3], const double x[3])
{
    return vector4_fused(vector4_all(x[2]), axis[2], vector4_fused(vector4_all(x[1]), axis[1], vector4_all(x[0]) * axis[0]));
}

WIDE_INLINE vector4 cross_product(vector4 a, vector4 b)
{
    typedef int64_t order __attribute__((vector_size(32)));
    const order next = { 1, 2, 0, 3 };
    const vector4 turned = a * __builtin_shuffle(b, next) - __builtin_shuffle(a, next) * b;
    return __builtin_shuffle(turned, next);
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
    axes_of(body->orientation, m->before);
    m->force = m->torque = (vector4){ 0 };
    for (size_t k = 0; k < shape->sphere_count; k++) {
        row8 *load = &s->load[(size_t)body->first_sphere + k];
        const vector4 f = vector4_low(load), r = leap->scale_now * along_space(m->before, shape->place[k]);
        m->force += f;
        m->torque += vector4_high(load);
        m->torque += cross_product(r, f);
        *load = (row8){ 0 };
    }
}

/* The spin at the next half step, along the axes of space and of the body. */
static void turn(const leap_frog *leap, const cluster_shape *shape, cluster_body *body, motion *m)
{
    if (shape->is_isotropic) { /* Euler's products vanish; no need to turn back and forth */
        const vector4 spin = { body->spin[0], body->spin[1], body->spin[2] };
        m->omega = vector4_fused(vector4_all(leap->dt * (1.0 / shape->inertia[0])), m->torque, vector4_all(leap->keep) * spin);
        for (int c = 0; c < 3; c++) {
            body->spin[c] = m->omega[c];
            m->spin[c] = scalar_product(m->before[c], m->omega);
        }
        return;
    }
    double torque[3];
    for (int c = 0; c < 3; c++) {
        torque[c] = scalar_product(m->before[c], m->torque);
        body->spin[c] *= leap->keep;
    }
    euler_advance(body->spin, body->spin_change, torque, shape->inertia, leap->dt, leap->corrector_passes);
    memcpy(m->spin, body->spin, sizeof body->spin);
    m->omega = along_space(m->before, m->spin);
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
                             const vector4 *picked_velocity)
{
    const cluster_shape *shape = &s->clusters.shape[body->species];
    const size_t first = (size_t)body->first_sphere;
    const vector4 per_dt = vector4_all(1 / leap->dt);
    vector4 largest = { 0 };
    for (size_t k = 0; k < shape->sphere_count; k++) {
        const vector4 r_before = leap->scale_now * along_space(m->before, shape->place[k]);
        const vector4 r = leap->scale_next * along_space(m->after, shape->place[k]);
        const vector4 v = vector4_fused(r - r_before, per_dt, m->velocity), astray = v - picked_velocity[first + k];
        s->velocity[first + k] = v;
        s->angular_velocity[first + k] = m->omega;
        s->place[first + k] = sphere_move(leap, &s->row[first + k], m->place + r, v, m->omega);
        largest = vector4_greater(largest, astray * astray);
    }
    return largest;
}

vector4 clusters_advance(const leap_frog *leap, spheres *s, const vector4 *picked_velocity, size_t from, size_t to)
{
    motion m[SOME];
    vector4 largest = { 0 };
    for (size_t begin = from; begin < to; begin += SOME) {
        cluster_body *body = &s->clusters.body[begin];
        const size_t count = begin + SOME < to ? SOME : to - begin;
        for (size_t b = 0; b < count; b++) collect(leap, s, &body[b], &m[b]);
        for (size_t b = 0; b < count; b++) turn(leap, &s->clusters.shape[body[b].species], &body[b], &m[b]);
        for (size_t b = 0; b < count; b++) push(leap, &s->clusters.shape[body[b].species], &body[b], &m[b]);
        for (size_t b = 0; b < count; b++) body[b].orientation = quaternion_advance(body[b].orientation, m[b].spin, leap->dt);
        for (size_t b = 0; b < count; b++) axes_of(body[b].orientation, m[b].after);
        for (size_t b = 0; b < count; b++)
            largest = vector4_greater(largest, carry_spheres(leap, s, &body[b], &m[b], picked_velocity));
    }
    return largest;
}
