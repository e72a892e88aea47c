/* One time step: the simple algorithm, then each way in which the code departs from it to be fast.
 *
 * The simple algorithm, as the paper has it:
 *
 *     1. Bring the neighbor lists up to date; contacts keep their histories                          (step_neighbors).
 *     2. Compute the force of every contact, between spheres and with walls, from the places and velocities of now, and
 *        add it to the loads of the spheres that it acts on                                          (step_contacts).
 *     3. Add up the loads of each cluster's spheres; advance velocities and places (Eqns 3, 4), spins and orientations
 *        (Eqns 5-23); set the loads to zero                                                          (step_motion).
 *     4. Set aside the particles that fell off a plate; let the stream's next particles in; move the container; change
 *        the phase when that is due                                                                  (finish_step).
 *
 * One invariant holds for all that follows: each sphere's load is one running sum, over its contacts with spheres in the
 * order of the list and then over its contacts with walls (contact_list.h), and every force is computed from the places
 * and velocities of one moment. Therefore each departure gives the same bits as the simple algorithm.
 *
 * Parts (contact_parts.h). Each thread computes one part: whole blocks of the list, and all loads of a range of spheres.
 *     Invariant: a thread writes to the loads and rows of its own spheres alone; a contact between spheres of two parts is
 *     computed by both. Results of parts are combined only by operations whose order does not matter, such as a maximum.
 *     Switch: definition.threads > 1.
 * Halo (contact_parts.h). A part reads the spheres of other parts from copies of their rows. There are two sets of copies,
 *     which alternate (spheres.front_copy): a step reads one set while spheres that move early are written to the other.
 *     Invariant: the front set equals the rows of now whenever spheres.copies_hold is true. Whoever changes a row outside
 *     the early motion sets it to false (sphere_set does so), and the next step copies all shared rows again.
 *     Switch: with several parts, always.
 * Walls on the way (contact_forces.c, spheres_complete). The contacts of some spheres with walls are computed when these
 *     spheres have all their other forces, while they are in the cache, not before all others.
 *     Invariant: a contact with a wall reads its own sphere and the wall, nothing else.
 *     Switch: step_contacts, walls_first. When the torque is due, all walls come first, because the torque is of one moment.
 * Early motion (contact_forces.c, spheres_complete). A single sphere takes its step inside step 2, as soon as its load is
 *     complete. Spheres of clusters wait for step 3.
 *     Invariant: no contact that is still to be computed in this step reads the sphere's row. That follows from the order
 *     of the list: the first sphere of a contact is before the second in memory, and first spheres ascend.
 *     Switch: one_step passes no `leap` to step_contacts when something has to see all loads, or all spheres, between the
 *     forces and the motion: `looks`.
 * Waves (wave.h). Up to HORIZON steps of a very large bed are taken in one pass through memory; threads share the steps, not
 *     the spheres.
 *     Invariant: between two steps of one wave nothing changes but the spheres' motion; all else is the same in each.
 *     Switch: wave_length is more than 1; wave_is_possible in wave.c gives the conditions and their reasons.
 * Prefetch (contact_forces.c, neighbor_pick.c, wall_forces.c, integrator.c). What the next contacts read is loaded into the
 *     cache in advance. Invariant: it changes no result. Switch: spheres.are_many, spheres.exceed_caches.
 *
 * Whoever adds something to the step keeps this:
 *   - A new force belongs to the passes of contact_block.h. A contact in reach that does not touch gives exact zeros; what
 *     the padding of a list gives may be NaN and is never read. What a contact remembers is a number in contact_history.
 *   - What needs all places, velocities or loads of one moment between forces and motion joins `looks` in one_step and
 *     the conditions of wave_is_possible. What looks at the scene every so many steps bounds wave_length instead.
 *   - What changes spheres, walls, masses or parameters from one step to the next joins the conditions of wave_is_possible; the
 *     test of waves has a list of all such effects, and holds runs with and without waves to the same bits.
 *   - A bound for the lists: if something moves spheres or walls otherwise than by integrator_advance, it calls
 *     neighbor_list_invalidate, or its speed is in neighbor_list.c's bounds.
 *   - No sum runs over parts, and nothing depends on when a list was made or on how many threads there are.
 *   - What is kept for each sphere has a row in sphere_arrays, so that it is sorted, saved and restored with the sphere.
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
    scene->neighbors.stays_whole = wave_is_possible(scene);
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

/* Adds to the torque's mean and to the audit's work of the walls, while the places are still those that the forces were
 * computed at. With a lining the torque is summed from all loads; without one, from the contacts with walls alone.
 * has_loads: the call comes when all loads are complete; the other call of the step comes when the walls' rows are. */
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

/* largest: m, the largest overlap of the step. since: s, by which single spheres have moved on since the forces were
 * computed. Errors: DEM_OVERLAP_TOO_LARGE. */
static dem_status look_at_overlaps(dem_scene *scene, double largest, double since)
{
    scene->maximum_overlap = fmax(scene->maximum_overlap, largest);
    return largest > failure_least_overlap(scene) ? failure_check_overlaps(scene, since) : DEM_OK;
}

/* leap: single spheres move early, as soon as their loads are complete; NULL: no sphere does. strayed: becomes what
 * spheres_advance returns for those that moved. */
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

/* Adds half of the work that the contacts do in this step. It is called twice: with the velocities from before the forces
 * act, and with those from after. */
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

/* The motion, and between it and the forces the torque and the audit of energy. moved: the single spheres that have moved
 * early; so_far: what spheres_advance returned for them. Returns integrator_advance's bound on how fast velocities have
 * left those of the pick, m/s. */
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

/* What follows the motion. Whatever is added here happens between two steps of a wave, too: see wave_is_possible in wave.c.
 * deviation: m/s, as step_motion returns it. */
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

/* The next steps as one wave. After the pass, the end of each step is done in order. From step w.whole on the list no longer
 * holds: it is picked anew, and each later step is resumed from where the wave left it. Not inlined, so that the large wave
 * is not on the stack of single steps. */
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
    bool to_rotation; /* stop where the running phase begins, even if steps are left */
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
    /* The caller may look at the scene now: its lists hold for the present places. */
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
