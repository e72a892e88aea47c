/* Starting from a bed that was made before: which it is, and whether it belongs to the drum and the particles asked for. */
#ifndef START_RULES_H
#define START_RULES_H

#include "job_spec.h"

/* Looks at the start alone, and looks up the bed where the spec is parsed with a source of beds. New reference to the spec
 * that made it; NULL: none needed, none known, or a problem says why. Where the number of particles is not asked for, it
 * becomes the bed's. */
json_t *start_find(job_spec *spec, problem_list *problems);
/* Shares and number of the particles that are given one by one. False: they are not. */
bool start_count_particles(scene_inputs *inputs, dem_scene_definition *drum, problem_list *problems);
/* The drum complete: each particle in it, none too far within another. */
void start_check_particles(const scene_inputs *inputs, const dem_scene_definition *drum, problem_list *problems);
/* The same container and particles as the bed's own spec has. origin: of start_find; NULL: nothing to hold it against. */
void start_compare(const job_spec *spec, const json_t *origin, problem_list *problems);

/* Whether a drum turns first with a rate below 0. */
bool turns_back(const scene_inputs *inputs);

#endif
