/* The measures of a calibration: which results of a run stand beside what was measured. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "plan_request.h"
#include "process_type.h"
#include "spec_text.h"

/* Lists in the results that are curves. */
static const struct {
    const char *process, *name, *pointer, *across, *along;
} curves[] = {
    { "heap", "profile", "/surface/profile", "radius", "height" },
    { "fill", "profile", "/surface/profile", "radius", "height" },
    { "drum", "interface", "/repose/interface", "x", "height" },
};

/* "/repose/angle_deg", "/repose/slumps/period" or "/repose/other_methods/chord". */
static bool has_number(const result_table *results, const char *pointer)
{
    char at[JSON_POINTER_SIZE];
    for (size_t f = 0; f < results->count; f++) {
        const result_field *field = &results->field[f];
        if (field->kind != RESULT_REAL && field->kind != RESULT_WHOLE && field->kind != RESULT_SIZE) continue;
        snprintf(at, sizeof at, "/%s%s%s/%s", field->output, field->group ? "/" : "", field->group ? field->group : "",
                 field->name);
        if (strcmp(at, pointer) == 0) return true;
    }
    for (size_t k = 0; results->other_angles && results->other_angles[k]; k++) {
        snprintf(at, sizeof at, "/repose/other_methods/%s", results->other_angles[k]);
        if (strcmp(at, pointer) == 0) return true;
    }
    return false;
}

static double read_error(const json_t *error, const char *place, problem_list *problems)
{
    char seen[80];
    if (json_is_number(error) && json_number_value(error) > 0.0 && isfinite(json_number_value(error)))
        return json_number_value(error);
    json_value_text(error, seen, sizeof seen);
    if (!error) problem_list_add(problems, place, "is missing; must be the standard error of the value, more than 0");
    else problem_list_add(problems, place, "is %s; must be the standard error of the value, more than 0", seen);
    return NAN;
}

static plan_measure *new_measure(plan_request *request, const char *place, plan_use use, size_t test, problem_list *problems)
{
    if (request->measures == PLAN_MOST_MEASURES) {
        problem_list_add(problems, place, "makes more than %d values in all; give fewer points of curves", PLAN_MOST_MEASURES);
        return NULL;
    }
    plan_measure *measure = &request->measure[request->measures++];
    *measure = (plan_measure){ .use = use, .test = test, .value = NAN, .error = NAN };
    if (use == PLAN_FITTED) request->test[test].use = PLAN_FITTED;
    return measure;
}

/* The name that the target has, or one that its place, its process and its result make: "targets/1 drum /repose/angle_deg". */
static void name_measure(const json_t *target, const char *place, const char *process, const char *result,
                         char name[PLAN_NAME_SIZE])
{
    const char *given = json_string_value(json_object_get(target, "name"));
    if (given) snprintf(name, PLAN_NAME_SIZE, "%.160s", given);
    else snprintf(name, PLAN_NAME_SIZE, "%.30s %.20s %.100s", place + 1, process, result);
}

static void add_number(plan_request *request, const json_t *target, const char *place, plan_use use, size_t test,
                       const process_type *type, problem_list *problems)
{
    char at[LONGEST_POINTER];
    const char *pointer = json_string_value(json_object_get(target, "result"));
    pointer_to_member(at, place, "result");
    if (!pointer || !has_number(type->results, pointer)) {
        problem_list_add(problems, at,
                         "is %s; must be a JSON Pointer to a number among the results of the process \"%s\", as /repose/angle_deg",
                         pointer ? pointer : "missing or no text", type->name);
        return;
    }
    plan_measure *measure = new_measure(request, place, use, test, problems);
    if (!measure) return;
    snprintf(measure->pointer, sizeof measure->pointer, "%s", pointer);
    name_measure(target, place, type->name, pointer, measure->name);
    pointer_to_member(at, place, "standard_error");
    measure->error = read_error(json_object_get(target, "standard_error"), at, problems);
    const json_t *value = json_object_get(target, "value");
    pointer_to_member(at, place, "value");
    if (json_is_number(value)) measure->value = json_number_value(value);
    else if (use != PLAN_PROPOSED) problem_list_add(problems, at, "is missing or no number; must be the value that was measured");
}

/* False: there is no room for more. */
static bool add_point(plan_request *request, const json_t *target, const char *place, plan_use use, size_t test, size_t curve,
                      size_t index, problem_list *problems)
{
    char at[LONGEST_POINTER];
    const json_t *point = json_array_get(json_object_get(target, "points"), index);
    snprintf(at, sizeof at, "%.200s/points/%zu", place, index);
    if (json_array_size(point) != 3 || !json_is_number(json_array_get(point, 0)) || !json_is_number(json_array_get(point, 1))) {
        problem_list_add(problems, at, "must be a list of three numbers: %s, %s and its standard error", curves[curve].across,
                         curves[curve].along);
        return true;
    }
    plan_measure *measure = new_measure(request, place, use, test, problems);
    if (!measure) return false;
    char name[PLAN_NAME_SIZE];
    name_measure(target, place, curves[curve].process, curves[curve].name, name);
    measure->at = json_number_value(json_array_get(point, 0));
    measure->value = json_number_value(json_array_get(point, 1));
    snprintf(measure->name, sizeof measure->name, "%.120s at %.6g", name, measure->at);
    snprintf(measure->pointer, sizeof measure->pointer, "%s", curves[curve].pointer);
    measure->across = curves[curve].across;
    measure->along = curves[curve].along;
    snprintf(at, sizeof at, "%.200s/points/%zu/2", place, index);
    measure->error = read_error(json_array_get(point, 2), at, problems);
    return true;
}

static void add_curve(plan_request *request, const json_t *target, const char *place, plan_use use, size_t test,
                      const process_type *type, problem_list *problems)
{
    char at[LONGEST_POINTER];
    const char *name = json_string_value(json_object_get(target, "curve"));
    const size_t points = json_array_size(json_object_get(target, "points"));
    size_t c = 0;
    const size_t count = sizeof curves / sizeof curves[0];
    while (c < count && !(name && strcmp(curves[c].name, name) == 0 && strcmp(curves[c].process, type->name) == 0)) c++;
    pointer_to_member(at, place, "curve");
    if (c == count)
        problem_list_add(problems, at,
                         "is %s; the process \"%s\" has no such curve. Heap and fill have \"profile\", a drum has "
                         "\"interface\"",
                         name ? name : "no text", type->name);
    pointer_to_member(at, place, "points");
    if (points == 0) problem_list_add(problems, at, "must be a list of at least one point [place, value, standard error]");
    bool fits = c < count;
    for (size_t i = 0; fits && i < points; i++) fits = add_point(request, target, place, use, test, c, i, problems);
}

void plan_measures_add(plan_request *request, const json_t *target, const char *place, plan_use use, size_t test,
                       problem_list *problems)
{
    const process_type *type = process_type_find(json_string_value(json_object_get(request->test[test].request, "process")));
    const bool has_result = json_object_get(target, "result"), has_curve = json_object_get(target, "curve");
    if (has_result == has_curve) problem_list_add(problems, place, "must have one of \"result\" and \"curve\"");
    else if (has_curve) add_curve(request, target, place, use, test, type, problems);
    else add_number(request, target, place, use, test, type, problems);
}
