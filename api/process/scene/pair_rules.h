/* From materials and pairs to what each contact of a scene is made of. */
#ifndef PAIR_RULES_H
#define PAIR_RULES_H

#include <math.h>

#include "job_spec.h"

#define MOST_OVERLAP 0.25 /* of the smallest diameter: beyond half a radius a run is stopped */

/* What stiffness is chosen for: the heaviest particle at the speed at which it meets the wall. */
typedef struct collision {
    double heaviest, lightest; /* kg; the lightest that a contact can move */
    double smallest, largest;  /* m, diameters of spheres, also those of clusters */
    double speed;              /* m/s */
    double fastest;            /* m/s, that or what two particles of the start can meet at: the step must do for it */
    double pull;               /* N, the largest that cohesion bears without pairs */
} collision;

/* Of two numbers, of which either may follow from what was refused: then it is not a number either. */
static inline double larger_of(double a, double b) { return isnan(a) || isnan(b) ? NAN : fmax(a, b); }
static inline double smaller_of(double a, double b) { return isnan(a) || isnan(b) ? NAN : fmin(a, b); }

/* One spelling of each material's members, and whether the names that particles and walls give are there. */
void materials_complete(scene_inputs *inputs, problem_list *problems);
/* kg/m3, of a species: its own, or its material's. */
double material_density(const scene_inputs *inputs, const species_inputs *species);

/* Each pair's contact, once `scene` has the contact of those that nothing is said of, and its time step; the step becomes the least
 * that any pair needs at DEM_STEPS_PER_CONTACT. overlap: the largest expected, as a share of the smallest diameter, without pairs;
 * becomes the same with them. Returns the number of steps that the contact which is over soonest usually takes; where others unload
 * faster, so many that these have theirs. */
double pairs_derive(const scene_inputs *inputs, const collision *worst, double *overlap, dem_scene_definition *scene,
                    problem_list *problems);

#endif
