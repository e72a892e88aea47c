#include "contact_forces.h"

#include "contact_block.h"

/* Order of a sphere's row behind its place. */
enum { RADIUS = 0, VELOCITY = 1, R_OMEGA = 4, OMEGA = 7 };

static void gather_spheres(contact_block *restrict block, const sphere_row *restrict row, const int32_t *restrict first,
                           const int32_t *restrict second, const container *drum)
{
    /* of two rows: sums, but for the velocity, of which the difference */
    static const float sign[16] = { [7] = -0.0f, -0.0f, -0.0f };
    const wide_double period = wide_double_all(drum->period), inverse_period = wide_double_all(drum->inverse_period);
    for (int k = 0; k < BLOCK; k += LANES) {
        wide sum[ROW_NUMBERS];
        wide_double dx[HALVES], dy[HALVES], dz[HALVES], d2[HALVES], gap2[HALVES], radii[HALVES];
        wide_row_sums(row, sizeof *row, first + k, second + k, sign, sum);
        wide_to_doubles(sum[RADIUS], radii);
        for (int h = 0; h < HALVES; h++) {
            wide_place_differences(row, sizeof *row, first + k + 8 * h, second + k + 8 * h, &dx[h], &dy[h], &dz[h]);
            dz[h] -= period * wide_double_rint(dz[h] * inverse_period);
            d2[h] = wide_double_fused(dz[h], dz[h], wide_double_fused(dy[h], dy[h], dx[h] * dx[h]));
            gap2[h] = wide_double_fused(radii[h], radii[h], -d2[h]);
        }
        const wide d[3] = { wide_from_doubles(dx), wide_from_doubles(dy), wide_from_doubles(dz) };
        store_vector(block->n, k, d);
        wide_store(block->distance2 + k, wide_from_doubles(d2));
        wide_store(block->gap2 + k, wide_from_doubles(gap2));
        wide_store(block->reach + k, sum[RADIUS]);
        wide_store(block->radii + k, sum[RADIUS]);
        store_vector(block->v, k, sum + VELOCITY);
        store_vector(block->r_omega, k, sum + R_OMEGA);
        store_vector(block->omega, k, sum + OMEGA);
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
 * spheres grow, radii are below full size, but then there is no friction, hence no moment.) */
static void write_rows(const contact_block *restrict block, const real *restrict first_radius, contact_row *restrict row)
{
    const wide half = wide_all((real)0.5);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide t[3] = { wide_load(block->force[0] + k), wide_load(block->force[1] + k), wide_load(block->force[2] + k) };
        const wide f_n = -wide_load(block->f_n + k), less = half * wide_load(block->overlap + k);
        const wide r_first = wide_load(first_radius + k);
        const wide r_a = r_first - less, r_b = wide_load(block->radii + k) - r_first - less;
        wide f[3], q[3];
        for (int c = 0; c < 3; c++) {
            f[c] = wide_fused(f_n, n[c], t[c]);
            q[c] = cross(n, t, c);
        }
        const wide on_first[3] = { r_a * q[0], r_a * q[1], r_a * q[2] }, on_second[3] = { r_b * q[0], r_b * q[1], r_b * q[2] };
        wide_store_ends((real *)(row + k), f, on_first, on_second);
    }
}

static wide block_largest_overlap(const contact_block *block, real *restrict overlap)
{
    wide largest = wide_all(0);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide here = wide_load(block->overlap + k);
        wide_store(overlap + k, here);
        largest = wide_greater(largest, here);
    }
    return largest;
}

static double largest_lane(wide x)
{
    double largest = 0.0;
    for (int k = 0; k < LANES; k++) largest = (double)x[k] > largest ? (double)x[k] : largest;
    return largest;
}

double contact_block_forces(contact_list *list, size_t start, contact_block *block, const dem_contact_parameters *contact,
                            bool is_wall, double dt)
{
    normals(block);
    displacements(block, (real)dt);
    if (contact->law == DEM_WALTON_BRAUN) contact_block_walton_braun(block, list, start, contact);
    else contact_block_damped_springs(block, list, start, contact, is_wall, dt);
    write_rows(block, list->first_radius + start, list->row + start);
    return largest_lane(block_largest_overlap(block, list->overlap + start));
}

double contact_forces_between_spheres(contact_list *pairs, const spheres *s, const container *drum,
                                      const dem_contact_parameters *contact, double dt, int threads)
{
    double largest = 0.0;
    const size_t count = round_up_to_block(pairs->count);
#pragma omp parallel for schedule(static) reduction(max : largest) num_threads(threads) if (threads > 1)
    for (size_t start = 0; start < count; start += BLOCK) {
        contact_block block;
        gather_spheres(&block, s->row, pairs->first + start, pairs->second + start, drum);
        largest = fmax(largest, contact_block_forces(pairs, start, &block, contact, false, dt));
    }
    return largest;
}

void contact_forces_sum(const neighbor_list *list, spheres *s, int threads)
{
    const row8 *restrict end = list->rows->end;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < s->mobile_count; i++) {
        row8 load = { 0 };
        /* Whole groups, the last filled up with rows of zeros: almost every sphere has one group, so that the
         * processor foresees the end of the loop. */
        for (size_t k = list->ends_start[i]; k < list->ends_start[i + 1]; k += ENDS_A_GROUP)
            for (size_t m = 0; m < ENDS_A_GROUP; m++) load += end[list->ends[k + m]];
        s->load[i] = load;
    }
}
