/* What one step does to every particle alike, and what single spheres and the spheres of clusters share of it. */
#ifndef LEAP_FROG_H
#define LEAP_FROG_H

#include "spheres.h"
#include "team.h"

typedef struct leap_frog {
    vector4 gravity_dt;
    vector4 period, inverse_period; /* along z alone */
    double inside;                  /* m: nearer than this to z = 0, half a period is not passed; infinite where there is none */
    double ring_units;              /* 1/m */
    double dt, keep;
    double scale_now, scale_next; /* share of full size that clusters have */
    int corrector_passes;
} leap_frog;

WIDE_INLINE vector4 vector4_all(double x) { return x - (vector4){ 0 }; }

/* x within one period, and into the row and the rest. */
WIDE_INLINE vector4 sphere_move(const leap_frog *leap, sphere_row *row, sphere_rest *rest, vector4 x, vector4 v, vector4 omega)
{
    x -= leap->period * vector4_rint(x * leap->inverse_period);
    sphere_row_store(row, rest, x * vector4_all(leap->ring_units), v, omega);
    return x;
}

/* Eqns 3 and 4 for the single spheres from..to-1, which leaves their loads zeros. Returns the largest of each component of
 * v - picked_velocity, by size. */
vector4 spheres_advance(const leap_frog *leap, spheres *spheres, const half_row *picked_velocity, size_t from, size_t to);
/* Eqns 3-23 for the clusters from..to-1 and their spheres; likewise. */
vector4 clusters_advance(const leap_frog *leap, spheres *spheres, const half_row *picked_velocity, size_t from, size_t to);

#endif
