/* Time steps: dem_scene_advance and dem_scene_advance_to_run of dem.h. step.c opens with the algorithm. */
#ifndef STEP_H
#define STEP_H

#include "scene.h"

/* Brings the neighbor lists up to the present places, as the next step would. Errors: DEM_NO_MEMORY; where it is time to
 * look at every sphere, DEM_NOT_A_NUMBER and DEM_PARTICLE_ESCAPED. The failure is described in the scene. */
dem_status scene_update_neighbors(dem_scene *scene);

#endif
