#include "neighbor_list.h"

#include <stdbool.h>

#include "array.h"
#include "dem_rules.h"
#include "neighbor_pick.h"

/* Shares of the smallest diameter, chosen by measurement: core/NUMERICS.md, "Neighbor lists". */
static const double SKIN = 0.4, LEAST_MARGIN = 0.0001, FIRST_MARGIN = 0.006, MOST_MARGIN = 0.02;

dem_status neighbor_list_init(neighbor_list *list, const spheres *s, const dem_scene_definition *definition)
{
    memset(list, 0, sizeof *list);
    list->margin = FIRST_MARGIN * s->smallest_diameter;
    list->least_margin = LEAST_MARGIN * s->smallest_diameter;
    list->most_margin = MOST_MARGIN * s->smallest_diameter;
    const bool has_rolling = dem_has_rolling_friction(definition);
    bool ends_differ = has_rolling, alike = s->lining_count == 0;
    for (size_t i = 1; i < spheres_count(s); i++) ends_differ = ends_differ || s->full_radius[i] != s->full_radius[0];
    for (size_t i = 1; alike && i < s->mobile_count; i++)
        alike = s->full_radius[i] == s->full_radius[0] && s->species[i] == s->species[0];
    const size_t n = s->mobile_count;
    list->picked_velocity = array_create(n, sizeof *list->picked_velocity);
    list->wall_start = array_create(n + 1, sizeof *list->wall_start);
    contact_parts_init(&list->parts, n);
    pair_table_set(&list->table, definition);
    bool enough = outer_list_init(&list->outer, s, SKIN * s->smallest_diameter + list->table.gap) == DEM_OK && list->picked_velocity
                  && list->wall_start;
    contact_list *const all[] = { &list->pairs, &list->walls, &list->pairs_before, &list->walls_before };
    const bool spheres_differ = pair_table_spheres_differ(&list->table, definition);
    const bool walls_differ = pair_table_walls_differ(&list->table, definition);
    alike = alike && !spheres_differ;
    const contact_constants constants[] = { alike ? CONSTANTS_OF_ALL : CONSTANTS_OF_EACH, CONSTANTS_OF_EACH };
    for (int k = 0; k < 4; k++) {
        const bool laws_differ = k % 2 == 0 ? spheres_differ : walls_differ;
        const bool coheres = (k % 2 == 0 ? pair_table_spheres_cohere : pair_table_walls_cohere)(&list->table, definition);
        const int extras =
            (has_rolling ? CONTACTS_ROLL : 0) + (laws_differ ? CONTACT_LAWS_DIFFER : 0) + (coheres ? CONTACTS_COHERE : 0);
        enough = contact_list_init(all[k], extras, k < 2 ? constants[k] : CONSTANTS_OF_NONE) == DEM_OK && enough;
    }
    list->pairs.ends_differ = ends_differ;
    list->pairs.damped = damped_law_of(&definition->contact, false, definition->time_step);
    list->walls.damped = damped_law_of(&definition->contact, true, definition->time_step);
    list->pairs.latch_damping = list->walls.latch_damping = latch_damping_of(&definition->contact);
    if (enough) return DEM_OK;
    neighbor_list_clear(list);
    return DEM_NO_MEMORY;
}

void neighbor_list_sizes_changed(neighbor_list *list, const spheres *s)
{
    cell_grid_clear(&list->outer.grid);
    cell_grid_init(&list->outer.grid, s);
    neighbor_list_invalidate(list);
}

void neighbor_list_clear(neighbor_list *list)
{
    outer_list_clear(&list->outer);
    free(list->picked_velocity);
    free(list->wall_start);
    free(list->wall_rows);
    free(list->wall_torques);
    contact_parts_clear(&list->parts);
    contact_list_clear(&list->pairs);
    contact_list_clear(&list->pairs_before);
    contact_list_clear(&list->walls);
    contact_list_clear(&list->walls_before);
    memset(list, 0, sizeof *list);
}

void neighbor_list_invalidate(neighbor_list *list)
{
    list->outer.valid = false;
    list->inner_valid = false;
}

void neighbor_list_expire(neighbor_list *list, int steps_apart)
{
    list->inner_valid = false;
    list->steps_apart = steps_apart;
}

/* ---- how long the lists are safe ---- */

static size_t begin_of_part(const neighbor_list *list, const spheres *s, int part, int parts)
{
    return contact_parts_begin(&list->parts, s->mobile_count, part, parts);
}

typedef struct outlook_work {
    const neighbor_list *list;
    const spheres *spheres;
    outlook part[MOST_PARTS]; /* squared, the displacement in ring units */
} outlook_work;

static void outlook_of_part(void *context, int part, int parts)
{
    outlook_work *const work = context;
    const spheres *const s = work->spheres;
    const size_t to = begin_of_part(work->list, s, part + 1, parts);
    double displacement2 = 0.0, speed2 = 0.0;
    for (size_t i = begin_of_part(work->list, s, part, parts); i < to; i++) {
        const vector4 v = s->velocity[i];
        double moved2 = 0.0;
        for (int c = 0; c < 3; c++) {
            const double moved = (double)ring_difference(work->list->outer.built_at[i][c], s->row[i].place[c]);
            moved2 += moved * moved;
        }
        const double v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        displacement2 = moved2 > displacement2 ? moved2 : displacement2;
        speed2 = v2 > speed2 ? v2 : speed2;
    }
    work->part[part] = (outlook){ displacement2, speed2 };
}

static outlook outlook_measure(const neighbor_list *list, const spheres *s, const container *vessel, int threads)
{
    outlook_work work = { .list = list, .spheres = s };
    team_run(team_parts(threads), outlook_of_part, &work);
    outlook out = { 0, 0 };
    for (int p = 0; p < team_parts(threads); p++) {
        out.largest_displacement = fmax(out.largest_displacement, sqrt(work.part[p].largest_displacement) / s->ring_units);
        out.largest_speed = fmax(out.largest_speed, sqrt(work.part[p].largest_speed));
    }
    if (s->lining_count) {
        out.largest_speed = fmax(out.largest_speed, fabs(vessel->rotation_rate) * vessel->radius);
        out.largest_displacement =
            fmax(out.largest_displacement, fabs(vessel->angle - list->outer.angle_at_build) * vessel->radius);
    }
    return out;
}

/* Bounds of now, extrapolated from those of the last pick: the speed of then, times the time since then, adds to the displacement,
 * and the largest deviation from the velocities of then adds to the speed. */
static outlook outlook_since(const neighbor_list *list, double time_step)
{
    const outlook *before = &list->at_pick;
    const double passed = list->steps_since_pick * time_step;
    return (outlook){ before->largest_displacement + before->largest_speed * passed + list->strayed,
                      before->largest_speed + list->deviation };
}

/* Steps for which every pair outside the outer list stays apart, at most HORIZON; 0: not even now. */
static int safe_steps(const neighbor_list *list, const outlook *now, double time_step)
{
    const double room = 0.5 * (list->outer.skin - list->table.gap) - list->margin - now->largest_displacement;
    if (!(room > 0)) return 0;
    return (int)fmin(HORIZON, 1 + room / (now->largest_speed * time_step + 1e-300));
}

/* Chooses the next margin: how far spheres would stray in a whole horizon if they went on as since the last pick, and a fifth more.
 * A wider margin lists pairs that do not touch; with a narrower one the list is picked too often. */
static void choose_margin(neighbor_list *list)
{
    if (!list->inner_valid || list->steps_since_pick == 0) return;
    const double ahead = 1.2 * list->strayed / list->steps_since_pick * HORIZON;
    list->margin = fmax(list->least_margin, fmin(ahead, list->most_margin));
}

dem_status neighbor_list_update(neighbor_list *list, spheres *s, const container *vessel, const dem_contact_parameters *contact,
                                double time_step, int threads, bool *looked)
{
    *looked = false;
    if (list->inner_valid && list->steps_since_pick < list->safe_steps && list->strayed <= list->margin) return DEM_OK;

    *looked = list->inner_picks % PICKS_BETWEEN_LOOKS == 0;
    choose_margin(list);
    outlook now = outlook_since(list, time_step);
    int steps = list->inner_valid ? safe_steps(list, &now, time_step) : 0;
    if (steps < HORIZON) {
        now = outlook_measure(list, s, vessel, threads);
        steps = list->outer.valid ? safe_steps(list, &now, time_step) : 0;
        *looked = true;
    }
    if (steps < HORIZON) {
        const dem_status status = outer_list_build(&list->outer, s, vessel, &list->parts, threads);
        if (status != DEM_OK) {
            neighbor_list_invalidate(list);
            return status;
        }
        now.largest_displacement = 0.0;
        steps = safe_steps(list, &now, time_step);
    }
    list->at_pick = now;
    /* Right after a build, the step at hand is safe whatever the speed. */
    list->safe_steps = steps > 1 ? steps : 1;
    const dem_status status = neighbor_list_pick(list, s, vessel, contact, time_step, threads);
    if (status != DEM_OK) neighbor_list_invalidate(list);
    return status;
}

void neighbor_list_count_contacts(const neighbor_list *list, const spheres *s, const container *vessel, const int32_t *id,
                                  int32_t *contacts)
{
    memset(contacts, 0, s->mobile_count * sizeof *contacts);
    for (size_t k = 0; k < list->pairs.count; k++) {
        const int32_t i = list->pairs.first[k], j = list->pairs.second[k];
        const double radii = sphere_radius(s, (size_t)i) + sphere_radius(s, (size_t)j);
        if (squared_distance(sphere_place(s, (size_t)i), sphere_place(s, (size_t)j), vessel->period, vessel->inverse_period)
            >= radii * radii)
            continue;
        contacts[id ? id[i] : i]++;
        if ((size_t)j < s->mobile_count) contacts[id ? id[j] : j]++;
    }
    for (size_t k = 0; k < list->walls.count; k++) {
        const int32_t i = list->walls.first[k];
        const container_wall *w = &vessel->wall[list->walls.second[k]];
        contacts[id ? id[i] : i] += wall_seen_from(w, sphere_place(s, (size_t)i)).distance < sphere_radius(s, (size_t)i);
    }
}
