/* Beds to measure: a drum as users write it, run until its flow is steady, and the same bed repeated along the axis, which
 * makes a large one at the cost of a small one. */
#ifndef BED_H
#define BED_H

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "dem.h"
#include "dem_rules.h"
#include "job_spec.h"
#include "scene_state.h"

static inline double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline void give_up(const char *what, const char *why)
{
    fprintf(stderr, "bench: %s: %s\n", what, why);
    exit(1);
}

static inline dem_scene_definition bed_definition(const char *inputs)
{
    problem_list problems;
    job_spec spec;
    problem_list_init(&problems);
    json_t *request = json_pack("{s:o}", "inputs", json_loads(inputs, 0, NULL));
    if (!job_spec_parse("drum", request, 1, &spec, &problems)) give_up(inputs, json_dumps(problems.errors, 0));
    const dem_scene_definition drum = spec.scene;
    job_spec_clear(&spec);
    problem_list_clear(&problems);
    json_decref(request);
    return drum;
}

static inline void bed_advance(dem_scene *scene, int64_t steps)
{
    const dem_status status = dem_scene_advance(scene, steps);
    if (status != DEM_OK) give_up("a scene failed", dem_status_text(status));
}

static inline dem_scene *bed_create(const dem_scene_definition *drum)
{
    dem_scene *scene;
    const dem_status status = dem_scene_create(drum, &scene);
    if (status != DEM_OK) give_up("a scene can't be made", dem_status_text(status));
    return scene;
}

/* --- repeating --- */

typedef struct bed_contact {
    int32_t first, second;
    size_t row;  /* of the original's history */
    bool turned; /* first and second have changed places, so the remembered force points the other way */
} bed_contact;

static inline int by_spheres(const void *a, const void *b)
{
    const bed_contact *x = a, *y = b;
    if (x->first != y->first) return x->first < y->first ? -1 : 1;
    return (x->second > y->second) - (x->second < y->second);
}

static inline dem_state_array *bed_array(dem_state *state, const char *name)
{
    for (size_t k = 0; k < state->array_count; k++)
        if (strcmp(state->array[k].name, name) == 0) return &state->array[k];
    give_up("a saved scene has no array", name);
    return NULL;
}

static inline void bed_repeat_rows(dem_state_array *array, size_t copies, double length, bool is_position)
{
    const size_t n = array->rows, columns = array->columns;
    const double *from = array->data;
    double *to = malloc(n * copies * columns * sizeof *to);
    for (size_t c = 0; c < copies; c++)
        for (size_t i = 0; i < n; i++) {
            double *row = to + (c * n + i) * columns;
            memcpy(row, from + i * columns, columns * sizeof *row);
            if (is_position) row[2] += length * ((double)c - 0.5 * (double)(copies - 1));
        }
    free(array->data);
    array->data = to;
    array->rows = n * copies;
}

/* Whatever a state has of each sphere. */
static inline void bed_repeat_spheres(dem_state *state, size_t copies, double length)
{
    for (size_t a = 0; a < state->array_count; a++)
        for (int k = 0; k < SPHERE_ARRAYS; k++)
            if (sphere_arrays[k].saved && strcmp(sphere_arrays[k].saved, state->array[a].name) == 0)
                bed_repeat_rows(&state->array[a], copies, length, strcmp(sphere_arrays[k].saved, "position") == 0);
}

/* Contacts of spheres i and j of the original, which may touch through the periodic end: then j is in the next copy. */
static inline void bed_repeat_contacts(dem_state *state, const char *ids, const char *histories, size_t n, size_t copies,
                                       const double *position, double length, bool with_wall)
{
    dem_state_array *pair = bed_array(state, ids), *history = bed_array(state, histories);
    const size_t rows = pair->rows, columns = history->columns;
    const int32_t *from = pair->data;
    bed_contact *all = malloc((rows * copies + 1) * sizeof *all);
    size_t count = 0;
    for (size_t c = 0; c < copies; c++)
        for (size_t k = 0; k < rows; k++) {
            const size_t i = (size_t)from[2 * k], j = (size_t)from[2 * k + 1];
            const int32_t first = (int32_t)(c * n + i);
            if (with_wall) {
                all[count++] = (bed_contact){ first, from[2 * k + 1], k, false };
                continue;
            }
            const double dz = position[3 * j + 2] - position[3 * i + 2];
            const size_t other = dz > 0.5 * length ? (c + copies - 1) % copies : dz < -0.5 * length ? (c + 1) % copies : c;
            const int32_t second = (int32_t)(other * n + j);
            all[count++] = first < second ? (bed_contact){ first, second, k, false } : (bed_contact){ second, first, k, true };
        }
    qsort(all, count, sizeof *all, by_spheres);
    int32_t *pairs = malloc((2 * count + 1) * sizeof *pairs);
    double *numbers = malloc((columns * count + 1) * sizeof *numbers);
    for (size_t k = 0; k < count; k++) {
        pairs[2 * k] = all[k].first;
        pairs[2 * k + 1] = all[k].second;
        memcpy(numbers + k * columns, (const double *)history->data + all[k].row * columns, columns * sizeof *numbers);
        for (size_t c = 0; all[k].turned && c < 3; c++) numbers[k * columns + c] *= -1.0;
    }
    free(all);
    free(pair->data);
    free(history->data);
    *pair = (dem_state_array){ pair->name, DEM_INT32, count, 2, pairs };
    *history = (dem_state_array){ history->name, DEM_FLOAT64, count, columns, numbers };
}

/* Ids in the order in memory. */
static inline void bed_number(dem_state_array *array, size_t count)
{
    int32_t *id = malloc(count * sizeof *id);
    for (size_t i = 0; i < count; i++) id[i] = (int32_t)i;
    free(array->data);
    array->data = id;
    array->rows = count;
}

/* The next step sorts particles in memory, as it does every some thousand steps: copies lie one behind the other as yet. */
static inline void bed_sort(dem_state *state)
{
    int64_t *counter = bed_array(state, "counters")->data;
    counter[STATE_RUN_START] = counter[STATE_STEP];
    counter[STATE_STEPS_BEFORE] = 0;
}

/* A scene of `copies` times this bed of spheres, one behind the other, with so many threads. */
static inline dem_scene *bed_repeat(const dem_scene *scene, const dem_scene_definition *drum, size_t copies, int threads)
{
    dem_state state;
    if (dem_scene_save(scene, &state) != DEM_OK) give_up("saving", "no memory");
    dem_scene_definition large = *drum;
    large.length *= (double)copies;
    large.particle_count *= copies;
    large.threads = threads;
    if (copies > 1) {
        const size_t n = drum->particle_count;
        const dem_state_array *places = bed_array(&state, "position");
        double *position = malloc(3 * n * sizeof *position);
        memcpy(position, places->data, 3 * n * sizeof *position);
        bed_repeat_spheres(&state, copies, drum->length);
        bed_repeat_contacts(&state, "pair", "pair_history", n, copies, position, drum->length, false);
        bed_repeat_contacts(&state, "wall_contact", "wall_history", n, copies, position, drum->length, true);
        bed_number(bed_array(&state, "particle"), n * copies);
        free(position);
    }
    bed_sort(&state);
    dem_scene *repeated = bed_create(&large);
    const dem_status status = dem_scene_restore(repeated, &state);
    if (status != DEM_OK) give_up("a repeated bed can't be restored", dem_status_text(status));
    dem_state_clear(&state);
    return repeated;
}

#endif
