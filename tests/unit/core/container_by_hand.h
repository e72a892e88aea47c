/* Scenes of few spheres in any container, each sphere where a test wants it. As in scene_by_hand.h they go in as a
 * checkpoint does; but containers of more walls than one are not widened, so their spheres are placed by filling first. */
#ifndef CONTAINER_BY_HAND_H
#define CONTAINER_BY_HAND_H

#include "core_claims.h"
#include "dem.h"
#include "dem_rules.h"
#include "scene.h"

/* 4 mm spheres in 0.1 m: a drum, to be closed, set up or given bars by the test. */
static inline dem_scene_definition container_definition(dem_container_kind kind, size_t n)
{
    return (dem_scene_definition){
        .container = kind,
        .diameter = 0.1,
        .length = 0.06,
        .ends = { .friction = 0.3 },
        .plate = { .diameter = 0.2, .friction = 0.3 },
        .gravity = 9.81,
        .fill_fraction = 0.5,
        .particle_count = n,
        .species_count = 1,
        .species = { { .diameter = 0.004, .density = 2500, .share = 1 } },
        .contact = { .stiffness = 4000,
                     .restitution = 0.8,
                     .friction = 0.3,
                     .wall_friction = 0.3,
                     .tangential_stiffness_ratio = 0.8 },
        .time_step = 1e-5,
        .seed = 1,
        .threads = 1,
    };
}

static inline dem_scene *container_scene(const dem_scene_definition *d)
{
    dem_scene *scene = NULL;
    const dem_status status = dem_scene_create(d, &scene);
    if (status != DEM_OK) fail_msg("the test's own container: %s", dem_status_text(status));
    return scene;
}

/* Puts the spheres there, without contacts, at the first step of the phase in which the container moves. Arrays (n,3);
 * NULL: zero. */
static inline void put(dem_scene *scene, const double *position, const double *velocity, const double *spin)
{
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    for (size_t k = 0; k < state.array_count; k++) {
        dem_state_array *a = &state.array[k];
        const double *numbers = strcmp(a->name, "position") == 0           ? position
                                : strcmp(a->name, "velocity") == 0         ? velocity
                                : strcmp(a->name, "angular_velocity") == 0 ? spin
                                                                           : NULL;
        if (a->element == DEM_FLOAT64) memset(a->data, 0, a->rows * a->columns * sizeof(double));
        if (numbers) memcpy(a->data, numbers, a->rows * a->columns * sizeof(double));
        if (strstr(a->name, "pair") || strstr(a->name, "wall")) a->rows = 0;
        if (strcmp(a->name, "counters") == 0) memcpy(a->data, (int64_t[]){ DEM_PHASE_RUNNING, 0, 0, 0 }, 4 * sizeof(int64_t));
    }
    const dem_status status = dem_scene_restore(scene, &state);
    dem_state_clear(&state);
    if (status != DEM_OK) fail_msg("the test's own places: %s", dem_scene_failure(scene)->quantity);
}

static inline void go_on(dem_scene *scene, int64_t steps)
{
    const dem_status status = dem_scene_advance(scene, steps);
    if (status == DEM_OK) return;
    const dem_failure *f = dem_scene_failure(scene);
    fail_msg("stopped at step %lld: %s (%s %g %s, limit %g)", (long long)f->step, dem_status_text(status), f->quantity, f->value,
             f->unit, f->limit);
}

static inline double sphere_mass_of(const dem_scene *scene) { return particle_mass(&scene->spheres, 0); }

#endif
