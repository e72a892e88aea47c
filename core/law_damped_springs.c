/* The damped laws of contact_law.h for a block of contacts, LANES at a time: spring-dashpot and Hertz-Mindlin. */
#include "contact_block.h"
#include "dem_rules.h"

/* zeta of a linear spring and dashpot for a restitution e: -ln e/sqrt(pi^2 + ln^2 e). */
static double damping_ratio(double restitution)
{
    const double l = log(restitution);
    return -l / sqrt(DEM_PI * DEM_PI + l * l);
}

/* 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, 1/G* = (2 - nu1)/G1 + (2 - nu2)/G2, G = E/(2 (1 + nu)). */
static damped_law law_of_materials(dem_elasticity a, dem_elasticity b, double restitution)
{
    const double compliance =
        (1 - a.poissons_ratio * a.poissons_ratio) / a.youngs_modulus + (1 - b.poissons_ratio * b.poissons_ratio) / b.youngs_modulus;
    const double shear = 2 * (2 - a.poissons_ratio) * (1 + a.poissons_ratio) / a.youngs_modulus
                         + 2 * (2 - b.poissons_ratio) * (1 + b.poissons_ratio) / b.youngs_modulus;
    return (damped_law){ (real)(1 / compliance), (real)(1 / shear), (real)(sqrt(5.0 / 6.0) * damping_ratio(restitution)) };
}

WIDE_INLINE wide wide_square_root(wide x) { return x * wide_inverse_root(x); }

/* Springs and dashpots of each contact: normal spring force into f_n, c_n into mu_n, k_t into stored, c_t into s_p. */
static void linear_block(contact_block *restrict block, const real *restrict mass, damped_law law)
{
    const wide k_n = wide_all(law.k_n), twice_zeta = wide_all(2 * law.damping), half = wide_all((real)0.5), k_t = wide_all(law.k_t);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide c_n = twice_zeta * wide_square_root(wide_load(mass + k) * k_n);
        wide_store(block->f_n + k, k_n * wide_load(block->overlap + k));
        wide_store(block->mu_n + k, c_n);
        wide_store(block->stored + k, k_t);
        wide_store(block->s_p + k, c_n * half);
    }
}

/* is_wall: the effective radius is the sphere's own; else R_i R_j/(R_i + R_j). */
static void hertz_mindlin_block(contact_block *restrict block, const real *restrict mass, const real *restrict first_radius,
                                damped_law law, bool is_wall)
{
    const wide twice_e = wide_all(2 * law.k_n), eight_g = wide_all(8 * law.k_t), twice_zeta = wide_all(2 * law.damping);
    const wide two_thirds = wide_all((real)(2.0 / 3.0)), half = wide_all((real)0.5), tiny = wide_all((real)1e-30);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide r_i = wide_load(first_radius + k), radii = wide_load(block->radii + k), m = wide_load(mass + k);
        const wide radius = is_wall ? r_i : r_i * (radii - r_i) / radii;
        const wide alpha = wide_load(block->overlap + k);
        const wide a = wide_square_root(wide_greater(radius * alpha, tiny)); /* apart: what follows is not used */
        const wide s_n = twice_e * a, c_n = twice_zeta * wide_square_root(wide_greater(m * s_n, tiny));
        wide_store(block->f_n + k, two_thirds * s_n * alpha);
        wide_store(block->mu_n + k, c_n);
        wide_store(block->stored + k, eight_g * a);
        wide_store(block->s_p + k, half * c_n);
    }
}

static void normal_forces(contact_block *restrict block)
{
    const wide zero = wide_all(0);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide damped = wide_fused(wide_load(block->mu_n + k), wide_load(block->closing + k), wide_load(block->f_n + k));
        wide_store(block->f_n + k, wide_select(wide_exceeds(wide_load(block->overlap + k), zero), damped, zero));
    }
}

/* damped_friction_increment of contact_law.h, LANES at a time, in two passes: the stretch turned into the tangent plane and
 * grown by this step's displacement; the force, and what it leaves of the stretch. */
static void turn_stretch(contact_block *restrict block, const real *restrict t_x, const real *restrict t_y,
                         const real *restrict t_z)
{
    const wide zero = wide_all(0), one = wide_all(1), half = wide_all((real)0.5), tiny = wide_all(TINY_SQUARE);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide stretch[3] = { wide_load(t_x + k), wide_load(t_y + k), wide_load(t_z + k) };
        const wide sn = -wide_dot(stretch, n);
        const wide u[3] = { wide_fused(sn, n[0], stretch[0]), wide_fused(sn, n[1], stretch[1]), wide_fused(sn, n[2], stretch[2]) };
        const wide uu = wide_dot(u, u);
        const wide off2 = wide_select(wide_exceeds(uu, tiny), sn * sn / uu, zero);
        const wide keep = wide_fused(half, wide_lesser(off2, one), one);
        for (int c = 0; c < 3; c++) wide_store(block->h[c] + k, wide_fused(u[c], keep, wide_load(block->ds[c] + k)));
    }
}

static void friction_forces(contact_block *restrict block, real *restrict t_x, real *restrict t_y, real *restrict t_z,
                            const real *restrict friction, real inverse_time_step)
{
    real *const spring[3] = { t_x, t_y, t_z };
    const wide zero = wide_all(0), one = wide_all(1), inverse_dt = wide_all(inverse_time_step);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide k_t = wide_load(block->stored + k), per_dt = wide_load(block->s_p + k) * inverse_dt;
        const wide mu_n = wide_load(friction + k) * wide_load(block->f_n + k), limit = wide_greater(mu_n, -mu_n);
        const wide_mask pressed = wide_exceeds(limit, wide_all(TINY_FORCE));
        wide dashpot[3], stretched[3], f[3];
        for (int c = 0; c < 3; c++) {
            dashpot[c] = per_dt * wide_load(block->ds[c] + k);
            stretched[c] = wide_load(block->h[c] + k);
            f[c] = wide_fused(k_t, stretched[c], dashpot[c]);
        }
        const wide size2 = wide_dot(f, f);
        const wide_mask cut = wide_exceeds(size2, limit * limit);
        const wide scale = wide_select(cut, limit * wide_inverse_root(size2), one);
        const wide compliance = wide_select(pressed, one / k_t, zero);
        for (int c = 0; c < 3; c++) {
            f[c] = f[c] * scale;
            const wide left = wide_select(cut, (f[c] - dashpot[c]) * compliance, stretched[c]);
            wide_store(spring[c] + k, wide_select(pressed, left, zero));
        }
        store_vector(block->force, k, f);
    }
}

void contact_block_damped_springs(contact_block *block, contact_list *list, size_t start, const dem_contact_parameters *contact,
                                  bool is_wall, double dt)
{
    const size_t at = constants_of(list, start);
    if (contact->law == DEM_SPRING_DASHPOT) {
        const damped_law law = { (real)contact->stiffness, (real)(contact->stiffness * contact->tangential_stiffness_ratio),
                                 (real)damping_ratio(contact->restitution) };
        linear_block(block, list->mass + at, law);
    } else {
        const damped_law law =
            law_of_materials(contact->particle, is_wall ? contact->wall : contact->particle, contact->restitution);
        hertz_mindlin_block(block, list->mass + at, list->first_radius + at, law, is_wall);
    }
    normal_forces(block);
    turn_stretch(block, list->t[0] + start, list->t[1] + start, list->t[2] + start);
    friction_forces(block, list->t[0] + start, list->t[1] + start, list->t[2] + start, list->friction + at,
                    dt > 0 ? (real)(1 / dt) : 0);
}
