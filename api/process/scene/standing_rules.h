/* Rules that the upright containers share: the cylinder that is filled, the tube that is raised, the vessel with an orifice. */
#ifndef STANDING_RULES_H
#define STANDING_RULES_H

#include "calibration.h"
#include "scene_rules.h"

/* A scene with everything that does not depend on the container: gravity, species, seed. */
void standing_derive_scene(scene_inputs *inputs, dem_scene_definition *scene, uint64_t seed_if_missing, problem_list *problems);

/* Particles from fill_height, which becomes usual_height where neither is given, or particle_count. The scene's diameter
 * and species must be derived. least: particles below which there is nothing to measure. */
void standing_derive_count(scene_inputs *inputs, dem_scene_definition *scene, double usual_height, double least,
                           problem_list *problems);
/* m2: of the cross-section; of a vessel above its hopper. */
double standing_area(const dem_scene_definition *scene);
/* m: of the bed that so many particles make at a solid fraction of 0.6. */
double standing_bed_height(const dem_scene_definition *scene);

/* What goes by the duration, which must be set: intervals, threads, amounts. duration: pointer to the input that bounds it. */
void standing_complete(job_spec *spec, const char *duration, problem_list *problems);

/* Cost of so many seconds with so many of the particles inside, on average; before: s that the bed takes to make itself. */
job_estimate standing_estimate(const job_spec *spec, const calibration *machine, double seconds, double before,
                               double share_inside);

#endif
