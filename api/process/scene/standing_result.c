#include "standing_result.h"

#include <math.h>

#include "json_text.h"

bool angle_methods_add(json_t *repose, const dem_angle *angle, int count, const char *const *name)
{
    json_t *angles = json_object(), *errors = json_object();
    for (int m = 1; m < count; m++) {
        json_object_set_new(angles, name[m], json_real_or_null(angle[m].mean_deg));
        json_object_set_new(errors, name[m], json_real_or_null(angle[m].standard_error_deg));
    }
    return (json_object_set_new(repose, "other_methods", angles)
            | json_object_set_new(repose, "other_methods_standard_error_deg", errors))
           == 0;
}

static json_t *list_of(const double *values, size_t count)
{
    json_t *list = json_array();
    for (size_t k = 0; k < count; k++) json_array_append_new(list, json_real_or_null(values[k]));
    return list;
}

json_t *profile_to_json(const dem_profile *profile, const char *place, const char *value)
{
    bool has_error = false;
    for (size_t k = 0; k < profile->count; k++) has_error = has_error || isfinite(profile->standard_error[k]);
    json_t *object =
        json_pack("{s:o, s:o}", place, list_of(profile->place, profile->count), value, list_of(profile->value, profile->count));
    if (object && has_error) json_object_set_new(object, "standard_error", list_of(profile->standard_error, profile->count));
    return object;
}

void describe_angle_methods(json_t *properties)
{
    json_object_set_new(properties, "other_methods",
                        json_pack("{s:s, s:s, s:s, s:{s:[s, s]}}", "type", "object", "description",
                                  "mean angle by other definitions", "x-unit", "degrees", "additionalProperties", "type", "number",
                                  "null"));
    json_object_set_new(properties, "other_methods_standard_error_deg",
                        json_pack("{s:s, s:s, s:s, s:{s:[s, s]}}", "type", "object", "description", "errors of those", "x-unit",
                                  "degrees", "additionalProperties", "type", "number", "null"));
}

void describe_profile(json_t *properties, const char *name, const char *meaning)
{
    json_object_set_new(properties, name,
                        json_pack("{s:s, s:b, s:s}", "type", "object", "additionalProperties", 1, "description", meaning));
}
