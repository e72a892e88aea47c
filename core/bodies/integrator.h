/* Leap-frog: positions and forces on the step, velocities at the half step (Eqns 1-4 of Walton & Braun 1993), and the
 * rotation of clusters (Eqns 5-23). */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include "leap_frog.h"

typedef struct body_forces {
    double gravity;                /* m/s2, along `up` */
    const double *up;              /* (3), unit vector against gravity */
    double period, inverse_period; /* m, 1/m along z; both 0 where the axis is not periodic */
    double drag;                   /* 1/s: velocities and spins decay at this rate; only while a bed is being made */
    double scale;                  /* share of full size that clusters have after the step */
} body_forces;

/* What the next step does to all; written where it differs alone, since all threads read it. */
void integrator_leap(leap_frog *leap, const spheres *spheres, const body_forces *body, double dt);
/* One step for all particles, under their spheres' loads, but for the first `moved` single spheres, which have taken theirs;
 * so_far: what spheres_advance returned of those. Returns a bound on |v - picked_velocity| of every sphere, m/s: from the
 * largest of each component. */
double integrator_advance(spheres *spheres, const half_row *picked_velocity, const leap_frog *leap, size_t moved, vector4 so_far,
                          int threads);

#endif
