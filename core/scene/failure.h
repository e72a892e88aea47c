/* Numerical failure: found, and described with what, where, when and a likely cause. */
#ifndef FAILURE_H
#define FAILURE_H

#include "scene.h"

/* An overlap beyond this share of the smaller radius is no contact any more. */
#define FAILURE_OVERLAP 0.5
/* m: an overlap that is not larger is no failure, whatever spheres have it. */
static inline double failure_least_overlap(const dem_scene *scene)
{
    return FAILURE_OVERLAP * 0.5 * scene->spheres.smallest_diameter;
}

dem_status failure_check_places(dem_scene *scene); /* DEM_NOT_A_NUMBER, DEM_PARTICLE_ESCAPED */
/* Looks for overlaps beyond the limit at the places that the forces were computed at. since: s, by which single spheres have
 * moved on since then. Errors: those of failure_check_places, DEM_OVERLAP_TOO_LARGE. */
dem_status failure_check_overlaps(dem_scene *scene, double since);
dem_status failure_of_settling(dem_scene *scene, double energy);
dem_status failure_of_memory(dem_scene *scene);

#endif
