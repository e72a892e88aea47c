/* Particles that fell off the plate. They are out of the test: laid out on a tray far below, each in a place of its own,
 * and held there, so that they touch nothing and nothing waits for their fall to end. */
#ifndef LOST_H
#define LOST_H

#include "scene.h"

/* Only a tube on a plate loses particles. Errors: DEM_NO_MEMORY. */
dem_status lost_init(dem_scene *scene);
void lost_clear(dem_scene *scene);
/* Lays particles on the tray that fell below the plate, or tipped over its edge so far that one of their spheres is beneath it.
 * It looks for them every so many steps, counted from the run's first, so that a run in pieces loses the same ones. */
void lost_look(dem_scene *scene);
/* Whether sphere i is below the plate without having tipped over the edge, which means that it was too fast for the time step: a
 * sphere that comes around the edge, or sinks in so slowly that an overlap of half a radius is noticed, moves by less than its
 * radius in a step. */
bool lost_came_through_plate(const dem_scene *scene, size_t i);
/* After each step: puts lost particles back to their places on the tray, at rest. */
void lost_hold(dem_scene *scene);
/* After places were restored: marks the particles that lie on the tray as lost. */
void lost_recognize(dem_scene *scene);

#endif
