/* How much of what an emulator says varies with which parameter: Sobol's indices over the unit cube (Saltelli et al. 2010, Comput.
 * Phys. Commun. 181, 259: first order by their eqn b of table 2, total by Jansen's, eqn f). */
#ifndef SENSITIVITY_H
#define SENSITIVITY_H

#include "emulator.h"

#include <stdint.h>

typedef struct sensitivity {
    double spread; /* standard deviation of the emulator's mean over the cube, in the units of the values */
    double lowest, highest;
    double first[EMULATOR_MOST_PARAMETERS], total[EMULATOR_MOST_PARAMETERS]; /* 0 where nothing varies */
} sensitivity;

/* False: no memory. */
bool sensitivity_measure(const emulator *emulator, uint64_t seed, sensitivity *s);

#endif
