/* The posterior: which parameters give what was measured, as draws of equal weight.
 *
 * Priors are flat over the unit cube. The likelihood of a place is that of the values measured, each about the emulator's mean with
 * the variance of measurement and emulator together. Drawn by tempering (Del Moral, Doucet & Jasra 2006, J. R. Stat. Soc. B 68,
 * 411): points that fill the cube evenly are weighted by a power of the likelihood that grows from 0 to 1 in steps that leave
 * half of them in effect, drawn anew by their weights, and moved by steps of Metropolis along differences of two others
 * (ter Braak 2006, Stat. Comput. 16, 239). A curved ridge, and islands, thus come out whole. */
#ifndef POSTERIOR_H
#define POSTERIOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "emulator.h"

typedef struct measured_value {
    const emulator *emulator;
    double value, error;
} measured_value;

typedef struct posterior {
    size_t draws, parameters;
    double *x;          /* (draws,parameters) in [0, 1], owned */
    double *likelihood; /* (draws) its logarithm, owned */
    double best[EMULATOR_MOST_PARAMETERS];
    double best_likelihood;
} posterior;

/* False: no memory. Clear it either way. */
bool posterior_draw(posterior *posterior, size_t parameters, const measured_value *measured, size_t values, size_t draws,
                    uint64_t seed);
void posterior_clear(posterior *posterior);

/* The logarithm of the likelihood at each of the places x (count,parameters). False: no memory. */
bool posterior_likelihood(const measured_value *measured, size_t values, size_t parameters, size_t count, const double *x,
                          double *likelihood);

#endif
