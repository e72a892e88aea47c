/* A stream of particles that fills a standing cylinder: they enter one after the other, at even times, at random free
 * places of the inlet, which rises with the bed.
 *
 * Who has not entered yet costs nothing: particles are numbered in the order in which they enter, and the counts of
 * spheres and clusters are those of the ones inside. What enters where follows from the seed, the particle and the step
 * alone, so there is nothing to save but how many are in. */
#ifndef STREAM_H
#define STREAM_H

#include "scene.h"

static inline bool has_stream(const dem_scene_definition *definition) { return definition->stream.rate > 0; }

/* Where spheres and clusters are mixed, the spheres become clusters of one: the order then is one for all. */
void stream_complete_species(dem_scene_definition *definition);
/* Species in the stream in proportion, in random order. Errors: DEM_NO_MEMORY. */
dem_status stream_init(dem_scene *scene);
/* All are outside but the first, and the test begins. */
void stream_begin(dem_scene *scene);
/* After a step: whoever is due enters, if the inlet has room. */
void stream_enter(dem_scene *scene);
/* As many inside as have so many spheres. Errors: DEM_STATE_MISMATCH. */
dem_status stream_restore(dem_scene *scene, size_t sphere_count);

#endif
