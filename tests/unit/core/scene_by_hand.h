/* Scenes whose particles a test puts where it wants. They go in as a checkpoint does, by dem_scene_restore, so
 * that nothing here depends on how a scene keeps its particles. */
#ifndef SCENE_BY_HAND_H
#define SCENE_BY_HAND_H

#include "equal_spheres.h"
#include "scene.h"

/* Spheres that every such scene has beside the test's own, parked on the axis: filling does not place one or two
 * spheres alone, nor a bed as thin as that. */
enum { PARKED = 10 };

/* n equal spheres of 4 mm in a wide drum that stands still: room to collide far from the wall. */
static inline dem_scene_definition hand_definition(size_t n)
{
    dem_scene_definition d = equal_spheres(n);
    d.diameter = 0.2;
    d.length = 0.1;
    return d;
}

/* Two species: the first sphere is of the first, all others of the second. */
static inline void first_sphere_differs(dem_scene_definition *d, dem_species second)
{
    d->species_count = 2;
    d->species[0].share = 1.0 / (double)(d->particle_count + PARKED);
    d->species[1] = second;
    d->species[1].share = 1 - d->species[0].share;
}

/* Created in a drum that they fill, which is then widened to the one asked for. */
static inline dem_scene *hand_scene(const dem_scene_definition *definition)
{
    dem_scene_definition narrow = *definition;
    narrow.particle_count += PARKED;
    double largest = 0;
    for (size_t k = 0; k < narrow.species_count; k++) largest = fmax(largest, narrow.species[k].diameter);
    narrow.diameter = 3.001 * largest;
    narrow.length = fmax(3.01, (double)narrow.particle_count / 5) * largest;
    dem_scene *scene = NULL;
    const dem_status status = dem_scene_create(&narrow, &scene);
    if (status != DEM_OK) fail_msg("the test's own scene: %s", dem_status_text(status));
    scene->definition.diameter = definition->diameter;
    scene->definition.length = definition->length;
    container_init(&scene->container, definition);
    return scene;
}

/* The same without weight, which no definition may ask for. */
static inline dem_scene *weightless_scene(const dem_scene_definition *definition)
{
    dem_scene *scene = hand_scene(definition);
    scene->definition.gravity = 0.0;
    return scene;
}

static inline dem_state_array *state_array(dem_state *state, const char *name)
{
    for (size_t k = 0; k < state->array_count; k++)
        if (strcmp(state->array[k].name, name) == 0) return &state->array[k];
    fail_msg("a saved state has no array %s", name);
    return NULL;
}

/* What a contact remembers, as a saved state has it. */
enum { HISTORY_T = 0, HISTORY_T_STAR = 3, HISTORY_ALPHA_0 = 4, HISTORY_ROLL = 5, HISTORY_WIDTH = 8 };

/* What a test puts into a scene; NULL: all zero. */
typedef struct placement {
    dem_phase phase;
    const double *position, *velocity, *spin; /* (n,3) m, m/s, rad/s */
    size_t pair_count;
    const int32_t *pair;   /* (pair_count, 2), in ascending order */
    const double *history; /* (pair_count, HISTORY_WIDTH) */
} placement;

static inline void state_fill(dem_state *state, const char *name, const double *numbers)
{
    const dem_state_array *a = state_array(state, name);
    memset(a->data, 0, a->rows * a->columns * sizeof(double));
    if (numbers) memcpy(a->data, numbers, (a->rows - PARKED) * a->columns * sizeof(double));
}

static inline void park(dem_state *state, double length)
{
    const dem_state_array *a = state_array(state, "position");
    for (size_t k = 0; k < PARKED; k++)
        ((double *)a->data)[3 * (a->rows - PARKED + k) + 2] = length * (((double)k + 0.5) / PARKED - 0.5);
}

static inline void state_replace(dem_state *state, const char *name, size_t rows, const void *data, size_t row_bytes)
{
    dem_state_array *a = state_array(state, name);
    free(a->data);
    a->rows = rows;
    a->data = calloc(rows + 1, row_bytes);
    assert_non_null(a->data);
    if (rows) memcpy(a->data, data, rows * row_bytes);
}

/* A state at step 0 of the phase, with the particles and contacts of the placement. */
static inline void place_by_hand(dem_scene *scene, const placement *p)
{
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    int64_t *counters = state_array(&state, "counters")->data;
    counters[0] = p->phase;
    counters[1] = counters[2] = 0;
    counters[3] = p->phase == DEM_PHASE_RUNNING ? 0 : -1;
    memset(state_array(&state, "numbers")->data, 0, state_array(&state, "numbers")->columns * sizeof(double));
    state_fill(&state, "position", p->position);
    park(&state, scene->container.length);
    state_fill(&state, "velocity", p->velocity);
    state_fill(&state, "angular_velocity", p->spin);
    state_replace(&state, "pair", p->pair_count, p->pair, 2 * sizeof(int32_t));
    state_replace(&state, "pair_history", p->pair_count, p->history, HISTORY_WIDTH * sizeof(double));
    state_replace(&state, "wall_contact", 0, NULL, 2 * sizeof(int32_t));
    state_replace(&state, "wall_history", 0, NULL, HISTORY_WIDTH * sizeof(double));
    const dem_status status = dem_scene_restore(scene, &state);
    dem_state_clear(&state);
    assert_int_equal(status, DEM_OK);
}

/* The test's own spheres, without the parked; arrays as in dem_particle_arrays, (n,3). NULL: not asked for. */
static inline void look_at(const dem_scene *scene, double *position, double *velocity, double *spin)
{
    const size_t all = dem_scene_particle_count(scene), bytes = 3 * (all - PARKED) * sizeof(double);
    double *x = calloc(9 * all, sizeof *x), *v = x + 3 * all, *w = x + 6 * all;
    assert_non_null(x);
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = x, .velocity = v, .angular_velocity = w });
    if (position) memcpy(position, x, bytes);
    if (velocity) memcpy(velocity, v, bytes);
    if (spin) memcpy(spin, w, bytes);
    free(x);
}

static inline void advance(dem_scene *scene, int64_t steps)
{
    const dem_status status = dem_scene_advance(scene, steps);
    if (status != DEM_OK) {
        const dem_failure *f = dem_scene_failure(scene);
        fail_msg("the scene stopped at step %lld: %s (%s %g %s, limit %g)", (long long)f->step, dem_status_text(status),
                 f->quantity, f->value, f->unit, f->limit);
    }
}

/* Two states, bit for bit. */
static inline bool states_are_equal(const dem_state *a, const dem_state *b)
{
    static const size_t size[] = { [DEM_FLOAT64] = 8, [DEM_INT64] = 8, [DEM_INT32] = 4 };
    if (a->array_count != b->array_count) return false;
    for (size_t k = 0; k < a->array_count; k++) {
        const dem_state_array *x = &a->array[k], *y = &b->array[k];
        if (strcmp(x->name, y->name) != 0 || x->element != y->element || x->rows != y->rows || x->columns != y->columns
            || memcmp(x->data, y->data, x->rows * x->columns * size[x->element]) != 0)
            return false;
    }
    return true;
}

static inline double species_mass(const dem_species *s) { return dem_sphere_mass(s->diameter, s->density); }

#endif
