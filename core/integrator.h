/* Leap-frog: positions and forces on the step, velocities at the half step (Eqns 1-4 of Walton & Braun 1993), and the
 * rotation of clusters (Eqns 5-23). */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include "neighbor_list.h"

typedef struct body_forces {
    double gravity; /* m/s2, against the container's `up` */
    double drag;    /* 1/s: velocities and spins decay at this rate; only while a bed is being made */
    double scale;   /* share of full size that clusters have after the step */
} body_forces;

/* One step for all particles, under the rows of forces that the list's contacts have written. Returns a bound on |v - v at
 * the pick| of every sphere, m/s: from the largest of each component. */
double integrator_advance(spheres *spheres, const neighbor_list *list, const container *drum, const body_forces *body, double dt,
                          int threads);

#endif
