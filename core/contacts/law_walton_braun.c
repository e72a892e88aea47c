/* Walton & Braun's law of contact_law.h for a block of contacts, LANES at a time. */
#include "contact_block.h"

/* What the dashpots of a block are made of: c_n of an effective mass of 1 kg, and the roots of the masses. */
typedef struct latch_dashpots {
    real damping;
    const real *root_mass;
} latch_dashpots;

/* -c_n of the contacts from k on. */
WIDE_INLINE wide minus_c_n(latch_dashpots dashpots, int k)
{
    return wide_all(-dashpots.damping) * wide_load(dashpots.root_mass + k);
}

/* latching_force of contact_law.h, LANES at a time. The spring does not push where nothing touches; latched is 0 there. */
WIDE_INLINE void store_latching_force(contact_block *restrict block, int k, wide latch, wide latched, wide_mask touching, wide k_1,
                                      wide k_2, wide minus_c)
{
    const wide zero = wide_all(0), alpha = wide_load(block->overlap + k);
    const wide spring = wide_lesser(k_1 * alpha, k_2 * (alpha - latched));
    const wide_mask loaded_before = wide_both(touching, wide_exceeds(latched, latch));
    const wide f_n = wide_fused_where(loaded_before, wide_lesser(wide_load(block->parting + k), zero), minus_c, spring);
    wide_store(block->f_n + k, wide_greater(f_n, zero));
}

/* normal_force of contact_law.h, LANES at a time. alike: all masses are. */
WIDE_INLINE void normal_forces(contact_block *restrict block, real *restrict alpha_0, real stiffness, real unloading_stiffness,
                               latch_dashpots dashpots, bool alike)
{
    const wide k_1 = wide_all(stiffness), k_2 = wide_all(unloading_stiffness), zero = wide_all(0);
    const wide share = wide_all(1 - stiffness / unloading_stiffness), of_all = minus_c_n(dashpots, 0);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide alpha = wide_load(block->overlap + k), latch = alpha * share;
        const wide_mask touching = wide_exceeds(alpha, zero);
        const wide latched = wide_where(touching, wide_greater(wide_load(alpha_0 + k), latch));
        wide_store(alpha_0 + k, latched);
        store_latching_force(block, k, latch, latched, touching, k_1, k_2, alike ? of_all : minus_c_n(dashpots, k));
    }
}

/* normal_force_of_slope of contact_law.h, LANES at a time. */
static void normal_forces_of_slope(contact_block *restrict block, real *restrict alpha_0, real stiffness, real unloading_slope,
                                   latch_dashpots dashpots)
{
    const wide k_1 = wide_all(stiffness), half_k_1 = wide_all(stiffness / 2), slope = wide_all(unloading_slope);
    const wide zero = wide_all(0), one = wide_all(1), four = wide_all(4), tiny = wide_all(TINY_SQUARE);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide alpha = wide_load(block->overlap + k), pressed = wide_greater(alpha, zero), s = slope * pressed;
        const wide latch = s * pressed / (one + s);
        const wide_mask touching = wide_exceeds(alpha, zero);
        const wide latched = wide_where(touching, wide_greater(wide_load(alpha_0 + k), latch));
        wide_store(alpha_0 + k, latched);
        const wide q = slope * latched, root2 = wide_greater(q * (q + four), tiny);
        const wide steepness = q + root2 * wide_inverse_root(root2), k_2 = wide_fused(half_k_1, steepness, k_1);
        store_latching_force(block, k, latch, latched, touching, k_1, k_2, minus_c_n(dashpots, k));
    }
}

/* Both where materials differ, and the numbers of the law with them. law: (LAW_NUMBERS) from the block's first on. */
WIDE_INLINE void normal_forces_of_materials(contact_block *restrict block, real *restrict alpha_0, const real *const law[],
                                            const real *restrict root_mass, bool has_slope)
{
    const wide zero = wide_all(0), one = wide_all(1), half = wide_all((real)0.5), four = wide_all(4), tiny = wide_all(TINY_SQUARE);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide k_1 = wide_load(law[LAW_K_N] + k), number = wide_load(law[LAW_K_2] + k), alpha = wide_load(block->overlap + k);
        const wide pressed = wide_greater(alpha, zero), s = number * pressed;
        const wide latch = has_slope ? s * pressed / (one + s) : alpha * (one - k_1 / number);
        const wide_mask touching = wide_exceeds(alpha, zero);
        const wide latched = wide_where(touching, wide_greater(wide_load(alpha_0 + k), latch));
        wide_store(alpha_0 + k, latched);
        const wide q = number * latched, root2 = wide_greater(q * (q + four), tiny);
        const wide k_2 = has_slope ? wide_fused(half * k_1, q + root2 * wide_inverse_root(root2), k_1) : number;
        store_latching_force(block, k, latch, latched, touching, k_1, k_2,
                             -wide_load(law[LAW_LATCH] + k) * wide_load(root_mass + k));
    }
}

static void normal_forces_of_list(contact_block *block, real *alpha_0, const contact_list *list, size_t start, bool has_slope)
{
    const size_t at = constants_of(list, start);
    const real *law[LAW_NUMBERS];
    for (int c = 0; c < LAW_NUMBERS; c++) law[c] = list->law[c] + at;
    if (has_slope) normal_forces_of_materials(block, alpha_0, law, list->root_mass + at, true);
    else normal_forces_of_materials(block, alpha_0, law, list->root_mass + at, false);
}

/* friction_increment of contact_law.h, LANES at a time, in three passes: the stored force turned into the tangent
 * plane; the stiffness along it; the new force. */
static void rotate_friction(contact_block *restrict block, const real *restrict t_x, const real *restrict t_y,
                            const real *restrict t_z, const real *restrict friction)
{
    const wide one = wide_all(1), half = wide_all((real)0.5), tiny = wide_all(TINY_SQUARE);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide t[3] = { wide_load(t_x + k), wide_load(t_y + k), wide_load(t_z + k) };
        const wide ds[3] = { wide_load(block->ds[0] + k), wide_load(block->ds[1] + k), wide_load(block->ds[2] + k) };
        const wide tn = wide_dot(t, n);
        const wide u[3] = { wide_minus_product(t[0], tn, n[0]), wide_minus_product(t[1], tn, n[1]),
                            wide_minus_product(t[2], tn, n[2]) };
        const wide uu = wide_dot(u, u);
        const wide turn = wide_where(wide_exceeds(uu, tiny), wide_inverse_root(uu));
        const wide size = uu * turn, off = tn * turn, magnitude = wide_fused(half * size, wide_lesser(off * off, one), size);
        const wide h[3] = { u[0] * turn, u[1] * turn, u[2] * turn };
        const wide mu_n = wide_load(friction + k) * wide_load(block->f_n + k);
        store_vector(block->h, k, h);
        wide_store(block->mu_n + k, mu_n);
        wide_store(block->stored + k, wide_lesser(magnitude, mu_n));
        wide_store(block->s_p + k, wide_dot(ds, h));
    }
}

static void friction_stiffness(contact_block *restrict block, real *restrict t_star)
{
    const wide one = wide_all(1), floor = wide_all(SLIP_FLOOR);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide mu_n = wide_load(block->mu_n + k), stored = wide_load(block->stored + k), s_p = wide_load(block->s_p + k);
        const wide_mask pressed = wide_exceeds(mu_n, wide_all(TINY_FORCE));
        const wide tau = wide_times_sign(wide_where(pressed, stored / mu_n), s_p);
        const wide turning = wide_lesser(wide_times_sign(wide_load(t_star + k), s_p), tau);
        const wide left = wide_greater(one - tau, floor), left_at_turn = wide_greater(one - turning, floor);
        const wide share = left * wide_inverse_cube_root(left * left * left_at_turn);
        const wide s = wide_fused(share, s_p, stored);
        wide_store(block->along + k, s);
        wide_store(t_star + k, wide_where(pressed, wide_times_sign(wide_times_sign(turning, s_p), s)));
    }
}

static void friction_forces(contact_block *restrict block, real *restrict t_x, real *restrict t_y, real *restrict t_z)
{
    const wide one = wide_all(1);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide along = wide_load(block->along + k) - wide_load(block->s_p + k), mu_n = wide_load(block->mu_n + k);
        wide f[3];
        for (int c = 0; c < 3; c++) f[c] = wide_fused(along, wide_load(block->h[c] + k), wide_load(block->ds[c] + k));
        const wide scale = wide_lesser(mu_n * wide_inverse_root(wide_dot(f, f)), one);
        for (int c = 0; c < 3; c++) f[c] = f[c] * scale;
        wide_store(t_x + k, f[0]);
        wide_store(t_y + k, f[1]);
        wide_store(t_z + k, f[2]);
    }
}

void contact_block_walton_braun(contact_block *block, contact_list *list, size_t start, const dem_contact_parameters *contact)
{
    const double k_1 = contact->stiffness, k_2 = k_1 / (contact->restitution * contact->restitution);
    real *const t_x = list->t[0] + start, *const t_y = list->t[1] + start, *const t_z = list->t[2] + start;
    real *const alpha_0 = list->alpha_0 + start;
    const latch_dashpots dashpots = { list->latch_damping, list->root_mass + constants_of(list, start) };
    const bool alike = list->constants == CONSTANTS_OF_ALL;
    if (list->laws_differ) normal_forces_of_list(block, alpha_0, list, start, contact->unloading_slope > 0);
    else if (contact->unloading_slope > 0)
        normal_forces_of_slope(block, alpha_0, (real)k_1, (real)contact->unloading_slope, dashpots);
    else if (alike) normal_forces(block, alpha_0, (real)k_1, (real)k_2, dashpots, true);
    else normal_forces(block, alpha_0, (real)k_1, (real)k_2, dashpots, false);
    rotate_friction(block, t_x, t_y, t_z, list->friction + constants_of(list, start));
    friction_stiffness(block, list->t_star + start);
    friction_forces(block, t_x, t_y, t_z);
}
