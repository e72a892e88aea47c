#include "integrator.h"

#include "contact_forces.h"
#include "leap_frog.h"

static inline double largest_of(double a, double b) { return a > b ? a : b; }

/* Eqns 3 and 4 for some spheres. A sphere's inertia is the same about every axis, so Euler's products (Eq 5) vanish and
 * its spin advances as its velocity does. Returns the largest of each component of (v - picked_velocity)^2. */
static vector4 some_spheres_advance(const leap_frog *leap, spheres *s, const row8 *restrict load, const vector4 *picked_velocity,
                                    size_t from, size_t to)
{
    const double *restrict inverse_mass = s->inverse_mass, *restrict inverse_inertia = s->inverse_inertia;
    vector4 *restrict velocity = s->velocity, *restrict spin = s->angular_velocity, *restrict place = s->place;
    sphere_row *restrict row = s->row;
    const vector4 keep = vector4_all(leap->keep), dt = vector4_all(leap->dt);
    vector4 largest = { 0 };
    for (size_t i = from; i < to; i++) {
        const vector4 per_mass = vector4_all(leap->dt * inverse_mass[i]), per_inertia = vector4_all(leap->dt * inverse_inertia[i]);
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
                             .scale_now = s->scale,
                             .scale_next = body->scale,
                             .corrector_passes = s->clusters.corrector_passes };
    const size_t count = s->single_count, bodies = s->clusters.count;
    if (bodies > 0) contact_forces_sum(list, s, count, threads);
    double x = 0.0, y = 0.0, z = 0.0;
#pragma omp parallel for schedule(static) reduction(max : x, y, z) num_threads(threads) if (threads > 1)
    for (int part = 0; part < threads; part++) {
        const vector4 of_spheres =
            spheres_advance(&leap, s, list, part_start(count, part, threads), part_start(count, part + 1, threads));
        const vector4 of_clusters = clusters_advance(&leap, s, list->picked_velocity, part_start(bodies, part, threads),
                                                     part_start(bodies, part + 1, threads));
        const vector4 largest = vector4_greater(of_spheres, of_clusters);
        x = largest_of(x, largest[0]);
        y = largest_of(y, largest[1]);
        z = largest_of(z, largest[2]);
    }
    return sqrt(x + y + z);
}
