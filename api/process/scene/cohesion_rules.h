/* From what is said of cohesion to what a scene's contacts are pulled by. */
#ifndef COHESION_RULES_H
#define COHESION_RULES_H

#include "pair_rules.h"

/* What one `cohesion` says, once the scene has its species and gravity; none where it is not given. */
dem_cohesion cohesion_of(const cohesion_inputs *inputs, const dem_scene_definition *scene);
/* Checks all of them; sets the law, and what contact and wall say. Returns the largest pull that a contact of theirs bears, N. */
double cohesion_derive(const scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems);
/* K1 (N/m) and E* (Pa) with which the pull makes half of that overlap, a share of the smallest diameter; 0 without a pull. */
double cohesion_stiffness(const collision *worst, double overlap);
double cohesion_modulus(const collision *worst, double overlap);
/* Once pairs are derived: a time step short enough, and gaps that are not too wide. overlap: as pairs_derive returns it. Returns it
 * with that of the pull. */
double cohesion_complete(const scene_inputs *inputs, const collision *worst, double overlap, dem_scene_definition *scene,
                         problem_list *problems);
/* The largest pull-off over the weight of the mean particle; 0 without cohesion. */
double cohesion_bond_number(const dem_scene_definition *scene);

#endif
