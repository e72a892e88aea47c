#include "neighbor_list.h"

#include <stdbool.h>

#include "array.h"
#include "contact_constants.h"
#include "dem_rules.h"
#include "wall_reach.h"

/* Shares of the smallest diameter, chosen by measurement: core/NUMERICS.md, "Neighbor lists". */
static const double SKIN = 0.4, LEAST_MARGIN = 0.0001, FIRST_MARGIN = 0.006, MOST_MARGIN = 0.02;

dem_status neighbor_list_init(neighbor_list *list, const spheres *s, const dem_drum_definition *definition)
{
    memset(list, 0, sizeof *list);
    list->skin = SKIN * s->smallest_diameter;
    list->margin = FIRST_MARGIN * s->smallest_diameter;
    list->least_margin = LEAST_MARGIN * s->smallest_diameter;
    list->most_margin = MOST_MARGIN * s->smallest_diameter;
    const bool has_rolling = dem_has_rolling_friction(definition);
    bool ends_differ = has_rolling, alike = s->lining_count == 0;
    for (size_t i = 1; i < spheres_count(s); i++) ends_differ = ends_differ || s->full_radius[i] != s->full_radius[0];
    for (size_t i = 1; alike && i < s->mobile_count; i++)
        alike = s->full_radius[i] == s->full_radius[0] && s->species[i] == s->species[0];
    cell_grid_init(&list->grid, s);
    const size_t n = s->mobile_count;
    list->start = array_create(n + 1, sizeof *list->start);
    list->farthest = array_create(n / STRETCH + 1, sizeof *list->farthest);
    list->built_at = array_create(n, sizeof *list->built_at);
    list->picked_velocity = array_create(n, sizeof *list->picked_velocity);
    list->wall_start = array_create(n + 1, sizeof *list->wall_start);
    contact_parts_init(&list->parts, n);
    bool enough = list->start && list->farthest && list->built_at && list->picked_velocity && list->wall_start;
    contact_list *const all[] = { &list->pairs, &list->walls, &list->pairs_before, &list->walls_before };
    const contact_constants constants[] = { alike ? CONSTANTS_OF_ALL : CONSTANTS_OF_EACH, CONSTANTS_OF_EACH };
    for (int k = 0; k < 4; k++)
        enough = contact_list_init(all[k], has_rolling, k < 2 ? constants[k] : CONSTANTS_OF_NONE) == DEM_OK && enough;
    list->pairs.ends_differ = ends_differ;
    list->pairs.damped = damped_law_of(&definition->contact, false, definition->time_step);
    list->walls.damped = damped_law_of(&definition->contact, true, definition->time_step);
    list->pairs.latch_damping = list->walls.latch_damping = latch_damping_of(&definition->contact);
    if (enough) return DEM_OK;
    neighbor_list_clear(list);
    return DEM_NO_MEMORY;
}

void neighbor_list_clear(neighbor_list *list)
{
    free(list->start);
    free(list->first);
    free(list->second);
    free(list->farthest);
    for (int p = 0; p < MOST_PARTS; p++) free(list->part[p].second);
    free(list->in_reach);
    free(list->was_in_reach);
    free(list->built_at);
    free(list->picked_velocity);
    free(list->wall_start);
    free(list->wall_rows);
    free(list->wall_torques);
    contact_parts_clear(&list->parts);
    cell_grid_clear(&list->grid);
    contact_list_clear(&list->pairs);
    contact_list_clear(&list->pairs_before);
    contact_list_clear(&list->walls);
    contact_list_clear(&list->walls_before);
    memset(list, 0, sizeof *list);
}

void neighbor_list_invalidate(neighbor_list *list)
{
    list->outer_valid = false;
    list->inner_valid = false;
}

void neighbor_list_doubt(neighbor_list *list, int steps_apart)
{
    list->inner_valid = false;
    list->steps_apart = steps_apart;
}

/* ---- outer list ---- */

static int compare_numbers(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static void sort_ascending(int32_t *x, size_t count)
{
    enum { MANY = 100 }; /* neighbors of a sphere among much smaller ones */
    if (count > MANY) {
        qsort(x, count, sizeof *x, compare_numbers);
        return;
    }
    for (size_t k = 1; k < count; k++) {
        const int32_t value = x[k];
        size_t at = k;
        for (; at > 0 && x[at - 1] > value; at--) x[at] = x[at - 1];
        x[at] = value;
    }
}

static dem_status part_reserve(pair_part *part, size_t capacity)
{
    if (capacity <= part->capacity) return DEM_OK;
    int32_t *second = array_create(capacity + capacity / 8, sizeof *second);
    if (!second) return DEM_NO_MEMORY;
    if (part->count) memcpy(second, part->second, part->count * sizeof *second);
    free(part->second);
    part->second = second;
    part->capacity = capacity + capacity / 8;
    return DEM_OK;
}

/* Spheres of one cluster never meet: their ids follow each other, so those after i come first. */
static size_t drop_own_particle(int32_t *found, size_t count, const spheres *s, size_t i)
{
    if (i < s->single_count) return count;
    size_t own = 0;
    while (own < count && (size_t)found[own] < s->mobile_count
           && particle_of_sphere(s, (size_t)found[own]) == particle_of_sphere(s, i))
        own++;
    memmove(found, found + own, (count - own) * sizeof *found);
    return count - own;
}

/* Spheres after i within the skin of it, ascending, appended to the part. */
static dem_status append_neighbors(pair_part *part, const spheres *s, const cell_grid *grid, size_t i, double skin,
                                   uint32_t *listed)
{
    enum { USUAL_ROOM = 64 };
    size_t count, room = USUAL_ROOM;
    for (;; room = count) {
        if (part_reserve(part, part->count + room + BLOCK) != DEM_OK) return DEM_NO_MEMORY;
        count = cell_grid_neighbors(grid, s, i, skin, part->second + part->count, room);
        if (count <= room) break;
    }
    int32_t *found = part->second + part->count;
    sort_ascending(found, count);
    count = drop_own_particle(found, count, s, i);
    part->count += count;
    *listed = (uint32_t)count;
    return DEM_OK;
}

static size_t begin_of_part(const neighbor_list *list, const spheres *s, int part, int parts)
{
    return contact_parts_begin(&list->parts, s->mobile_count, part, parts);
}

typedef struct outer_work {
    neighbor_list *list;
    const spheres *spheres;
    dem_status status[MOST_PARTS];
} outer_work;

/* Each part of the spheres lists its neighbors into memory of its own, so that threads need not wait for each other. */
static dem_status outer_part(neighbor_list *list, const spheres *s, int which, int parts)
{
    const size_t from = begin_of_part(list, s, which, parts), to = begin_of_part(list, s, which + 1, parts);
    pair_part own = list->part[which]; /* which lies in memory beside others' */
    own.count = 0;
    dem_status status = parts == 1 ? part_reserve(&own, list->pair_count) : DEM_OK; /* as many as last time */
    for (size_t i = from; i < to && status == DEM_OK; i++) {
        status = append_neighbors(&own, s, &list->grid, i, list->skin, &list->start[i + 1]);
        memcpy(&list->built_at[i], s->row[i].place, sizeof list->built_at[i]);
    }
    list->part[which] = own;
    return status;
}

static void outer_of_part(void *context, int part, int parts)
{
    outer_work *const work = context;
    work->status[part] = outer_part(work->list, work->spheres, part, parts);
}

static dem_status outer_reserve(neighbor_list *list, size_t count)
{
    if (count <= list->pair_capacity) return DEM_OK;
    const size_t capacity = round_up_to_block(count + count / 16);
    int32_t *first = array_create(capacity, sizeof *first);
    uint16_t *in_reach = array_create(capacity / LANES, sizeof *in_reach), *was_in_reach = array_create(capacity / LANES, 2);
    if (!first || !in_reach || !was_in_reach) {
        free(first);
        free(in_reach);
        free(was_in_reach);
        return DEM_NO_MEMORY;
    }
    free(list->first);
    free(list->in_reach);
    free(list->was_in_reach);
    list->first = first;
    list->in_reach = in_reach;
    list->was_in_reach = was_in_reach;
    list->pair_capacity = capacity;
    return DEM_OK;
}

/* Room for the parts' neighbors one after the other; of one part alone, its own memory. */
static dem_status second_reserve(neighbor_list *list, int parts)
{
    if (parts > 1 && list->pair_count <= list->second_capacity) return DEM_OK;
    free(list->second);
    list->second_capacity = parts == 1 ? list->part[0].capacity : round_up_to_block(list->pair_count + list->pair_count / 16);
    list->second = parts == 1 ? list->part[0].second : array_create(list->second_capacity, sizeof *list->second);
    if (parts == 1) list->part[0] = (pair_part){ .count = list->part[0].count };
    if (list->second || list->second_capacity == 0) return DEM_OK;
    list->second_capacity = 0;
    return DEM_NO_MEMORY;
}

static void outer_join(void *context, int part, int parts)
{
    const outer_work *const work = context;
    neighbor_list *const list = work->list;
    const spheres *const s = work->spheres;
    size_t at = 0;
    for (int p = 0; p < part; p++) at += list->part[p].count;
    if (list->part[part].second && list->part[part].count)
        memcpy(list->second + at, list->part[part].second, list->part[part].count * sizeof *list->second);
    const size_t to = begin_of_part(list, s, part + 1, parts);
    for (size_t i = begin_of_part(list, s, part, parts); i < to; i++) {
        const size_t end = at + list->start[i + 1];
        for (; at < end; at++) list->first[at] = (int32_t)i;
        list->start[i + 1] = (uint32_t)end;
    }
}

static void find_farthest(neighbor_list *list, const spheres *s)
{
    for (size_t i = 0; i < s->mobile_count; i++) {
        const bool has_pairs = list->start[i + 1] > list->start[i];
        const uint32_t last = has_pairs ? (uint32_t)list->second[list->start[i + 1] - 1] : (uint32_t)i;
        uint32_t *const of_stretch = &list->farthest[i / STRETCH];
        if (i % STRETCH == 0 || last > *of_stretch) *of_stretch = last;
    }
}

static dem_status outer_build(neighbor_list *list, const spheres *s, const container *drum, int threads)
{
    list->outer_valid = false;
    const int parts = team_parts(threads);
    outer_work work = { .list = list, .spheres = s };
    if (cell_grid_fill(&list->grid, s, drum->low, drum->high, drum->period, list->skin) != DEM_OK) return DEM_NO_MEMORY;
    team_run(parts, outer_of_part, &work);
    list->pair_count = 0;
    for (int p = 0; p < parts; p++) {
        if (work.status[p] != DEM_OK) return work.status[p];
        list->pair_count += list->part[p].count;
    }
    if (outer_reserve(list, list->pair_count) != DEM_OK || second_reserve(list, parts) != DEM_OK) return DEM_NO_MEMORY;
    list->start[0] = 0;
    team_run(parts, outer_join, &work);
    for (size_t k = list->pair_count; k < round_up_to_block(list->pair_count); k++) {
        list->first[k] = sphere_of_zeros(s);
        list->second[k] = sphere_far_away(s);
    }
    if (s->in_waves) find_farthest(list, s);
    list->turned_at_build = drum->angle;
    list->outer_valid = true;
    list->outer_builds++;
    return DEM_OK;
}

/* ---- inner list ---- */

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
            const double moved = (double)ring_difference(work->list->built_at[i][c], s->row[i].place[c]);
            moved2 += moved * moved;
        }
        const double v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        displacement2 = moved2 > displacement2 ? moved2 : displacement2;
        speed2 = v2 > speed2 ? v2 : speed2;
    }
    work->part[part] = (outlook){ displacement2, speed2 };
}

static outlook outlook_measure(const neighbor_list *list, const spheres *s, const container *drum, int threads)
{
    outlook_work work = { .list = list, .spheres = s };
    team_run(team_parts(threads), outlook_of_part, &work);
    outlook out = { 0, 0 };
    for (int p = 0; p < team_parts(threads); p++) {
        out.largest_displacement = fmax(out.largest_displacement, sqrt(work.part[p].largest_displacement) / s->ring_units);
        out.largest_speed = fmax(out.largest_speed, sqrt(work.part[p].largest_speed));
    }
    if (s->lining_count) {
        out.largest_speed = fmax(out.largest_speed, fabs(drum->rotation_rate) * drum->radius);
        out.largest_displacement = fmax(out.largest_displacement, fabs(drum->angle - list->turned_at_build) * drum->radius);
    }
    return out;
}

/* What has become of the last pick's: speeds add up to displacements, deviations to speeds. */
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
    const double room = 0.5 * list->skin - list->margin - now->largest_displacement;
    if (!(room > 0)) return 0;
    return (int)fmin(HORIZON, 1 + room / (now->largest_speed * time_step + 1e-300));
}

/* Could the pairs touch within `duration`, both ends straying at most `margin` from straight paths, and `apart` (m) at the
 * most from where they are at one time? Along the line of centres now, r long, they are never nearer than
 * r + duration * (parting speed), which must not exceed the reach, with twice the margin. Both times r, and
 * r * reach <= (r^2 + reach^2)/2 for lack of a root: r^2 + 2 duration (dv.x) against reach^2, in units of the ring. In contact
 * arithmetic, whose rounding the reach is widened for. */
static uint32_t pairs_in_reach(const neighbor_list *list, const spheres *s, size_t pair, double duration, double apart)
{
    enum { AHEAD = 4 * LANES };
    for (size_t k = pair + AHEAD; s->are_many && k < pair + AHEAD + LANES && k < list->pair_count; k++)
        __builtin_prefetch(&s->row[list->second[k]]);
    const int32_t *const first = list->first + pair, *const second = list->second + pair;
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
    const wide reach = radii + wide_all((real)(2 * units * (list->margin + apart)));
    return wide_mask_bits(wide_exceeds(reach * reach, nearest2));
}

/* What a pick is of, and what its parts find. */
typedef struct pick_work {
    neighbor_list *list;
    const spheres *spheres;
    const container *drum;
    const dem_contact_parameters *contact;
    species_roots roots;
    wall_outlook ahead;
    double apart;    /* m: pairs_in_reach */
    bool same_outer; /* as at the pick before */
    /* how many pairs each part has in reach, and had at the pick before, and contacts with walls; then how many the parts
     * before it have, had */
    size_t now[MOST_PARTS + 1], was[MOST_PARTS + 1], walls[MOST_PARTS + 1];
} pick_work;

/* The first vector of pairs of a part's. */
static size_t begin_of_groups(const pick_work *work, int part, int parts)
{
    const neighbor_list *const list = work->list;
    return part < parts ? list->start[begin_of_part(list, work->spheres, part, parts)] / LANES
                        : (list->pair_count + LANES - 1) / LANES;
}

static void mark_in_reach(void *context, int part, int parts)
{
    pick_work *const work = context;
    neighbor_list *const list = work->list;
    const spheres *const s = work->spheres;
    size_t now = 0, was = 0;
    const size_t end = begin_of_groups(work, part + 1, parts);
    for (size_t g = begin_of_groups(work, part, parts); g < end; g++) {
        list->in_reach[g] = (uint16_t)pairs_in_reach(list, s, g * LANES, work->ahead.duration, work->apart);
        now += (size_t)__builtin_popcount(list->in_reach[g]);
        if (work->same_outer) was += (size_t)__builtin_popcount(list->was_in_reach[g]);
    }
    work->now[part] = now;
    work->was[part] = was;
    const size_t from = begin_of_part(list, s, part, parts), to = begin_of_part(list, s, part + 1, parts);
    wall_reach_count(s, work->drum, work->ahead, from, to, list->wall_start + 1);
    uint32_t walls = 0;
    for (size_t i = from; i < to; i++) list->wall_start[i + 1] = walls += list->wall_start[i + 1];
    work->walls[part] = walls;
    for (size_t i = from; i < to; i++) memcpy(&list->picked_velocity[i], s->row[i].v, sizeof *list->picked_velocity);
}

/* Counts of the parts become where each begins. Returns the sum. */
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

/* A part's pairs in reach, in the outer list's order. Where it is still the one of the last pick, each vector of it tells
 * what its pairs remember. */
static void pick_pairs(const pick_work *work, int part, int parts)
{
    neighbor_list *const list = work->list;
    real *to[CONTACT_NUMBERS], *from[CONTACT_NUMBERS];
    const int numbers = work->same_outer ? contact_list_memory(&list->pairs, to) : 0;
    contact_list_memory(&list->pairs_before, from);
    size_t at = work->now[part], old = work->was[part];
    /* Vectors are written whole, also where only the first lanes count: the last ones, which reach into the next part, aside. */
    real aside[CONTACT_NUMBERS][LANES];
    int32_t first_aside[LANES], second_aside[LANES];
    const size_t end = begin_of_groups(work, part + 1, parts);
    for (size_t g = begin_of_groups(work, part, parts); g < end; g++) {
        const uint32_t now = list->in_reach[g], was = list->was_in_reach[g];
        const size_t count = (size_t)__builtin_popcount(now);
        const bool is_aside = part + 1 < parts && at + LANES > work->now[part + 1];
        for (int m = 0; m < numbers; m++) wide_carry(is_aside ? aside[m] : to[m] + at, now, from[m] + old, was);
        wide_compress(is_aside ? second_aside : list->pairs.second + at, now, list->second + g * LANES);
        wide_compress(is_aside ? first_aside : list->pairs.first + at, now, list->first + g * LANES);
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
        if (slot < end) wall_reach_fill(&list->walls, slot, end, s, work->drum, work->ahead, i);
        slot = end;
    }
    contact_list_carry(&list->walls, &list->walls_before, work->walls[part], work->walls[part + 1]);
}

/* The lists at hand, of a part. */
static void make_contacts(void *context, int part, int parts)
{
    const pick_work *const work = context;
    neighbor_list *const list = work->list;
    const spheres *const s = work->spheres;
    const size_t first = work->now[part], end = work->now[part + 1];
    pick_pairs(work, part, parts);
    if (list->pairs.constants == CONSTANTS_OF_EACH)
        contact_constants_of_each(&list->pairs, s, work->contact, &work->roots, first, end);
    if (!work->same_outer) contact_list_carry(&list->pairs, &list->pairs_before, first, end);
    fill_walls(work, part, parts);
    if (part + 1 < parts) return;
    contact_list_pad(&list->pairs, sphere_of_zeros(s), sphere_far_away(s));
    contact_list_pad(&list->walls, sphere_of_zeros(s), 0);
}

static dem_status inner_pick(neighbor_list *list, spheres *s, const container *drum, const dem_contact_parameters *contact,
                             double time_step, int threads)
{
    const int parts = team_parts(threads);
    const double duration = list->safe_steps * time_step;
    pick_work work = { .list = list, .spheres = s, .drum = drum, .contact = contact, .ahead = { duration, list->margin } };
    if (list->pairs.constants == CONSTANTS_OF_EACH) species_roots_set(&work.roots, s);
    work.apart = list->steps_apart * time_step * list->at_pick.largest_speed;
    work.same_outer = list->picked_of == list->outer_builds;
    contact_list_swap(&list->pairs, &list->pairs_before);
    contact_list_swap(&list->walls, &list->walls_before);
    uint16_t *const was = list->in_reach;
    list->in_reach = list->was_in_reach;
    list->was_in_reach = was;
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
    if (list->pairs.constants == CONSTANTS_OF_ALL) contact_constants_of_all(&list->pairs, s, contact);
    list->picked_of = list->outer_builds;
    /* The lining's paths are arcs: they leave their straight paths by this much at most. */
    list->strayed = s->lining_count ? 0.5 * drum->rotation_rate * drum->rotation_rate * drum->radius * duration * duration : 0.0;
    list->deviation = 0.0;
    list->steps_since_pick = 0;
    list->inner_valid = true;
    list->inner_picks++;
    const dem_status status = wall_rows_reserve(list);
    return status == DEM_OK ? contact_parts_deal(&list->parts, &list->pairs, list->wall_start, s, threads) : status;
}

/* What spheres would stray in a whole horizon if they go on as since the last pick, and a fifth more: a wider margin lists
 * pairs in vain, a narrower one makes the list anew too often. */
static void choose_margin(neighbor_list *list)
{
    if (!list->inner_valid || list->steps_since_pick == 0) return;
    const double ahead = 1.2 * list->strayed / list->steps_since_pick * HORIZON;
    list->margin = fmax(list->least_margin, fmin(ahead, list->most_margin));
}

dem_status neighbor_list_update(neighbor_list *list, spheres *s, const container *drum, const dem_contact_parameters *contact,
                                double time_step, int threads, bool *looked)
{
    *looked = false;
    if (list->inner_valid && list->steps_since_pick < list->safe_steps && list->strayed <= list->margin) return DEM_OK;

    *looked = list->inner_picks % PICKS_BETWEEN_LOOKS == 0;
    choose_margin(list);
    outlook now = outlook_since(list, time_step);
    int steps = list->inner_valid ? safe_steps(list, &now, time_step) : 0;
    if (steps < HORIZON) {
        now = outlook_measure(list, s, drum, threads);
        steps = list->outer_valid ? safe_steps(list, &now, time_step) : 0;
        *looked = true;
    }
    if (steps < HORIZON) {
        const dem_status status = outer_build(list, s, drum, threads);
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
    const dem_status status = inner_pick(list, s, drum, contact, time_step, threads);
    if (status != DEM_OK) neighbor_list_invalidate(list);
    return status;
}

void neighbor_list_count_contacts(const neighbor_list *list, const spheres *s, const container *drum, const int32_t *id,
                                  int32_t *contacts)
{
    memset(contacts, 0, s->mobile_count * sizeof *contacts);
    for (size_t k = 0; k < list->pairs.count; k++) {
        const int32_t i = list->pairs.first[k], j = list->pairs.second[k];
        const double radii = sphere_radius(s, (size_t)i) + sphere_radius(s, (size_t)j);
        if (squared_distance(sphere_place(s, (size_t)i), sphere_place(s, (size_t)j), drum->period, drum->inverse_period)
            >= radii * radii)
            continue;
        contacts[id ? id[i] : i]++;
        if ((size_t)j < s->mobile_count) contacts[id ? id[j] : j]++;
    }
    for (size_t k = 0; k < list->walls.count; k++) {
        const int32_t i = list->walls.first[k];
        const container_wall *w = &drum->wall[list->walls.second[k]];
        contacts[id ? id[i] : i] += wall_seen_from(w, sphere_place(s, (size_t)i)).distance < sphere_radius(s, (size_t)i);
    }
}
