/* What a run's results say of a measure. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "plan_request.h"

static bool find_number(const json_t *results, const char *pointer, double *number)
{
    const json_t *value = json_pointer_find(results, pointer);
    if (!json_is_number(value)) return false;
    *number = json_number_value(value);
    return isfinite(*number);
}

/* Where results have the error of a result: "standard_error_deg" of "angle_deg", "period_standard_error" of "period",
 * "start_standard_error_deg" of "start_deg", and a list of their own for the other methods. */
static double own_error(const json_t *results, const char *pointer)
{
    char folder[JSON_POINTER_SIZE], at[2 * JSON_POINTER_SIZE + 40];
    double error;
    snprintf(folder, sizeof folder, "%s", pointer);
    char *name = strrchr(folder, '/');
    *name++ = '\0';
    const size_t length = strlen(name);
    const bool is_deg = length > 4 && strcmp(name + length - 4, "_deg") == 0;
    if (strcmp(name, "angle_deg") == 0) snprintf(at, sizeof at, "%s/standard_error_deg", folder);
    else if (is_deg) snprintf(at, sizeof at, "%s/%.*s_standard_error_deg", folder, (int)length - 4, name);
    else if (strcmp(folder, "/repose/other_methods") == 0) snprintf(at, sizeof at, "%s_standard_error_deg/%s", folder, name);
    else snprintf(at, sizeof at, "%s/%s_standard_error", folder, name);
    return strlen(at) < JSON_POINTER_SIZE && find_number(results, at, &error) ? fabs(error) : NAN;
}

/* Between the two entries of the list `across`, which grows, that the place lies between; at its ends, the end's. */
static bool along_curve(const json_t *curve, const plan_measure *measure, double *value, double *error)
{
    const json_t *across = json_object_get(curve, measure->across), *along = json_object_get(curve, measure->along);
    const json_t *errors = json_object_get(curve, "standard_error");
    const size_t count = json_array_size(across);
    if (count == 0 || json_array_size(along) != count) return false;
    size_t after = 0;
    while (after < count && json_number_value(json_array_get(across, after)) < measure->at) after++;
    const size_t before = after ? after - 1 : 0;
    if (after == count) after = count - 1;
    const json_t *ends[2] = { json_array_get(along, before), json_array_get(along, after) };
    if (!json_is_number(ends[0]) || !json_is_number(ends[1])) return false;
    const double from = json_number_value(json_array_get(across, before)), to = json_number_value(json_array_get(across, after));
    const double share = to > from ? fmin(fmax((measure->at - from) / (to - from), 0.0), 1.0) : 0.0;
    *value = (1.0 - share) * json_number_value(ends[0]) + share * json_number_value(ends[1]);
    const json_t *own[2] = { json_array_get(errors, before), json_array_get(errors, after) };
    const bool known = json_is_number(own[0]) && json_is_number(own[1]);
    *error = known ? (1.0 - share) * json_number_value(own[0]) + share * json_number_value(own[1]) : NAN;
    return true;
}

bool plan_measure_read(const plan_measure *measure, const json_t *results, double *value, double *error)
{
    if (measure->across) return along_curve(json_pointer_find(results, measure->pointer), measure, value, error);
    if (!find_number(results, measure->pointer, value)) return false;
    *error = own_error(results, measure->pointer);
    return true;
}
