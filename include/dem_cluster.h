/* Clusters: spheres joined for good. Their shapes by name, whether spheres make one body, and the body's volume, centre
 * and principal moments. A part of the rules (dem_rules.h). */
#ifndef DEM_CLUSTER_H
#define DEM_CLUSTER_H

#include "dem_rules.h"

typedef enum dem_shape { DEM_SPHERE, DEM_DUMBBELL, DEM_TETRAHEDRON, DEM_CUBE, DEM_NAMED_SHAPES } dem_shape;

/* The touching spheres of a named shape: none for a sphere, which is no cluster. */
void dem_cluster_of_shape(dem_cluster *cluster, dem_shape shape, double diameter);

/* r turned by w, x, y, z of a quaternion of any length but 0: r + 2 w (u x r) + 2 u x (u x r), u its vector part. */
void dem_turn(const double wxyz[4], const double r[3], double turned[3]);

/* Between centres, m. */
double dem_cluster_distance(const dem_cluster_sphere *a, const dem_cluster_sphere *b);

/* The first sphere that no chain of touching spheres joins to sphere 0; -1: all are one body. Positions are given in so
 * many digits: a gap below a millionth of the diameters is a touch. */
int dem_cluster_loose_sphere(const dem_cluster *cluster);

/* The first sphere that lies wholly within another, *in: it adds nothing (a sphere given twice, mostly). -1: none. */
int dem_cluster_hidden_sphere(const dem_cluster *cluster, int *in);

/* Volume, principal moments and reach of the spheres given; positions into the principal frame. */
void dem_cluster_complete(dem_cluster *cluster);

#endif
