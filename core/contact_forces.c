#include "contact_forces.h"

#include <stddef.h>

#include "wide.h"

/* The law is applied in short passes over a block of contacts: geometry, normal force, friction, output. Each
 * pass works on LANES contacts at once without branches; a block's values stay in the first-level cache between
 * passes. One long pass would be bound by the latency of its divisions and roots. */
typedef struct contact_block {
    real n[3][BLOCK];     /* unit normal, first to second */
    real overlap[BLOCK];  /* m, negative: apart */
    real ds[3][BLOCK];    /* m, tangential displacement of this step */
    real f_n[BLOCK];      /* N, normal force */
} __attribute__((aligned(ALIGNMENT))) contact_block;

/* One component of a sphere's row for each of LANES spheres. */
#define GATHER(member, index) wide_gather(row, (int)offsetof(sphere_row, member), (int)sizeof(sphere_row), index)
#define GATHER_DOUBLE(member, index) wide_double_gather(row, (int)offsetof(sphere_row, member), (int)sizeof(sphere_row), index)

/* Stores normal, overlap and ds = (v_r - (v_r.n) n) dt; s = r_a omega_a + r_b omega_b; v: v_b - v_a. */
WIDE_INLINE void store_geometry(contact_block *block, int k, const wide n[3], wide overlap, const wide s[3], const wide v[3], wide dt)
{
    const wide v_r[3] = { v[0] - (s[1] * n[2] - s[2] * n[1]), v[1] - (s[2] * n[0] - s[0] * n[2]),
                          v[2] - (s[0] * n[1] - s[1] * n[0]) };
    const wide v_n = v_r[0] * n[0] + v_r[1] * n[1] + v_r[2] * n[2];
    wide_store(block->overlap + k, overlap);
    for (int c = 0; c < 3; c++) {
        wide_store(block->n[c] + k, n[c]);
        wide_store(block->ds[c] + k, (v_r[c] - v_n * n[c]) * dt);
    }
}

static void geometry_between_spheres(contact_block *restrict block, const sphere_row *restrict row,
                                     const int32_t *restrict first, const int32_t *restrict second, double length, real time_step)
{
    const wide_double period = wide_double_all(length), inverse_period = wide_double_all(1.0 / length);
    const wide dt = wide_all(time_step), half = wide_all((real)0.5);
    for (int k = 0; k < BLOCK; k += LANES) {
        const int32_t *a = first + k, *b = second + k;
        wide_double dx[HALVES], dy[HALVES], dz[HALVES], d2[HALVES], gap2[HALVES];
        for (int h = 0; h < HALVES; h++) {
            const int32_t *ah = a + 8 * h, *bh = b + 8 * h;
            dx[h] = GATHER_DOUBLE(x[0], bh) - GATHER_DOUBLE(x[0], ah);
            dy[h] = GATHER_DOUBLE(x[1], bh) - GATHER_DOUBLE(x[1], ah);
            dz[h] = GATHER_DOUBLE(x[2], bh) - GATHER_DOUBLE(x[2], ah);
            dz[h] -= period * wide_double_rint(dz[h] * inverse_period);
            d2[h] = dx[h] * dx[h] + dy[h] * dy[h] + dz[h] * dz[h];
            const wide_double radii = GATHER_DOUBLE(exact_radius, ah) + GATHER_DOUBLE(exact_radius, bh);
            gap2[h] = radii * radii - d2[h];
        }
        const wide r_i = GATHER(radius, a), r_j = GATHER(radius, b);
        const wide distance = wide_root(wide_from_doubles(d2)), inverse = wide_all(1) / distance;
        const wide n[3] = { wide_from_doubles(dx) * inverse, wide_from_doubles(dy) * inverse, wide_from_doubles(dz) * inverse };
        /* The difference of squares is taken in double, so that a small overlap keeps its digits. */
        const wide overlap = wide_from_doubles(gap2) / (r_i + r_j + distance);
        const wide r_a = r_i - half * overlap, r_b = r_j - half * overlap;
        const wide s[3] = { r_a * GATHER(omega[0], a) + r_b * GATHER(omega[0], b), r_a * GATHER(omega[1], a) + r_b * GATHER(omega[1], b),
                            r_a * GATHER(omega[2], a) + r_b * GATHER(omega[2], b) };
        const wide v[3] = { GATHER(v[0], b) - GATHER(v[0], a), GATHER(v[1], b) - GATHER(v[1], a), GATHER(v[2], b) - GATHER(v[2], a) };
        store_geometry(block, k, n, overlap, s, v, dt);
    }
}

static void geometry_with_cylinder(contact_block *restrict block, const sphere_row *restrict row,
                                   const int32_t *restrict first, double radius, real rotation_rate, real time_step)
{
    const wide dt = wide_all(time_step), half = wide_all((real)0.5), wall_speed = wide_all(rotation_rate * (real)radius);
    for (int k = 0; k < BLOCK; k += LANES) {
        const int32_t *a = first + k;
        wide_double x[HALVES], y[HALVES], rho2[HALVES], beyond2[HALVES];
        for (int h = 0; h < HALVES; h++) {
            x[h] = GATHER_DOUBLE(x[0], a + 8 * h);
            y[h] = GATHER_DOUBLE(x[1], a + 8 * h);
            const wide_double room = wide_double_all(radius) - GATHER_DOUBLE(exact_radius, a + 8 * h);
            rho2[h] = x[h] * x[h] + y[h] * y[h];
            beyond2[h] = rho2[h] - room * room;
        }
        const wide r = GATHER(radius, a);
        const wide rho = wide_root(wide_from_doubles(rho2)), inverse = wide_all(1) / wide_greater(rho, wide_all((real)1e-30));
        const wide n[3] = { wide_from_doubles(x) * inverse, wide_from_doubles(y) * inverse, wide_all(0) };
        const wide overlap = wide_from_doubles(beyond2) / (rho + (wide_all((real)radius) - r)); /* rho - (R - r) */
        const wide r_a = r - half * overlap;
        const wide s[3] = { r_a * GATHER(omega[0], a), r_a * GATHER(omega[1], a), r_a * GATHER(omega[2], a) };
        const wide v[3] = { -wall_speed * n[1] - GATHER(v[0], a), wall_speed * n[0] - GATHER(v[1], a), -GATHER(v[2], a) };
        store_geometry(block, k, n, overlap, s, v, dt);
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

WIDE_INLINE wide wide_cube_root(wide x)
{
    const wide two_x = x + x;
    wide y = wide_cube_root_guess(x);
    for (int k = 0; k < CUBE_ROOT_STEPS; k++) {
        const wide y3 = y * y * y;
        y *= (y3 + two_x) / (y3 + y3 + x);
    }
    return y;
}

/* friction_increment of contact_law.h, LANES at a time. */
static void friction_forces(contact_block *restrict block, real *restrict t_x, real *restrict t_y, real *restrict t_z,
                            real *restrict t_star, const real *restrict friction, real stiffness)
{
    const wide zero = wide_all(0), one = wide_all(1), tiny = wide_all(TINY_SQUARE), floor = wide_all(SLIP_FLOOR), k_t0 = wide_all(stiffness);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide nx = wide_load(block->n[0] + k), ny = wide_load(block->n[1] + k), nz = wide_load(block->n[2] + k);
        const wide dx = wide_load(block->ds[0] + k), dy = wide_load(block->ds[1] + k), dz = wide_load(block->ds[2] + k);
        const wide mu_n = wide_load(friction + k) * wide_load(block->f_n + k);
        const wide tx = wide_load(t_x + k), ty = wide_load(t_y + k), tz = wide_load(t_z + k);

        const wide tn = tx * nx + ty * ny + tz * nz;
        const wide ux = tx - tn * nx, uy = ty - tn * ny, uz = tz - tn * nz;
        const wide tt = tx * tx + ty * ty + tz * tz;
        const wide uu = ux * ux + uy * uy + uz * uz;
        const wide_mask stored = wide_exceeds(uu, tiny);
        const wide turn = wide_select(stored, one / wide_root(uu), zero);
        const wide magnitude = wide_select(stored, wide_root(tt), zero);
        const wide hx = ux * turn, hy = uy * turn, hz = uz * turn;

        const wide_mask pressed = wide_exceeds(mu_n, zero);
        const wide inverse = wide_select(pressed, one / mu_n, zero);
        const wide tau = wide_lesser(magnitude * inverse, one);
        const wide s_p = dx * hx + dy * hy + dz * hz;

        const wide sign = wide_select(wide_exceeds(zero, s_p), -one, one);
        const wide turning = wide_lesser(sign * wide_load(t_star + k), sign * tau);
        const wide left = wide_greater(one - sign * tau, floor), left_at_turn = wide_greater(one - turning, floor);
        const wide k_t = k_t0 * wide_cube_root(left / left_at_turn);
        const wide s = tau * mu_n + k_t * s_p;
        const wide star = sign * turning;
        wide_store(t_star + k, wide_select(pressed, wide_select(wide_exceeds(zero, s), -star, star), zero));

        const wide fx = s * hx + k_t0 * (dx - s_p * hx), fy = s * hy + k_t0 * (dy - s_p * hy), fz = s * hz + k_t0 * (dz - s_p * hz);
        const wide size2 = fx * fx + fy * fy + fz * fz;
        const wide scale = wide_select(wide_exceeds(size2, mu_n * mu_n), mu_n / wide_root(size2), one);
        wide_store(t_x + k, fx * scale);
        wide_store(t_y + k, fy * scale);
        wide_store(t_z + k, fz * scale);
    }
}

static void write_rows(const contact_block *restrict block, const real *restrict t_x, const real *restrict t_y,
                       const real *restrict t_z, contact_row *restrict row)
{
    for (int k = 0; k < BLOCK; k++) {
        const real nx = block->n[0][k], ny = block->n[1][k], nz = block->n[2][k], f_n = block->f_n[k];
        const real tx = t_x[k], ty = t_y[k], tz = t_z[k];
        /* n x f is n x T: the normal force has no moment about the centre */
        row[k] = (contact_row){ .f = { tx - f_n * nx, ty - f_n * ny, tz - f_n * nz }, .half_overlap = block->overlap[k] / 2,
                                .q = { ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx } };
    }
}

static real block_largest_overlap(const contact_block *block)
{
    real largest = 0;
    for (int k = 0; k < BLOCK; k++) largest = greater(largest, block->overlap[k]);
    return largest;
}

static void block_forces(contact_list *list, size_t start, contact_block *block, const dem_contact_parameters *contact)
{
    const double k_1 = contact->stiffness, k_2 = k_1 / (contact->restitution * contact->restitution);
    real *const t_x = list->t[0] + start, *const t_y = list->t[1] + start, *const t_z = list->t[2] + start;
    normal_forces(block, list->alpha_0 + start, (real)k_1, (real)k_2);
    friction_forces(block, t_x, t_y, t_z, list->t_star + start, list->friction + start, (real)(k_1 * contact->tangential_stiffness_ratio));
    write_rows(block, t_x, t_y, t_z, list->row + start);
}

double contact_forces_between_spheres(contact_list *pairs, const spheres *s, const container *drum,
                                      const dem_contact_parameters *contact, double dt, int threads)
{
    double largest = 0.0;
    const size_t count = round_up_to_block(pairs->count);
#pragma omp parallel for schedule(static) reduction(max : largest) num_threads(threads) if (threads > 1)
    for (size_t start = 0; start < count; start += BLOCK) {
        contact_block block;
        geometry_between_spheres(&block, s->row, pairs->first + start, pairs->second + start, drum->length, (real)dt);
        block_forces(pairs, start, &block, contact);
        largest = fmax(largest, (double)block_largest_overlap(&block));
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
        geometry_with_cylinder(&block, s->row, walls->first + start, drum->radius, (real)drum->rotation_rate, (real)dt);
        block_forces(walls, start, &block, contact);
        largest = fmax(largest, (double)block_largest_overlap(&block));
    }
    return largest;
}

/* Adds one row: sign +1 where the sphere is the first of the pair, -1 where it is the second. */
static inline void add_row(const contact_row *row, double sign, double radius, double force[4], double torque[4])
{
    const double arm = radius - (double)row->half_overlap;
    for (int c = 0; c < 3; c++) {
        force[c] += sign * (double)row->f[c];
        torque[c] += arm * (double)row->q[c];
    }
}

void contact_forces_sum(const neighbor_list *list, spheres *s, int threads)
{
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double radius = (double)s->row[i].radius;
        double force[4] = { 0 }, torque[4] = { 0 };
        for (size_t k = list->incoming_start[i]; k < list->incoming_start[i + 1]; k++)
            add_row(&list->pairs.row[list->incoming[k]], -1.0, radius, force, torque);
        for (size_t k = list->pairs.start[i]; k < list->pairs.start[i + 1]; k++)
            add_row(&list->pairs.row[k], 1.0, radius, force, torque);
        for (size_t k = list->walls.start[i]; k < list->walls.start[i + 1]; k++)
            add_row(&list->walls.row[k], 1.0, radius, force, torque);
        memcpy(s->force[i], force, sizeof force);
        memcpy(s->torque[i], torque, sizeof torque);
    }
}
