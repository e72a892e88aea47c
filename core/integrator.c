#include "integrator.h"

/* What one step does to every sphere alike. */
typedef struct leap_frog {
    vector4 gravity_dt, period, inverse_period; /* the last two along z alone */
    double dt, keep;
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

double integrator_advance(spheres *s, const container *drum, const body_forces *body,
                          const vector4 *picked_velocity, double dt, int threads)
{
    const leap_frog leap = { .gravity_dt = { 0.0, body->gravity * dt }, .period = { 0.0, 0.0, drum->length },
                        .inverse_period = { 0.0, 0.0, 1.0 / drum->length }, .dt = dt, .keep = 1.0 - body->drag * dt };
    const row8 *restrict load = s->load;
    const double *restrict inverse_mass = s->inverse_mass, *restrict inverse_inertia = s->inverse_inertia;
    vector4 *restrict velocity = s->velocity, *restrict spin = s->angular_velocity;
    sphere_row *restrict row = s->row;
    const size_t count = s->mobile_count;
    double largest_x = 0.0, largest_y = 0.0, largest_z = 0.0;
#pragma omp parallel for schedule(static) reduction(max : largest_x, largest_y, largest_z) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < count; i++) {
        sphere_advance(&leap, &load[i], inverse_mass[i], inverse_inertia[i], &velocity[i], &spin[i], &row[i]);
        const vector4 d = velocity[i] - picked_velocity[i], d2 = d * d;
        largest_x = largest_of(largest_x, d2[0]);
        largest_y = largest_of(largest_y, d2[1]);
        largest_z = largest_of(largest_z, d2[2]);
    }
    return sqrt(largest_x + largest_y + largest_z);
}
