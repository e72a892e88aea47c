/* One time step, as the paper has it. */
#ifndef STEP_H
#define STEP_H

#include "scene.h"

dem_status scene_step(dem_scene *scene);
/* Brings the neighbor lists up to the present places, as the next step would. */
dem_status scene_update_neighbors(dem_scene *scene);

#endif
