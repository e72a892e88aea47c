/* The pick of the inner list from the outer one: the pairs that can touch before the next pick, and the contacts with walls,
 * with what each remembers. */
#include "neighbor_pick.h"

#include "array.h"
#include "contact_constants.h"
#include "wall_reach.h"

static size_t begin_of_part(const neighbor_list *list, const spheres *s, int part, int parts)
{
    return contact_parts_begin(&list->parts, s->mobile_count, part, parts);
}

/* Which of LANES pairs can touch within `duration` (s), as bits. Both spheres may stray by `margin` from straight paths, and by
 * `apart` (m) from where they are at one moment (waves).
 *
 * With the centres r apart now, the distance never becomes less than r + duration * (parting speed); the pair can touch only if
 * that is at most the reach, the sum of the radii and of the gap that cohesion bridges, plus twice the margin. Multiplied by r, and with r * reach replaced by its
 * bound (r^2 + reach^2)/2 to avoid a root, the condition is r^2 + 2 duration (dv.x) <= reach^2, in ring units. It is computed
 * with the rounding of contacts, for which the reach is widened. */
static uint32_t pairs_in_reach(const neighbor_list *list, const spheres *s, size_t pair, double duration, double apart)
{
    enum { AHEAD = 4 * LANES };
    for (size_t k = pair + AHEAD; s->are_many && k < pair + AHEAD + LANES && k < list->outer.pair_count; k++)
        __builtin_prefetch(&s->row[list->outer.second[k]]);
    const int32_t *const first = list->outer.first + pair, *const second = list->outer.second + pair;
    const wide_rows p = wide_rows_of_pairs(s->row, first, second);
    wide x[3];
    for (int c = 0; c < 3; c++) x[c] = __builtin_convertvector(p.place[c], wide);
    const wide parting = wide_lesser(wide_dot(p.v, x), wide_all(0));
    const wide nearest2 = wide_fused(wide_all((real)(2 * duration * s->ring_units)), parting, wide_dot(x, x));
    /* at full size, also while they grow */
    const double units = (1 + 4e-6) * s->ring_units;
    const wide radii = list->pairs.constants == CONSTANTS_OF_ALL
                           ? wide_all((real)(2 * units * (double)s->full_radius[0]))
                           : (wide_rests_load(s->rest, first).radius + wide_rests_load(s->rest, second).radius)
                                 * wide_all((real)(units / s->scale));
    const wide reach = radii + wide_all((real)(units * (2 * (list->margin + apart) + list->table.gap)));
    return wide_mask_bits(wide_exceeds(reach * reach, nearest2));
}

/* The input of a pick, and what its parts find. */
typedef struct pick_work {
    neighbor_list *list;
    const spheres *spheres;
    const container *vessel;
    const dem_contact_parameters *contact;
    species_roots roots;
    wall_outlook ahead;
    double apart;    /* m: pairs_in_reach */
    bool same_outer; /* as at the pick before */
    /* First, of each part, the number of pairs in reach now (now) and at the pick before (was), and of contacts with walls
     * (walls). starts_of_parts then turns each count into the sum over the parts before it: where the part begins. */
    size_t now[MOST_PARTS + 1], was[MOST_PARTS + 1], walls[MOST_PARTS + 1];
} pick_work;

/* Index of a part's first group of LANES pairs in the outer list. */
static size_t begin_of_groups(const pick_work *work, int part, int parts)
{
    const neighbor_list *const list = work->list;
    return part < parts ? list->outer.start[begin_of_part(list, work->spheres, part, parts)] / LANES
                        : (list->outer.pair_count + LANES - 1) / LANES;
}

static void mark_in_reach(void *context, int part, int parts)
{
    pick_work *const work = context;
    neighbor_list *const list = work->list;
    const spheres *const s = work->spheres;
    size_t now = 0, was = 0;
    const size_t end = begin_of_groups(work, part + 1, parts);
    for (size_t g = begin_of_groups(work, part, parts); g < end; g++) {
        list->outer.in_reach[g] = (uint16_t)pairs_in_reach(list, s, g * LANES, work->ahead.duration, work->apart);
        now += (size_t)__builtin_popcount(list->outer.in_reach[g]);
        if (work->same_outer) was += (size_t)__builtin_popcount(list->outer.was_in_reach[g]);
    }
    work->now[part] = now;
    work->was[part] = was;
    const size_t from = begin_of_part(list, s, part, parts), to = begin_of_part(list, s, part + 1, parts);
    wall_reach_count(s, work->vessel, work->ahead, from, to, list->wall_start + 1);
    uint32_t walls = 0;
    for (size_t i = from; i < to; i++) list->wall_start[i + 1] = walls += list->wall_start[i + 1];
    work->walls[part] = walls;
    for (size_t i = from; i < to; i++) memcpy(&list->picked_velocity[i], s->row[i].v, sizeof *list->picked_velocity);
}

/* Replaces the count of each part by the sum of the counts before it. Returns the sum of all. */
static size_t starts_of_parts(size_t *count, int parts)
{
    size_t sum = 0;
    for (int p = 0; p <= parts; p++) {
        const size_t here = p < parts ? count[p] : 0;
        count[p] = sum;
        sum += here;
    }
    return sum;
}

static dem_status wall_rows_reserve(neighbor_list *list)
{
    const size_t needed = round_up_to_block(list->walls.count);
    if (needed > list->wall_row_capacity) {
        contact_row *rows = array_create(needed + needed / 4, sizeof *rows);
        double *torques = array_create(needed + needed / 4, sizeof *torques);
        if (!rows || !torques) {
            free(rows);
            free(torques);
            return DEM_NO_MEMORY;
        }
        free(list->wall_rows);
        free(list->wall_torques);
        list->wall_rows = rows;
        list->wall_torques = torques;
        list->wall_row_capacity = needed + needed / 4;
    }
    list->walls.row = list->wall_rows;
    return DEM_OK;
}

/* Writes a part's pairs in reach, in the order of the outer list. If the outer list is the one of the last pick, the bits of then
 * and of now tell where each pair's history is, and histories are carried along; else contact_list_carry looks them up. */
static void pick_pairs(const pick_work *work, int part, int parts)
{
    neighbor_list *const list = work->list;
    real *const *const to = list->pairs.memory, *const *const from = list->pairs_before.memory;
    const int numbers = work->same_outer ? contact_list_numbers(&list->pairs) : 0;
    size_t at = work->now[part], old = work->was[part];
    /* Vectors are written whole, also where only the first lanes count: the last ones, which reach into the next part, aside. */
    real aside[CONTACT_NUMBERS][LANES];
    int32_t first_aside[LANES], second_aside[LANES];
    const size_t end = begin_of_groups(work, part + 1, parts);
    for (size_t g = begin_of_groups(work, part, parts); g < end; g++) {
        const uint32_t now = list->outer.in_reach[g], was = list->outer.was_in_reach[g];
        const size_t count = (size_t)__builtin_popcount(now);
        const bool is_aside = part + 1 < parts && at + LANES > work->now[part + 1];
        const wide_move move = wide_move_of(now, was);
        for (int m = 0; m < numbers; m++) wide_carry(is_aside ? aside[m] : to[m] + at, &move, from[m] + old);
        wide_compress(is_aside ? second_aside : list->pairs.second + at, now, list->outer.second + g * LANES);
        wide_compress(is_aside ? first_aside : list->pairs.first + at, now, list->outer.first + g * LANES);
        for (int m = 0; is_aside && m < numbers; m++) memcpy(to[m] + at, aside[m], count * sizeof *to[m]);
        if (is_aside) {
            memcpy(list->pairs.second + at, second_aside, count * sizeof *second_aside);
            memcpy(list->pairs.first + at, first_aside, count * sizeof *first_aside);
        }
        at += count;
        old += (size_t)__builtin_popcount(was);
    }
}

/* A part's contacts with walls. */
static void fill_walls(const pick_work *work, int part, int parts)
{
    neighbor_list *const list = work->list;
    const spheres *const s = work->spheres;
    const size_t from = begin_of_part(list, s, part, parts), to = begin_of_part(list, s, part + 1, parts);
    const uint32_t before = (uint32_t)work->walls[part];
    for (size_t i = from, slot = before; i < to; i++) {
        const size_t end = list->wall_start[i + 1] += before;
        if (slot < end) wall_reach_fill(&list->walls, slot, end, s, work->vessel, &list->table, work->ahead, i);
        slot = end;
    }
    contact_list_carry(&list->walls, &list->walls_before, work->walls[part], work->walls[part + 1]);
}

/* Fills a part's share of the new lists of pairs and of walls. */
static void make_contacts(void *context, int part, int parts)
{
    const pick_work *const work = context;
    neighbor_list *const list = work->list;
    const spheres *const s = work->spheres;
    const size_t first = work->now[part], end = work->now[part + 1];
    pick_pairs(work, part, parts);
    if (list->pairs.constants == CONSTANTS_OF_EACH)
        contact_constants_of_each(&list->pairs, s, work->contact, &work->roots, &list->table, first, end);
    if (!work->same_outer) contact_list_carry(&list->pairs, &list->pairs_before, first, end);
    fill_walls(work, part, parts);
    if (part + 1 < parts) return;
    contact_list_pad(&list->pairs, sphere_of_zeros(s), sphere_far_away(s));
    contact_list_pad(&list->walls, sphere_of_zeros(s), 0);
}

dem_status neighbor_list_pick(neighbor_list *list, spheres *s, const container *vessel, const dem_contact_parameters *contact,
                              double time_step, int threads)
{
    const int parts = team_parts(threads);
    const double duration = list->safe_steps * time_step;
    pick_work work = {
        .list = list, .spheres = s, .vessel = vessel, .contact = contact, .ahead = { duration, list->margin + list->table.gap }
    };
    if (list->pairs.constants == CONSTANTS_OF_EACH) species_roots_set(&work.roots, s);
    work.apart = list->steps_apart * time_step * list->at_pick.largest_speed;
    work.same_outer = list->picked_of == list->outer.builds;
    contact_list_swap(&list->pairs, &list->pairs_before);
    contact_list_swap(&list->walls, &list->walls_before);
    uint16_t *const was = list->outer.in_reach;
    list->outer.in_reach = list->outer.was_in_reach;
    list->outer.was_in_reach = was;
    team_run(parts, mark_in_reach, &work);
    const size_t count = starts_of_parts(work.now, parts);
    starts_of_parts(work.was, parts);
    const size_t wall_count = starts_of_parts(work.walls, parts);
    list->wall_start[0] = 0;
    /* whole vectors are read and written, also at the end */
    if (contact_list_reserve(&list->pairs, count + LANES) != DEM_OK || contact_list_reserve(&list->walls, wall_count) != DEM_OK) {
        contact_list_swap(&list->pairs, &list->pairs_before); /* what contacts remember is there */
        contact_list_swap(&list->walls, &list->walls_before);
        return DEM_NO_MEMORY;
    }
    list->pairs.count = count;
    list->walls.count = wall_count;
    team_run(parts, make_contacts, &work);
    if (list->pairs.constants == CONSTANTS_OF_ALL) contact_constants_of_all(&list->pairs, s, contact, &list->table);
    list->picked_of = list->outer.builds;
    /* The lining's paths are arcs: they leave their straight paths by this much at most. */
    list->strayed =
        s->lining_count ? 0.5 * vessel->rotation_rate * vessel->rotation_rate * vessel->radius * duration * duration : 0.0;
    list->deviation = 0.0;
    list->steps_since_pick = 0;
    list->inner_valid = true;
    list->inner_picks++;
    const dem_status status = wall_rows_reserve(list);
    const int dealt_to = list->stays_whole ? 1 : threads;
    return status == DEM_OK ? contact_parts_deal(&list->parts, &list->pairs, list->wall_start, s, dealt_to) : status;
}
