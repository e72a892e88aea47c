/* rolling_increment of contact_law.h for a block of contacts, LANES at a time. */
#include "contact_block.h"

static void rolling_moments(contact_block *restrict block, real *restrict roll_x, real *restrict roll_y, real *restrict roll_z,
                            const real *restrict rolling_friction, const real *restrict effective_radius, real time_step)
{
    real *const roll[3] = { roll_x, roll_y, roll_z };
    const wide zero = wide_all(0), one = wide_all(1), half = wide_all((real)0.5), tiny = wide_all(TINY_SQUARE);
    const wide dt = wide_all(time_step);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide spin[3] = { wide_load(block->spin[0] + k), wide_load(block->spin[1] + k), wide_load(block->spin[2] + k) };
        const wide before[3] = { wide_load(roll_x + k), wide_load(roll_y + k), wide_load(roll_z + k) };
        const wide radius = wide_load(effective_radius + k);
        const wide rn = -wide_dot(before, n), twist = -wide_dot(spin, n), stiffness = -wide_load(block->k_t + k),
                   arm_dt = radius * dt;
        const wide u[3] = { wide_fused(rn, n[0], before[0]), wide_fused(rn, n[1], before[1]), wide_fused(rn, n[2], before[2]) };
        const wide uu = wide_dot(u, u), off2 = wide_select(wide_exceeds(uu, tiny), rn * rn / uu, zero);
        const wide keep = wide_fused(half, wide_lesser(off2, one), one);
        const wide f_n = wide_load(block->f_n + k), limit = wide_load(rolling_friction + k) * wide_greater(f_n, -f_n);
        wide f[3];
        for (int c = 0; c < 3; c++) f[c] = wide_fused(stiffness, wide_fused(twist, n[c], spin[c]) * arm_dt, keep * u[c]);
        const wide size2 = wide_dot(f, f);
        const wide scale = wide_select(wide_exceeds(size2, limit * limit), limit * wide_inverse_root(size2), one);
        const wide_mask pressed = wide_exceeds(limit, wide_all(TINY_FORCE));
        for (int c = 0; c < 3; c++) {
            f[c] = wide_select(pressed, f[c] * scale, zero);
            wide_store(roll[c] + k, f[c]);
            wide_store(block->moment[c] + k, f[c] * radius);
        }
    }
}

void contact_block_roll(contact_block *block, contact_list *list, size_t start, const dem_contact_parameters *contact, double dt)
{
    /* The damped laws have set each contact's; Walton & Braun's is one for all, or of the materials. */
    if (contact->law == DEM_WALTON_BRAUN && list->laws_differ)
        memcpy(block->k_t, list->law[LAW_K_T] + constants_of(list, start), sizeof block->k_t);
    else if (contact->law == DEM_WALTON_BRAUN)
        for (int k = 0; k < BLOCK; k++) block->k_t[k] = (real)(contact->stiffness * contact->tangential_stiffness_ratio);
    const size_t at = constants_of(list, start);
    rolling_moments(block, list->roll[0] + start, list->roll[1] + start, list->roll[2] + start, list->rolling_friction + at,
                    list->radius + at, (real)dt);
}
