/* The contact law as pure functions of numbers: a latching normal spring and incremental friction.
 *
 * Source: Walton & Braun (1993), text of "Method"; the friction's three-dimensional form after Walton (1993b)
 * and Walton & Braun (1986). All of it free of branches, so that a loop over contacts becomes wide arithmetic. */
#ifndef CONTACT_LAW_H
#define CONTACT_LAW_H

#include "real.h"

/* What a contact remembers. All zero for a contact that has just begun. */
typedef struct contact_history {
    real t[3];    /* T, N: friction force on the first body */
    real t_star;  /* T at the last turning point over mu N, signed along T */
    real alpha_0; /* m: overlap at which the unloading branch reaches zero */
} contact_history;

/* Normal force, N, of the latching spring: K1 when loading beyond all before, K2 on unloading and reloading
 * below it; never attractive. An isolated collision has e = sqrt(K1/K2).
 * alpha: overlap, m (negative: apart); alpha_0: as in contact_history, updated; forgotten when they part. */
static inline real normal_force(real alpha, real k_1, real k_2, real *alpha_0)
{
    const real latched = greater(*alpha_0, alpha * (1 - k_1 / k_2));
    *alpha_0 = alpha > 0 ? latched : 0;
    const real loading = k_1 * alpha, unloading = k_2 * (alpha - latched);
    return greater(lesser(loading, unloading), 0);
}

/* Smallest 1 -+ t that a cube root sees: at full slip the stiffness falls to 1/100 of K_T0, not to zero. */
#define SLIP_FLOOR ((real)1e-6)

/* N2: a stored friction force below its root has no direction. */
#define TINY_SQUARE ((real)1e-30)
/* N: a limit of friction below this is none. */
#define TINY_FORCE ((real)1e-20)

/* One increment of friction. n: unit normal, first to second; ds: tangential displacement in this step, m;
 * mu_n: mu N; k_t0: tangential stiffness at the start of a loading, N/m. Updates t and t_star. */
static inline void friction_increment(const real n[3], const real ds[3], real mu_n, real k_t0,
                                      real t[3], real *t_star)
{
    /* Turn the friction force with the contact before adding to it: a rolling pair would otherwise store force
     * along its normal. */
    const real tn = dot(t, n);
    const real u[3] = { fused(-tn, n[0], t[0]), fused(-tn, n[1], t[1]), fused(-tn, n[2], t[2]) };
    const real tt = dot(t, t), uu = dot(u, u);
    const real turn = uu > TINY_SQUARE ? inverse_root(uu) : 0;
    const real magnitude = uu > TINY_SQUARE ? tt * inverse_root(tt) : 0;
    const real h[3] = { u[0] * turn, u[1] * turn, u[2] * turn };

    const real stored = lesser(magnitude, mu_n);
    const real tau = mu_n > TINY_FORCE ? stored * inverse(mu_n) : 0; /* t of the formulas: |T| as a share of its limit */
    const real s_p = dot(ds, h);

    /* Loading softens towards slip; after a turning point at t* the spring starts stiff again. */
    const real sign = s_p >= 0 ? 1 : -1;
    const real turning = lesser(sign * *t_star, sign * tau);
    const real left = greater(1 - sign * tau, SLIP_FLOOR), left_at_turn = greater(1 - turning, SLIP_FLOOR);
    /* (a/b)^(1/3) = a (a a b)^(-1/3) */
    const real k_t = k_t0 * (left * inverse_cube_root(left * left * left_at_turn));
    const real s = fused(k_t, s_p, stored);
    const real star = sign * turning;

    for (int c = 0; c < 3; c++) t[c] = fused(s, h[c], k_t0 * fused(-s_p, h[c], ds[c]));
    const real size2 = dot(t, t);
    const real scale = size2 > mu_n * mu_n ? mu_n * inverse_root(size2) : 1;
    for (int c = 0; c < 3; c++) t[c] *= scale;
    *t_star = mu_n > TINY_FORCE ? (s < 0 ? -star : star) : 0;
}

#endif
