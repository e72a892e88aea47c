#include "contact_forces.h"

#include "wide.h"

/* The law is applied in short passes over a block of contacts: gather, normal, displacement, normal force, turned
 * friction, friction stiffness, friction, output. Each pass works on LANES contacts at once without branches; a
 * block's values stay in the first-level cache between passes. The passes are short so that the processor works on
 * several batches at a time: in one long pass, each batch waits for the chain of its own roots and quotients. */
typedef struct contact_block {
    real n[3][BLOCK];       /* displacement between centres, m; then unit normal, first to second */
    real distance2[BLOCK];  /* m2; to the wall: from the axis */
    real gap2[BLOCK];       /* m2: square of the distance at first touch less distance2 (wall: the reverse) */
    real reach[BLOCK];      /* m: distance at first touch */
    real radii[BLOCK];      /* m, of both together; a wall has none */
    real v[3][BLOCK];       /* m/s: second less first */
    real r_omega[3][BLOCK]; /* m/s: sum of radius times spin */
    real omega[3][BLOCK];   /* rad/s: sum of spins */
    real overlap[BLOCK];    /* m, negative: apart */
    real ds[3][BLOCK];      /* m, tangential displacement of this step */
    real f_n[BLOCK];        /* N, normal force */
    real h[3][BLOCK];       /* direction of the stored friction force, turned into the tangent plane */
    real mu_n[BLOCK];       /* N, limit of friction */
    real stored[BLOCK];     /* N, magnitude of the stored friction force; then what it becomes along h */
    real s_p[BLOCK];        /* m, displacement along h */
} __attribute__((aligned(ALIGNMENT))) contact_block;

/* Order of a sphere's row behind its place. */
enum { RADIUS = 0, VELOCITY = 1, R_OMEGA = 4, OMEGA = 7 };

WIDE_INLINE void store_vector(real to[3][BLOCK], int k, const wide x[3])
{
    for (int c = 0; c < 3; c++) wide_store(to[c] + k, x[c]);
}

static void gather_spheres(contact_block *restrict block, const sphere_row *restrict row, const int32_t *restrict first,
                           const int32_t *restrict second, double length)
{
    /* of two rows: sums, but for the velocity, of which the difference */
    static const float sign[16] = { [7] = -0.0f, -0.0f, -0.0f };
    const wide_double period = wide_double_all(length), inverse_period = wide_double_all(1.0 / length);
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

static void gather_sphere_and_cylinder(contact_block *restrict block, const sphere_row *restrict row, const int32_t *restrict first,
                                       int32_t origin, double radius, real rotation_rate)
{
    static const float as_it_is[16] = { 0 };
    int32_t nothing[LANES];
    for (int k = 0; k < LANES; k++) nothing[k] = origin;
    for (int k = 0; k < BLOCK; k += LANES) {
        wide own[ROW_NUMBERS];
        wide_double x[HALVES], y[HALVES], z[HALVES], rho2[HALVES], beyond2[HALVES], r[HALVES];
        wide_row_sums(row, sizeof *row, nothing, first + k, as_it_is, own);
        wide_to_doubles(own[RADIUS], r);
        for (int h = 0; h < HALVES; h++) {
            wide_place_differences(row, sizeof *row, nothing, first + k + 8 * h, &x[h], &y[h], &z[h]);
            const wide_double room = wide_double_all(radius) - r[h];
            rho2[h] = x[h] * x[h] + y[h] * y[h];
            beyond2[h] = rho2[h] - room * room; /* overlap = rho - (R - r) */
        }
        const wide outward[3] = { wide_from_doubles(x), wide_from_doubles(y), wide_all(0) };
        const wide rate = wide_all(rotation_rate);
        /* the wall's velocity at the place of the contact: omega x r, at the wall rather than at the centre */
        const wide widen = wide_all((real)radius) * wide_inverse_root(wide_from_doubles(rho2));
        const wide v[3] = { -rate * widen * outward[1] - own[VELOCITY], rate * widen * outward[0] - own[VELOCITY + 1], -own[VELOCITY + 2] };
        store_vector(block->n, k, outward);
        wide_store(block->distance2 + k, wide_from_doubles(rho2));
        wide_store(block->gap2 + k, wide_from_doubles(beyond2));
        wide_store(block->reach + k, wide_all((real)radius) - own[RADIUS]);
        wide_store(block->radii + k, own[RADIUS]);
        store_vector(block->v, k, v);
        store_vector(block->r_omega, k, own + R_OMEGA);
        store_vector(block->omega, k, own + OMEGA);
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
        for (int c = 0; c < 3; c++) wide_store(block->ds[c] + k, wide_fused(v_n, n[c], v_r[c]) * dt);
    }
}

/* normal_force of contact_law.h, LANES at a time. */
static void normal_forces(contact_block *restrict block, real *restrict alpha_0, real stiffness, real unloading_stiffness)
{
    const wide k_1 = wide_all(stiffness), k_2 = wide_all(unloading_stiffness), zero = wide_all(0);
    const wide latch = wide_all(1 - stiffness / unloading_stiffness);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide alpha = wide_load(block->overlap + k);
        const wide latched = wide_greater(wide_load(alpha_0 + k), alpha * latch);
        wide_store(alpha_0 + k, wide_select(wide_exceeds(alpha, zero), latched, zero));
        wide_store(block->f_n + k, wide_greater(wide_lesser(k_1 * alpha, k_2 * (alpha - latched)), zero));
    }
}

/* friction_increment of contact_law.h, LANES at a time, in three passes: the stored force turned into the tangent
 * plane; the stiffness along it; the new force. */
static void turn_friction(contact_block *restrict block, const real *restrict t_x, const real *restrict t_y,
                          const real *restrict t_z, const real *restrict friction)
{
    const wide zero = wide_all(0), tiny = wide_all(TINY_SQUARE);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide t[3] = { wide_load(t_x + k), wide_load(t_y + k), wide_load(t_z + k) };
        const wide ds[3] = { wide_load(block->ds[0] + k), wide_load(block->ds[1] + k), wide_load(block->ds[2] + k) };
        const wide tn = -wide_dot(t, n);
        const wide u[3] = { wide_fused(tn, n[0], t[0]), wide_fused(tn, n[1], t[1]), wide_fused(tn, n[2], t[2]) };
        const wide tt = wide_dot(t, t), uu = wide_dot(u, u);
        const wide_mask has_direction = wide_exceeds(uu, tiny);
        const wide turn = wide_select(has_direction, wide_inverse_root(uu), zero);
        const wide magnitude = wide_select(has_direction, tt * wide_inverse_root(tt), zero);
        const wide h[3] = { u[0] * turn, u[1] * turn, u[2] * turn };
        const wide mu_n = wide_load(friction + k) * wide_load(block->f_n + k);
        store_vector(block->h, k, h);
        wide_store(block->mu_n + k, mu_n);
        wide_store(block->stored + k, wide_lesser(magnitude, mu_n));
        wide_store(block->s_p + k, wide_dot(ds, h));
    }
}

static void friction_stiffness(contact_block *restrict block, real *restrict t_star, real stiffness)
{
    const wide zero = wide_all(0), one = wide_all(1), floor = wide_all(SLIP_FLOOR), k_t0 = wide_all(stiffness);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide mu_n = wide_load(block->mu_n + k), stored = wide_load(block->stored + k), s_p = wide_load(block->s_p + k);
        const wide_mask pressed = wide_exceeds(mu_n, wide_all(TINY_FORCE));
        const wide tau = wide_select(pressed, stored * wide_inverse(mu_n), zero);
        const wide sign = wide_select(wide_exceeds(zero, s_p), -one, one);
        const wide turning = wide_lesser(sign * wide_load(t_star + k), sign * tau);
        const wide left = wide_greater(one - sign * tau, floor), left_at_turn = wide_greater(one - turning, floor);
        const wide k_t = k_t0 * (left * wide_inverse_cube_root(left * left * left_at_turn));
        const wide s = wide_fused(k_t, s_p, stored), star = sign * turning;
        wide_store(block->stored + k, s);
        wide_store(t_star + k, wide_select(pressed, wide_select(wide_exceeds(zero, s), -star, star), zero));
    }
}

static void friction_forces(const contact_block *restrict block, real *restrict t_x, real *restrict t_y, real *restrict t_z, real stiffness)
{
    const wide one = wide_all(1), k_t0 = wide_all(stiffness);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide s = wide_load(block->stored + k), s_p = wide_load(block->s_p + k), mu_n = wide_load(block->mu_n + k);
        wide f[3];
        for (int c = 0; c < 3; c++) {
            const wide h = wide_load(block->h[c] + k);
            f[c] = wide_fused(s, h, k_t0 * wide_fused(-s_p, h, wide_load(block->ds[c] + k)));
        }
        const wide size2 = wide_dot(f, f);
        const wide scale = wide_select(wide_exceeds(size2, mu_n * mu_n), mu_n * wide_inverse_root(size2), one);
        wide_store(t_x + k, f[0] * scale);
        wide_store(t_y + k, f[1] * scale);
        wide_store(t_z + k, f[2] * scale);
    }
}

/* f on the first = T - N n; moments about the centres: n x f = n x T times each lever r = R - overlap/2. (While
 * spheres grow, radii are below full size, but then there is no friction, hence no moment.) */
static void write_rows(const contact_block *restrict block, const real *restrict t_x, const real *restrict t_y,
                       const real *restrict t_z, const real *restrict first_radius, contact_row *restrict row)
{
    const wide half = wide_all((real)0.5);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide t[3] = { wide_load(t_x + k), wide_load(t_y + k), wide_load(t_z + k) };
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

/* Everything behind the gathering, the same for spheres and walls. Returns the largest overlap, m. */
static double block_forces(contact_list *list, size_t start, contact_block *block, const dem_contact_parameters *contact, double dt)
{
    const double k_1 = contact->stiffness, k_2 = k_1 / (contact->restitution * contact->restitution);
    const real k_t0 = (real)(k_1 * contact->tangential_stiffness_ratio);
    real *const t_x = list->t[0] + start, *const t_y = list->t[1] + start, *const t_z = list->t[2] + start;
    normals(block);
    displacements(block, (real)dt);
    normal_forces(block, list->alpha_0 + start, (real)k_1, (real)k_2);
    turn_friction(block, t_x, t_y, t_z, list->friction + start);
    friction_stiffness(block, list->t_star + start, k_t0);
    friction_forces(block, t_x, t_y, t_z, k_t0);
    write_rows(block, t_x, t_y, t_z, list->first_radius + start, list->row + start);
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
        gather_spheres(&block, s->row, pairs->first + start, pairs->second + start, drum->length);
        largest = fmax(largest, block_forces(pairs, start, &block, contact, dt));
    }
    return largest;
}

double contact_forces_with_wall(contact_list *walls, const spheres *s, const container *drum,
                                const dem_contact_parameters *contact, double dt, int threads)
{
    double largest = 0.0;
    const size_t count = round_up_to_block(walls->count);
#pragma omp parallel for schedule(static) reduction(max : largest) num_threads(threads) if (threads > 1)
    for (size_t start = 0; start < count; start += BLOCK) {
        contact_block block;
        gather_sphere_and_cylinder(&block, s->row, walls->first + start, sphere_of_zeros(s), drum->radius, (real)drum->rotation_rate);
        largest = fmax(largest, block_forces(walls, start, &block, contact, dt));
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
