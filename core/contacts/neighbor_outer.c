#include "neighbor_outer.h"

#include "array.h"

dem_status outer_list_init(outer_list *list, const spheres *s, double skin)
{
    const size_t n = s->mobile_count;
    list->skin = skin;
    cell_grid_init(&list->grid, s);
    list->start = array_create(n + 1, sizeof *list->start);
    list->farthest = array_create(n / STRETCH + 1, sizeof *list->farthest);
    list->built_at = array_create(n, sizeof *list->built_at);
    return list->start && list->farthest && list->built_at ? DEM_OK : DEM_NO_MEMORY;
}

void outer_list_clear(outer_list *list)
{
    free(list->start);
    free(list->first);
    free(list->second);
    free(list->farthest);
    for (int p = 0; p < MOST_PARTS; p++) free(list->part[p].second);
    free(list->in_reach);
    free(list->was_in_reach);
    free(list->built_at);
    cell_grid_clear(&list->grid);
}

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

/* Drops the spheres of i's own cluster, which never count as touching: they follow i in memory, so they come first in `found`.
 * Returns how many are left. */
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

typedef struct outer_work {
    outer_list *list;
    const spheres *spheres;
    const contact_parts *shares;
    dem_status status[MOST_PARTS];
} outer_work;

/* Each part of the spheres lists its neighbors into memory of its own, so that threads need not wait for each other. */
static dem_status outer_part(const outer_work *work, int which, int parts)
{
    outer_list *const list = work->list;
    const spheres *const s = work->spheres;
    const size_t from = contact_parts_begin(work->shares, s->mobile_count, which, parts),
                 to = contact_parts_begin(work->shares, s->mobile_count, which + 1, parts);
    pair_part own = list->part[which]; /* a copy: the original shares cache lines with those of other threads */
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
    work->status[part] = outer_part(work, part, parts);
}

static dem_status outer_reserve(outer_list *list, size_t count)
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

/* Makes room for the neighbors of all parts, one part behind the other. With a single part its memory becomes the list's, and
 * nothing is copied. Errors: DEM_NO_MEMORY. */
static dem_status second_reserve(outer_list *list, int parts)
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
    outer_list *const list = work->list;
    const spheres *const s = work->spheres;
    size_t at = 0;
    for (int p = 0; p < part; p++) at += list->part[p].count;
    if (list->part[part].second && list->part[part].count)
        memcpy(list->second + at, list->part[part].second, list->part[part].count * sizeof *list->second);
    const size_t to = contact_parts_begin(work->shares, s->mobile_count, part + 1, parts);
    for (size_t i = contact_parts_begin(work->shares, s->mobile_count, part, parts); i < to; i++) {
        const size_t end = at + list->start[i + 1];
        for (; at < end; at++) list->first[at] = (int32_t)i;
        list->start[i + 1] = (uint32_t)end;
    }
}

static void find_farthest(outer_list *list, const spheres *s)
{
    for (size_t i = 0; i < s->mobile_count; i++) {
        const bool has_pairs = list->start[i + 1] > list->start[i];
        const uint32_t last = has_pairs ? (uint32_t)list->second[list->start[i + 1] - 1] : (uint32_t)i;
        uint32_t *const of_stretch = &list->farthest[i / STRETCH];
        if (i % STRETCH == 0 || last > *of_stretch) *of_stretch = last;
    }
}

dem_status outer_list_build(outer_list *list, const spheres *s, const container *vessel, const contact_parts *shares, int threads)
{
    list->valid = false;
    const int parts = team_parts(threads);
    outer_work work = { .list = list, .spheres = s, .shares = shares };
    if (cell_grid_fill(&list->grid, s, vessel->low, vessel->high, vessel->period, list->skin) != DEM_OK) return DEM_NO_MEMORY;
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
    list->angle_at_build = vessel->angle;
    list->valid = true;
    list->builds++;
    return DEM_OK;
}
