/* Bodies of several spheres: rigid clusters. Contacts know spheres alone; here is what joins them: each cluster's
 * place, orientation and motion, and where that puts its spheres. */
#ifndef CLUSTER_H
#define CLUSTER_H

#include "dem_types.h"
#include "quaternion.h"
#include "wide.h"

/* What all clusters of one species have in common. */
typedef struct cluster_shape {
    size_t sphere_count;
    double place[DEM_MAXIMUM_CLUSTER][3]; /* m, in the principal frame, at full size */
    double mass;                          /* kg */
    double inertia[3];                    /* kg m2, principal moments */
    double reach;                         /* m: radius of the sphere about the centre that holds the cluster */
    bool is_isotropic;                    /* three equal moments: turns as a sphere does */
} cluster_shape;

typedef struct cluster_body {
    double x[3];           /* m, centre of mass, z within one period */
    double spin[3];        /* rad/s at the half step; along the principal axes, isotropic: along those of space */
    double spin_change[3]; /* rad/s, of the last step: Eq 6 extrapolates with it */
    vector4 velocity;      /* m/s at the half step */
    quaternion orientation;
    int32_t species;
    int32_t first_sphere;
    int32_t id; /* of the particle that it is */
} cluster_body;

typedef struct clusters {
    size_t count, sphere_count;
    cluster_body *body;   /* (count) */
    int32_t *of_sphere;   /* (sphere_count) the body of each sphere, counted from the clusters' first */
    cluster_shape *shape; /* (species) */
    int corrector_passes; /* of Euler's equations, at least 1 */
} clusters;

dem_status clusters_init(clusters *clusters, const dem_scene_definition *definition, size_t count, size_t sphere_count);
void clusters_clear(clusters *clusters);

/* A sphere's place from the centre of its cluster, along the axes of space, m. */
static inline vector4 cluster_offset(const cluster_shape *shape, size_t sphere, double a[3][3], double scale)
{
    double r[3];
    to_space(a, shape->place[sphere], r);
    return (vector4){ scale * r[0], scale * r[1], scale * r[2] };
}

/* Angular velocity by Euler's equations in principal axes, from half step to half step, Eqns 5-10: predicted with the
 * last step's change, then corrected so many times (at least once; the order is two however often).
 * torque: N m, on the step. change: rad/s, of the last step; of this one afterwards. */
void euler_advance(double omega[3], double change[3], const double torque[3], const double inertia[3], double dt, int corrections);

double clusters_kinetic_energy(const clusters *clusters); /* J */

#endif
