/* The paper's boundaries between centrifuging, sliding and raining. */
#include "regime_map.h"

#include <math.h>

/* 1/sin(phi) of t = tan(phi). */
static double cosecant(double t) { return copysign(sqrt(1 + 1 / (t * t)), t); }

double regime_map_stationary(double tangent) { return cosecant(tangent); }

double regime_map_sliding_eq34(double tangent) { return sqrt(0.5) * (1 + 1 / (tangent + 0.125)); }

double regime_map_sliding_eq36(double tangent) { return cosecant(0.16 + tangent); }
