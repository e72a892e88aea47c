/* Time steps, as the paper has them: dem_scene_advance. */
#ifndef STEP_H
#define STEP_H

#include "scene.h"

/* Brings the neighbor lists up to the present places, as the next step would. */
dem_status scene_update_neighbors(dem_scene *scene);

#endif
