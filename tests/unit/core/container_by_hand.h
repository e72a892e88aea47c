/* Scenes of few spheres in any container, each sphere where a test wants it. As in scene_by_hand.h they go in as a
 * checkpoint does; but containers of more walls than one are not widened, so their spheres are placed by filling first. */
#ifndef CONTAINER_BY_HAND_H
#define CONTAINER_BY_HAND_H

#include "equal_spheres.h"
#include "scene.h"

/* 4 mm spheres in 0.1 m: a drum, to be closed, set up or given bars by the test. */
static inline dem_scene_definition container_definition(dem_container_kind kind, size_t n)
{
    dem_scene_definition d = equal_spheres(n);
    d.container = kind;
    d.diameter = 0.1;
    d.length = 0.06;
    d.ends.friction = 0.3;
    d.plate = (dem_plate){ .diameter = 0.2, .friction = 0.3 };
    if (kind == DEM_VESSEL) d.orifice = (dem_orifice){ .opening = 0.03 };
    d.contact.wall_friction = 0.3;
    return d;
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
