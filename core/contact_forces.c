#include "contact_forces.h"

#include "contact_block.h"

static void gather_spheres(contact_block *restrict block, const spheres *s, const int32_t *restrict first,
                           const int32_t *restrict second)
{
    double unit[3];
    spheres_ring_unit(s, unit);
    for (int k = 0; k < BLOCK; k += LANES) {
        wide_pairs pairs;
        wide_double radii[HALVES], d2[HALVES], gap2[HALVES];
        wide_row_pairs(s->row, first + k, second + k, unit, &pairs);
        wide_to_doubles(pairs.radii, radii);
        for (int h = 0; h < HALVES; h++) {
            const wide_double x = pairs.x[0][h], y = pairs.x[1][h], z = pairs.x[2][h];
            d2[h] = wide_double_fused(z, z, wide_double_fused(y, y, x * x));
            gap2[h] = wide_double_fused(radii[h], radii[h], -d2[h]);
        }
        store_vector(block->n, k, pairs.n);
        wide_store(block->distance2 + k, wide_from_doubles(d2));
        wide_store(block->gap2 + k, wide_from_doubles(gap2));
        wide_store(block->reach + k, pairs.radii);
        wide_store(block->radii + k, pairs.radii);
        store_vector(block->v, k, pairs.v);
        store_vector(block->r_omega, k, pairs.r_omega);
        store_vector(block->omega, k, pairs.omega);
    }
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

/* Unit normal and overlap. The overlap is the difference of squares, which was taken in double, over the sum: a
 * small overlap keeps its digits. */
static void normals(contact_block *restrict block)
{
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide distance2 = wide_load(block->distance2 + k), to_unit = wide_inverse_root(distance2);
        for (int c = 0; c < 3; c++) wide_store(block->n[c] + k, wide_load(block->n[c] + k) * to_unit);
        const wide sum = wide_fused(distance2, to_unit, wide_load(block->reach + k));
        wide_store(block->overlap + k, wide_load(block->gap2 + k) * wide_inverse(sum));
    }
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

/* f on the first = T - N n; moments about the centres: n x f = n x T times each lever r = R - overlap/2. (While
 * spheres grow, radii are below full size, but then there is no friction, hence no moment.) rolls: with the
 * moments of rolling friction, opposite for the two ends. second: may be NULL. */
WIDE_INLINE void write_rows(const contact_block *restrict block, const real *restrict first_radius, bool rolls,
                            contact_row *restrict row, contact_row *restrict second)
{
    const wide half = wide_all((real)0.5);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide t[3] = { wide_load(block->force[0] + k), wide_load(block->force[1] + k), wide_load(block->force[2] + k) };
        const wide f_n = -wide_load(block->f_n + k), less = half * wide_load(block->overlap + k);
        const wide r_first = wide_load(first_radius + k), r_a = r_first - less;
        wide f[3], q[3], moment[3];
        for (int c = 0; c < 3; c++) {
            f[c] = wide_fused(f_n, n[c], t[c]);
            q[c] = cross(n, t, c);
            moment[c] = rolls ? wide_fused(r_a, q[c], wide_load(block->moment[c] + k)) : r_a * q[c];
        }
        wide_store_rows(row + k, f, moment);
        if (!second) continue;
        const wide r_b = wide_load(block->radii + k) - r_first - less;
        for (int c = 0; c < 3; c++) moment[c] = rolls ? wide_fused(r_b, q[c], -wide_load(block->moment[c] + k)) : r_b * q[c];
        wide_store_rows(second + k, f, moment);
    }
}

static void keep_overlaps(const contact_block *restrict block, real *restrict overlap, wide *largest)
{
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide here = wide_load(block->overlap + k);
        wide_store(overlap + k, here);
        *largest = wide_greater(*largest, here);
    }
}

void contact_block_forces(contact_list *list, size_t start, contact_block *block, const dem_contact_parameters *contact,
                          bool is_wall, double dt, wide *largest)
{
    normals(block);
    displacements(block, (real)dt);
    if (contact->law == DEM_WALTON_BRAUN) contact_block_walton_braun(block, list, start, contact);
    else contact_block_damped_springs(block, list, start, contact, is_wall, dt);
    if (list->has_rolling) contact_block_roll(block, list, start, contact, is_wall, dt);
    contact_row *const row = list->row + start, *const second = list->second_row ? list->second_row + start : NULL;
    if (list->has_rolling) write_rows(block, list->first_radius + start, true, row, second);
    else write_rows(block, list->first_radius + start, false, row, second);
    keep_overlaps(block, list->overlap + start, largest);
}

double contact_forces_between_spheres(contact_list *pairs, const spheres *s, const dem_contact_parameters *contact, double dt,
                                      int threads)
{
    double largest = 0.0;
    const size_t blocks = round_up_to_block(pairs->count) / BLOCK;
#pragma omp parallel for schedule(static) reduction(max : largest) num_threads(threads) if (threads > 1)
    for (int part = 0; part < threads; part++) {
        wide largest_here = wide_all(0);
        for (size_t b = part_start(blocks, part, threads); b < part_start(blocks, part + 1, threads); b++) {
            contact_block block;
            gather_spheres(&block, s, pairs->first + b * BLOCK, pairs->second + b * BLOCK);
            if (pairs->has_rolling) gather_spins(&block, s, pairs->first + b * BLOCK, pairs->second + b * BLOCK);
            contact_block_forces(pairs, b * BLOCK, &block, contact, false, dt, &largest_here);
        }
        largest = fmax(largest, wide_largest_lane(largest_here));
    }
    return largest;
}

void contact_forces_sum(const neighbor_list *list, spheres *s, size_t from, int threads)
{
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = from; i < s->mobile_count; i++) s->load[i] = contact_forces_of(list, i);
}
