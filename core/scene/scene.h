/* What a scene is made of; the inside of dem.h's dem_scene. */
#ifndef SCENE_H
#define SCENE_H

#include "container.h"
#include "dem.h"
#include "energy.h"
#include "filling.h"
#include "integrator.h"
#include "neighbor_list.h"
#include "spheres.h"

/* All particles of a stream, those not yet in included. */
typedef struct stream {
    size_t particles, spheres;
    bool has_clusters; /* then every particle is one, if of one sphere */
} stream;

/* How far the bed's inner surface falls behind the drum. */
typedef struct surface_meter {
    double since; /* s since rotation began, when the present revolution did; NaN: none has yet */
    double lag;   /* rad a revolution, of the last whole one; NaN: none was */
} surface_meter;

struct dem_scene {
    dem_scene_definition definition;
    dem_contact_parameters contact; /* those of the present phase: friction waits until spheres have grown */
    container container;
    leap_frog leap; /* of the present step */
    spheres spheres;
    neighbor_list neighbors;
    filling filling;
    stream stream;
    dem_phase phase;
    int64_t step_count, phase_start, run_start; /* run_start: -1 before */
    int64_t steps_before;                       /* of rotation at the same rate, before the scene's own clock began */
    double maximum_overlap;                     /* m since rotation began */
    size_t lost_count;                          /* particles that fell off the plate */
    int32_t *lost;                              /* (lost_count of particles) who; NULL where none can be lost */
    bool *is_lost;                              /* (particles) */
    torque_meter torque;
    surface_meter surface;
    energy_audit audit;
    dem_failure failure;
    dem_step_profile *profile; /* the caller's; NULL: none wanted */
};

static inline bool particle_is_lost(const dem_scene *scene, size_t p) { return scene->is_lost && scene->is_lost[p]; }

/* s that the container has moved, those before the scene's own clock began included. */
static inline double scene_time_in_motion(const dem_scene *scene)
{
    return (double)(scene->step_count - scene->run_start + scene->steps_before) * scene->definition.time_step;
}

/* Everything that follows from the phase alone: friction, the drum's rate. */
void scene_enter_phase(dem_scene *scene, dem_phase phase);

#endif
