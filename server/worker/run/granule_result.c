/* From the core's numbers, in radians, to what the table of results tells. */
#include "granule_result.h"

#include <math.h>

#include "dem.h"
#include "dem_rules.h"
#include "granule_process.h"

static double degrees(double radians) { return radians * (180.0 / DEM_PI); }

void granule_result_set(granule_result *result, const dem_granule_result *solved, const run_facts *run)
{
    results_init(&granule_result_fields, result, sizeof *result);
    result->solved = *solved;
    result->slip_onset_deg = degrees(solved->slip_onset);
    result->run = *run;
    if (!solved->has_motion) return;
    result->regime = dem_regime_name(solved->motion.regime);
    result->keeps_contact = solved->motion.keeps_contact;
    result->goes_round = solved->motion.goes_round;
    result->revolutions = solved->motion.revolutions;
    result->motion_slip_onset_deg = degrees(solved->motion.slip_onset);
}

json_t *granule_result_to_json(const granule_result *result) { return results_to_json(&granule_result_fields, result); }
