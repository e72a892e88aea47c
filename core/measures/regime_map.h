/* Boundaries of the fast regimes in Omega^2 against the angle of repose phi_r (paper, Fig 8). */
#ifndef REGIME_MAP_H
#define REGIME_MAP_H

/* tangent: tan(phi_r); for a single particle its mu. */
double regime_map_stationary(double tangent);   /* Eq 33: above it nothing slips */
double regime_map_sliding_eq34(double tangent); /* Eqns 34 and 35: below it particles rain, a fit */
double regime_map_sliding_eq36(double tangent); /* Eqns 36-37: another fit of the same boundary */

#endif
