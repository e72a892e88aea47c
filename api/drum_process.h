/* The parts that the rotating drum's process is made of. */
#ifndef DRUM_PROCESS_H
#define DRUM_PROCESS_H

#include "process_type.h"
#include "spec_memory.h"

extern const process_type drum_process;
extern const spec_table drum_fields;          /* drum_fields.c */
extern const result_table drum_result_fields; /* drum_result_fields.c */

void drum_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems); /* drum_rules.c */
/* Complete, but for a sphere; of not-a-number where the spheres were refused or make no cluster. Fills in the
 * diameters of spheres that have none. */
void drum_cluster_derive(spec_memory *memory, species_inputs *inputs, size_t species, dem_cluster *cluster,
                         problem_list *problems);                /* drum_clusters.c; memory: NULL, or of clusters derived before */
double drum_spheres_a_particle(const dem_drum_definition *drum); /* mean; drum_estimate.c */
void drum_warn(const job_spec *spec, problem_list *warnings);    /* drum_warnings.c */
void drum_understand(const job_spec *spec, json_t *words);       /* drum_warnings.c */
job_estimate drum_estimate(const job_spec *spec, const calibration *machine); /* drum_estimate.c */

#endif
