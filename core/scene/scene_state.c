/* Saving and restoring: what a scene can't make again from its definition. Neighbor lists are made again, since
 * no result depends on when they were made (core/contacts/contact_list.h). */
#include "scene_state.h"

#include <assert.h>

#include "array.h"
#include "lost.h"
#include "sizing.h"
#include "sorting.h"
#include "step.h"
#include "stream.h"

static void *state_add(dem_state *state, const char *name, dem_element element, size_t rows, size_t columns)
{
    static const size_t size[] = { [DEM_FLOAT64] = 8, [DEM_INT64] = 8, [DEM_INT32] = 4 };
    assert(state->array_count < DEM_STATE_ARRAYS);
    void *data = array_create(rows * columns, size[element]);
    if (data) state->array[state->array_count++] = (dem_state_array){ name, element, rows, columns, data };
    return data;
}

const dem_state_array *state_find(const dem_state *state, const char *name, dem_element element, size_t columns)
{
    for (size_t k = 0; k < state->array_count; k++) {
        const dem_state_array *a = &state->array[k];
        if (strcmp(a->name, name) == 0) return a->element == element && a->columns == columns ? a : NULL;
    }
    return NULL;
}

static bool is_remembered(const contact_history *h)
{
    for (int m = 0; m < CONTACT_NUMBERS; m++)
        if (h->number[m] != 0) return true;
    return false;
}

/* Two arrays: the spheres of each contact that remembers something, and what it remembers. */
static bool save_contacts(dem_state *state, const contact_list *list, const char *ids, const char *history)
{
    size_t n = 0;
    for (size_t k = 0; k < list->count; k++) {
        const contact_history h = contact_list_history(list, k);
        n += is_remembered(&h);
    }
    int32_t *id = state_add(state, ids, DEM_INT32, n, 2);
    double *numbers = state_add(state, history, DEM_FLOAT64, n, CONTACT_NUMBERS);
    if (!id || !numbers) return false;
    for (size_t k = 0; k < list->count; k++) {
        const contact_history h = contact_list_history(list, k);
        if (!is_remembered(&h)) continue;
        *id++ = list->first[k];
        *id++ = list->second[k];
        for (int m = 0; m < CONTACT_NUMBERS; m++) *numbers++ = (double)h.number[m];
    }
    return true;
}

/* What is saved of each mobile sphere, as the table of their arrays says: first what every state has. */
static bool save_spheres(dem_state *state, const spheres *s, bool optional)
{
    for (int k = 0; k < SPHERE_ARRAYS; k++) {
        const sphere_array *a = &sphere_arrays[k];
        if (!a->saved || a->is_optional != optional) continue;
        const char *from = sphere_array_of(s, a);
        double *to = state_add(state, a->saved, DEM_FLOAT64, s->mobile_count, (size_t)a->columns);
        if (!to) return false;
        for (size_t i = 0; i < s->mobile_count; i++, from += a->size)
            for (int c = 0; c < a->columns; c++) *to++ = a->is_float ? (double)((const float *)from)[c] : ((const double *)from)[c];
    }
    return true;
}

/* A scene of spheres alone has no such array. */
static bool save_clusters(dem_state *state, const clusters *c)
{
    double *numbers = c->count ? state_add(state, "cluster", DEM_FLOAT64, c->count, CLUSTER_NUMBERS) : NULL;
    for (size_t k = 0; numbers && k < c->count; k++, numbers += CLUSTER_NUMBERS) {
        const cluster_body *b = &c->body[k];
        const quaternion q = b->orientation;
        const double orientation[4] = { q.q1, q.q2, q.q3, q.q4 };
        memcpy(numbers + CLUSTER_PLACE, b->x, sizeof b->x);
        memcpy(numbers + CLUSTER_VELOCITY, &b->velocity, 3 * sizeof *numbers);
        memcpy(numbers + CLUSTER_SPIN, b->spin, sizeof b->spin);
        memcpy(numbers + CLUSTER_SPIN_CHANGE, b->spin_change, sizeof b->spin_change);
        memcpy(numbers + CLUSTER_ORIENTATION, orientation, sizeof orientation);
    }
    return c->count == 0 || numbers != NULL;
}

/* Neither has one whose species are each of one size. */
static bool save_sizes(dem_state *state, const spheres *s)
{
    double *radius = s->have_sizes ? state_add(state, "radius", DEM_FLOAT64, s->mobile_count, 1) : NULL;
    for (size_t i = 0; radius && i < s->mobile_count; i++) radius[i] = (double)s->full_radius[i];
    return !s->have_sizes || radius != NULL;
}

static bool save_surface(dem_state *state, const surface_meter *meter)
{
    double *last = state_add(state, "surface", DEM_FLOAT64, 1, 2);
    if (last) memcpy(last, (double[]){ meter->since, meter->lag }, 2 * sizeof *last);
    return last != NULL;
}

/* A state without it has not looked at the surface yet. */
static void restore_surface(dem_scene *scene, const dem_state *state)
{
    const dem_state_array *last = state_find(state, "surface", DEM_FLOAT64, 2);
    const bool is_there = last && last->rows == 1 && state_find(state, "surface_track", DEM_FLOAT64, 2);
    const double *meter = is_there ? last->data : (double[]){ NAN, NAN };
    scene->surface = (surface_meter){ meter[0], meter[1] };
    if (!is_there) spheres_forget_surface(&scene->spheres);
}

/* Of a drum with stages the mean, by which a run that goes on from here finds how far it has turned. */
static double rate_of_run(const dem_scene *scene)
{
    const double time = scene_time_in_motion(scene);
    if (scene->definition.stage_count == 0) return scene->definition.rotation_rate;
    return scene->run_start >= 0 && time > 0 ? (scene->container.angle - scene->container.angle_before) / time : 0;
}

dem_status dem_scene_save(const dem_scene *scene, dem_state *state)
{
    const spheres *s = &scene->spheres;
    memset(state, 0, sizeof *state);
    int64_t *integers = state_add(state, "counters", DEM_INT64, 1, STATE_INTEGERS);
    double *numbers = state_add(state, "numbers", DEM_FLOAT64, 1, STATE_NUMBERS);
    int32_t *id = state_add(state, "particle", DEM_INT32, particles_count(s), 1);
    if (!integers || !numbers || !id || !save_spheres(state, s, false) || !save_clusters(state, &s->clusters)
        || !save_sizes(state, s) || !save_surface(state, &scene->surface) || !save_spheres(state, s, true)
        || !save_contacts(state, &scene->neighbors.pairs, "pair", "pair_history")
        || !save_contacts(state, &scene->neighbors.walls, "wall_contact", "wall_history")) {
        dem_state_clear(state);
        return DEM_NO_MEMORY;
    }
    integers[STATE_PHASE] = (int64_t)scene->phase;
    integers[STATE_STEP] = scene->step_count;
    integers[STATE_PHASE_START] = scene->phase_start;
    integers[STATE_RUN_START] = scene->run_start;
    integers[STATE_STEPS_BEFORE] = scene->steps_before;
    integers[STATE_LAW] = (int64_t)scene->definition.contact.law;
    numbers[STATE_OVERLAP] = scene->maximum_overlap;
    numbers[STATE_TORQUE_SUM] = scene->torque.sum;
    numbers[STATE_TORQUE_COUNT] = scene->torque.count;
    numbers[STATE_ANGLE_BEFORE] = scene->container.angle_before;
    numbers[STATE_RATE] = rate_of_run(scene);
    numbers[STATE_TIME_STEP] = scene->definition.time_step;
    for (size_t p = 0; p < particles_count(s); p++) id[p] = particle_id(s, p);
    return DEM_OK;
}

void dem_state_clear(dem_state *state)
{
    for (size_t k = 0; k < state->array_count; k++) free(state->array[k].data);
    memset(state, 0, sizeof *state);
}

/* The two arrays of a list of contacts, ordered by first, then by second, of spheres that are there. */
static bool contacts_fit(const dem_state *state, const char *ids, const char *history, size_t n, size_t all)
{
    const dem_state_array *id = state_find(state, ids, DEM_INT32, 2);
    const dem_state_array *numbers = state_find(state, history, DEM_FLOAT64, CONTACT_NUMBERS);
    if (!id || !numbers || id->rows != numbers->rows) return false;
    const int32_t *pair = id->data;
    for (size_t k = 0; k < id->rows; k++, pair += 2) {
        const bool ordered = k == 0 || pair[0] > pair[-2] || (pair[0] == pair[-2] && pair[1] > pair[-1]);
        if (pair[0] < 0 || (size_t)pair[0] >= n || pair[1] < 0 || (size_t)pair[1] >= all || !ordered) return false;
    }
    return true;
}

/* What is saved of n spheres. */
static bool array_fits(const dem_state *state, const sphere_array *a, size_t n)
{
    const dem_state_array *saved = a->saved ? state_find(state, a->saved, DEM_FLOAT64, (size_t)a->columns) : NULL;
    return !a->saved || (saved ? saved->rows == n : a->is_optional);
}

/* The list from which the next one carries its histories over. */
static void restore_contacts(const dem_state *state, contact_list *list, const char *ids, const char *history)
{
    const dem_state_array *id = state_find(state, ids, DEM_INT32, 2);
    const int32_t *pair = id->data;
    const double *h = state_find(state, history, DEM_FLOAT64, CONTACT_NUMBERS)->data;
    list->count = id->rows;
    for (size_t k = 0; k < id->rows; k++, pair += 2, h += CONTACT_NUMBERS) {
        list->first[k] = pair[0];
        list->second[k] = pair[1];
        contact_history remembered;
        for (int m = 0; m < CONTACT_NUMBERS; m++) remembered.number[m] = (real)h[m];
        contact_list_set_history(list, k, &remembered);
    }
}

/* Rows are made of places, velocities and spins together; the rest stands for itself. */
static void restore_spheres(dem_scene *scene, const dem_state *state)
{
    spheres *s = &scene->spheres;
    const int64_t grown = scene->phase == DEM_PHASE_GROWING ? scene->step_count - scene->phase_start : scene->filling.growing_steps;
    spheres_set_period(s, &scene->definition, scene->container.period);
    spheres_set_scale(s, filling_scale(&scene->filling, grown));
    const double *x = state_find(state, "position", DEM_FLOAT64, 3)->data, *v = state_find(state, "velocity", DEM_FLOAT64, 3)->data,
                 *w = state_find(state, "angular_velocity", DEM_FLOAT64, 3)->data;
    for (size_t i = 0; i < s->mobile_count; i++, x += 3, v += 3, w += 3)
        sphere_set(s, i, (vector4){ x[0], x[1], x[2] }, (vector4){ v[0], v[1], v[2] }, (vector4){ w[0], w[1], w[2] });
    for (int k = 0; k < SPHERE_ARRAYS; k++) {
        const sphere_array *a = &sphere_arrays[k];
        const dem_state_array *saved =
            a->saved && a->is_float ? state_find(state, a->saved, DEM_FLOAT64, (size_t)a->columns) : NULL;
        float *to = saved ? sphere_array_of(s, a) : NULL;
        for (size_t i = 0; to && i < s->mobile_count * (size_t)a->columns; i++) to[i] = (float)((const double *)saved->data)[i];
    }
    memset(s->load, 0, s->load_count * sizeof *s->load);
}

static void restore_clusters(clusters *c, const double *numbers)
{
    for (size_t k = 0; k < c->count; k++, numbers += CLUSTER_NUMBERS) {
        cluster_body *b = &c->body[k];
        const double *q = numbers + CLUSTER_ORIENTATION;
        memcpy(b->x, numbers + CLUSTER_PLACE, sizeof b->x);
        for (int a = 0; a < 3; a++) b->velocity[a] = numbers[CLUSTER_VELOCITY + a];
        memcpy(b->spin, numbers + CLUSTER_SPIN, sizeof b->spin);
        memcpy(b->spin_change, numbers + CLUSTER_SPIN_CHANGE, sizeof b->spin_change);
        b->orientation = (quaternion){ q[0], q[1], q[2], q[3] };
    }
}

/* Particles in the order in memory that they were saved in. */
static dem_status restore_order(spheres *s, const dem_state *state)
{
    const size_t n = particles_count(s), singles = s->single_count;
    const dem_state_array *saved = state_find(state, "particle", DEM_INT32, 1);
    if (!saved || saved->rows != n) return DEM_STATE_MISMATCH;
    const int32_t *id = saved->data;
    int32_t *now_at = array_create(n, sizeof *now_at), *order = array_create(n, sizeof *order),
            *sphere_order = array_create(s->mobile_count, sizeof *sphere_order);
    dem_status status = now_at && order && sphere_order ? DEM_OK : DEM_NO_MEMORY;
    if (status == DEM_OK) {
        for (size_t p = 0; p < n; p++) now_at[p] = -1;
        for (size_t p = 0; p < n; p++) now_at[particle_id(s, p)] = (int32_t)p;
        for (size_t p = 0; p < n && status == DEM_OK; p++) {
            const bool is_there = id[p] >= 0 && (size_t)id[p] < n && now_at[id[p]] >= 0;
            order[p] = is_there ? now_at[id[p]] : 0;
            if (!is_there || ((size_t)order[p] < singles) != (p < singles)) status = DEM_STATE_MISMATCH;
            else now_at[id[p]] = -1; /* once only */
        }
    }
    if (status == DEM_OK) status = sorting_apply(s, order, sphere_order);
    free(now_at);
    free(order);
    free(sphere_order);
    return status;
}

static dem_status restore_sizes(dem_scene *scene, const dem_state *state)
{
    const spheres *s = &scene->spheres;
    const dem_state_array *radius = state_find(state, "radius", DEM_FLOAT64, 1);
    if (!s->have_sizes) return DEM_OK;
    if (!radius || radius->rows != s->mobile_count || !sizing_fits(s, &scene->definition, radius->data)) return DEM_STATE_MISMATCH;
    return sizing_restore(scene, radius->data);
}

dem_status dem_scene_restore(dem_scene *scene, const dem_state *state)
{
    const dem_state_array *places = state_find(state, "position", DEM_FLOAT64, 3);
    if (!places || stream_restore(scene, places->rows) != DEM_OK) return DEM_STATE_MISMATCH;
    const size_t n = scene->spheres.mobile_count;
    const dem_state_array *integers = state_find(state, "counters", DEM_INT64, STATE_INTEGERS);
    const dem_state_array *numbers = state_find(state, "numbers", DEM_FLOAT64, STATE_NUMBERS);
    for (int k = 0; k < SPHERE_ARRAYS; k++)
        if (!array_fits(state, &sphere_arrays[k], n)) return DEM_STATE_MISMATCH;
    const size_t bodies = scene->spheres.clusters.count;
    const dem_state_array *of_clusters = state_find(state, "cluster", DEM_FLOAT64, CLUSTER_NUMBERS);
    if (!integers || !numbers || (bodies > 0 && !of_clusters) || (of_clusters && of_clusters->rows != bodies))
        return DEM_STATE_MISMATCH;
    const int64_t *counter = integers->data;
    if (counter[STATE_PHASE] < DEM_PHASE_GROWING || counter[STATE_PHASE] > DEM_PHASE_RUNNING) return DEM_STATE_MISMATCH;

    const size_t all = spheres_count(&scene->spheres);
    contact_list *pairs = &scene->neighbors.pairs, *walls = &scene->neighbors.walls;
    if (!contacts_fit(state, "pair", "pair_history", n, all)
        || !contacts_fit(state, "wall_contact", "wall_history", n, (size_t)scene->container.wall_count))
        return DEM_STATE_MISMATCH;
    if (contact_list_reserve(pairs, state_find(state, "pair", DEM_INT32, 2)->rows) != DEM_OK
        || contact_list_reserve(walls, state_find(state, "wall_contact", DEM_INT32, 2)->rows) != DEM_OK) {
        neighbor_list_invalidate(&scene->neighbors);
        return DEM_NO_MEMORY;
    }
    dem_status status = restore_order(&scene->spheres, state);
    if (status == DEM_OK) status = restore_sizes(scene, state);
    if (status != DEM_OK) return status;
    /* Nothing can fail from here on but memory for new lists. */
    restore_contacts(state, pairs, "pair", "pair_history");
    restore_contacts(state, walls, "wall_contact", "wall_history");
    scene->step_count = counter[STATE_STEP];
    scene->phase_start = counter[STATE_PHASE_START];
    scene->run_start = counter[STATE_RUN_START];
    scene->steps_before = counter[STATE_STEPS_BEFORE];
    const double *number = numbers->data;
    scene->maximum_overlap = number[STATE_OVERLAP];
    scene->torque = (torque_meter){ .sum = number[STATE_TORQUE_SUM], .count = number[STATE_TORQUE_COUNT] };
    scene->container.angle_before = number[STATE_ANGLE_BEFORE];
    scene->phase = (dem_phase)counter[STATE_PHASE];
    scene_enter_phase(scene, scene->phase);
    if (bodies > 0) restore_clusters(&scene->spheres.clusters, of_clusters->data);
    restore_spheres(scene, state);
    restore_surface(scene, state);
    lost_recognize(scene);
    return scene_update_neighbors(scene);
}
