/* One frictional particle on the inner wall of a rotating horizontal cylinder: a point mass held by nothing but its
 * own inertia and Coulomb friction (Walton & Braun 1993, Eqns 24-37 and Fig 8). Everything but `gravity` and `radius`
 * is dimensionless: Omega^2 = omega^2 R/g.
 *
 * Angles are the particle's, from the horizontal on the rising side: -pi/2 is the bottom, pi/2 the top. */
#ifndef DEM_GRANULE_H
#define DEM_GRANULE_H

#include "dem_types.h"

typedef struct dem_granule_definition {
    double friction;      /* mu, particle on wall; above 0 */
    double radius;        /* m, of the particle's circle */
    double gravity;       /* m/s2 */
    double rotation_rate; /* rad/s; NaN: only the least rate is wanted */
    int revolutions;      /* to be followed, at least 1 */
    double tolerance;     /* half-width of the bracket of the least Omega^2, at least 1e-12 */
} dem_granule_definition;

/* What becomes of a particle that starts at the bottom, turning with the wall. */
typedef struct dem_granule_motion {
    double omega2;
    dem_regime regime;  /* DEM_CENTRIFUGING (never slips), DEM_SLIDING (slips, goes round), DEM_RAINING (falls
                                 * off the wall), DEM_SLIPPING (slides back before the horizontal, never goes round) */
    bool keeps_contact; /* N >= 0 at all times */
    bool goes_round;
    int revolutions;            /* completed; fewer than asked for where the motion repeats itself or ends */
    double slip_per_revolution; /* rad by which the drum gets ahead, in the last one completed; NaN: none was */
    double slip_onset;          /* rad, where it first slips; NaN: never */
    double least_normal_force;  /* over m g, up to where it fell off (then 0) or came to rest */
} dem_granule_motion;

typedef struct dem_granule_result {
    double minimum_omega2;        /* least Omega^2 that keeps contact round the cylinder */
    double error;                 /* bound on its error, from bisection and rounding */
    double minimum_rotation_rate; /* rad/s */
    double slip_per_revolution;   /* rad, at that rate */
    double slip_onset;            /* rad, at that rate */
    /* What the paper has for the same, tan(phi_r) = mu: the no-slip bound, and fits to simulations. Deviations are
     * fit/minimum_omega2 - 1. */
    double stationary_eq33, sliding_eq34, sliding_eq36;
    double stationary_deviation_eq33, sliding_deviation_eq34, sliding_deviation_eq36;
    bool has_motion;           /* a rotation rate was given */
    dem_granule_motion motion; /* at that rate; else its numbers are NaN */
} dem_granule_result;

/* Errors: DEM_BAD_PARAMETER. */
dem_status dem_granule_solve(const dem_granule_definition *definition, dem_granule_result *result);

/* The motion alone, at one Omega^2. Errors: DEM_BAD_PARAMETER. */
dem_status dem_granule_follow(double friction, double omega2, int revolutions, dem_granule_motion *motion);

#endif
