/* The loop over the contacts between spheres. For each block of BLOCK contacts:
 *
 *     gather     copies the two spheres of each contact from their rows into the block's arrays, one number after the other,
 *                and prefetches the spheres of the next block
 *     compute    the passes of contact_block.h: normal, displacement, law, rolling friction, and the rows of forces and moments
 *     scatter    adds these rows to the loads of the two spheres
 *     complete   spheres that are before the first sphere of the next block have all their contacts with other spheres behind
 *                them: now come their contacts with walls and, if there is a leap, their step
 *
 * list_cursor is the place that one part has reached in one step. step.c says what this loop must keep. */
#include "contact_forces.h"

#include "wall_forces.h"

/* Stores what every contact has: displacement between the centres, its square, and by how much the square of the reach exceeds
 * that. apart: the displacement, and reach, in ring units; to_metres: m, one ring unit. */
WIDE_INLINE void store_geometry(contact_block *restrict block, int k, const wide_ring apart[3], wide reach, wide to_metres)
{
    wide x[3];
    const wide gap2 = wide_ring_gap2(apart, reach, x);
    store_vector(block->n, k, x);
    /* Where centres nearly coincide, rounding could make this zero or less: it is kept above that. */
    const wide reach2 = reach * reach;
    wide_store(block->distance2 + k, wide_greater(reach2 - gap2, reach2 * wide_all((real)0x1p-20)));
    wide_store(block->gap2 + k, gap2 * to_metres);
}

/* Prefetches the rows of LANES spheres, and what does not fit into the rows where the caches do not hold it. */
WIDE_INLINE void prefetch_spheres(const spheres *s, const int32_t *sphere)
{
    for (int k = 0; k < LANES; k++) __builtin_prefetch(&s->row[sphere[k]]);
    for (int k = 0; s->exceed_caches && k < LANES; k++) __builtin_prefetch(&s->rest[sphere[k]]);
}

/* Prefetches the histories of the block of contacts that begins at `next`, and the spheres' indices of the block behind it. The
 * processor prefetches arrays that are read in order by itself, but not as many as these. The function is inline because the
 * compiler leaves out a call that does nothing but prefetch, as it sees no effect. */
WIDE_INLINE void prefetch_block(const contact_list *pairs, size_t next)
{
    enum { LINE = ALIGNMENT / sizeof(real), INDEX_LINE = ALIGNMENT / sizeof(int32_t) };
    for (size_t k = next; k < next + BLOCK; k += LINE) {
        for (int c = 0; c < 3; c++) __builtin_prefetch(&pairs->t[c][k], 1);
        __builtin_prefetch(&pairs->t_star[k], 1);
        __builtin_prefetch(&pairs->alpha_0[k], 1);
    }
    for (size_t k = next + BLOCK; k < next + 2 * BLOCK; k += INDEX_LINE) {
        __builtin_prefetch(&pairs->first[k]);
        __builtin_prefetch(&pairs->second[k]);
    }
}

/* Gathers a block of contacts between spheres that are all alike; set_reach has put their reach and radii into the block.
 * first, second: (BLOCK) whose rows to read. in_order: the first spheres ascend, and all are below in_order; 0: they may come in
 * any order. next_second: (BLOCK) the second spheres of the next block, to be prefetched; NULL: they are in the cache anyway.
 * (The first spheres of the next block are near those of this one.) */
static void gather_alike(contact_block *restrict block, const spheres *s, const int32_t *restrict first,
                         const int32_t *restrict second, size_t in_order, const int32_t *next_second)
{
    const wide to_metres = wide_all((real)(1 / s->ring_units)), reach = wide_load(block->reach);
    for (int k = 0; k < BLOCK; k += LANES) {
        if (next_second) prefetch_spheres(s, next_second + k);
        const wide_rows pairs = wide_rows_of_pairs(s->row, first + k, second + k);
        store_geometry(block, k, pairs.place, reach, to_metres);
        store_vector(block->v, k, pairs.v);
        wide_store(block->omega[0] + k, pairs.omega[0]);
        wide_store(block->omega[1] + k, pairs.omega[1]);
    }
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide of_first = wide_spins_in_order(s->rest, first + k, in_order);
        wide_store(block->omega[2] + k, of_first + wide_rests_load(s->rest, second + k).omega_z);
    }
}

/* Gathers a block of contacts between spheres of any sizes. next_second: as for gather_alike. spins: gather also the difference
 * of spins, which rolling friction needs. */
WIDE_INLINE void gather_any(contact_block *restrict block, const spheres *s, const int32_t *restrict first,
                            const int32_t *restrict second, const int32_t *next_second, bool spins)
{
    const wide to_units = wide_all((real)s->ring_units), to_metres = wide_all((real)(1 / s->ring_units));
    for (int k = 0; k < BLOCK; k += LANES) {
        if (next_second) prefetch_spheres(s, next_second + k);
        const wide_rows row_i = wide_rows_load(s->row, first + k), row_j = wide_rows_load(s->row, second + k);
        const wide_rests rest_i = wide_rests_load(s->rest, first + k), rest_j = wide_rests_load(s->rest, second + k);
        const wide omega_i[3] = { row_i.omega[0], row_i.omega[1], rest_i.omega_z };
        const wide omega_j[3] = { row_j.omega[0], row_j.omega[1], rest_j.omega_z };
        const wide radii = rest_i.radius + rest_j.radius, reach = radii * to_units;
        wide_ring apart[3];
        for (int c = 0; c < 3; c++) {
            apart[c] = wide_ring_difference(row_i.place[c], row_j.place[c]);
            wide_store(block->v[c] + k, row_j.v[c] - row_i.v[c]);
            wide_store(block->r_omega[c] + k, wide_fused(rest_i.radius, omega_i[c], rest_j.radius * omega_j[c]));
            wide_store(block->omega[c] + k, omega_i[c] + omega_j[c]);
            if (spins) wide_store(block->spin[c] + k, omega_i[c] - omega_j[c]);
        }
        store_geometry(block, k, apart, reach, to_metres);
        wide_store(block->reach + k, reach);
        wide_store(block->radii + k, radii);
    }
}

/* Sets reach and radii of a block once for all, where spheres are all alike. The radius is computed as spheres_set_scale
 * computes that of the rows, and not read from a row, because another thread may be writing to that row. */
static void set_reach(contact_block *block, const spheres *s)
{
    const wide radii = wide_all(2 * (real)(s->scale * (double)s->full_radius[0])), reach = radii * wide_all((real)s->ring_units);
    for (int k = 0; k < BLOCK; k += LANES) {
        wide_store(block->reach + k, reach);
        wide_store(block->radii + k, radii);
    }
}

/* Unit normal and overlap of each contact. The overlap is reach - distance = (reach^2 - distance^2)/(reach + distance); the
 * difference of squares is exact where the two are near (wide_ring_gap2), so that a small overlap keeps its
 * digits. Returns the larger of `largest` and the block's overlaps, lane by lane, m. */
static wide normals(contact_block *restrict block, wide largest)
{
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide distance2 = wide_load(block->distance2 + k), to_unit = wide_inverse_root(distance2);
        for (int c = 0; c < 3; c++) wide_store(block->n[c] + k, wide_load(block->n[c] + k) * to_unit);
        const wide sum = wide_fused(distance2, to_unit, wide_load(block->reach + k));
        const wide overlap = wide_load(block->gap2 + k) / sum;
        wide_store(block->overlap + k, overlap);
        largest = wide_greater(largest, overlap);
    }
    return largest;
}

/* a x b, one component */
WIDE_INLINE wide cross(const wide a[3], const wide b[3], int c)
{
    const int d = (c + 1) % 3, e = (c + 2) % 3;
    return wide_fused(a[d], b[e], -(a[e] * b[d]));
}

/* Tangential displacement of the step: ds = (v_r - (v_r.n) n) factor, with the relative velocity at the contact
 * v_r = v_j - v_i - (r_a omega_i + r_b omega_j) x n and the levers r = R - overlap/2. radius: (BLOCK) m, R of both ends where
 * they are the same; NULL: they may differ, and gather_any has summed R omega of both. factors: (BLOCK) where the factor is not one
 * for all; else NULL. */
WIDE_INLINE void displacements(contact_block *restrict block, const real *restrict radius, double factor,
                               const real *restrict factors)
{
    const wide of_all = wide_all((real)factor), half = wide_all((real)0.5);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide overlap = wide_load(block->overlap + k);
        const wide arm = radius ? wide_fused(-half, overlap, wide_load(radius + k)) : -half * overlap;
        wide omega[3], v_r[3];
        for (int c = 0; c < 3; c++) omega[c] = wide_load(block->omega[c] + k);
        if (radius) {
            for (int c = 0; c < 3; c++) v_r[c] = wide_fused(-arm, cross(omega, n, c), wide_load(block->v[c] + k));
        } else {
            wide s[3];
            for (int c = 0; c < 3; c++) s[c] = wide_fused(arm, omega[c], wide_load(block->r_omega[c] + k));
            for (int c = 0; c < 3; c++) v_r[c] = wide_load(block->v[c] + k) - cross(s, n, c);
        }
        const wide parting = wide_dot(v_r, n), times = factors ? wide_load(factors + k) : of_all;
        wide_store(block->parting + k, parting);
        for (int c = 0; c < 3; c++) wide_store(block->ds[c] + k, wide_minus_product(v_r[c], parting, n[c]) * times);
    }
}

static void displacements_of_materials(contact_block *block, const real *radius, const real *factors)
{
    if (radius) displacements(block, radius, 0, factors);
    else displacements(block, NULL, 0, factors);
}

/* Makes the rows that are added to the loads. The force on the first sphere is f = T - N n; the moment about each centre is
 * n x T times that sphere's lever r = R - overlap/2. (first_radius is that at full size. While spheres grow they are smaller,
 * but then there is no friction and hence no moment.) force: T, N. rolls: add the moments of rolling friction, which are
 * opposite for the two spheres. ends_differ: the second sphere's moment differs from the first's and gets a row of its own. */
WIDE_INLINE void make_rows(contact_block *restrict block, const real *const force[3], const real *restrict first_radius, bool rolls,
                           bool ends_differ)
{
    const wide half = wide_all((real)0.5);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide t[3] = { wide_load(force[0] + k), wide_load(force[1] + k), wide_load(force[2] + k) };
        const wide f_n = wide_load(block->f_n + k), overlap = wide_load(block->overlap + k);
        const wide r_first = wide_load(first_radius + k), r_a = wide_fused(-half, overlap, r_first);
        wide f[3], q[3], moment[3];
        for (int c = 0; c < 3; c++) {
            f[c] = wide_minus_product(t[c], f_n, n[c]);
            q[c] = cross(n, t, c);
            moment[c] = rolls ? wide_fused(r_a, q[c], wide_load(block->moment[c] + k)) : r_a * q[c];
        }
        wide_store_rows(block->row + k, f, moment);
        if (!ends_differ) continue;
        const wide r_b = wide_load(block->radii + k) - r_first - half * overlap;
        for (int c = 0; c < 3; c++) moment[c] = rolls ? wide_fused(r_b, q[c], -wide_load(block->moment[c] + k)) : r_b * q[c];
        wide_store_rows(block->second_row + k, f, moment);
    }
}

/* Whether gather_alike serves the list; else gather_any does. */
static bool are_alike(const contact_list *pairs) { return pairs->constants == CONSTANTS_OF_ALL && !pairs->has_rolling; }

void contact_block_forces(contact_list *list, size_t start, contact_block *block, const dem_contact_parameters *contact,
                          bool is_wall, double dt, wide *largest)
{
    const bool is_damped = contact->law != DEM_WALTON_BRAUN;
    const real *const first_radius = list->first_radius + constants_of(list, start);
    *largest = normals(block, *largest);
    const double factor = is_damped ? dt : contact->stiffness * contact->tangential_stiffness_ratio * dt;
    const real *const radius = is_wall || are_alike(list) ? first_radius : NULL;
    if (list->laws_differ && !is_damped) displacements_of_materials(block, radius, list->law[LAW_PUSH] + constants_of(list, start));
    else if (radius) displacements(block, radius, factor, NULL);
    else displacements(block, NULL, factor, NULL);
    const dem_cohesion_law cohesion = list->coheres ? contact->cohesion_law : DEM_NO_COHESION;
    if (cohesion) contact_block_recall(block, list, start);
    if (!is_damped) contact_block_walton_braun(block, list, start, contact);
    else contact_block_damped_springs(block, list, start, contact, dt);
    if (list->has_rolling) contact_block_roll(block, list, start, contact, dt);
    if (cohesion) contact_block_cohere(block, list, start, cohesion, is_wall);
    const real *force[3];
    for (int c = 0; c < 3; c++) force[c] = is_damped ? block->force[c] : list->t[c] + start;
    if (list->has_rolling) make_rows(block, force, first_radius, true, list->ends_differ);
    else make_rows(block, force, first_radius, false, list->ends_differ);
}

/* Where to add the rows of a block: for each contact, the offset of the first sphere's load and of the second's from the
 * beginning of spheres.load, in bytes. */
typedef struct block_loads {
    uint32_t first[BLOCK], second[BLOCK];
} block_loads;

static uint32_t load_offset(size_t load) { return (uint32_t)(load * sizeof(row8)); }

/* Finds the loads of a block's spheres, as far as they are among begin..end-1, the part's own. What other spheres would get is
 * added to padding loads, which nobody reads; there are LOADS_A_PART of these in turn, so that one sum need not wait for the one
 * before it. padding: the first of them. all: every sphere of the block is the part's own. */
static void find_loads(block_loads *restrict to, const int32_t *restrict first, const int32_t *restrict second, size_t begin,
                       size_t end, size_t padding, bool all)
{
    const uint32_t none = load_offset(padding), start = (uint32_t)begin, count = (uint32_t)(end - begin);
    for (int k = 0; k < BLOCK; k++) {
        to->first[k] = load_offset((uint32_t)first[k]);
        to->second[k] = load_offset((uint32_t)second[k]);
    }
    for (int k = 0; !all && k < BLOCK; k++) {
        const uint32_t there = none + load_offset((size_t)k % LOADS_A_PART);
        to->first[k] = (uint32_t)first[k] - start < count ? to->first[k] : there;
        to->second[k] = (uint32_t)second[k] - start < count ? to->second[k] : there;
    }
}

/* Adds a block's rows to its spheres' loads, contact after contact in the order of the list, while the rows are in the
 * first-level cache. next_second: as for gather_alike; here their loads are prefetched. */
static void add_to_loads(const contact_block *restrict block, const block_loads *to, bool ends_differ, row8 *loads,
                         const int32_t *next_second)
{
    static const row8 on_second = { -1, -1, -1, 1, 1, 1, 0, 0 };
    const contact_row *restrict row = block->row, *restrict second_row = ends_differ ? block->second_row : block->row;
    char *restrict load = (char *)loads;
    for (int begin = 0; begin < BLOCK; begin += LANES) {
#pragma GCC unroll 16 /* unrolled, wide_row_slot is a constant */
        for (int lane = 0; lane < LANES; lane++) {
            const int k = begin + lane, from = begin + wide_row_slot(lane);
            row8 *const first = (row8 *)(load + to->first[k]), *const second = (row8 *)(load + to->second[k]);
            if (next_second) __builtin_prefetch(&loads[next_second[k]], 1);
            *first += row[from];
            *second = row8_fused(on_second, second_row[from], *second);
        }
    }
}

/* Adds the rows of the contacts with walls of the spheres from..to-1. They come last in each sphere's sum. */
WIDE_INLINE void add_walls(const neighbor_list *list, spheres *s, size_t from, size_t to)
{
    for (size_t k = list->wall_start[from]; k < list->wall_start[to]; k++) s->load[list->walls.first[k]] += list->walls.row[k];
}

/* The part's own spheres up to `to` have all their forces from other spheres: computes those from walls where that is still to
 * be done, adds them, and lets single spheres take their step where the step has a leap (early motion). The new rows of
 * spheres that other parts read go into the set of copies that the next step reads. */
WIDE_INLINE void spheres_complete(list_cursor *cursor, size_t to)
{
    enum { AHEAD = 96 }; /* as many spheres as three or four blocks complete */
    const pair_work *const work = cursor->work;
    neighbor_list *const list = work->list;
    spheres *const s = work->spheres;
    if (s->exceed_caches) __builtin_prefetch(&list->wall_start[to + AHEAD]);
    while (cursor->walls < cursor->walls_end && cursor->walls < list->wall_start[to]) {
        const size_t next = cursor->walls / BLOCK * BLOCK + BLOCK, end = next < cursor->walls_end ? next : cursor->walls_end;
        contact_forces_with_some_walls(list, cursor->walls, end, s, work->walls, work->contact, work->dt, &cursor->largest);
        cursor->walls = end;
    }
    const size_t from = cursor->complete, last = to < s->single_count ? to : s->single_count;
    add_walls(list, s, from, to);
    cursor->complete = to;
    if (!work->leap || from >= last) return;
    cursor->strayed = vector4_greater_size(cursor->strayed, spheres_advance(work->leap, s, list->picked_velocity, from, last));
    contact_parts_copy_rows(&list->parts, s, 1 - work->front_copy, list->parts.shared_begin[cursor->part + 1], last,
                            &cursor->shared);
}

/* Computes block b of a list and adds its rows to the loads of the part's own spheres. rows: where to read the spheres, of
 * which some are copies of other parts' rows; NULL: all are the part's own. next_second: as for gather_alike. */
WIDE_INLINE void block_forces(list_cursor *cursor, contact_list *pairs, size_t b, const block_rows *rows,
                              const int32_t *next_second)
{
    const pair_work *const work = cursor->work;
    const contact_parts *const parts = &work->list->parts;
    spheres *const s = work->spheres;
    contact_block *const block = cursor->block;
    const int32_t *const first = pairs->first + b * BLOCK, *const second = pairs->second + b * BLOCK;
    const int32_t *const first_row = rows ? rows->first[work->front_copy] : first;
    const int32_t *const second_row = rows ? rows->second[work->front_copy] : second;
    const bool all_mobile = s->lining_count == 0 && (b + 1) * BLOCK <= pairs->count;
    block_loads loads;
    if (are_alike(pairs)) gather_alike(block, s, first_row, second_row, rows ? 0 : parts->sphere[cursor->part + 1], next_second);
    else if (pairs->has_rolling) gather_any(block, s, first_row, second_row, next_second, true);
    else gather_any(block, s, first_row, second_row, next_second, false);
    if (next_second && s->exceed_caches) prefetch_block(pairs, (b + 1) * BLOCK);
    contact_block_forces(pairs, b * BLOCK, block, work->contact, false, work->dt, &cursor->largest);
    find_loads(&loads, first, second, parts->sphere[cursor->part], parts->sphere[cursor->part + 1], padding_loads(s, cursor->part),
               !rows && all_mobile);
    add_to_loads(block, &loads, pairs->ends_differ, s->load, next_second);
}

/* block_forces for the few blocks outside the main loop: not inlined a second time, and nothing is prefetched. */
static __attribute__((noinline)) void block_forces_outlined(list_cursor *cursor, contact_list *pairs, size_t b,
                                                            const block_rows *rows)
{
    block_forces(cursor, pairs, b, rows, NULL);
}

/* Block b is done: the spheres before the first sphere of the next block are complete. In each contact the first sphere is before
 * the second in memory, and the list ascends by first spheres; so no later contact of this step has such a sphere at either
 * end, and no later contact reads its row. */
WIDE_INLINE void block_done(list_cursor *cursor, size_t b)
{
    const int32_t *const next = cursor->work->list->pairs.first + (b + 1) * BLOCK;
    if (b + 1 < cursor->end && (size_t)*next > cursor->complete) spheres_complete(cursor, (size_t)*next);
}

void list_cursor_next_block(list_cursor *cursor)
{
    contact_list *const pairs = &cursor->work->list->pairs;
    const contact_part *const own = &cursor->work->list->parts.part[cursor->part];
    const size_t b = cursor->next++;
    const bool is_across = cursor->across < own->across_count && own->across[cursor->across] == b;
    const int32_t *const next_second =
        cursor->work->spheres->are_many && cursor->next < cursor->end ? pairs->second + cursor->next * BLOCK : NULL;
    block_forces(cursor, pairs, b, is_across ? &own->rows[cursor->across++] : NULL, next_second);
    block_done(cursor, b);
}

void list_cursor_complete(list_cursor *cursor, size_t to) { spheres_complete(cursor, to); }

/* The first `done` contacts are replaced by padding while the block is computed, and then put back with their histories. */
void list_cursor_rest_of_block(list_cursor *cursor, size_t done)
{
    contact_list *const pairs = &cursor->work->list->pairs;
    const spheres *const s = cursor->work->spheres;
    const size_t b = cursor->next++;
    int32_t *const first = pairs->first + b * BLOCK, *const second = pairs->second + b * BLOCK;
    int32_t ends[2][BLOCK];
    real kept[CONTACT_NUMBERS][BLOCK];
    const int numbers = contact_list_numbers(pairs);
    memcpy(ends[0], first, sizeof ends[0]);
    memcpy(ends[1], second, sizeof ends[1]);
    for (int m = 0; m < numbers; m++) memcpy(kept[m], pairs->memory[m] + b * BLOCK, done * sizeof(real));
    for (size_t k = 0; k < done; k++) {
        first[k] = sphere_of_zeros(s);
        second[k] = sphere_far_away(s);
    }
    block_rows rows = { 0 };
    memcpy(rows.first[cursor->work->front_copy], first, sizeof rows.first[0]);
    memcpy(rows.second[cursor->work->front_copy], second, sizeof rows.second[0]);
    block_forces_outlined(cursor, pairs, b, &rows);
    memcpy(first, ends[0], sizeof ends[0]);
    memcpy(second, ends[1], sizeof ends[1]);
    for (int m = 0; m < numbers; m++) memcpy(pairs->memory[m] + b * BLOCK, kept[m], done * sizeof(real));
    block_done(cursor, b);
}

void pair_work_begin(pair_work *work, neighbor_list *list, spheres *s, const container *walls,
                     const dem_contact_parameters *contact, double dt, const leap_frog *leap)
{
    work->list = list, work->spheres = s, work->walls = walls, work->contact = contact, work->dt = dt, work->leap = leap;
    work->front_copy = s->front_copy;
}

list_cursor list_cursor_begin(const pair_work *work, int part, contact_block *block)
{
    const neighbor_list *const list = work->list;
    const size_t begin = list->parts.sphere[part];
    list_cursor cursor = { .work = work, .part = part, .block = block, .complete = begin };
    cursor.next = list->parts.block[part];
    cursor.end = list->parts.block[part + 1];
    cursor.shared = list->parts.shared_begin[part];
    if (work->walls) {
        cursor.walls = list->wall_start[begin];
        cursor.walls_end = list->wall_start[list->parts.sphere[part + 1]];
    }
    if (are_alike(&list->pairs)) set_reach(block, work->spheres);
    return cursor;
}

/* Computes one part: first its copies of contacts that earlier parts have, then its own blocks. For each of the part's spheres
 * that is the order of the list, where the contacts of earlier parts come first, too. */
static void part_forces(pair_work *work, int part)
{
    contact_part *const own = &work->list->parts.part[part];
    const size_t own_end = work->list->parts.sphere[part + 1];
    contact_block block;
    list_cursor cursor = list_cursor_begin(work, part, &block);
    for (size_t b = 0; b * BLOCK < own->copies.count; b++)
        block_forces_outlined(&cursor, &own->copies, b, &own->rows[own->across_count + b]);
    while (cursor.next < cursor.end) list_cursor_next_block(&cursor);
    if (cursor.complete < own_end) list_cursor_complete(&cursor, own_end);
    work->part[part].largest = wide_largest_lane(cursor.largest);
    work->part[part].strayed = cursor.strayed;
}

static void pairs_of_part(void *context, int part, int parts)
{
    (void)parts;
    pair_work *const work = context;
    const uint64_t begin = __builtin_ia32_rdtsc();
    part_forces(work, part);
    work->part[part].ticks = __builtin_ia32_rdtsc() - begin;
}

double contact_forces_between_spheres(neighbor_list *list, spheres *s, const container *walls,
                                      const dem_contact_parameters *contact, double dt, const leap_frog *leap, vector4 *strayed)
{
    pair_work work;
    pair_work_begin(&work, list, s, walls, contact, dt, leap);
    contact_parts_hand_out(&list->parts, s);
    team_run(list->parts.count, pairs_of_part, &work);
    if (leap) s->front_copy = 1 - s->front_copy;
    double largest = 0.0;
    *strayed = (vector4){ 0 };
    for (int part = 0; part < list->parts.count; part++) {
        list->parts.part[part].took += (double)work.part[part].ticks;
        largest = fmax(largest, work.part[part].largest);
        *strayed = vector4_greater_size(*strayed, work.part[part].strayed);
    }
    return largest;
}
