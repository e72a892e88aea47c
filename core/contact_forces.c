#include "contact_forces.h"

#include "contact_block.h"
#include "leap_frog.h"
#include "wall_forces.h"

/* alike: all spheres have one radius, and the block has its reach and radii. coming: the second ends of the next block,
 * whose rows are sent for; NULL: they are in the cache anyway. */
WIDE_INLINE void gather(contact_block *restrict block, const spheres *s, const int32_t *restrict first,
                        const int32_t *restrict second, const int32_t *coming, bool alike)
{
    const wide to_units = wide_all((real)s->ring_units), to_metres = wide_all((real)(1 / s->ring_units));
    const wide all_reach = alike ? wide_load(block->reach) : to_units;
    for (int k = 0; k < BLOCK; k += LANES) {
        for (int j = k; coming && j < k + LANES; j++) __builtin_prefetch(&s->row[coming[j]]);
        wide_pairs pairs;
        wide_row_pairs(s->row, first + k, second + k, &pairs);
        wide x[3];
        const wide reach = alike ? all_reach : pairs.radii * to_units, gap2 = wide_ring_gap2(pairs.turned, reach, x);
        store_vector(block->n, k, x);
        wide_store(block->distance2 + k, wide_dot(x, x));
        wide_store(block->gap2 + k, gap2 * to_metres);
        store_vector(block->v, k, pairs.v);
        store_vector(block->r_omega, k, pairs.r_omega);
        store_vector(block->omega, k, pairs.omega);
        if (alike) continue;
        wide_store(block->reach + k, reach);
        wide_store(block->radii + k, pairs.radii);
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

static void gather_spheres(contact_block *restrict block, const spheres *s, const int32_t *restrict first,
                           const int32_t *restrict second, const int32_t *coming, bool alike)
{
    if (alike) gather(block, s, first, second, coming, true);
    else gather(block, s, first, second, coming, false);
}

/* For rolling friction alone: the rows' sums don't tell. */
static void gather_spins(contact_block *restrict block, const spheres *s, const int32_t *restrict first,
                         const int32_t *restrict second)
{
    for (int k = 0; k < BLOCK; k += LANES) {
        wide spin[3];
        wide_row_spins(s->row, first + k, second + k, spin);
        store_vector(block->spin, k, spin);
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

/* ds = (v_r - (v_r.n) n) dt, v_r = v_j - v_i - (r_a omega_i + r_b omega_j) x n, r = R - overlap/2. */
static void displacements(contact_block *restrict block, real time_step)
{
    const wide dt = wide_all(time_step), half = wide_all((real)0.5);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide less = -half * wide_load(block->overlap + k);
        wide s[3], v_r[3];
        for (int c = 0; c < 3; c++) s[c] = wide_fused(less, wide_load(block->omega[c] + k), wide_load(block->r_omega[c] + k));
        for (int c = 0; c < 3; c++) v_r[c] = wide_load(block->v[c] + k) - cross(s, n, c);
        const wide v_n = -wide_dot(v_r, n);
        wide_store(block->closing + k, v_n);
        for (int c = 0; c < 3; c++) wide_store(block->ds[c] + k, wide_fused(v_n, n[c], v_r[c]) * dt);
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
        const wide f_n = -wide_load(block->f_n + k), overlap = wide_load(block->overlap + k);
        const wide r_first = wide_load(first_radius + k), r_a = wide_fused(-half, overlap, r_first);
        wide f[3], q[3], moment[3];
        for (int c = 0; c < 3; c++) {
            f[c] = wide_fused(f_n, n[c], t[c]);
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

void contact_block_forces(contact_list *list, size_t start, contact_block *block, const dem_contact_parameters *contact,
                          bool is_wall, double dt, wide *largest)
{
    *largest = normals(block, *largest);
    displacements(block, (real)dt);
    if (contact->law == DEM_WALTON_BRAUN) contact_block_walton_braun(block, list, start, contact);
    else contact_block_damped_springs(block, list, start, contact, is_wall, dt);
    if (list->has_rolling) contact_block_roll(block, list, start, contact, is_wall, dt);
    const real *first_radius = list->first_radius + constants_of(list, start);
    const real *force[3];
    for (int c = 0; c < 3; c++) force[c] = contact->law == DEM_WALTON_BRAUN ? list->t[c] + start : block->force[c];
    if (list->has_rolling) make_rows(block, force, first_radius, true, list->ends_differ);
    else make_rows(block, force, first_radius, false, list->ends_differ);
}

/* Bytes from the first of spheres.load: which of them gets what the first ends of a block get, and the second. */
typedef struct block_loads {
    uint32_t first[BLOCK], second[BLOCK];
} block_loads;

static uint32_t load_offset(size_t load) { return (uint32_t)(load * sizeof(row8)); }

/* Of pairs start..start+BLOCK-1, which are a part's. later: the first of list->later_end that is not before them; then the
 * first behind them. */
static void find_loads(block_loads *restrict to, const neighbor_list *list, size_t start, const spheres *s, int part, size_t *later)
{
    const int32_t *restrict first = list->pairs.first + start, *restrict second = list->pairs.second + start;
    const size_t mobile = s->mobile_count;
    for (int k = 0; k < BLOCK; k++) {
        to->first[k] = load_offset((uint32_t)first[k]);
        to->second[k] = load_offset((uint32_t)second[k]);
    }
    if (s->lining_count || start + BLOCK > list->pairs.count) {
        const uint32_t end = load_offset(mobile), nobody = load_offset(mobile + (size_t)part);
        for (int k = 0; k < BLOCK; k++) { /* lining and padding */
            to->first[k] = to->first[k] < end ? to->first[k] : nobody;
            to->second[k] = to->second[k] < end ? to->second[k] : nobody;
        }
    }
    for (; *later < list->later_count && list->later_end[*later] < 2 * (start + BLOCK); ++*later) {
        const size_t end = list->later_end[*later] - 2 * start;
        (end % 2 ? to->second : to->first)[end / 2] = load_offset(mobile + MOST_PARTS + *later);
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

typedef struct pair_work {
    neighbor_list *list;
    spheres *spheres;
    const container *walls; /* NULL: all their contacts have their rows */
    const dem_contact_parameters *contact;
    double dt;
    const leap_frog *leap;
    /* of each part */
    double largest[MOST_PARTS]; /* m, overlaps */
    vector4 strayed[MOST_PARTS];
} pair_work;

/* How far one part has come. */
typedef struct part_turn {
    const pair_work *work;
    size_t complete; /* the first sphere that has not all its forces yet */
    size_t shared;   /* the next of list->shared */
    size_t walls;    /* the first contact with a wall whose row is the part's to make yet */
    size_t walls_end;
    wide largest; /* m, overlaps */
    vector4 strayed;
} part_turn;

/* Contacts with walls come last in a sphere's sum. */
WIDE_INLINE void add_walls(const neighbor_list *list, spheres *s, size_t from, size_t to)
{
    for (size_t k = list->wall_start[from]; k < list->wall_start[to]; k++) s->load[list->walls.first[k]] += list->walls.row[k];
}

/* The spheres from..to-1 have all their forces from others. */
WIDE_INLINE void spheres_complete(part_turn *turn, size_t from, size_t to)
{
    const pair_work *const work = turn->work;
    neighbor_list *const list = work->list;
    spheres *const s = work->spheres;
    add_walls(list, s, from, to);
    const size_t last = to < s->single_count ? to : s->single_count;
    if (work->leap && from < last)
        turn->strayed = vector4_greater_size(turn->strayed, spheres_advance(work->leap, s, list->picked_velocity, from, last));
}

/* The part's own up to `to`, but those that wait for other parts. */
WIDE_INLINE void own_spheres_complete(part_turn *turn, size_t to)
{
    const pair_work *const work = turn->work;
    neighbor_list *const list = work->list;
    for (; turn->walls < turn->walls_end && turn->walls < list->wall_start[to]; turn->walls += BLOCK)
        contact_forces_with_walls_of_block(list, turn->walls, work->spheres, work->walls, work->contact, work->dt, &turn->largest);
    for (; turn->shared < list->shared_count && (size_t)list->shared[turn->shared] < to; turn->shared++) {
        const size_t waiting = (size_t)list->shared[turn->shared];
        if (turn->complete < waiting) spheres_complete(turn, turn->complete, waiting);
        turn->complete = waiting + 1;
    }
    if (turn->complete < to) spheres_complete(turn, turn->complete, to);
    turn->complete = to;
}

/* The blocks of contacts with walls that are one part's alone. */
static void part_walls(const neighbor_list *list, int part, size_t *from, size_t *to)
{
    const size_t end = list->wall_start[list->part_begins[part + 1]];
    *from = round_up_to_block(list->wall_start[list->part_begins[part]]);
    *to = part + 1 < list->parts ? end / BLOCK * BLOCK : end;
}

/* Those that several parts have a share in, before any of them begins. */
static double walls_of_several(const pair_work *work)
{
    wide largest = wide_all(0);
    const neighbor_list *const list = work->list;
    for (size_t part = 1, done = 0; part < (size_t)list->parts; part++) {
        const size_t from = list->wall_start[list->part_begins[part]], start = from / BLOCK * BLOCK;
        if (from == start || start + BLOCK <= done) continue;
        contact_forces_with_walls_of_block(work->list, start, work->spheres, work->walls, work->contact, work->dt, &largest);
        done = start + BLOCK;
    }
    return wide_largest_lane(largest);
}

/* One part's blocks. A sphere is first in contacts with those behind it in memory alone: behind its last one as first, it
 * has all its forces, and no other contact reads its row in this step. */
static void part_forces(pair_work *work, int part)
{
    neighbor_list *const list = work->list;
    spheres *const s = work->spheres;
    contact_list *const pairs = &list->pairs;
    const size_t end = list->part_blocks[part + 1], own_end = list->part_begins[part + 1];
    part_turn turn = { .work = work, .complete = list->part_begins[part], .shared = list->part_shared[part] };
    if (work->walls) part_walls(list, part, &turn.walls, &turn.walls_end);
    size_t later = list->part_later[part];
    const bool alike = pairs->constants == CONSTANTS_OF_ALL;
    contact_block block;
    if (alike) set_reach(&block, s);
    for (size_t b = list->part_blocks[part]; b < end; b++) {
        const int32_t *const first = pairs->first + b * BLOCK, *const second = pairs->second + b * BLOCK;
        const int32_t *const coming = s->are_many && b + 1 < end ? second + BLOCK : NULL;
        block_loads loads;
        gather_spheres(&block, s, first, second, coming, alike);
        if (pairs->has_rolling) gather_spins(&block, s, first, second);
        contact_block_forces(pairs, b * BLOCK, &block, work->contact, false, work->dt, &turn.largest);
        find_loads(&loads, list, b * BLOCK, s, part, &later);
        add_to_loads(&block, &loads, pairs->ends_differ, s->load, coming);
        if (b + 1 == end) break;
        const size_t next = (size_t)first[BLOCK];
        if (next > turn.complete) own_spheres_complete(&turn, next);
    }
    own_spheres_complete(&turn, own_end);
    work->largest[part] = wide_largest_lane(turn.largest);
    work->strayed[part] = turn.strayed;
}

/* What several parts gave to one sphere, in the order of the list as if there were but one part; then its step. */
static void part_finish(pair_work *work, int part)
{
    const neighbor_list *const list = work->list;
    spheres *const s = work->spheres;
    const size_t from = list->part_begins[part], to = list->part_begins[part + 1];
    row8 *const later = s->load + s->mobile_count + MOST_PARTS;
    for (size_t k = 0; k < list->later_count; k++) {
        const size_t i = (size_t)list->later[k];
        if (i < from || i >= to) continue;
        s->load[i] += later[k];
        later[k] = (row8){ 0 };
    }
    part_turn turn = { .work = work, .strayed = work->strayed[part] };
    for (size_t k = list->part_shared[part], next; k < list->part_shared[part + 1]; k = next) {
        next = k + 1;
        while (next < list->part_shared[part + 1] && list->shared[next] == list->shared[next - 1] + 1) next++;
        const size_t i = (size_t)list->shared[k];
        spheres_complete(&turn, i, i + (next - k));
    }
    work->strayed[part] = turn.strayed;
}

static void pairs_of_part(void *context, int part, int parts)
{
    (void)parts;
    part_forces(context, part);
}

static void rest_of_part(void *context, int part, int parts)
{
    (void)parts;
    part_finish(context, part);
}

double contact_forces_between_spheres(neighbor_list *list, spheres *s, const container *walls,
                                      const dem_contact_parameters *contact, double dt, const leap_frog *leap, vector4 *strayed)
{
    pair_work work;
    work.list = list, work.spheres = s, work.walls = walls, work.contact = contact, work.dt = dt, work.leap = leap;
    double largest = walls ? walls_of_several(&work) : 0.0;
    team_run(list->parts, pairs_of_part, &work);
    if (list->shared_count) team_run(list->parts, rest_of_part, &work);
    *strayed = (vector4){ 0 };
    for (int part = 0; part < list->parts; part++) {
        largest = fmax(largest, work.largest[part]);
        *strayed = vector4_greater_size(*strayed, work.strayed[part]);
    }
    return largest;
}
