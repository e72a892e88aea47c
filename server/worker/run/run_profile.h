/* What a run's time went into, for `repose run --profile`: making the bed, the parts of the steps after that, measuring,
 * writing. Only when asked for: a run without it reads the clock for none of this. */
#ifndef RUN_PROFILE_H
#define RUN_PROFILE_H

#include <jansson.h>
#include <stdbool.h>

#include "dem.h"

typedef enum run_part { RUN_MEASURES, RUN_SNAPSHOTS, RUN_CHECKPOINTS, RUN_PARTS } run_part;

typedef struct run_profile {
    bool is_on;
    dem_step_profile step;     /* since rotation began */
    double seconds[RUN_PARTS]; /* beside the steps */
    double begun, rotation_begun, lap_begin;
    int64_t first_step;    /* of those that are counted */
    double pairs_touching; /* sum over the looks */
    int64_t looks;
} run_profile;

/* All do nothing where the profile is off. It must stay where it is while the scene lives. */
void run_profile_begin(run_profile *profile, dem_scene *scene);
void run_profile_rotating(run_profile *profile, const dem_scene *scene); /* the bed is made */
void run_profile_lap_begin(run_profile *profile);
void run_profile_lap(run_profile *profile, run_part part);
void run_profile_look(run_profile *profile, const dem_scene *scene); /* counts the pairs that touch */

/* New reference; NULL: no memory. */
json_t *run_profile_report(const run_profile *profile, const dem_scene *scene);
void run_profile_print(const json_t *report);

#endif
