/* What unit tests of the core start from. */
#ifndef CORE_CLAIMS_H
#define CORE_CLAIMS_H

#include <float.h>

#include "claims.h"
#include "real.h"

/* Rounding of the numbers that contacts are computed in: tolerances are stated in multiples of it. */
#define ROUNDING (sizeof(real) == sizeof(float) ? (double)FLT_EPSILON : DBL_EPSILON)

#endif
