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
static damped_law law_of_materials(dem_elasticity a, dem_elasticity b, double restitution, double dt)
{
    const double e_star = dem_effective_modulus(a, b);
    const double shear = 2 * (2 - a.poissons_ratio) * (1 + a.poissons_ratio) / a.youngs_modulus
                         + 2 * (2 - b.poissons_ratio) * (1 + b.poissons_ratio) / b.youngs_modulus;
    const double damping = 2 * sqrt(5.0 / 6.0) * damping_ratio(restitution) * sqrt(2 * e_star);
    return (damped_law){ (real)e_star, (real)(1 / shear), (real)damping, (real)(HERTZIAN_LAG * damping * dt / 2), HERTZIAN_EDGE };
}

damped_law damped_law_of(const dem_contact_parameters *c, bool is_wall, double dt)
{
    if (c->law == DEM_HERTZ_MINDLIN) return law_of_materials(c->particle, is_wall ? c->wall : c->particle, c->restitution, dt);
    const double damping = 2 * damping_ratio(c->restitution) * sqrt(c->stiffness);
    return (damped_law){ (real)c->stiffness, (real)(c->stiffness * c->tangential_stiffness_ratio), (real)damping,
                         (real)(LINEAR_LAG * damping * dt / 2), LINEAR_EDGE };
}

/* The share of at_edge of contact_law.h, LANES at a time. */
WIDE_INLINE wide edge_share(wide alpha, wide v, const wide edge[2], wide per_dt)
{
    const wide in_one_step = wide_greater(alpha, wide_all(0)) * per_dt, size = wide_greater(v, -v);
    return wide_select(wide_exceeds(size, in_one_step), wide_fused(edge[1], in_one_step / size, edge[0]), wide_all(1));
}

/* What all contacts of a block share. */
typedef struct shared_numbers {
    wide edge[2], per_dt, half_per_dt;
} shared_numbers;

static shared_numbers shared_by_all(damped_law law, real inverse_time_step)
{
    return (shared_numbers){ { wide_all(law.edge[0]), wide_all(law.edge[1]) },
                             wide_all(inverse_time_step),
                             wide_all(inverse_time_step / 2) };
}

/* A number of the law for the contacts from k on. of_each: (BLOCK) where materials differ; NULL: of_all. */
WIDE_INLINE wide law_number(const real *of_each, int k, wide of_all) { return of_each ? wide_load(of_each + k) : of_all; }

/* What friction needs. spring: N. */
WIDE_INLINE void store_normal(contact_block *restrict block, int k, wide spring, wide c_n, wide mu, wide k_t, wide compliance,
                              const shared_numbers *all)
{
    const wide zero = wide_all(0), alpha = wide_load(block->overlap + k);
    const wide parting = wide_load(block->parting + k), c = c_n * edge_share(alpha, parting, all->edge, all->per_dt);
    const wide f_n = wide_select(wide_exceeds(alpha, zero), wide_minus_product(spring, c, parting), zero), mu_n = mu * f_n;
    wide_store(block->f_n + k, f_n);
    wide_store(block->mu_n + k, wide_greater(mu_n, -mu_n));
    wide_store(block->k_t + k, k_t);
    wide_store(block->compliance + k, compliance);
    wide_store(block->dashpot + k, c * all->half_per_dt);
}

/* linear_springs of contact_law.h, LANES at a time, and the force they make. of_each: (LAW_NUMBERS) numbers of the law for each
 * contact; all NULL: those of `law`. */
WIDE_INLINE void linear_normals(contact_block *restrict block, const real *restrict root_mass, const real *restrict friction,
                                damped_law law, const real *const of_each[], real inverse_time_step)
{
    const wide damping = wide_all(law.damping), lag = wide_all(law.lag);
    const wide k_n = wide_all(law.k_n), k_t_of_all = wide_all(law.k_t), compliance = wide_all(1 / law.k_t);
    const shared_numbers all = shared_by_all(law, inverse_time_step);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide k_t = law_number(of_each[LAW_K_T], k, k_t_of_all);
        const wide c_n =
            law_number(of_each[LAW_DAMPING], k, damping) * (wide_load(root_mass + k) - law_number(of_each[LAW_LAG], k, lag));
        store_normal(block, k, law_number(of_each[LAW_K_N], k, k_n) * wide_load(block->overlap + k), c_n, wide_load(friction + k),
                     k_t, of_each[LAW_K_T] ? wide_all(1) / k_t : compliance, &all);
    }
}

/* hertz_mindlin_springs of contact_law.h, likewise. */
WIDE_INLINE void hertz_mindlin_normals(contact_block *restrict block, const real *restrict root_mass, const real *restrict radius,
                                       const real *restrict friction, damped_law law, const real *const of_each[],
                                       real inverse_time_step)
{
    const wide damping = wide_all(law.damping), lag = wide_all(law.lag), four_thirds = wide_all((real)(4.0 / 3.0));
    const wide four_thirds_e_of_all = wide_all((real)(4.0 / 3.0) * law.k_n), eight_g_of_all = wide_all(8 * law.k_t);
    const wide per_eight_g_of_all = wide_all(1 / (8 * law.k_t)), tiny = wide_all(TINY_SQUARE), eight = wide_all(8);
    const shared_numbers all = shared_by_all(law, inverse_time_step);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide alpha = wide_load(block->overlap + k);
        const wide aa = wide_greater(wide_load(radius + k) * alpha, tiny); /* apart: what follows is not used */
        const wide y = wide_inverse_fourth_root(aa), inverse_a = y * y, a = aa * inverse_a, root_a = a * y;
        const wide four_thirds_e = of_each[LAW_K_N] ? four_thirds * wide_load(of_each[LAW_K_N] + k) : four_thirds_e_of_all;
        const wide eight_g = of_each[LAW_K_T] ? eight * wide_load(of_each[LAW_K_T] + k) : eight_g_of_all;
        const wide per_eight_g = of_each[LAW_K_T] ? wide_all(1) / eight_g : per_eight_g_of_all;
        const wide c_n = law_number(of_each[LAW_DAMPING], k, damping) * root_a
                         * wide_minus_product(wide_load(root_mass + k), law_number(of_each[LAW_LAG], k, lag), root_a);
        store_normal(block, k, four_thirds_e * a * alpha, c_n, wide_load(friction + k), eight_g * a, per_eight_g * inverse_a, &all);
    }
}

/* damped_friction_increment of contact_law.h, LANES at a time, in two passes: the stretch turned into the tangent plane and
 * grown by this step's displacement; the force, and what it leaves of the stretch. */
static void rotate_stretch(contact_block *restrict block, const real *restrict t_x, const real *restrict t_y,
                           const real *restrict t_z)
{
    const wide one = wide_all(1), half = wide_all((real)0.5), tiny = wide_all(TINY_SQUARE);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide n[3] = { wide_load(block->n[0] + k), wide_load(block->n[1] + k), wide_load(block->n[2] + k) };
        const wide stretch[3] = { wide_load(t_x + k), wide_load(t_y + k), wide_load(t_z + k) };
        const wide sn = wide_dot(stretch, n);
        const wide u[3] = { wide_minus_product(stretch[0], sn, n[0]), wide_minus_product(stretch[1], sn, n[1]),
                            wide_minus_product(stretch[2], sn, n[2]) };
        const wide off2 = sn * sn / wide_greater(wide_dot(u, u), tiny), keep = wide_fused(half, wide_lesser(off2, one), one);
        for (int c = 0; c < 3; c++) wide_store(block->stretch[c] + k, wide_fused(u[c], keep, wide_load(block->ds[c] + k)));
    }
}

static void friction_forces(contact_block *restrict block, real *restrict t_x, real *restrict t_y, real *restrict t_z)
{
    real *const spring[3] = { t_x, t_y, t_z };
    const wide zero = wide_all(0), one = wide_all(1), tiny = wide_all(TINY_FORCE);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide k_t = wide_load(block->k_t + k), per_dt = wide_load(block->dashpot + k), limit = wide_load(block->mu_n + k);
        wide stretch[3], f[3];
        for (int c = 0; c < 3; c++) {
            stretch[c] = wide_load(block->stretch[c] + k);
            f[c] = wide_fused(k_t, stretch[c], per_dt * wide_load(block->ds[c] + k));
        }
        const wide scale = wide_lesser(limit * wide_inverse_root(wide_dot(f, f)), one);
        const wide pulled = (scale - one) * wide_load(block->compliance + k);
        const wide_mask pressed = wide_exceeds(limit, tiny);
        for (int c = 0; c < 3; c++) {
            wide_store(spring[c] + k, wide_select(pressed, wide_fused(pulled, f[c], stretch[c]), zero));
            f[c] = f[c] * scale;
        }
        store_vector(block->force, k, f);
    }
}

/* What a contact of Johnson, Kendall & Roberts' is made of: R/a_f^2, pi w R/6 and a_f (core/NUMERICS.md, "Cohesion"). */
enum { JKR_PER_OVERLAP, JKR_FORCE, JKR_LEAST_CONTACT };

/* y^2 = a/a_f of the overlap alpha: y^4 - 4 y = D, D = alpha R/a_f^2 >= -3. With z = y - 1 that is z sqrt(z^2 + 4 z + 6) = s,
 * s^2 = D + 3, which is nearly a line for small z and nearly a parabola for large: from the root of z^2 + sqrt(6) z = s, three percent
 * off at most, three of Newton's steps come to rounding. Returns z. */
WIDE_INLINE wide jkr_opening(wide s)
{
    const wide two = wide_all(2), four = wide_all(4), six = wide_all(6);
    const wide half_root_6 = wide_all((real)1.22474487139158905), q_0 = s + wide_all((real)1.5);
    wide z = s / (half_root_6 + q_0 * wide_inverse_root(q_0));
    for (int k = 0; k < 3; k++) {
        const wide q = wide_fused(z, z + four, six), per_root = wide_inverse_root(q), root = q * per_root;
        const wide slope = wide_fused(z * (z + two), per_root, root);
        z = z - wide_fused(z, root, -s) / slope;
    }
    return z;
}

/* jkr_springs of contact_law.h, LANES at a time, in the place of hertz_mindlin_normals. law, of_each: as there. A contact that is not
 * joined has none of it. */
WIDE_INLINE void jkr_normals(contact_block *restrict block, const contact_list *list, size_t at, const real *const of_each[],
                             real inverse_time_step)
{
    const wide damping = wide_all(list->damped.damping), lag = wide_all(list->damped.lag), zero = wide_all(0), one = wide_all(1);
    const wide eight_g_of_all = wide_all(8 * list->damped.k_t), half_per_dt = wide_all(inverse_time_step / 2), three = wide_all(3);
    const real *const per_overlap = list->cohesion[JKR_PER_OVERLAP] + at, *const force = list->cohesion[JKR_FORCE] + at;
    const real *const least = list->cohesion[JKR_LEAST_CONTACT] + at;
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide alpha = wide_load(block->overlap + k), d = wide_fused(alpha, wide_load(per_overlap + k), three);
        const wide_mask holds = wide_both(wide_exceeds(wide_load(block->joined + k), zero), wide_exceeds(d, zero));
        const wide joined = wide_greater(wide_where(holds, one), wide_where(wide_exceeds(alpha, zero), one));
        const wide_mask is_joined = wide_exceeds(joined, zero);
        const wide s2 = wide_greater(d, wide_all((real)1e-12)), y = one + jkr_opening(s2 * wide_inverse_root(s2));
        const wide yyy = y * y * y, spring = wide_load(force + k) * (yyy * (yyy - wide_all(6)));
        const wide a_f = wide_load(least + k), a = a_f * (y * y), root_a = a_f * wide_inverse_root(a_f) * y;
        const wide c_n = law_number(of_each[LAW_DAMPING], k, damping) * root_a
                         * wide_minus_product(wide_load(list->root_mass + at + k), law_number(of_each[LAW_LAG], k, lag), root_a);
        const wide f_n = wide_where(is_joined, wide_minus_product(spring, c_n, wide_load(block->parting + k)));
        const wide k_t = (of_each[LAW_K_T] ? wide_all(8) * wide_load(of_each[LAW_K_T] + k) : eight_g_of_all) * a;
        /* Thornton (1991): friction bears mu (N + 2 F_c), F_c = 9 pi w R/6 */
        const wide pressed = wide_fused(wide_all(18), wide_load(force + k), f_n);
        wide_store(block->joined + k, joined);
        wide_store(block->f_n + k, f_n);
        wide_store(block->mu_n + k, wide_where(is_joined, wide_load(list->friction + at + k) * wide_greater(pressed, zero)));
        wide_store(block->k_t + k, k_t);
        wide_store(block->compliance + k, one / k_t);
        wide_store(block->dashpot + k, c_n * half_per_dt);
    }
}

/* The normal forces of either law. of_each: as above. */
WIDE_INLINE void damped_normals(contact_block *block, const contact_list *list, size_t at, const real *const of_each[],
                                bool is_linear, real inverse_dt)
{
    const real *const root_mass = list->root_mass + at, *const friction = list->friction + at;
    if (is_linear) linear_normals(block, root_mass, friction, list->damped, of_each, inverse_dt);
    else hertz_mindlin_normals(block, root_mass, list->radius + at, friction, list->damped, of_each, inverse_dt);
}

static void normals_of_all(contact_block *block, const contact_list *list, size_t at, bool is_linear, real inverse_dt)
{
    const real *const none[LAW_NUMBERS] = { NULL };
    damped_normals(block, list, at, none, is_linear, inverse_dt);
}

static void normals_of_materials(contact_block *block, const contact_list *list, size_t at, bool is_linear, real inverse_dt)
{
    const real *const of_each[LAW_NUMBERS] = { list->law[LAW_K_N] + at, list->law[LAW_K_T] + at, list->law[LAW_DAMPING] + at,
                                               list->law[LAW_LAG] + at };
    damped_normals(block, list, at, of_each, is_linear, inverse_dt);
}

static void jkr_normals_of_list(contact_block *block, const contact_list *list, size_t at, real inverse_dt)
{
    const real *const none[LAW_NUMBERS] = { NULL };
    if (!list->laws_differ) {
        jkr_normals(block, list, at, none, inverse_dt);
        return;
    }
    const real *const of_each[LAW_NUMBERS] = { NULL, list->law[LAW_K_T] + at, list->law[LAW_DAMPING] + at,
                                               list->law[LAW_LAG] + at };
    jkr_normals(block, list, at, of_each, inverse_dt);
}

void contact_block_damped_springs(contact_block *block, contact_list *list, size_t start, const dem_contact_parameters *contact,
                                  double dt)
{
    const size_t at = constants_of(list, start);
    const real inverse_dt = dt > 0 ? (real)(1 / dt) : 0;
    real *const t_x = list->t[0] + start, *const t_y = list->t[1] + start, *const t_z = list->t[2] + start;
    const bool is_jkr = contact->cohesion_law == DEM_JKR && list->coheres;
    if (is_jkr) jkr_normals_of_list(block, list, at, inverse_dt);
    else
        (list->laws_differ ? normals_of_materials : normals_of_all)(block, list, at, contact->law == DEM_SPRING_DASHPOT,
                                                                    inverse_dt);
    rotate_stretch(block, t_x, t_y, t_z);
    friction_forces(block, t_x, t_y, t_z);
}
