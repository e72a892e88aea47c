/* The spheres of a scene: mobile ones first (index = id), then the lining's, then two that no list names but in its
 * padding: one of zeros at the origin, one of zeros far away. */
#ifndef SPHERES_H
#define SPHERES_H

#include "dem_types.h"
#include "wide.h"

/* What a contact reads of a sphere: one cache line in single precision. wide.h reads rows by this order. */
typedef struct sphere_row {
    double x[3];      /* m */
    real radius;      /* m, now (smaller while growing) */
    real v[3];        /* m/s, half a step behind x */
    real r_omega[3];  /* m/s: radius times spin */
    real omega[3];    /* rad/s, half a step behind x */
} __attribute__((aligned(64))) sphere_row;

/* Place, velocity and spin of a step, in four stores; the radius stays. */
static inline void sphere_row_store(sphere_row *row, vector4 x, vector4 v, vector4 omega)
{
    const half_row w = half_row_of(omega);
    half_row front, middle;
    half_row_weave(row->radius, half_row_of(v), row->radius * w, w, &front, &middle);
    memcpy(row->x, &x, sizeof x);                       /* runs over the radius, which the next store mends */
    memcpy(&row->radius, &front, sizeof front);         /* radius, v */
    memcpy(&row->r_omega, &middle, sizeof middle);      /* R omega, first of omega */
    row->omega[1] = w[1];
    row->omega[2] = w[2];
}

typedef struct spheres {
    size_t mobile_count, lining_count;
    sphere_row *row;           /* (mobile + lining + 2) */
    int32_t *species;          /* (mobile) */
    double *full_radius;       /* (mobile + lining) m, rounded to real */
    vector4 *velocity;         /* (mobile) m/s at the half step */
    vector4 *angular_velocity; /* (mobile) rad/s at the half step */
    row8 *load;                /* (mobile) force N, 0, torque N m about the centre, 0: contacts only */
    double *inverse_mass;      /* (mobile) 1/kg */
    double *inverse_inertia;   /* (mobile) 1/(kg m2) */
    double *fallen_time;       /* (mobile) s since rotation began when last seen nearer the axis than R_i - 2d */
    vector4 *lining_place;     /* (lining) m, when the drum has not turned */
    double smallest_diameter, largest_diameter; /* m, mobile */
    double scale;              /* share of full size that the mobile spheres have now */
} spheres;

dem_status spheres_init(spheres *spheres, const dem_drum_definition *definition, size_t lining_count);
void spheres_clear(spheres *spheres);
size_t spheres_count(const spheres *spheres); /* mobile and lining */
static inline int32_t sphere_of_zeros(const spheres *s) { return (int32_t)(s->mobile_count + s->lining_count); }
static inline int32_t sphere_far_away(const spheres *s) { return sphere_of_zeros(s) + 1; }
/* Radii of the mobile spheres at `scale` of their full size, in the rows. */
void spheres_set_scale(spheres *spheres, double scale);
double spheres_kinetic_energy(const spheres *spheres); /* J */

#endif
