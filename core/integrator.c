#include "integrator.h"

/* Eqns 3 and 4 for one sphere. A sphere's inertia is the same about every axis, so Euler's products (Eq 5) vanish
 * and its spin advances as its velocity does. */
static inline void sphere_advance(spheres *s, size_t i, const body_forces *body, double dt, double keep,
                                  double length, double inverse_length)
{
    double *v = s->velocity[i], *omega = s->angular_velocity[i];
    sphere_row *row = &s->row[i];
    const double dt_m = dt * s->inverse_mass[i], dt_i = dt * s->inverse_inertia[i];
    for (int c = 0; c < 3; c++) {
        v[c] = keep * v[c] + dt_m * s->force[i][c];
        omega[c] = keep * omega[c] + dt_i * s->torque[i][c];
    }
    v[1] -= dt * body->gravity;
    for (int c = 0; c < 3; c++) {
        row->x[c] += dt * v[c];
        row->v[c] = (real)v[c];
        row->omega[c] = (real)omega[c];
    }
    row->x[2] = wrap_axial(row->x[2], length, inverse_length);
}

double integrator_advance(spheres *s, const container *drum, const body_forces *body,
                          vector4 *picked_velocity, double dt, int threads)
{
    const double keep = 1.0 - body->drag * dt, inverse_length = 1.0 / drum->length;
    double largest2 = 0.0;
#pragma omp parallel for schedule(static) reduction(max : largest2) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < s->mobile_count; i++) {
        sphere_advance(s, i, body, dt, keep, drum->length, inverse_length);
        const double *v = s->velocity[i], *p = picked_velocity[i];
        const double d0 = v[0] - p[0], d1 = v[1] - p[1], d2 = v[2] - p[2];
        const double deviation2 = d0 * d0 + d1 * d1 + d2 * d2;
        largest2 = deviation2 > largest2 ? deviation2 : largest2;
    }
    return sqrt(largest2);
}
