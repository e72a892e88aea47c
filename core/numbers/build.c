#include "dem.h"
#include "wide.h"

const char *dem_build_isa(void) { return WIDE_BYTES == 64 ? "avx512" : WIDE_BYTES == 32 ? "avx2" : "plain"; }
const char *dem_build_precision(void) { return IN_DOUBLE ? "double" : "single"; }
