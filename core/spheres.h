/* The spheres of a scene: mobile ones first (index = id), then the lining's, then one null sphere far away that
 * fills up the last block of a list. */
#ifndef SPHERES_H
#define SPHERES_H

#include "dem_types.h"
#include "real.h"

/* What a contact reads of a sphere, in one or two cache lines. */
typedef struct sphere_row {
    double x[3];              /* m */
    double exact_radius;      /* m, now (smaller while growing) */
    real v[3];                /* m/s, half a step behind x */
    real omega[3];            /* rad/s, likewise */
    real radius;              /* the same, rounded */
} __attribute__((aligned(64))) sphere_row;

static inline void sphere_row_set_radius(sphere_row *row, double radius)
{
    row->exact_radius = radius;
    row->radius = (real)radius;
}

typedef double vector4[4]; /* x, y, z and one unused: a vector is one aligned load */

typedef struct spheres {
    size_t mobile_count, lining_count;
    sphere_row *row;           /* (mobile + lining + 1) */
    int32_t *species;          /* (mobile) */
    double *full_radius;       /* (mobile + lining + 1) m */
    vector4 *velocity;         /* (mobile) m/s at the half step */
    vector4 *angular_velocity; /* (mobile) rad/s at the half step */
    vector4 *force;            /* (mobile) N, contacts only */
    vector4 *torque;           /* (mobile) N m about the centre */
    double *inverse_mass;      /* (mobile) 1/kg */
    double *inverse_inertia;   /* (mobile) 1/(kg m2) */
    double *fallen_time;       /* (mobile) s since rotation began when last seen nearer the axis than R_i - 2d */
    vector4 *lining_place;     /* (lining) m, when the drum has not turned */
    double smallest_diameter, largest_diameter; /* m, mobile */
} spheres;

dem_status spheres_init(spheres *spheres, const dem_drum_definition *definition, size_t lining_count);
void spheres_clear(spheres *spheres);
size_t spheres_count(const spheres *spheres); /* mobile and lining */
/* Radii of the mobile spheres at `scale` of their full size, in the rows. */
void spheres_set_scale(spheres *spheres, double scale);
double spheres_kinetic_energy(const spheres *spheres); /* J */

#endif
