/* Particles that fell off the plate. They are out of the test: laid out on a tray far below, each in a place of its own,
 * and held there, so that they touch nothing and nothing waits for their fall to end. */
#ifndef LOST_H
#define LOST_H

#include "scene.h"

/* Only a tube on a plate loses particles. Errors: DEM_NO_MEMORY. */
dem_status lost_init(dem_scene *scene);
void lost_clear(dem_scene *scene);
/* Looks for particles that fell below the plate, or tipped over its edge so far that one of their spheres is beneath it, every so many steps: when does not depend on how a run is divided. */
void lost_look(dem_scene *scene);
/* A sphere below the plate that did not tip over its edge. Who comes around the edge, or sinks in so slowly that an overlap
 * of half a radius tells of it, moves by less than its radius in a step. */
bool lost_came_through_plate(const dem_scene *scene, size_t i);
/* After each step: back to their places, at rest. */
void lost_hold(dem_scene *scene);
/* After places were restored: who lies on the tray was lost. */
void lost_recognize(dem_scene *scene);

#endif
