/* Where the time of a step goes, for whoever hands the scene a clock: the core has none of its own. Without one each lap
 * costs a comparison. */
#ifndef STEP_PROFILE_H
#define STEP_PROFILE_H

#include "dem_types.h"

static inline void step_profile_begin(dem_step_profile *profile)
{
    if (profile) profile->lap_begin = profile->clock();
}

/* What was done since the last lap was of this part. */
static inline void step_profile_lap(dem_step_profile *profile, dem_step_part part)
{
    if (!profile) return;
    const double now = profile->clock();
    profile->seconds[part] += now - profile->lap_begin;
    profile->lap_begin = now;
}

#endif
