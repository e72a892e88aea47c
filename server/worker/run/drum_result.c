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

/* The mean height where every bed has one. */
static void mean_interface(const drum_result *bed, size_t count, dem_profile *all)
{
    all->count = 0;
    for (size_t i = 0; i < bed[0].interface.count; i++) {
        double value[MOST_BEDS], error[MOST_BEDS];
        size_t found = 0;
        for (size_t k = 0; k < count; k++)
            for (size_t j = 0; j < bed[k].interface.count; j++) {
                if (bed[k].interface.place[j] != bed[0].interface.place[i]) continue;
                value[found] = bed[k].interface.value[j];
                error[found++] = bed[k].interface.standard_error[j];
            }
        if (found < count) continue;
        all->place[all->count] = bed[0].interface.place[i];
        mean_over_beds(value, error, count, &all->value[all->count], &all->standard_error[all->count]);
        all->count++;
    }
}

/* What the table's rows do not say: the angles by other methods, and what all beds tell together. */
static void measure_together(const drum_result *bed, size_t count, drum_result *all)
{
    dem_drum_results measured[MOST_BEDS];
    for (size_t k = 0; k < count; k++) measured[k] = bed[k].measured;
    dem_drum_results_of_beds(measured, count, &all->measured.repose);
    say_verdict(all);
    for (int m = 0; m < DEM_ANGLE_METHODS; m++) {
        double value[MOST_BEDS], error[MOST_BEDS];
        dem_angle *angle = &all->measured.repose.angle[m];
        for (size_t k = 0; k < count; k++) {
            value[k] = measured[k].repose.angle[m].mean_deg;
            error[k] = measured[k].repose.angle[m].standard_error_deg;
        }
        mean_over_beds(value, error, count, &angle->mean_deg, &angle->standard_error_deg);
    }
    mean_interface(bed, count, &all->interface);
}

void drum_result_of_beds(drum_result *bed, size_t count, drum_result *all)
{
    const void *said[MOST_BEDS];
    for (size_t k = 0; k < count; k++) {
        say_verdict(&bed[k]);
        said[k] = &bed[k];
    }
    *all = bed[0];
    if (count == 1) return;
    measure_together(bed, count, all);
    results_of_beds(&drum_result_fields, said, count, all);
}

static json_t *document_of(const drum_result *said)
{
    json_t *document = results_to_json(&drum_result_fields, said);
    if (document && add_other_angles(document, said)
        && json_object_set_new(json_object_get(document, "repose"), "interface", profile_to_json(&said->interface, "x", "height"))
               == 0)
        return document;
    json_decref(document);
    return NULL;
}

/* Of each bed, what is told of it. */
static bool add_beds(json_t *document, const drum_result *bed, size_t count)
{
    json_t *each[MOST_BEDS];
    double seed[MOST_BEDS];
    bool complete = true;
    for (size_t k = 0; k < count; k++) {
        each[k] = results_to_json(&drum_result_fields, &bed[k]);
        seed[k] = bed[k].run.seed;
        complete = complete && each[k];
    }
    complete = complete && beds_to_json(&drum_result_fields, each, seed, count, document);
    for (size_t k = 0; k < count; k++) json_decref(each[k]);
    return complete;
}

json_t *drum_result_to_json(drum_result *bed, size_t count)
{
    drum_result all;
    drum_result_of_beds(bed, count, &all);
    json_t *document = document_of(&all);
    if (document && add_beds(document, bed, count)) return document;
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
