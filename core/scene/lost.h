/* Particles that fell off the plate, or through the orifice of a vessel. They are out of the test: laid out on a tray far below, each in a place of its own,
 * and held there, so that they touch nothing and nothing waits for their fall to end. */
#ifndef LOST_H
#define LOST_H

#include "scene.h"

/* Only a tube on a plate and a vessel lose particles. Errors: DEM_NO_MEMORY. */
dem_status lost_init(dem_scene *scene);
void lost_clear(dem_scene *scene);
/* Lays particles on the tray that fell below the plate, or tipped over its edge so far that one of their spheres is beneath it; of a
 * vessel those that are through the orifice, and touch neither its edge nor what is inside.
 * It looks for them every so many steps, counted from the run's first, so that a run in pieces loses the same ones. */
void lost_look(dem_scene *scene);
/* Whether sphere i is below the plate without having tipped over the edge, which means that it was too fast for the time step: a
 * sphere that comes around the edge, or sinks in so slowly that an overlap of half a radius is noticed, moves by less than its
 * radius in a step. */
bool lost_came_through_plate(const dem_scene *scene, size_t i);
/* The same of a vessel's floor or hopper. */
bool lost_came_through_floor(const dem_scene *scene, size_t i);
/* After each step: puts lost particles back to their places on the tray, at rest. Those of a vessel are most of all in the end: they
 * are put back when lost_look looks, and fall by less than their own size meanwhile. */
void lost_hold(dem_scene *scene);
/* After places were restored: marks the particles that lie on the tray as lost. */
void lost_recognize(dem_scene *scene);

#endif
