/* The results document of a drum: the table's numbers, and the words beside them. */
#include "drum_result.h"

#include <math.h>
#include <string.h>

#include "dem.h"
#include "drum_process.h"

void drum_result_init(drum_result *result)
{
    results_init(&drum_result_fields, result, sizeof *result);
    for (size_t m = 0; m < DEM_ANGLE_METHODS; m++) result->measured.repose.angle[m] = (dem_angle){ NAN, NAN, NAN, NAN };
}

static json_t *real_or_null(double number) { return isfinite(number) ? json_real(number) : json_null(); }

static bool add_words(json_t *document, const drum_result *result)
{
    json_t *repose = json_object_get(document, "repose"), *regime = json_object_get(document, "regime");
    json_t *angles = json_object(), *errors = json_object();
    for (int m = 0; m < DEM_ANGLE_METHODS; m++) {
        if (m == DEM_SURFACE_FIT) continue;
        const dem_angle *angle = &result->measured.repose.angle[m];
        const char *name = dem_angle_method_name((dem_angle_method)m);
        json_object_set_new(angles, name, real_or_null(angle->mean_deg));
        json_object_set_new(errors, name, real_or_null(angle->standard_error_deg));
    }
    json_t *name = result->has_regime ? json_string(dem_regime_name(result->measured.regime.regime)) : json_null();
    const int failed = json_object_set_new(repose, "method", json_string(dem_angle_method_name(DEM_SURFACE_FIT)))
                       | json_object_set_new(repose, "other_methods", angles)
                       | json_object_set_new(repose, "other_methods_standard_error_deg", errors)
                       | json_object_set_new(regime, "name", name);
    return failed == 0;
}

/* The verdict as users read it. Where there were too few frames for anything, the run was too short. */
static void say_verdict(drum_result *result)
{
    const dem_verdict verdict = result->measured.repose.frames > 0 ? result->measured.repose.verdict : DEM_TOO_SHORT;
    result->verdict = dem_verdict_name(verdict);
    result->steady = verdict == DEM_STEADY ? 1.0 : verdict == DEM_DRIFTING ? 0.0 : NAN;
    result->certain = result->has_regime ? (double)result->measured.regime.is_certain : NAN;
}

json_t *drum_result_to_json(const drum_result *result)
{
    drum_result whole = *result;
    say_verdict(&whole);
    json_t *document = results_to_json(&drum_result_fields, &whole);
    if (document && add_words(document, &whole)) return document;
    json_decref(document);
    return NULL;
}
