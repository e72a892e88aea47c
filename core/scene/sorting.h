/* Particles in memory in the order of their places, so that spheres that touch are near each other there, too: from some
 * thousands on, what a contact reads and writes otherwise comes from slow memory. A particle keeps its id (spheres.h);
 * everything inside the core goes by the place in memory.
 *
 * The order changes the sums over a sphere's contacts in their last bits. It therefore follows from the run alone, not
 * from when neighbor lists are made: it is made anew at given steps of a phase, and saved with the state. */
#ifndef SORTING_H
#define SORTING_H

#include "scene.h"

/* Steps that can be taken until the next time, after sorting_look. */
int64_t sorting_steps_left(const dem_scene *scene);
/* Sorts when it is due; contacts keep what they remember, and lists are made again. Errors: DEM_NO_MEMORY. */
dem_status sorting_look(dem_scene *scene);
/* Particles into another order, in memory: order (particles): where each was; spheres before clusters, as always. The
 * neighbor lists know nothing of it. Errors: DEM_NO_MEMORY, and nothing has changed. */
dem_status sorting_apply(spheres *spheres, const int32_t *order, int32_t *sphere_order);

#endif
