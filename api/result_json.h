/* What a drum run found, and the document of GET /jobs/{id}/results that says it. */
#ifndef RESULT_JSON_H
#define RESULT_JSON_H

#include <jansson.h>

#include "dem_types.h"

/* How the run went; NaN where unknown. Counts are doubles, as in the inputs: all fit exactly. */
typedef struct run_facts {
    double particles, steps, time_step; /* steps: since creation, settling included; s */
    double simulated_seconds;           /* s of rotation */
    double settling_seconds;            /* s simulated before rotation began */
    double wall_seconds;                /* s, of all attempts */
    double particle_steps_per_second;
    double maximum_overlap;             /* while rotating, share of the smallest diameter */
    double stiffness;                   /* N/m */
    double fill_fraction;
    double samples, snapshots;
    double threads, seed, attempt;
} run_facts;

typedef struct job_result {
    dem_drum_results measured;
    bool has_regime; /* false: too few frames to tell */
    run_facts run;
} job_result;

/* Every measure NaN, as when there were too few frames to measure. */
void job_result_init(job_result *result);

/* The results document: NaN becomes null. New reference; NULL: no memory. */
json_t *job_result_to_json(const job_result *result);

#endif
