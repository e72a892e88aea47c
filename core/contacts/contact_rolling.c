/* rolling_increment and rolling_with_dashpot of contact_law.h for a block of contacts, LANES at a time. */
#include "contact_block.h"

/* What a pass needs of LANES contacts, and what their springs do. */
typedef struct rolling_lanes {
    wide n[3], v[3]; /* unit normal; m/s, R* times the relative spin in the tangent plane */
    wide twist;      /* rad/s, less the relative spin along n */
    wide radius;     /* m, R* */
    wide limit;      /* N */
    wide f[3];       /* N, what the spring bears */
    wide_mask yields;
} rolling_lanes;

/* The spring alone, with its history. `v` is not set: the spring needs the displacement alone. */
WIDE_INLINE rolling_lanes roll_springs(contact_block *restrict block, real *const roll[3], const real *restrict rolling_friction,
                                       const real *restrict effective_radius, wide dt, int k)
{
    const wide zero = wide_all(0), one = wide_all(1), half = wide_all((real)0.5), tiny = wide_all(TINY_SQUARE);
    rolling_lanes at = { .n = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) } };
    const wide *const n = at.n;
    const wide spin[3] = { wide_load(block->spin[0] + k), wide_load(block->spin[1] + k), wide_load(block->spin[2] + k) };
    const wide before[3] = { wide_load(roll[0] + k), wide_load(roll[1] + k), wide_load(roll[2] + k) };
    at.radius = wide_load(effective_radius + k);
    at.twist = -wide_dot(spin, n);
    const wide rn = -wide_dot(before, n), stiffness = -wide_load(block->k_t + k), arm_dt = at.radius * dt;
    const wide u[3] = { wide_fused(rn, n[0], before[0]), wide_fused(rn, n[1], before[1]), wide_fused(rn, n[2], before[2]) };
    const wide uu = wide_dot(u, u), off2 = wide_select(wide_exceeds(uu, tiny), rn * rn / uu, zero);
    const wide keep = wide_fused(half, wide_lesser(off2, one), one);
    const wide f_n = wide_load(block->f_n + k);
    at.limit = wide_load(rolling_friction + k) * wide_greater(f_n, -f_n);
    for (int c = 0; c < 3; c++) at.f[c] = wide_fused(stiffness, wide_fused(at.twist, n[c], spin[c]) * arm_dt, keep * u[c]);
    const wide size2 = wide_dot(at.f, at.f);
    at.yields = wide_exceeds(size2, at.limit * at.limit);
    const wide scale = wide_select(at.yields, at.limit * wide_inverse_root(size2), one);
    const wide_mask pressed = wide_exceeds(at.limit, wide_all(TINY_FORCE));
    for (int c = 0; c < 3; c++) {
        at.f[c] = wide_select(pressed, at.f[c] * scale, zero);
        wide_store(roll[c] + k, at.f[c]);
    }
    return at;
}

static void rolling_moments(contact_block *restrict block, real *restrict roll_x, real *restrict roll_y, real *restrict roll_z,
                            const real *restrict rolling_friction, const real *restrict effective_radius, real time_step)
{
    real *const roll[3] = { roll_x, roll_y, roll_z };
    const wide dt = wide_all(time_step);
    for (int k = 0; k < BLOCK; k += LANES) {
        const rolling_lanes at = roll_springs(block, roll, rolling_friction, effective_radius, dt, k);
        for (int c = 0; c < 3; c++) wide_store(block->moment[c] + k, at.f[c] * at.radius);
    }
}

/* By how much the force f, N, is to be cut to the limit, which is less where a contact twists, too. d: N, of the dashpot in the
 * tangent plane. */
WIDE_INLINE wide cut_of_twist(const rolling_lanes *at, const wide d[3], const wide f[3], wide damping)
{
    const wide one = wide_all(1), limit2 = at->limit * at->limit, d_n = damping * (at->twist * at->radius);
    const wide dd = wide_dot(d, d) + wide_greater(limit2, wide_all(TINY_SQUARE)), share2 = dd / wide_fused(d_n, d_n, dd);
    const wide size2 = wide_dot(f, f), cut = at->limit * (share2 * wide_inverse_root(share2));
    return wide_select(wide_exceeds(size2, cut * cut), cut * wide_inverse_root(size2), one);
}

/* The same with dashpots. damping: 2 zeta; root: the list's rolling_root. */
WIDE_INLINE void damped_moments(contact_block *restrict block, real *const roll[3], const real *restrict rolling_friction,
                                const real *restrict effective_radius, const real *restrict root, real damping, real time_step,
                                bool is_constant)
{
    const wide dt = wide_all(time_step), zero = wide_all(0), twice_zeta = wide_all(damping);
    for (int k = 0; k < BLOCK; k += LANES) {
        const rolling_lanes at = roll_springs(block, roll, rolling_friction, effective_radius, dt, k);
        const wide_mask pressed = wide_exceeds(at.limit, wide_all(TINY_FORCE));
        const wide k_t = wide_load(block->k_t + k), c_r = twice_zeta * wide_load(root + k) * (k_t * wide_inverse_root(k_t));
        wide d[3], f[3];
        for (int c = 0; c < 3; c++) {
            const wide v = wide_fused(at.twist, at.n[c], wide_load(block->spin[c] + k)) * at.radius;
            d[c] = c_r * v;
            if (!is_constant) d[c] = wide_select(at.yields, zero, d[c]);
            f[c] = at.f[c] - d[c];
        }
        const wide scale = is_constant ? cut_of_twist(&at, d, f, c_r) : wide_all(1);
        for (int c = 0; c < 3; c++) wide_store(block->moment[c] + k, wide_select(pressed, f[c] * scale, zero) * at.radius);
    }
}

static void moments_of_epsd_damped(contact_block *block, contact_list *list, size_t start, real damping, real dt)
{
    const size_t at = constants_of(list, start);
    real *const roll[3] = { list->roll[0] + start, list->roll[1] + start, list->roll[2] + start };
    damped_moments(block, roll, list->rolling_friction + at, list->radius + at, list->rolling_root + at, damping, dt, false);
}

static void constant_moments(contact_block *block, contact_list *list, size_t start, real dt)
{
    const size_t at = constants_of(list, start);
    real *const roll[3] = { list->roll[0] + start, list->roll[1] + start, list->roll[2] + start };
    damped_moments(block, roll, list->rolling_friction + at, list->radius + at, list->rolling_root + at,
                   (real)(2 * DAMPING_OF_CONSTANT_TORQUE), dt, true);
}

void contact_block_roll(contact_block *block, contact_list *list, size_t start, const dem_contact_parameters *contact, double dt)
{
    /* The damped laws have set each contact's; Walton & Braun's is one for all, or of the materials. */
    if (contact->law == DEM_WALTON_BRAUN && list->laws_differ)
        memcpy(block->k_t, list->law[LAW_K_T] + constants_of(list, start), sizeof block->k_t);
    else if (contact->law == DEM_WALTON_BRAUN)
        for (int k = 0; k < BLOCK; k++) block->k_t[k] = (real)(contact->stiffness * contact->tangential_stiffness_ratio);
    const size_t at = constants_of(list, start);
    switch (contact->rolling_law) {
    case DEM_EPSD:
        rolling_moments(block, list->roll[0] + start, list->roll[1] + start, list->roll[2] + start, list->rolling_friction + at,
                        list->radius + at, (real)dt);
        break;
    case DEM_EPSD_DAMPED: moments_of_epsd_damped(block, list, start, (real)(2 * contact->rolling_damping), (real)dt); break;
    case DEM_CONSTANT_TORQUE: constant_moments(block, list, start, (real)dt); break;
    }
}
