/* Beds that were made before: particles placed one by one, or another scene's state, from which a run begins to rotate at
 * once. Both go in as a checkpoint does, by dem_scene_restore, so that nothing here depends on how a scene keeps its
 * particles. */
#include <assert.h>

#include "scene_state.h"
#include "step.h"

/* The clock and what is counted by it begin here. */
static void begin_anew(dem_scene *scene, double elapsed)
{
    scene->step_count = scene->phase_start = scene->run_start = 0;
    scene->maximum_overlap = 0.0;
    scene->torque = (torque_meter){ .sum = 0 };
    scene->surface = (surface_meter){ NAN, NAN };
    for (size_t i = 0; i < scene->spheres.mobile_count; i++) scene->spheres.fallen_time[i] -= (float)elapsed;
}

/* How far the container had turned. At the same rate and step its angle goes on to be counted from where it was counted
 * from before, which gives the same bits; else from here. */
static void keep_angle(dem_scene *scene, const int64_t *counter, const double *number)
{
    const int64_t steps = counter[STATE_STEP] - counter[STATE_RUN_START] + counter[STATE_STEPS_BEFORE];
    const bool alike = scene->definition.stage_count == 0 && number[STATE_RATE] == scene->definition.rotation_rate
                       && number[STATE_TIME_STEP] == scene->definition.time_step;
    scene->steps_before = alike ? steps : 0;
    scene->container.angle_before = number[STATE_ANGLE_BEFORE];
    if (!alike) scene->container.angle_before += number[STATE_RATE] * ((double)steps * number[STATE_TIME_STEP]);
}

static void forget_contacts(contact_list *list)
{
    for (size_t k = 0; k < list->count; k++) contact_list_forget(list, k);
}

dem_status dem_scene_continue(dem_scene *scene, const dem_state *state)
{
    const dem_state_array *counters = state_find(state, "counters", DEM_INT64, STATE_INTEGERS);
    const dem_state_array *numbers = state_find(state, "numbers", DEM_FLOAT64, STATE_NUMBERS);
    if (!counters || !numbers) return DEM_STATE_MISMATCH;
    const int64_t *counter = counters->data;
    const double *number = numbers->data;
    if (counter[STATE_PHASE] != DEM_PHASE_RUNNING) return DEM_STATE_MISMATCH;
    const dem_status status = dem_scene_restore(scene, state);
    if (status != DEM_OK) return status;
    begin_anew(scene, (double)(counter[STATE_STEP] - counter[STATE_RUN_START]) * number[STATE_TIME_STEP]);
    keep_angle(scene, counter, number);
    if (counter[STATE_LAW] != (int64_t)scene->definition.contact.law) {
        forget_contacts(&scene->neighbors.pairs);
        forget_contacts(&scene->neighbors.walls);
    }
    scene_enter_phase(scene, DEM_PHASE_RUNNING);
    return scene_update_neighbors(scene);
}

/* --- placed one by one --- */

/* Where a saved state keeps what is placed. */
typedef struct placing_arrays {
    double *position, *velocity, *spin, *cluster;
    double *radius; /* NULL: no species has sizes */
} placing_arrays;

static void place_sphere(const placing_arrays *to, size_t i, const dem_placed_particle *particle)
{
    memcpy(to->position + 3 * i, particle->position, sizeof particle->position);
    memcpy(to->velocity + 3 * i, particle->velocity, sizeof particle->velocity);
    memcpy(to->spin + 3 * i, particle->angular_velocity, sizeof particle->angular_velocity);
}

static void place_cluster(const placing_arrays *to, const spheres *s, const container *vessel, size_t b,
                          const dem_placed_particle *particle)
{
    assert(to->cluster);
    const cluster_body *body = &s->clusters.body[b];
    const cluster_shape *shape = &s->clusters.shape[body->species];
    const quaternion q = quaternion_normal(quaternion_from_wxyz(particle->orientation));
    const double *v = particle->velocity, *w = particle->angular_velocity, orientation[4] = { q.q1, q.q2, q.q3, q.q4 };
    double *numbers = to->cluster + CLUSTER_NUMBERS * b, a[3][3];
    quaternion_matrix(q, a);
    memset(numbers, 0, CLUSTER_NUMBERS * sizeof *numbers);
    memcpy(numbers + CLUSTER_PLACE, particle->position, sizeof particle->position);
    memcpy(numbers + CLUSTER_VELOCITY, v, sizeof particle->velocity);
    memcpy(numbers + CLUSTER_ORIENTATION, orientation, sizeof orientation);
    if (shape->is_isotropic) memcpy(numbers + CLUSTER_SPIN, w, sizeof particle->angular_velocity);
    else to_body(a, w, numbers + CLUSTER_SPIN);
    for (size_t k = 0; k < shape->sphere_count; k++) {
        const vector4 r = cluster_offset(shape, k, a, 1);
        dem_placed_particle sphere = *particle;
        for (int c = 0; c < 3; c++) {
            const int d = (c + 1) % 3, e = (c + 2) % 3;
            sphere.position[c] += r[c];
            sphere.velocity[c] += w[d] * r[e] - w[e] * r[d];
        }
        sphere.position[2] = wrap_axial(sphere.position[2], vessel->period, vessel->inverse_period);
        place_sphere(to, (size_t)body->first_sphere + k, &sphere);
    }
}

/* Each particle takes the next id of its species. False: there are not as many of each as the definition has. */
static bool place_all(const dem_scene *scene, const placing_arrays *to, const dem_placed_particle *particles, size_t count)
{
    const spheres *s = &scene->spheres;
    size_t next[DEM_MAXIMUM_SPECIES] = { 0 }, end[DEM_MAXIMUM_SPECIES] = { 0 };
    for (size_t p = 0; p < particles_count(s); p++) {
        const int32_t k = particle_species(s, p);
        if (end[k] == 0) next[k] = p;
        end[k] = p + 1;
    }
    if (count != particles_count(s)) return false;
    for (size_t k = 0; k < count; k++) {
        const int32_t species = particles[k].species;
        if (species < 0 || (size_t)species >= scene->definition.species_count || next[species] >= end[species]) return false;
        const size_t p = next[species]++;
        dem_placed_particle wrapped = particles[k];
        wrapped.position[2] = wrap_axial(wrapped.position[2], scene->container.period, scene->container.inverse_period);
        if (to->radius && p < s->single_count && wrapped.diameter > 0) to->radius[p] = 0.5 * wrapped.diameter;
        if (p < s->single_count) place_sphere(to, p, &wrapped);
        else place_cluster(to, s, &scene->container, p - s->single_count, &wrapped);
    }
    return true;
}

static double *numbers_of(const dem_state *state, const char *name, size_t columns)
{
    const dem_state_array *found = state_find(state, name, DEM_FLOAT64, columns);
    return found ? found->data : NULL;
}

dem_status dem_scene_place(dem_scene *scene, const dem_placed_particle *particles, size_t count, double turned)
{
    dem_state state;
    dem_status status = dem_scene_save(scene, &state);
    if (status != DEM_OK) return status;
    const placing_arrays to = { numbers_of(&state, "position", 3), numbers_of(&state, "velocity", 3),
                                numbers_of(&state, "angular_velocity", 3), numbers_of(&state, "cluster", CLUSTER_NUMBERS),
                                numbers_of(&state, "radius", 1) };
    assert(to.position && to.velocity && to.spin);
    int64_t *counter = state_find(&state, "counters", DEM_INT64, STATE_INTEGERS)->data;
    counter[STATE_PHASE] = DEM_PHASE_RUNNING;
    counter[STATE_STEP] = counter[STATE_PHASE_START] = counter[STATE_RUN_START] = counter[STATE_STEPS_BEFORE] = 0;
    numbers_of(&state, "numbers", STATE_NUMBERS)[STATE_ANGLE_BEFORE] = turned;
    status = place_all(scene, &to, particles, count) ? dem_scene_restore(scene, &state) : DEM_STATE_MISMATCH;
    dem_state_clear(&state);
    return status;
}
