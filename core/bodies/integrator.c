#include "integrator.h"

#include "leap_frog.h"

/* Eqns 3 and 4 for some spheres. A sphere's inertia is the same about every axis, so Euler's products (Eq 5) vanish and
 * its spin advances as its velocity does. */
WIDE_INLINE vector4 advance(const leap_frog *all, spheres *s, const half_row *picked_velocity, size_t from, size_t to,
                            bool of_one_kind)
{
    const leap_frog leap = *all; /* in registers, which no store to a sphere can change */
    enum { AHEAD = 32 };         /* what is sent for is needed after a block of contacts or two */
    const double *restrict inverse_mass = s->inverse_mass, *restrict inverse_inertia = s->inverse_inertia;
    const int32_t *restrict kinds = s->kind;
    vector4 *restrict velocity = s->velocity, *restrict spin = s->angular_velocity, *restrict place = s->place;
    sphere_row *restrict row = s->row;
    sphere_rest *restrict rest = s->rest;
    row8 *restrict load = s->load;
    const vector4 keep = vector4_all(leap.keep), dt = vector4_all(leap.dt), units = vector4_all(leap.ring_units);
    const bool many = s->are_many;
    vector4 largest = { 0 }, farthest = { 0 };
    for (size_t i = from; i < to; i++) {
        if (many) {
            __builtin_prefetch(&place[i + AHEAD], 1);
            __builtin_prefetch(&velocity[i + AHEAD], 1);
            __builtin_prefetch(&spin[i + AHEAD], 1);
            __builtin_prefetch(&picked_velocity[i + AHEAD]);
        }
        const int32_t kind = of_one_kind ? 0 : kinds[i];
        const vector4 per_mass = dt * vector4_from(&inverse_mass[kind]), per_inertia = dt * vector4_from(&inverse_inertia[kind]);
        const vector4 v = vector4_fused(per_mass, row8_force(&load[i]), vector4_fused(keep, velocity[i], -leap.gravity_dt));
        const vector4 omega = vector4_fused(per_inertia, row8_torque(&load[i]), keep * spin[i]);
        const vector4 astray = v - vector4_of(&picked_velocity[i]);
        load[i] = (row8){ 0 };
        velocity[i] = v;
        spin[i] = omega;
        const vector4 x = vector4_fused(dt, v, place[i]);
        place[i] = x;
        sphere_row_store(&row[i], &rest[i], x * units, v, omega);
        largest = vector4_greater_size(largest, astray);
        farthest = vector4_greater_size(farthest, x);
    }
    if (farthest[2] > leap.inside) /* few steps of few spheres: a comparison costs less than wrapping them all */
        for (size_t i = from; i < to; i++) place[i] = sphere_move(&leap, &row[i], &rest[i], place[i], velocity[i], spin[i]);
    return largest;
}

vector4 spheres_advance(const leap_frog *leap, spheres *s, const half_row *picked_velocity, size_t from, size_t to)
{
    return s->of_one_kind ? advance(leap, s, picked_velocity, from, to, true) : advance(leap, s, picked_velocity, from, to, false);
}

void integrator_leap(leap_frog *leap, const spheres *s, const body_forces *body, double dt)
{
    const double g_dt = body->gravity * dt, *up = body->up;
    leap_frog now;
    memset(&now, 0, sizeof now); /* what lies between the numbers, too */
    now.gravity_dt = (vector4){ up[0] * g_dt, up[1] * g_dt, up[2] * g_dt };
    now.period = (vector4){ 0.0, 0.0, body->period };
    now.inverse_period = (vector4){ 0.0, 0.0, body->inverse_period };
    now.inside = body->period > 0 ? 0.499999 * body->period : INFINITY;
    now.ring_units = s->ring_units;
    now.dt = dt;
    now.keep = 1.0 - body->drag * dt;
    now.scale_now = s->scale;
    now.scale_next = body->scale;
    now.corrector_passes = s->clusters.corrector_passes;
    if (memcmp(leap, &now, sizeof now) != 0) memcpy(leap, &now, sizeof now);
}

typedef struct motion_work {
    spheres *spheres;
    const half_row *picked_velocity;
    const leap_frog *leap;
    size_t moved;
    vector4 largest[MOST_PARTS]; /* of each part, as spheres_advance returns it */
} motion_work;

static void motion_of_part(void *context, int part, int parts)
{
    motion_work *const work = context;
    spheres *const s = work->spheres;
    const size_t count = s->single_count - work->moved, bodies = s->clusters.count;
    const vector4 of_spheres = spheres_advance(work->leap, s, work->picked_velocity, work->moved + part_start(count, part, parts),
                                               work->moved + part_start(count, part + 1, parts));
    const vector4 of_clusters = clusters_advance(work->leap, s, work->picked_velocity, part_start(bodies, part, parts),
                                                 part_start(bodies, part + 1, parts));
    work->largest[part] = vector4_greater_size(of_spheres, of_clusters);
}

double integrator_advance(spheres *s, const half_row *picked_velocity, const leap_frog *leap, size_t moved, vector4 so_far,
                          int threads)
{
    const int parts = team_parts(threads);
    motion_work work = { .spheres = s, .picked_velocity = picked_velocity, .leap = leap, .moved = moved };
    if (s->single_count - moved + s->clusters.count > 0) {
        s->copies_hold = false;
        team_run(parts, motion_of_part, &work);
        for (int part = 0; part < parts; part++) so_far = vector4_greater_size(so_far, work.largest[part]);
    }
    return sqrt(so_far[0] * so_far[0] + so_far[1] * so_far[1] + so_far[2] * so_far[2]);
}
