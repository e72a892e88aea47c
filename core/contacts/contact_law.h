/* The contact laws as pure functions of numbers, free of branches, so that a loop over contacts becomes wide
 * arithmetic. Walton & Braun: a latching normal spring and incremental friction (Walton & Braun 1993, text of
 * "Method"; the friction's three-dimensional form after Walton 1993b and Walton & Braun 1986). Damped springs: linear
 * (the paper's footnote) or Hertz-Mindlin, with friction that cuts the tangential force and pulls its spring back. All of
 * them with rolling friction, where it is asked for. */
#ifndef CONTACT_LAW_H
#define CONTACT_LAW_H

#include <stdbool.h>
#include <stddef.h>

#include "real.h"

/* What a contact remembers, in the order of the arrays of contact_list.h: those of rolling friction are last, since without it
 * there are none. To add one: here, and the array there. */
enum { CONTACT_NUMBERS = 8, NUMBERS_OF_ROLLING = 3 };

/* All zero for a contact that has just begun. */
typedef union contact_history {
    real number[CONTACT_NUMBERS];
    struct {
        real t[3];    /* T, N: friction force on the first body; damped laws: m, stretch of its spring */
        real t_star;  /* T at the last turning point over mu N, signed along T */
        real alpha_0; /* m: overlap at which the unloading branch reaches zero */
        real roll[3]; /* N: rolling moment on the first body over R* */
    };
} contact_history;
_Static_assert(sizeof(contact_history) == CONTACT_NUMBERS * sizeof(real), "every number that a contact remembers is counted");
_Static_assert(offsetof(contact_history, roll) == (CONTACT_NUMBERS - NUMBERS_OF_ROLLING) * sizeof(real), "rolling is last");

/* N2: a stored friction force below its root has no direction; elsewhere: a square whose root counts as none. */
#define TINY_SQUARE ((real)1e-30)

/* The same contact seen from the other body: n points the other way, and so do all vectors. */
static inline void contact_history_reverse(contact_history *history)
{
    for (int c = 0; c < 3; c++) {
        history->t[c] = -history->t[c];
        history->roll[c] = -history->roll[c];
    }
}

/* Normal force, N, of a latching spring in either form below. Without damping, a contact that is at rest swings below its latch
 * for ever, and friction is cut whenever N comes to zero: so an overlap that was larger before meets a dashpot while it grows
 * again (after Luding 2008, who damps throughout). A collision by itself never does, and keeps its restitution.
 * latch: alpha_0 of a contact that was never pressed harder, m; closing: m/s, positive while the overlap grows; c_n: N s/m. */
static inline real latching_force(real alpha, real latch, real latched, real closing, real k_1, real k_2, real c_n)
{
    const real spring = lesser(k_1 * alpha, k_2 * (alpha - latched));
    const real damped = latched > latch ? fused(c_n, greater(closing, 0), spring) : spring;
    return alpha > 0 ? greater(damped, 0) : 0;
}

/* Normal force, N, of the latching spring: K1 when loading beyond all before, K2 on unloading and reloading
 * below it; never attractive. An isolated collision has e = sqrt(K1/K2).
 * alpha: overlap, m (negative: apart); alpha_0: as in contact_history, updated; forgotten when they part. */
static inline real normal_force(real alpha, real closing, real k_1, real k_2, real c_n, real *alpha_0)
{
    const real latch = alpha * (1 - k_1 / k_2), latched = greater(*alpha_0, latch);
    *alpha_0 = alpha > 0 ? latched : 0;
    return latching_force(alpha, latch, latched, closing, k_1, k_2, c_n);
}

/* The same where the unloading branch steepens with the load that the contact has borne: K2 = K1 + S N_max (Walton &
 * Braun 1986), so that an isolated collision at speed v has e = sqrt(w/(S v + w)), w = sqrt(K1/m). From N_max = K1 alpha_max
 * follows alpha_0 = S alpha_max^2/(1 + S alpha_max), and back from q = S alpha_0, K2/K1 = 1 + (q + sqrt(q^2 + 4 q))/2:
 * alpha_0 alone remembers both. slope: S, 1/m. */
static inline real normal_force_of_slope(real alpha, real closing, real k_1, real slope, real c_n, real *alpha_0)
{
    const real pressed = greater(alpha, 0), s = slope * pressed;
    const real latch = s * pressed / (1 + s), latched = greater(*alpha_0, latch);
    *alpha_0 = alpha > 0 ? latched : 0;
    const real q = slope * latched, root2 = greater(q * (q + 4), TINY_SQUARE), steepness = q + root2 * inverse_root(root2);
    return latching_force(alpha, latch, latched, closing, k_1, fused(k_1 / 2, steepness, k_1), c_n);
}

/* Smallest 1 -+ t that a cube root sees: at full slip the stiffness falls to 1/100 of K_T0, not to zero. */
#define SLIP_FLOOR ((real)1e-6)

/* N: a limit of friction below this is none. */
#define TINY_FORCE ((real)1e-20)

/* One increment of friction. n: unit normal, first to second; ds: tangential displacement in this step, m;
 * mu_n: mu N; k_t0: tangential stiffness at the start of a loading, N/m. Updates t and t_star. */
static inline void friction_increment(const real n[3], const real ds[3], real mu_n, real k_t0, real t[3], real *t_star)
{
    /* Turn the friction force with the contact before adding to it: a rolling pair would otherwise store force
     * along its normal. */
    const real tn = dot(t, n);
    const real u[3] = { fused(-tn, n[0], t[0]), fused(-tn, n[1], t[1]), fused(-tn, n[2], t[2]) };
    const real uu = dot(u, u), turn = uu > TINY_SQUARE ? inverse_root(uu) : 0;
    /* |T| = sqrt(|u|^2 + tn^2); a contact turns by far less than a radian in a step, so two terms of the root do. Of a T
     * that is rounding's, and lies along the normal, next to nothing stays. */
    const real size = uu * turn, off = tn * turn, magnitude = fused((real)0.5 * size, lesser(off * off, 1), size);
    const real h[3] = { u[0] * turn, u[1] * turn, u[2] * turn };

    const real stored = lesser(magnitude, mu_n);
    const real tau = mu_n > TINY_FORCE ? stored / mu_n : 0;            /* t of the formulas: |T| as a share of its limit */
    const real push[3] = { k_t0 * ds[0], k_t0 * ds[1], k_t0 * ds[2] }; /* N, at the spring's stiffest */
    const real s_p = dot(push, h);

    /* Loading softens towards slip; after a turning point at t* the spring starts stiff again. */
    const real sign = (real)copysign(1, (double)s_p);
    const real turning = lesser(sign * *t_star, sign * tau);
    const real left = greater(1 - sign * tau, SLIP_FLOOR), left_at_turn = greater(1 - turning, SLIP_FLOOR);
    /* (a/b)^(1/3) = a (a a b)^(-1/3) */
    const real share = left * inverse_cube_root(left * left * left_at_turn); /* K_T/K_T0 */
    const real s = fused(share, s_p, stored), along = s - s_p;
    for (int c = 0; c < 3; c++) t[c] = fused(along, h[c], push[c]);
    const real scale = lesser(mu_n * inverse_root(dot(t, t)), 1);
    for (int c = 0; c < 3; c++) t[c] *= scale;
    *t_star = mu_n > TINY_FORCE ? sign * (real)copysign(1, (double)s) * turning : 0;
}

/* What the two damped laws differ in, at one overlap. */
typedef struct damped_springs {
    real f_n; /* N, normal spring */
    real c_n; /* N s/m, normal dashpot */
    real k_t; /* N/m, tangential spring */
    real c_t; /* N s/m, tangential dashpot */
} damped_springs;

/* What they are made of, for one pair of materials. */
typedef struct damped_law {
    real k_n;     /* N/m; Hertz-Mindlin: Pa, E* */
    real k_t;     /* N/m; Hertz-Mindlin: Pa, G* */
    real damping; /* 2 zeta sqrt(k_n); Hertz-Mindlin: 2 sqrt(5/6) zeta sqrt(2 E*) */
    real lag;     /* kg^(1/2); Hertz-Mindlin: kg^(1/2) m^(-1/4): a share of damping dt/2 */
    real edge[2]; /* of at_edge: the line's value at 0 and its slope */
} damped_law;

/* What those shares are for linear springs and for Hertz-Mindlin, of which restitution is right at DEM_STEPS_PER_CONTACT and
 * more (core/NUMERICS.md, "Contact"). */
#define LINEAR_LAG 0.505
#define HERTZIAN_LAG 0.467
/* clang-format off */
#define LINEAR_EDGE { (real)0.5, 1 }
#define HERTZIAN_EDGE { (real)0.6, (real)0.74 }
/* clang-format on */

/* Linear: c_n = 2 zeta sqrt(m K1), c_t = c_n/2. root_mass: kg^(1/2), root of the effective mass.
 * The velocity at hand is half a step old: c_n v(n-1/2) = c_n v(n) + (c_n dt/2 m) N. Restitution is right to second order
 * with c_n (1 - z/2) instead, z = c_n dt/(2 m), which is damping (root_mass - lag). */
static inline damped_springs linear_springs(damped_law law, real alpha, real root_mass)
{
    const real c_n = law.damping * (root_mass - law.lag);
    return (damped_springs){ law.k_n * alpha, c_n, law.k_t, c_n / 2 };
}

/* Hertz: N = 4/3 E* sqrt(R* alpha) alpha, S_n = dN/dalpha = 2 E* a; Mindlin without slip: S_t = 8 G* a, a = sqrt(R* alpha);
 * c_n = 2 sqrt(5/6) zeta sqrt(S_n m), which makes restitution independent of speed (Tsuji, Tanaka & Ishida 1992), and
 * c_t half of it. alpha > 0; radius: effective, m. a and its root are made of one power of R* alpha. */
static inline damped_springs hertz_mindlin_springs(damped_law law, real alpha, real root_mass, real radius)
{
    const real aa = radius * alpha, y = inverse_fourth_root(aa), a = aa * (y * y), root_a = a * y;
    const real c_n = law.damping * root_a * fused(-law.lag, root_a, root_mass);
    return (damped_springs){ (real)(4.0 / 3.0) * law.k_n * a * alpha, c_n, 8 * law.k_t * a, c_n / 2 };
}

/* Of a contact that began within the last step, or ends within the next: it is there for half a step and for the share of
 * alpha in the way of a step, not for a whole one, and its dashpots likewise; Hertz-Mindlin: the integral of alpha^(1/4) over
 * that time, as a line through it. v: along the normal, m/s; per_dt: 1/dt, 1/s. */
static inline damped_springs at_edge(damped_springs springs, damped_law law, real alpha, real v, real per_dt)
{
    const real in_one_step = greater(alpha, 0) * per_dt, size = greater(v, -v);
    const real share = size > in_one_step ? fused(law.edge[1], in_one_step / size, law.edge[0]) : 1;
    return (damped_springs){ springs.f_n, springs.c_n * share, springs.k_t, springs.c_t * share };
}

/* Normal force of spring and dashpot; 0 apart. closing: m/s, positive while the overlap grows. The dashpot may pull at
 * the very end of a collision: the relation of zeta and e counts on it. */
static inline real damped_normal_force(damped_springs springs, real alpha, real closing)
{
    return alpha > 0 ? fused(springs.c_n, closing, springs.f_n) : 0;
}

/* One increment of the spring's stretch (turned with the contact, as above) by ds in dt; force: with the dashpot, cut
 * at mu |N|. Where it is cut, the spring is pulled back by what was cut off. Keeping the stretch rather than the force
 * is Mindlin's solution without slip as the published benchmarks have it: the stiffness of now acts on all of it. */
static inline void damped_friction_increment(const real n[3], const real ds[3], real inverse_dt, real mu_n, damped_springs springs,
                                             real stretch[3], real force[3])
{
    const real sn = dot(stretch, n);
    const real u[3] = { fused(-sn, n[0], stretch[0]), fused(-sn, n[1], stretch[1]), fused(-sn, n[2], stretch[2]) };
    /* |stretch|/|u|, as above by two terms of the root */
    const real off2 = sn * sn / greater(dot(u, u), TINY_SQUARE), keep = fused((real)0.5, lesser(off2, 1), 1);
    const real limit = greater(mu_n, -mu_n);
    for (int c = 0; c < 3; c++) {
        stretch[c] = fused(u[c], keep, ds[c]);
        force[c] = fused(springs.k_t, stretch[c], springs.c_t * inverse_dt * ds[c]);
    }
    const real scale = lesser(limit * inverse_root(dot(force, force)), 1);
    for (int c = 0; c < 3; c++) {
        stretch[c] = limit > TINY_FORCE ? fused((scale - 1) / springs.k_t, force[c], stretch[c]) : 0;
        force[c] *= scale;
    }
}

/* One increment of rolling friction: an elastic spring of stiffness K_T R*^2 against the relative rotation in the tangent
 * plane, which yields at mu_r R* N (Iwashita & Oda 1998; Ai et al. 2011, model C; Wensrich & Katterfeld 2012). Written as forces on the arm R*. ds: m, R* times the rotation in this step of the first less the second, its
 * part along n taken out; limit: mu_r |N|; k_t: tangential stiffness now, N/m. The second body has the opposite moment. */
static inline bool rolling_increment(const real n[3], const real ds[3], real limit, real k_t, real roll[3])
{
    const real rn = dot(roll, n);
    const real u[3] = { fused(-rn, n[0], roll[0]), fused(-rn, n[1], roll[1]), fused(-rn, n[2], roll[2]) };
    /* |roll|/|u|, as above by two terms of the root; 1 exactly where nothing turns, so that nothing leaks away */
    const real uu = dot(u, u), off2 = uu > TINY_SQUARE ? rn * rn / uu : 0;
    const real keep = fused((real)0.5, lesser(off2, 1), 1);
    for (int c = 0; c < 3; c++) roll[c] = fused(-k_t, ds[c], keep * u[c]);
    const real size2 = dot(roll, roll);
    const bool yields = size2 > limit * limit;
    const real scale = yields ? limit * inverse_root(size2) : 1;
    for (int c = 0; c < 3; c++) roll[c] = limit > TINY_FORCE ? roll[c] * scale : 0;
    return yields;
}

/* What a contact bears that has a dashpot beside this spring, from what the spring bears now. epsd-damped: the dashpot acts until
 * the spring yields (Ai et al. 2011). constant: always, and both together are cut at the limit, which is smaller where the contact
 * twists, too (core/NUMERICS.md, "Rolling friction"). v, twist: m/s, R* times the relative spin in the tangent plane and along n;
 * c: N s/m. */
static inline void rolling_with_dashpot(const real roll[3], const real v[3], real twist, real limit, real c, bool is_constant,
                                        bool yields, real total[3])
{
    if (!(limit > TINY_FORCE)) {
        for (int k = 0; k < 3; k++) total[k] = 0;
        return;
    }
    const real damping = yields && !is_constant ? 0 : c;
    for (int k = 0; k < 3; k++) total[k] = fused(-damping, v[k], roll[k]);
    if (!is_constant) return;
    const real d_n = c * twist, dd = fused(c * c, dot(v, v), greater(limit * limit, TINY_SQUARE)),
               share2 = dd / fused(d_n, d_n, dd);
    const real cut = limit * (share2 * inverse_root(share2)), size2 = dot(total, total);
    const real scale = size2 > cut * cut ? cut * inverse_root(size2) : 1;
    for (int k = 0; k < 3; k++) total[k] *= scale;
}

#endif
