#include "neighbor_list.h"

#include <stdbool.h>

#include "wall_reach.h"

/* Shares of the smallest diameter, chosen by measurement: core/NUMERICS.md, "Neighbor lists". */
static const double SKIN = 0.4, MARGIN = 0.006;

dem_status neighbor_list_init(neighbor_list *list, const spheres *s, bool has_rolling)
{
    memset(list, 0, sizeof *list);
    list->skin = SKIN * s->smallest_diameter;
    list->margin = MARGIN * s->smallest_diameter;
    list->rows_differ = has_rolling;
    for (size_t i = 1; i < spheres_count(s); i++) list->rows_differ = list->rows_differ || s->full_radius[i] != s->full_radius[0];
    cell_grid_init(&list->grid);
    const size_t n = s->mobile_count;
    list->start = array_create(n + 1, sizeof *list->start);
    list->built_at = array_create(n, sizeof *list->built_at);
    list->picked_velocity = array_create(n, sizeof *list->picked_velocity);
    list->ends_start = array_create(n + 1, sizeof *list->ends_start);
    list->ends_second = array_create(n, sizeof *list->ends_second);
    bool enough = list->start && list->built_at && list->picked_velocity && list->ends_start && list->ends_second;
    contact_list *const all[] = { &list->pairs, &list->pairs_before, &list->walls, &list->walls_before };
    for (int k = 0; k < 4; k++) enough = contact_list_init(all[k], n, has_rolling) == DEM_OK && enough;
    if (enough) return DEM_OK;
    neighbor_list_clear(list);
    return DEM_NO_MEMORY;
}

void neighbor_list_clear(neighbor_list *list)
{
    free(list->start);
    free(list->first);
    free(list->second);
    for (int p = 0; p < MOST_PARTS; p++) free(list->part[p].second);
    free(list->in_reach);
    free(list->built_at);
    free(list->picked_velocity);
    free(list->rows);
    free(list->ends_start);
    free(list->ends_second);
    free(list->ends);
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

void neighbor_list_extend(neighbor_list *list, size_t before, size_t now)
{
    for (size_t i = before + 1; i <= now; i++) {
        list->pairs.start[i] = list->pairs.start[before];
        list->walls.start[i] = list->walls.start[before];
    }
}

/* ---- outer list ---- */

static inline double squared_distance(const double a[3], const double b[3], double period, double inverse_period)
{
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = wrap_axial(b[2] - a[2], period, inverse_period);
    return dx * dx + dy * dy + dz * dz;
}

static void sort_ascending(int32_t *x, size_t count)
{
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
    int32_t *second = array_create(capacity + capacity / 2, sizeof *second);
    if (!second) return DEM_NO_MEMORY;
    if (part->count) memcpy(second, part->second, part->count * sizeof *second);
    free(part->second);
    part->second = second;
    part->capacity = capacity + capacity / 2;
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
static dem_status append_neighbors(pair_part *part, const spheres *s, const cell_grid *grid, size_t i, double skin, size_t *count)
{
    enum { USUAL_ROOM = 64 };
    size_t room = USUAL_ROOM;
    for (;; room = *count) {
        if (part_reserve(part, part->count + room + LANES) != DEM_OK) return DEM_NO_MEMORY;
        *count = cell_grid_neighbors(grid, i, skin, part->second + part->count, room);
        if (*count <= room) break;
    }
    int32_t *found = part->second + part->count;
    sort_ascending(found, *count);
    *count = drop_own_particle(found, *count, s, i);
    part->count += *count;
    return DEM_OK;
}

/* Each part of the spheres lists its neighbors into memory of its own, so that threads need not wait for each other. */
static dem_status outer_part(neighbor_list *list, const spheres *s, int which, int parts)
{
    const size_t n = s->mobile_count, from = n * (size_t)which / (size_t)parts, to = n * (size_t)(which + 1) / (size_t)parts;
    list->part[which].count = 0;
    for (size_t i = from; i < to; i++) {
        const dem_status status = append_neighbors(&list->part[which], s, &list->grid, i, list->skin, &list->start[i + 1]);
        if (status != DEM_OK) return status;
        list->built_at[i] = s->place[i];
    }
    return DEM_OK;
}

static dem_status outer_reserve(neighbor_list *list, size_t count)
{
    if (count <= list->pair_capacity) return DEM_OK;
    const size_t capacity = round_up_to_block(count + count / 4);
    int32_t *first = array_create(capacity, sizeof *first), *second = array_create(capacity, sizeof *second);
    uint16_t *in_reach = array_create(capacity / LANES, sizeof *in_reach);
    if (!first || !second || !in_reach) {
        free(first);
        free(second);
        free(in_reach);
        return DEM_NO_MEMORY;
    }
    free(list->first);
    free(list->second);
    free(list->in_reach);
    list->first = first;
    list->second = second;
    list->in_reach = in_reach;
    list->pair_capacity = capacity;
    return DEM_OK;
}

static dem_status outer_build(neighbor_list *list, const spheres *s, const container *drum, int threads)
{
    const size_t n = s->mobile_count;
    const double largest = fmax(s->largest_diameter, 2 * s->full_radius[spheres_count(s) - 1]);
    const int parts = threads < MOST_PARTS ? threads : MOST_PARTS;
    dem_status status = cell_grid_fill(&list->grid, s, drum->low, drum->high, drum->period, largest + list->skin),
               of_part[MOST_PARTS];
    if (status != DEM_OK) return status;
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
    for (int p = 0; p < parts; p++) of_part[p] = outer_part(list, s, p, parts);
    size_t count = 0;
    for (int p = 0; p < parts; p++) {
        if (of_part[p] != DEM_OK) return of_part[p];
        count += list->part[p].count;
    }
    status = outer_reserve(list, count);
    if (status != DEM_OK) return status;
    list->start[0] = list->pair_count = 0;
    for (int p = 0; p < parts; p++) {
        if (list->part[p].count)
            memcpy(list->second + list->pair_count, list->part[p].second, list->part[p].count * sizeof *list->second);
        list->pair_count += list->part[p].count;
    }
    for (size_t i = 0; i < n; i++) {
        const size_t end = list->start[i + 1] + list->start[i];
        for (size_t k = list->start[i]; k < end; k++) list->first[k] = (int32_t)i;
        list->start[i + 1] = end;
    }
    for (size_t k = count; k < round_up_to_block(count); k++) {
        list->first[k] = sphere_of_zeros(s);
        list->second[k] = sphere_far_away(s);
    }
    list->turned_at_build = drum->angle;
    list->outer_valid = true;
    list->outer_builds++;
    return DEM_OK;
}

/* ---- inner list ---- */

typedef struct outlook {
    double largest_displacement; /* m since the outer list was made */
    double largest_speed;        /* m/s */
} outlook;

static outlook outlook_measure(const neighbor_list *list, const spheres *s, const container *drum)
{
    double displacement2 = 0.0, speed2 = 0.0;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const vector4 v = s->velocity[i];
        const double moved2 =
            squared_distance((const double *)&list->built_at[i], sphere_place(s, i), drum->period, drum->inverse_period);
        const double v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        displacement2 = moved2 > displacement2 ? moved2 : displacement2;
        speed2 = v2 > speed2 ? v2 : speed2;
    }
    outlook out = { sqrt(displacement2), sqrt(speed2) };
    if (s->lining_count) {
        out.largest_speed = fmax(out.largest_speed, fabs(drum->rotation_rate) * drum->radius);
        out.largest_displacement = fmax(out.largest_displacement, fabs(drum->angle - list->turned_at_build) * drum->radius);
    }
    return out;
}

/* Steps for which every pair outside the outer list stays apart, at most HORIZON; 0: not even now. */
static int safe_steps(const neighbor_list *list, const outlook *now, double time_step)
{
    const double room = 0.5 * list->skin - list->margin - now->largest_displacement;
    if (!(room > 0)) return 0;
    return (int)fmin(HORIZON, 1 + room / (now->largest_speed * time_step + 1e-300));
}

/* Could the pairs touch within `duration`, both ends straying at most `margin` from straight paths? Along the line
 * of centres now, the distance is never less than gap + duration * (parting speed): a bound from below. In contact
 * arithmetic, whose rounding `margin` is widened for. */
static uint32_t pairs_in_reach(const neighbor_list *list, const spheres *s, size_t pair, const double unit[3], real duration)
{
    wide_pairs p;
    wide_row_pairs(s->row, list->first + pair, list->second + pair, unit, &p);
    const wide distance2 = wide_dot(p.n, p.n), to_unit = wide_inverse_root(distance2), parting = wide_dot(p.v, p.n) * to_unit;
    const wide nearest = distance2 * to_unit + wide_all(duration) * wide_lesser(parting, wide_all(0));
    /* at full size, also while they grow */
    const wide radii = p.radii * wide_all((real)((1 + 4e-6) / s->scale));
    return wide_mask_bits(wide_exceeds(radii + wide_all((real)(2 * list->margin)), nearest));
}

static void mark_in_reach(neighbor_list *list, const spheres *s, const container *drum, double duration, int threads)
{
    const size_t groups = (list->pair_count + LANES - 1) / LANES;
    const wall_outlook ahead = { duration, list->margin };
    double unit[3];
    spheres_ring_unit(s, unit);
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t g = 0; g < groups; g++) list->in_reach[g] = (uint16_t)pairs_in_reach(list, s, g * LANES, unit, (real)duration);
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < s->mobile_count; i++) {
        list->walls.start[i + 1] = wall_reach_count(s, drum, ahead, i);
        list->picked_velocity[i] = s->velocity[i];
    }
}

static void starts_from_counts(contact_list *list, size_t n)
{
    list->start[0] = 0;
    for (size_t i = 0; i < n; i++) list->start[i + 1] += list->start[i];
    list->count = list->start[n];
}

/* One run of rows for pairs and walls, so that one index names any of them. */
static dem_status rows_reserve(neighbor_list *list)
{
    const size_t pairs = round_up_to_block(list->pairs.count), walls = round_up_to_block(list->walls.count);
    const size_t seconds = list->rows_differ ? pairs : 0, needed = pairs + walls + seconds + 1;
    if (needed > list->row_capacity) {
        contact_row *rows = array_create(needed + needed / 4, sizeof *rows);
        if (!rows) return DEM_NO_MEMORY;
        free(list->rows);
        list->rows = rows;
        list->row_capacity = needed + needed / 4;
    }
    list->pairs.row = list->rows;
    list->walls.row = list->rows + pairs;
    list->pairs.second_row = list->rows_differ ? list->walls.row + walls : NULL;
    list->rows[needed - 1] = (contact_row){ 0 };
    return DEM_OK;
}

static dem_status ends_reserve(neighbor_list *list, size_t count)
{
    if (count <= list->ends_capacity) return DEM_OK;
    uint32_t *ends = array_create(count + count / 4, sizeof *ends);
    if (!ends) return DEM_NO_MEMORY;
    free(list->ends);
    list->ends = ends;
    list->ends_capacity = count + count / 4;
    return DEM_OK;
}

static inline uint32_t row_offset(size_t k) { return (uint32_t)(k * sizeof(contact_row)); }

/* Ends in a fixed order: contacts with spheres before it in memory, then behind it, then walls. */
static dem_status ends_build(neighbor_list *list, const spheres *s)
{
    const contact_list *pairs = &list->pairs, *walls = &list->walls;
    const size_t n = s->mobile_count, wall_rows = round_up_to_block(pairs->count),
                 all = wall_rows + round_up_to_block(walls->count), second_rows = list->rows_differ ? all : 0,
                 zeros = second_rows ? second_rows + wall_rows : all;
    size_t *start = list->ends_start;
    int32_t *second = list->ends_second;
    memset(second, 0, n * sizeof *second);
    for (size_t k = 0; k < pairs->count; k++)
        if ((size_t)pairs->second[k] < n) second[pairs->second[k]]++;
    start[0] = 0;
    for (size_t i = 0; i < n; i++) {
        const size_t ends = (size_t)second[i] + pairs->start[i + 1] - pairs->start[i] + walls->start[i + 1] - walls->start[i];
        const size_t groups = ends ? (ends + ENDS_A_GROUP - 1) / ENDS_A_GROUP : 1;
        start[i + 1] = start[i] + groups * ENDS_A_GROUP;
    }
    if (ends_reserve(list, start[n]) != DEM_OK) return DEM_NO_MEMORY;
    uint32_t *ends = list->ends;
    memset(second, 0, n * sizeof *second);
    for (size_t k = 0; k < pairs->count; k++) {
        const size_t j = (size_t)pairs->second[k];
        if (j < n) ends[start[j] + (size_t)second[j]++] = row_offset(second_rows + k);
    }
    for (size_t i = 0; i < n; i++) {
        size_t at = start[i] + (size_t)second[i];
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) ends[at++] = row_offset(k);
        for (size_t k = walls->start[i]; k < walls->start[i + 1]; k++) ends[at++] = row_offset(wall_rows + k);
        while (at < start[i + 1]) ends[at++] = row_offset(zeros);
    }
    return DEM_OK;
}

/* The pairs in reach, in the outer list's order. */
static dem_status pairs_pick(neighbor_list *list, size_t n)
{
    const size_t groups = (list->pair_count + LANES - 1) / LANES;
    contact_list *pairs = &list->pairs;
    size_t count = 0;
    for (size_t g = 0; g < groups; g++) count += (size_t)__builtin_popcount(list->in_reach[g]);
    /* whole vectors are written, also at the end */
    if (contact_list_reserve(pairs, count + LANES) != DEM_OK) return DEM_NO_MEMORY;
    pairs->count = 0;
    for (size_t g = 0; g < groups; g++) {
        wide_compress(pairs->second + pairs->count, list->in_reach[g], list->second + g * LANES);
        pairs->count += wide_compress(pairs->first + pairs->count, list->in_reach[g], list->first + g * LANES);
    }
    memset(pairs->start, 0, (n + 1) * sizeof *pairs->start);
    for (size_t k = 0; k < pairs->count; k++) pairs->start[pairs->first[k] + 1]++;
    for (size_t i = 0; i < n; i++) pairs->start[i + 1] += pairs->start[i];
    return DEM_OK;
}

static void fill_slots_of(neighbor_list *list, const spheres *s, const container *drum, const dem_contact_parameters *contact,
                          double duration, size_t i)
{
    contact_list *pairs = &list->pairs, *walls = &list->walls;
    const wall_outlook ahead = { duration, list->margin };
    const double own = s->inverse_mass[i];
    for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
        const bool between_mobile = (size_t)pairs->second[k] < s->mobile_count;
        pairs->friction[k] = (real)(between_mobile ? contact->friction : contact->wall_friction);
        if (pairs->has_rolling)
            pairs->rolling_friction[k] = (real)(between_mobile ? contact->rolling_friction : contact->wall_rolling_friction);
        pairs->mass[k] = (real)(1 / (between_mobile ? own + s->inverse_mass[pairs->second[k]] : own));
        pairs->first_radius[k] = (real)s->full_radius[i];
    }
    contact_list_carry(pairs, &list->pairs_before, i);
    wall_reach_fill(walls, s, drum, ahead, i);
    contact_list_carry(walls, &list->walls_before, i);
}

static dem_status inner_pick(neighbor_list *list, const spheres *s, const container *drum, const dem_contact_parameters *contact,
                             double duration, int threads)
{
    const size_t n = s->mobile_count;
    contact_list_swap(&list->pairs, &list->pairs_before);
    contact_list_swap(&list->walls, &list->walls_before);
    mark_in_reach(list, s, drum, duration, threads);
    dem_status status = pairs_pick(list, n);
    starts_from_counts(&list->walls, n);
    if (status != DEM_OK || contact_list_reserve(&list->walls, list->walls.count) != DEM_OK) return DEM_NO_MEMORY;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < n; i++) fill_slots_of(list, s, drum, contact, duration, i);
    contact_list_pad(&list->pairs, sphere_of_zeros(s), sphere_far_away(s));
    contact_list_pad(&list->walls, sphere_of_zeros(s), 0);
    /* The lining's paths are arcs: they leave their straight paths by this much at most. */
    list->strayed = s->lining_count ? 0.5 * drum->rotation_rate * drum->rotation_rate * drum->radius * duration * duration : 0.0;
    list->steps_since_pick = 0;
    list->inner_valid = true;
    list->inner_picks++;
    status = rows_reserve(list);
    return status == DEM_OK ? ends_build(list, s) : status;
}

dem_status neighbor_list_update(neighbor_list *list, const spheres *s, const container *drum, const dem_contact_parameters *contact,
                                double time_step, int threads, bool *made_new)
{
    const bool safe = list->inner_valid && list->steps_since_pick < list->safe_steps && list->strayed <= list->margin;
    if (made_new) *made_new = !safe;
    if (safe) return DEM_OK;

    outlook now = outlook_measure(list, s, drum);
    int steps = list->outer_valid ? safe_steps(list, &now, time_step) : 0;
    if (steps < HORIZON) {
        const dem_status status = outer_build(list, s, drum, threads);
        if (status != DEM_OK) return status;
        now.largest_displacement = 0.0;
        steps = safe_steps(list, &now, time_step);
    }
    /* Right after a build, the step at hand is safe whatever the speed. */
    list->safe_steps = steps > 1 ? steps : 1;
    return inner_pick(list, s, drum, contact, list->safe_steps * time_step, threads);
}

void neighbor_list_count_contacts(const neighbor_list *list, const spheres *s, const container *drum, const int32_t *id,
                                  int32_t *contacts)
{
    memset(contacts, 0, s->mobile_count * sizeof *contacts);
    for (size_t k = 0; k < list->pairs.count; k++) {
        const int32_t i = list->pairs.first[k], j = list->pairs.second[k];
        const double radii = (double)s->row[i].radius + (double)s->row[j].radius;
        if (squared_distance(sphere_place(s, (size_t)i), sphere_place(s, (size_t)j), drum->period, drum->inverse_period)
            >= radii * radii)
            continue;
        contacts[id ? id[i] : i]++;
        if ((size_t)j < s->mobile_count) contacts[id ? id[j] : j]++;
    }
    for (size_t k = 0; k < list->walls.count; k++) {
        const int32_t i = list->walls.first[k];
        const container_wall *w = &drum->wall[list->walls.second[k]];
        contacts[id ? id[i] : i] += wall_seen_from(w, sphere_place(s, (size_t)i)).distance < (double)s->row[i].radius;
    }
}
