/* What rests on the ground, directly or on others: a bed as against what still falls onto it. */
#ifndef GROUNDED_H
#define GROUNDED_H

#include "scene.h"

/* is_grounded: (particles) true for those that a chain of spheres, each less than a tenth of a grain from the next, joins to
 * the floor at z = 0. A bed that is shaken has few contacts at any moment, but no wider gaps; in a stream below a tenth of
 * solid a sphere has less than one such neighbor on average, so chains through it end.
 * grain: m, mean diameter. Errors: DEM_NO_MEMORY. */
dem_status grounded_find(const dem_scene *scene, double grain, bool *is_grounded);

#endif
