/* Rules that all processes share which advance a scene of particles. Each lists what is wrong with its part. */
#ifndef SCENE_RULES_H
#define SCENE_RULES_H

#include "job_spec.h"
#include "spec_memory.h"

#define SCENE_MOST_PARTICLES 5e6
#define SCENE_MOST_SIZE_RATIO 20.0
/* Results need 8 frames; one frame's angle has an error of a degree or more, so a run of any length gets at least so
 * many, and 20 a second. */
#define SCENE_SAMPLES_PER_RUN 64.0
#define SCENE_SAMPLE_INTERVAL_MOST 0.05 /* s */

/* The largest or smallest of a number over the species; NaN where all are. */
double scene_of_species(const dem_scene_definition *scene, double (*number)(const dem_species *), bool largest);
double scene_species_width(const dem_species *species); /* m, diameter of the sphere that holds a particle */

/* Shares that were left out. */
void scene_share_out(scene_inputs *inputs, problem_list *problems);
/* The cluster of a species, complete, but for a sphere; of not-a-number where the spheres were refused or make no cluster.
 * Fills in the diameters of spheres that have none. memory: NULL, or of clusters derived before. */
void scene_cluster_derive(spec_memory *memory, species_inputs *inputs, size_t species, dem_cluster *cluster,
                          problem_list *problems);
/* Spheres that a particle has in the mean over the species. */
double scene_spheres_a_particle(const dem_scene_definition *scene);
/* Species, with their clusters; shares must be out. */
void scene_derive_species(scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems);
/* A species asked for has at least one of so many particles. */
void scene_check_every_species(const scene_inputs *inputs, const dem_scene_definition *scene, double count, problem_list *problems);
void scene_check_size_ratio(const dem_scene_definition *scene, problem_list *problems);
/* Stiffness and time step; species must be derived. impact_speed: m/s, the largest at which a particle meets what is
 * backed by others or by a wall. Returns the overlap of that impact, as a share of the smallest diameter. */
double scene_derive_contact(scene_inputs *inputs, double impact_speed, dem_scene_definition *scene, problem_list *problems);
/* Steps, samples and snapshots, once all else is derived. duration: pointer to the input that bounds the run. */
void scene_check_amounts(const job_spec *spec, const char *duration, problem_list *problems);
/* What is kept beside the scene itself: intervals, threads; and how it is stepped. */
void scene_set_common(job_spec *spec);

#endif
