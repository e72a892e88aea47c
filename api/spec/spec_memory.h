/* What was costly in the specs read before, for the many of one study that have it in common: a bed placed particle by
 * particle, the check of its overlaps, and the moments of clusters. What is remembered is only used where everything it
 * came from is the same, so a spec is read to the same numbers with it as without. */
#ifndef SPEC_MEMORY_H
#define SPEC_MEMORY_H

#include <jansson.h>

#include "job_spec.h"

enum { REMEMBERED_CLUSTERS = 2 * DEM_MAXIMUM_SPECIES };

typedef struct spec_memory {
    json_t *placed_list; /* the very list that was read without a problem; owned reference; NULL: none */
    start_particle *placed;
    size_t placed_count;
    bool placed_apart; /* its particles do not overlap, with such a period and species; */
    double placed_period;
    double placed_diameter, placed_length; /* and are inside of such a drum */
    size_t placed_species_count;
    dem_species placed_species[DEM_MAXIMUM_SPECIES];

    json_t *origin; /* what made the bed of that job, owned; NULL: none was looked up */
    char origin_job[28];
    double origin_snapshot, origin_particles; /* snapshot NaN: its checkpoint */

    json_t *list; /* of particles that stood elsewhere, under this name; both owned, NULL: none */
    char *list_name;

    size_t clusters; /* how many were kept in all; the latest of them are there */
    dem_cluster cluster_asked[REMEMBERED_CLUSTERS], cluster_derived[REMEMBERED_CLUSTERS];
} spec_memory;

spec_memory *spec_memory_create(void); /* NULL: no memory, and then each spec is read by itself */
void spec_memory_free(spec_memory *memory);

/* The inputs without start/particles, where that is the list remembered: new reference. NULL: it is not. */
json_t *spec_memory_without_placed(const spec_memory *memory, const json_t *inputs);
/* A copy of the particles remembered. False: no memory. */
bool spec_memory_place(const spec_memory *memory, start_inputs *start);
/* Remembers the list that these particles were read from. */
void spec_memory_keep_placed(spec_memory *memory, const json_t *inputs, const start_inputs *start);

/* Whether the particles remembered, which these are, were found apart among such species, and inside of such a drum, too.
 * NULL remembers nothing. */
bool spec_memory_knows_apart(const spec_memory *memory, const start_inputs *start, const dem_scene_definition *drum);
bool spec_memory_knows_inside(const spec_memory *memory, const start_inputs *start, const dem_scene_definition *drum);
/* They are both. */
void spec_memory_keep_sound(spec_memory *memory, const start_inputs *start, const dem_scene_definition *drum);

/* The spec that made the bed of a job, and its number of particles. New reference; NULL: another bed, or memory is NULL. */
json_t *spec_memory_find_bed(const spec_memory *memory, const start_inputs *start, double *particles);
void spec_memory_keep_bed(spec_memory *memory, const start_inputs *start, json_t *origin, double particles);

/* The list of particles that stood elsewhere under the name. New reference; NULL: another one, or memory is NULL. */
json_t *spec_memory_find_list(const spec_memory *memory, const char *name);
void spec_memory_keep_list(spec_memory *memory, const char *name, json_t *list);

/* asked: the spheres as given. False: never derived, or memory is NULL. */
bool spec_memory_find_cluster(const spec_memory *memory, const dem_cluster *asked, dem_cluster *derived);
void spec_memory_keep_cluster(spec_memory *memory, const dem_cluster *asked, const dem_cluster *derived);

#endif
