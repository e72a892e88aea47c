/* Spheres of one species that are not all alike: which size each has. */
#ifndef SIZING_H
#define SIZING_H

#include "scene.h"

/* What follows from the radii: the extremes, and, of one species with sizes, the thirds. Errors: DEM_NO_MEMORY. */
dem_status sizing_complete(spheres *spheres, const dem_scene_definition *definition);
/* Draws the sizes of all species that have some, in an order that the seed gives, once each sphere has its species. Errors:
 * DEM_NO_MEMORY. */
dem_status sizing_draw(spheres *spheres, const dem_scene_definition *definition);
/* Radii of the mobile spheres, m, in their order in memory. False: one is not among those that its species can have. */
bool sizing_fits(const spheres *spheres, const dem_scene_definition *definition, const double *radius);
/* Takes them. Errors: DEM_NO_MEMORY. */
dem_status sizing_restore(dem_scene *scene, const double *radius);
/* The particles from the largest to the smallest, those alike in order. Freed by the caller; NULL: no memory. */
int32_t *sizing_order(const spheres *spheres);

#endif
