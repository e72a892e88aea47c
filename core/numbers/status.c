#include "dem.h"

const char *dem_status_text(dem_status status)
{
    switch (status) {
    case DEM_OK: return "ok";
    case DEM_NO_MEMORY: return "out of memory";
    case DEM_BAD_PARAMETER: return "a parameter is out of its range";
    case DEM_DOES_NOT_FIT: return "the particles do not fit into their container";
    case DEM_NOT_A_NUMBER: return "a particle's position is not a number";
    case DEM_OVERLAP_TOO_LARGE: return "an overlap is beyond half of the smaller radius";
    case DEM_PARTICLE_ESCAPED: return "a particle left its container";
    case DEM_NEVER_SETTLED: return "the bed did not come to rest";
    case DEM_TOO_FEW_FRAMES: return "too few frames to measure";
    case DEM_STATE_MISMATCH: return "the saved state is not whole, or belongs to another definition";
    }
    return "unknown status";
}

const char *dem_phase_name(dem_phase phase)
{
    static const char *const name[] = { "growing", "settling", "rotating" };
    return name[phase];
}

const char *dem_step_part_name(dem_step_part part)
{
    static const char *const name[DEM_STEP_PARTS] = { "outer list", "inner list", "pairs", "walls", "motion", "container" };
    return name[part];
}

const char *dem_regime_name(dem_regime regime)
{
    static const char *const name[] = { "slipping",    "slumping", "avalanching", "rolling",     "cascading",
                                        "cataracting", "raining",  "sliding",     "centrifuging" };
    return name[regime];
}

const char *dem_verdict_name(dem_verdict verdict)
{
    static const char *const name[] = { NULL, "steady", "drifting", "too-short", "too-few" };
    return name[verdict];
}

const char *dem_angle_method_name(dem_angle_method method)
{
    static const char *const name[] = { "surface-fit", "center-of-mass", "chord", "theil-sen", "upper-chord", "lower-chord" };
    return name[method];
}
