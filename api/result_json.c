/* Writes the results document from the table of results. */
#include "result_json.h"

#include <math.h>
#include <string.h>

#include "dem.h"
#include "result_fields.h"

void job_result_init(job_result *result)
{
    memset(result, 0, sizeof *result);
    for (size_t f = 0; f < result_field_count; f++) {
        const result_kind kind = result_fields[f].kind;
        if (kind == RESULT_REAL || kind == RESULT_WHOLE)
            *(double *)((char *)result + result_fields[f].offset) = NAN;
    }
    for (size_t m = 0; m < DEM_ANGLE_METHODS; m++)
        result->measured.repose.angle[m] = (dem_angle){NAN, NAN, NAN, NAN};
}

static json_t *real_or_null(double number)
{
    return isfinite(number) ? json_real(number) : json_null();
}

static json_t *field_value(const result_field *field, const job_result *result)
{
    const char *place = (const char *)result + field->offset;
    switch (field->kind) {
    case RESULT_SIZE:
        return json_integer((json_int_t) * (const size_t *)place);
    case RESULT_TRUTH:
        return json_boolean(*(const bool *)place);
    case RESULT_WHOLE:
        if (isfinite(*(const double *)place)) return json_integer((json_int_t) * (const double *)place);
        return json_null();
    default:
        return real_or_null(*(const double *)place);
    }
}

/* The object that a field is a member of, made when it is first needed. Borrowed. */
static json_t *field_parent(json_t *document, const result_field *field)
{
    json_t *output = json_object_get(document, field->output);
    if (!output && json_object_set_new(document, field->output, json_object()) != 0) return NULL;
    output = json_object_get(document, field->output);
    if (!field->group) return output;
    if (!json_object_get(output, field->group)) json_object_set_new(output, field->group, json_object());
    return json_object_get(output, field->group);
}

static bool add_words(json_t *document, const job_result *result)
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

json_t *job_result_to_json(const job_result *result)
{
    json_t *document = json_object();
    bool complete = document != NULL;
    for (size_t f = 0; complete && f < result_field_count; f++) {
        const result_field *field = &result_fields[f];
        complete = json_object_set_new(field_parent(document, field), field->name, field_value(field, result)) == 0;
    }
    if (complete && add_words(document, result)) return document;
    json_decref(document);
    return NULL;
}
