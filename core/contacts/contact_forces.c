#include "contact_forces.h"

#include "wall_forces.h"

/* What all contacts of a block have, from the way between their ends in ring units. */
WIDE_INLINE void store_geometry(contact_block *restrict block, int k, const wide_ring apart[3], wide reach, wide to_metres)
{
    wide x[3];
    const wide gap2 = wide_ring_gap2(apart, reach, x);
    store_vector(block->n, k, x);
    /* not zero where centres nearly coincide, by rounding */
    const wide reach2 = reach * reach;
    wide_store(block->distance2 + k, wide_greater(reach2 - gap2, reach2 * wide_all((real)0x1p-20)));
    wide_store(block->gap2 + k, gap2 * to_metres);
}

WIDE_INLINE void send_for(const spheres *s, const int32_t *coming)
{
    for (int k = 0; k < LANES; k++) __builtin_prefetch(&s->row[coming[k]]);
    for (int k = 0; s->exceed_caches && k < LANES; k++) __builtin_prefetch(&s->rest[coming[k]]);
}

/* What the contacts from `next` on remember, and who those after them are: these are more arrays than the processor follows
 * by itself. Inline: a call that only sends for memory has no effect that the compiler sees, and would be left out. */
WIDE_INLINE void send_for_block(const contact_list *pairs, size_t next)
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

/* Of spheres that are all alike: the block has their reach and radii. in_order: first ends ascend, before this one; 0: they
 * may be any. coming: the second ends of the next block, whose rows are sent for; NULL: they are in the cache anyway. */
static void gather_alike(contact_block *restrict block, const spheres *s, const int32_t *restrict first,
                         const int32_t *restrict second, size_t in_order, const int32_t *coming)
{
    const wide to_metres = wide_all((real)(1 / s->ring_units)), reach = wide_load(block->reach);
    for (int k = 0; k < BLOCK; k += LANES) {
        if (coming) send_for(s, coming + k);
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

/* coming: as above. spins: also what rolling friction needs. */
WIDE_INLINE void gather_any(contact_block *restrict block, const spheres *s, const int32_t *restrict first,
                            const int32_t *restrict second, const int32_t *coming, bool spins)
{
    const wide to_units = wide_all((real)s->ring_units), to_metres = wide_all((real)(1 / s->ring_units));
    for (int k = 0; k < BLOCK; k += LANES) {
        if (coming) send_for(s, coming + k);
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

/* Of spheres that are all alike: their radius as rows have it, which other parts may be writing by now. */
static void set_reach(contact_block *block, const spheres *s)
{
    const wide radii = wide_all(2 * (real)(s->scale * (double)s->full_radius[0])), reach = radii * wide_all((real)s->ring_units);
    for (int k = 0; k < BLOCK; k += LANES) {
        wide_store(block->reach + k, reach);
        wide_store(block->radii + k, radii);
    }
}

/* Unit normal and overlap. The overlap is the difference of squares, which was taken exactly, over the sum: a small
 * overlap keeps its digits. Returns the largest overlap so far. */
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

/* ds = (v_r - (v_r.n) n) factor, v_r = v_j - v_i - (r_a omega_i + r_b omega_j) x n, r = R - overlap/2. radius: R of both
 * ends; NULL: they may differ. */
WIDE_INLINE void displacements(contact_block *restrict block, const real *restrict radius, double factor)
{
    const wide times = wide_all((real)factor), half = wide_all((real)0.5);
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
        const wide parting = wide_dot(v_r, n);
        wide_store(block->parting + k, parting);
        for (int c = 0; c < 3; c++) wide_store(block->ds[c] + k, wide_minus_product(v_r[c], parting, n[c]) * times);
    }
}

/* force: T. f on the first = T - N n; moments about the centres: n x f = n x T times each lever r = R - overlap/2. (While
 * spheres grow, radii are below full size, but then there is no friction, hence no moment.) rolls: with the
 * moments of rolling friction, opposite for the two ends. */
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

/* Whether gather_alike is what serves. */
static bool are_alike(const contact_list *pairs) { return pairs->constants == CONSTANTS_OF_ALL && !pairs->has_rolling; }

void contact_block_forces(contact_list *list, size_t start, contact_block *block, const dem_contact_parameters *contact,
                          bool is_wall, double dt, wide *largest)
{
    const bool is_damped = contact->law != DEM_WALTON_BRAUN;
    const real *const first_radius = list->first_radius + constants_of(list, start);
    *largest = normals(block, *largest);
    const double factor = is_damped ? dt : contact->stiffness * contact->tangential_stiffness_ratio * dt;
    if (is_wall || are_alike(list)) displacements(block, first_radius, factor);
    else displacements(block, NULL, factor);
    if (!is_damped) contact_block_walton_braun(block, list, start, contact);
    else contact_block_damped_springs(block, list, start, contact, dt);
    if (list->has_rolling) contact_block_roll(block, list, start, contact, dt);
    const real *force[3];
    for (int c = 0; c < 3; c++) force[c] = is_damped ? block->force[c] : list->t[c] + start;
    if (list->has_rolling) make_rows(block, force, first_radius, true, list->ends_differ);
    else make_rows(block, force, first_radius, false, list->ends_differ);
}

/* Bytes from the first of spheres.load: which of them gets what the first ends of a block get, and the second. */
typedef struct block_loads {
    uint32_t first[BLOCK], second[BLOCK];
} block_loads;

static uint32_t load_offset(size_t load) { return (uint32_t)(load * sizeof(row8)); }

/* Of the spheres begin..end-1 of a block's contacts; what the others get is for nobody, who has several loads, so that sums
 * need not wait for each other. all: there are no others. */
static void find_loads(block_loads *restrict to, const int32_t *restrict first, const int32_t *restrict second, size_t begin,
                       size_t end, size_t nobody, bool all)
{
    const uint32_t none = load_offset(nobody), start = (uint32_t)begin, count = (uint32_t)(end - begin);
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

/* Adds a block's rows to their spheres' loads, while they are in the first-level cache. coming: as above, for their loads. */
static void add_to_loads(const contact_block *restrict block, const block_loads *to, bool ends_differ, row8 *loads,
                         const int32_t *coming)
{
    static const row8 on_second = { -1, -1, -1, 1, 1, 1, 0, 0 };
    const contact_row *restrict row = block->row, *restrict second_row = ends_differ ? block->second_row : block->row;
    char *restrict load = (char *)loads;
    for (int begin = 0; begin < BLOCK; begin += LANES) {
#pragma GCC unroll 16 /* rows lie in an order that is known then */
        for (int lane = 0; lane < LANES; lane++) {
            const int k = begin + lane, from = begin + wide_row_slot(lane);
            row8 *const first = (row8 *)(load + to->first[k]), *const second = (row8 *)(load + to->second[k]);
            if (coming) __builtin_prefetch(&loads[coming[k]], 1);
            *first += row[from];
            *second = row8_fused(on_second, second_row[from], *second);
        }
    }
}

/* Contacts with walls come last in a sphere's sum. */
WIDE_INLINE void add_walls(const neighbor_list *list, spheres *s, size_t from, size_t to)
{
    for (size_t k = list->wall_start[from]; k < list->wall_start[to]; k++) s->load[list->walls.first[k]] += list->walls.row[k];
}

/* The part's own up to `to` have all their forces from others. */
WIDE_INLINE void spheres_complete(list_cursor *cursor, size_t to)
{
    enum { AHEAD = 96 }; /* of three blocks or four */
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

/* One block, to the loads of the part's own spheres. rows: NULL: all are. coming: as above. */
WIDE_INLINE void block_forces(list_cursor *cursor, contact_list *pairs, size_t b, const block_rows *rows, const int32_t *coming)
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
    if (are_alike(pairs)) gather_alike(block, s, first_row, second_row, rows ? 0 : parts->sphere[cursor->part + 1], coming);
    else if (pairs->has_rolling) gather_any(block, s, first_row, second_row, coming, true);
    else gather_any(block, s, first_row, second_row, coming, false);
    if (coming && s->exceed_caches) send_for_block(pairs, (b + 1) * BLOCK);
    contact_block_forces(pairs, b * BLOCK, block, work->contact, false, work->dt, &cursor->largest);
    find_loads(&loads, first, second, parts->sphere[cursor->part], parts->sphere[cursor->part + 1],
               loads_of_nobody(s, cursor->part), !rows && all_mobile);
    add_to_loads(block, &loads, pairs->ends_differ, s->load, coming);
}

/* Of a list that is not gone through from block to block. */
static __attribute__((noinline)) void block_forces_aside(list_cursor *cursor, contact_list *pairs, size_t b, const block_rows *rows)
{
    block_forces(cursor, pairs, b, rows, NULL);
}

/* Block b is done: spheres before the first of the next one have all their forces. A sphere is first in contacts with those
 * behind it in memory alone: behind its last one as first, no other contact reads its row in this step. */
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
    const int32_t *const coming =
        cursor->work->spheres->are_many && cursor->next < cursor->end ? pairs->second + cursor->next * BLOCK : NULL;
    block_forces(cursor, pairs, b, is_across ? &own->rows[cursor->across++] : NULL, coming);
    block_done(cursor, b);
}

void list_cursor_complete(list_cursor *cursor, size_t to) { spheres_complete(cursor, to); }

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
    block_forces_aside(cursor, pairs, b, &rows);
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

/* One part's blocks, after the copies of what earlier parts have. */
static void part_forces(pair_work *work, int part)
{
    contact_part *const own = &work->list->parts.part[part];
    const size_t own_end = work->list->parts.sphere[part + 1];
    contact_block block;
    list_cursor cursor = list_cursor_begin(work, part, &block);
    for (size_t b = 0; b * BLOCK < own->copies.count; b++)
        block_forces_aside(&cursor, &own->copies, b, &own->rows[own->across_count + b]);
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
