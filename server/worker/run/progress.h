/* How far a run is, how fast, and how long it will still take. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "dem.h"
#include "job_spec.h"
#include "schedule.h"

typedef struct progress {
    double started, last_report;           /* s, monotonic clock */
    double earlier_seconds;                /* spent by earlier attempts on the way to where this one started */
    double spheres;                        /* of each bed */
    double settling_steps, rotation_steps; /* of each bed, expected; the latter of a drum are known */
    bool may_end_early;                    /* as soon as all is at rest */
    double steps_per_second;               /* of all beds, of late; 0: not known yet */
    int64_t last_step;                     /* of all beds together */
    int beds_at_once;
} progress;

typedef struct progress_report {
    double percent, eta_seconds, particle_steps_per_second;
} progress_report;

double monotonic_seconds(void);

/* scene: of each of the spec's beds. */
void progress_init(progress *run, const job_spec *spec, const schedule *plan, const dem_scene *const *scene,
                   double earlier_seconds);

/* True when a report is due (about once a second, of wall time) and made. */
bool progress_is_due(progress *run, const dem_scene *const *scene, size_t beds, progress_report *report);

double progress_wall_seconds(const progress *run); /* of all attempts */

/* Steps of one bed that take about 50 ms, of large beds up to a second: how long a signal or a report may have to wait. */
int64_t progress_short_run(const progress *run);

#endif
