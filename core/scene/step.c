/* The step:
 *     neighbor lists, made again when a displacement asks for it; contact history carried over
 *     forces of contacts between spheres and with the container, summed for each; single spheres that have all theirs take
 *         their step; now and then, those with the container before all others, and a look at the drum's torque
 *     each cluster's sum over its spheres; velocities and positions (Eqns 3, 4), spins and orientations (Eqns 5-23)
 *     what fell off a plate is laid aside; what is due of a stream enters
 *     the container moves; the phase may change
 */
#include "step.h"

#include "array.h"
#include "contact_forces.h"
#include "failure.h"
#include "filling.h"
#include "lost.h"
#include "sorting.h"
#include "step_profile.h"
#include "stream.h"
#include "team.h"
#include "wall_forces.h"
#include "wave.h"

dem_status scene_update_neighbors(dem_scene *scene)
{
    bool looked;
    const dem_status status = neighbor_list_update(&scene->neighbors, &scene->spheres, &scene->container, &scene->contact,
                                                   scene->definition.time_step, scene->definition.threads, &looked);
    if (status != DEM_OK) return failure_of_memory(scene);
    return looked ? failure_check_places(scene) : DEM_OK;
}

static dem_status step_neighbors(dem_scene *scene)
{
    const int64_t outer_builds = scene->neighbors.outer.builds;
    const dem_status status = scene_update_neighbors(scene);
    step_profile_lap(scene->profile, scene->neighbors.outer.builds > outer_builds ? DEM_PART_OUTER_LIST : DEM_PART_INNER_LIST);
    return status;
}

static bool torque_is_due(const dem_scene *scene)
{
    return scene->phase == DEM_PHASE_RUNNING && (scene->step_count - scene->run_start) % STEPS_BETWEEN_TORQUES == 0;
}

/* While the places are those of the forces: with a lining once all loads are there, else from the walls alone. */
static void look_at_torque(dem_scene *scene, bool has_loads)
{
    const bool is_due = torque_is_due(scene), is_lined = scene->spheres.lining_count > 0;
    if (is_lined != has_loads || (!is_due && !(scene->audit.is_on && scene->phase == DEM_PHASE_RUNNING))) return;
    const double torque = is_lined ? energy_torque_of_loads(&scene->spheres) : wall_torque(&scene->neighbors);
    if (scene->audit.is_on) scene->audit.wall_work += scene->definition.time_step * scene->container.rotation_rate * torque;
    if (!is_due) return;
    scene->torque.sum += torque;
    scene->torque.count += 1;
}

/* largest: m, of the step; since: s, for which single spheres have moved on since. */
static dem_status look_at_overlaps(dem_scene *scene, double largest, double since)
{
    scene->maximum_overlap = fmax(scene->maximum_overlap, largest);
    return largest > failure_least_overlap(scene) ? failure_check_overlaps(scene, since) : DEM_OK;
}

/* leap: those spheres that have all their forces move at once, while the processor has them at hand; NULL: none. */
static dem_status step_contacts(dem_scene *scene, const leap_frog *leap, vector4 *strayed)
{
    const double dt = scene->definition.time_step;
    neighbor_list *list = &scene->neighbors;
    spheres *s = &scene->spheres;
    const bool walls_first = !leap || torque_is_due(scene);
    double largest = walls_first ? contact_forces_with_walls(list, s, &scene->container, &scene->contact, dt) : 0.0;
    step_profile_lap(scene->profile, DEM_PART_WALLS);
    if (walls_first) look_at_torque(scene, false);
    const double between =
        contact_forces_between_spheres(list, s, walls_first ? NULL : &scene->container, &scene->contact, dt, leap, strayed);
    step_profile_lap(scene->profile, DEM_PART_PAIRS);
    return look_at_overlaps(scene, fmax(largest, between), leap ? dt : 0.0);
}

/* Half a step's work: once with the velocities before the forces act, once with those after. */
static void audit_half_step(dem_scene *scene, const row8 *load)
{
    scene->audit.contact_work += 0.5 * scene->definition.time_step * energy_contact_power(&scene->spheres, load);
}

static body_forces forces_of_phase(const dem_scene *scene)
{
    const container *const vessel = &scene->container;
    body_forces body = { .gravity = scene->definition.gravity,
                         .scale = 1,
                         .up = vessel->up,
                         .period = vessel->period,
                         .inverse_period = vessel->inverse_period };
    switch (scene->phase) {
    case DEM_PHASE_GROWING:
        body.gravity = 0.0;
        body.drag = scene->filling.growing_drag;
        body.scale = filling_scale(&scene->filling, scene->step_count + 1 - scene->phase_start);
        break;
    case DEM_PHASE_SETTLING: body.drag = scene->filling.settling_drag; break;
    case DEM_PHASE_RUNNING: break;
    }
    return body;
}

static void move_container(dem_scene *scene)
{
    if (scene->phase != DEM_PHASE_RUNNING) return;
    const bool another_velocity = container_move(&scene->container, &scene->definition, true, scene_time_in_motion(scene));
    if (another_velocity) neighbor_list_invalidate(&scene->neighbors);
    container_rotate_lining(&scene->container, &scene->spheres);
}

static void next_phase(dem_scene *scene, dem_phase phase)
{
    scene->phase_start = scene->step_count;
    if (phase == DEM_PHASE_RUNNING) {
        scene->run_start = scene->step_count;
        scene->maximum_overlap = 0.0;
    }
    scene_enter_phase(scene, phase);
}

static dem_status continue_settling(dem_scene *scene)
{
    const filling *f = &scene->filling;
    const int64_t steps = scene->step_count - scene->phase_start;
    if (steps < f->settling_steps_least || steps % STEPS_BETWEEN_RESTS) return DEM_OK;
    const double energy = spheres_kinetic_energy(&scene->spheres);
    if (energy < f->rest_energy) next_phase(scene, DEM_PHASE_RUNNING);
    else if (steps > f->settling_steps_most) return failure_of_settling(scene, energy);
    return DEM_OK;
}

static dem_status continue_phase(dem_scene *scene)
{
    const filling *f = &scene->filling;
    const int64_t steps = scene->step_count - scene->phase_start;
    switch (scene->phase) {
    case DEM_PHASE_GROWING:
        spheres_set_scale(&scene->spheres, filling_scale(f, steps));
        if (steps >= f->growing_steps) next_phase(scene, DEM_PHASE_SETTLING);
        return DEM_OK;
    case DEM_PHASE_SETTLING: return continue_settling(scene);
    case DEM_PHASE_RUNNING: break;
    }
    return DEM_OK;
}

/* The motion, and what is looked at between it and the forces. Returns integrator_advance's bound. */
static double step_motion(dem_scene *scene, const leap_frog *leap, size_t moved, vector4 so_far)
{
    spheres *s = &scene->spheres;
    row8 *load = NULL;
    look_at_torque(scene, true);
    if (scene->audit.is_on && (load = array_create(s->mobile_count, sizeof *load))) {
        memcpy(load, s->load, s->mobile_count * sizeof *load);
        audit_half_step(scene, load);
    }
    step_profile_lap(scene->profile, DEM_PART_CONTAINER);
    const double deviation =
        integrator_advance(s, scene->neighbors.picked_velocity, leap, moved, so_far, scene->definition.threads);
    step_profile_lap(scene->profile, DEM_PART_MOTION);
    if (load) audit_half_step(scene, load);
    free(load);
    return deviation;
}

/* What follows the motion. */
static dem_status finish_step(dem_scene *scene, double deviation)
{
    neighbor_list_step_done(&scene->neighbors, deviation, scene->definition.time_step);
    lost_hold(scene);
    scene->step_count++;
    lost_look(scene);
    stream_enter(scene);
    move_container(scene);
    return continue_phase(scene);
}

static dem_status one_step(dem_scene *scene)
{
    const bool looks = scene->profile || scene->audit.is_on || (torque_is_due(scene) && scene->spheres.lining_count > 0);
    vector4 so_far = { 0 };
    dem_status status = step_contacts(scene, looks ? NULL : &scene->leap, &so_far);
    if (status != DEM_OK) return status;
    const double deviation = step_motion(scene, &scene->leap, looks ? 0 : scene->spheres.single_count, so_far);
    status = finish_step(scene, deviation);
    step_profile_lap(scene->profile, DEM_PART_CONTAINER);
    return status;
}

/* The next steps as one wave. Apart: a wave's stages need not be in the way of the stack of single steps. */
__attribute__((noinline)) static dem_status several_steps(dem_scene *scene, int steps)
{
    const double dt = scene->definition.time_step;
    const bool walls_first = torque_is_due(scene);
    const double of_walls =
        walls_first ? contact_forces_with_walls(&scene->neighbors, &scene->spheres, &scene->container, &scene->contact, dt) : 0.0;
    look_at_torque(scene, false);
    wave w;
    wave_begin(&w, scene, steps, walls_first);
    wave_run(&w);
    dem_status status = DEM_OK;
    for (int k = 0; k < steps && status == DEM_OK; k++) {
        if (k == w.whole) neighbor_list_expire(&scene->neighbors, steps - w.whole);
        if (k >= w.whole) {
            status = scene_update_neighbors(scene);
            if (status != DEM_OK) break;
            wave_resume(&w, k);
        }
        status = look_at_overlaps(scene, fmax(wave_largest_overlap(&w, k), k == 0 ? of_walls : 0.0), dt);
        if (status == DEM_OK) status = finish_step(scene, wave_deviation(&w, k));
    }
    scene->neighbors.steps_apart = 0;
    return status;
}

typedef struct advance {
    dem_scene *scene;
    int64_t steps;
    bool to_rotation; /* at the furthest */
} advance;

static dem_status advance_scene(void *context)
{
    const advance *a = context;
    dem_scene *const scene = a->scene;
    for (int64_t k = 0; k < a->steps && !(a->to_rotation && scene->phase == DEM_PHASE_RUNNING);) {
        step_profile_begin(scene->profile);
        dem_status status = sorting_look(scene) == DEM_OK ? step_neighbors(scene) : failure_of_memory(scene);
        if (status != DEM_OK) return status;
        const body_forces body = forces_of_phase(scene);
        integrator_leap(&scene->leap, &scene->spheres, &body, scene->definition.time_step);
        const int steps = wave_length(scene, a->steps - k);
        status = steps > 1 ? several_steps(scene, steps) : one_step(scene);
        if (status != DEM_OK) return status;
        k += steps;
    }
    /* Whoever looks at the scene now finds lists that hold for the present places. */
    step_profile_begin(scene->profile);
    return step_neighbors(scene);
}

dem_status dem_scene_advance(dem_scene *scene, int64_t steps)
{
    return team_gather(scene->definition.threads, advance_scene, &(advance){ scene, steps, false });
}

dem_status dem_scene_advance_to_run(dem_scene *scene, int64_t steps)
{
    return team_gather(scene->definition.threads, advance_scene, &(advance){ scene, steps, true });
}
