/* The results document of a drum: the table's rows, and the angles by other methods. */
#include "drum_result.h"

#include <math.h>

#include "dem.h"
#include "drum_process.h"
#include "standing_result.h"

void drum_result_init(drum_result *result)
{
    results_init(&drum_result_fields, result, sizeof *result);
    for (size_t m = 0; m < DEM_ANGLE_METHODS; m++) result->measured.repose.angle[m] = (dem_angle){ NAN, NAN, NAN, NAN };
}

_Static_assert(DEM_SURFACE_FIT == 0, "the angle itself is the first of the methods");

static bool add_other_angles(json_t *document, const drum_result *result)
{
    const char *name[DEM_ANGLE_METHODS];
    for (int m = 0; m < DEM_ANGLE_METHODS; m++) name[m] = dem_angle_method_name((dem_angle_method)m);
    return angle_methods_add(json_object_get(document, "repose"), result->measured.repose.angle, DEM_ANGLE_METHODS, name);
}

/* The verdict as users read it. Where there were too few frames for anything, the run was too short. */
static void say_verdict(drum_result *result)
{
    const dem_verdict verdict = result->measured.repose.frames > 0 ? result->measured.repose.verdict : DEM_TOO_SHORT;
    result->verdict = dem_verdict_name(verdict);
    result->steady = verdict == DEM_STEADY ? 1.0 : verdict == DEM_DRIFTING ? 0.0 : NAN;
    result->method = dem_angle_method_name(DEM_SURFACE_FIT);
    result->regime = result->has_regime ? dem_regime_name(result->measured.regime.regime) : NULL;
    result->certain = result->has_regime ? (double)result->measured.regime.is_certain : NAN;
}

json_t *drum_result_to_json(const drum_result *result)
{
    drum_result whole = *result;
    say_verdict(&whole);
    json_t *document = results_to_json(&drum_result_fields, &whole);
    if (document && add_other_angles(document, &whole)
        && json_object_set_new(json_object_get(document, "repose"), "interface", profile_to_json(&whole.interface, "x", "height"))
               == 0)
        return document;
    json_decref(document);
    return NULL;
}

void drum_stage_result_init(drum_stage_result *result)
{
    results_init(&drum_stage_fields, result, sizeof *result);
    for (size_t m = 0; m < DEM_ANGLE_METHODS; m++) result->measured.repose.angle[m] = (dem_angle){ NAN, NAN, NAN, NAN };
}

json_t *drum_stage_result_to_json(const drum_stage_result *result)
{
    json_t *document = results_to_json(&drum_stage_fields, result), *entry = json_incref(json_object_get(document, "stages"));
    json_decref(document);
    return entry;
}
