#include "plan_request.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "job_spec.h"
#include "spec_text.h"

enum { MOST_REPEATS = 20, MOST_JOBS = 10000, USUAL_JOBS = 120, LONGEST_NAME = 200, LONGEST_DESCRIPTION = 2000 };

static void refuse_value(problem_list *problems, const char *pointer, const json_t *value, const char *must)
{
    char seen[80];
    json_value_text(value, seen, sizeof seen);
    problem_list_add(problems, pointer, "is %s; must be %s", seen, must);
}

/* --- the parameters --- */

static void read_range(const json_t *given, const char *place, plan_parameter *parameter, problem_list *problems)
{
    char at[LONGEST_POINTER];
    const json_t *range = json_object_get(given, "range"), *scale = json_object_get(given, "scale");
    pointer_to_member(at, place, "scale");
    if (json_is_string(scale) && strcmp(json_string_value(scale), "log") == 0) parameter->is_log = true;
    else if (scale && (!json_is_string(scale) || strcmp(json_string_value(scale), "linear") != 0))
        refuse_value(problems, at, scale, "\"linear\" or \"log\"");
    pointer_to_member(at, place, "range");
    if (json_array_size(range) != 2 || !json_is_number(json_array_get(range, 0)) || !json_is_number(json_array_get(range, 1))) {
        refuse_value(problems, at, range, "a list of two numbers, the lowest value and the highest");
        return;
    }
    parameter->low = json_number_value(json_array_get(range, 0));
    parameter->high = json_number_value(json_array_get(range, 1));
    if (!(parameter->low < parameter->high))
        problem_list_add(problems, at, "is from %g to %g; the second must be more than the first", parameter->low, parameter->high);
    if (parameter->is_log && !(parameter->low > 0.0))
        problem_list_add(problems, at, "begins at %g; must begin above 0 where the scale is \"log\"", parameter->low);
}

/* "/inputs/a/b", or "/targets/1/inputs/a/b" where there is such a target. */
static bool names_an_input(const char *pointer, size_t targets)
{
    unsigned target;
    int rest = 0;
    if (!json_pointer_is_valid(pointer)) return false;
    if (sscanf(pointer, "/targets/%u/inputs/%n", &target, &rest) == 1 && rest > 0) return target < targets && pointer[rest];
    return strncmp(pointer, "/inputs/", 8) == 0 && pointer[8];
}

static void read_parameters(plan_request *request, const json_t *document, problem_list *problems)
{
    static const char *const known[] = { "range", "scale", NULL };
    const json_t *parameters = json_object_get(document, "parameters");
    const size_t targets = json_array_size(json_object_get(document, "targets"));
    const char *pointer;
    json_t *given;
    if (!json_is_object(parameters) || json_object_size(parameters) == 0 || json_object_size(parameters) > PLAN_MOST_PARAMETERS) {
        problem_list_add(problems, "/parameters", "must be an object of 1 to %d ranges, each named by a JSON Pointer",
                         PLAN_MOST_PARAMETERS);
        return;
    }
    json_object_foreach((json_t *)parameters, pointer, given)
    {
        char place[LONGEST_POINTER];
        pointer_to_member(place, "/parameters", pointer);
        plan_parameter *parameter = &request->parameter[request->parameters];
        *parameter = (plan_parameter){ .known_to = NAN };
        if (!names_an_input(pointer, targets)) {
            problem_list_add(problems, place,
                             "names no input; must be a JSON Pointer as /inputs/contact/friction, or as "
                             "/targets/0/inputs/drum/rotation_rate of a target's alone");
        } else if (!json_is_object(given)) {
            refuse_value(problems, place, given, "an object with \"range\" and, if wanted, \"scale\"");
        } else {
            refuse_unknown_members(given, place, known, problems);
            snprintf(parameter->pointer, sizeof parameter->pointer, "%s", pointer);
            read_range(given, place, parameter, problems);
            request->parameters++;
        }
    }
}

/* --- the targets --- */

static void read_target(plan_request *request, const json_t *base, const json_t *target, const char *list, size_t index,
                        plan_use use, problem_list *problems)
{
    static const char *const known[] = {
        "name", "process", "inputs", "result", "curve", "value", "points", "standard_error", NULL
    };
    char place[64];
    snprintf(place, sizeof place, "/%s/%zu", list, index);
    if (!json_is_object(target)) {
        refuse_value(problems, place, target, "an object with \"result\", \"value\" and \"standard_error\"");
        return;
    }
    refuse_unknown_members(target, place, known, problems);
    size_t test;
    if (plan_test_add(request, base, target, place, use, index, &test, problems))
        plan_measures_add(request, target, place, use, test, problems);
}

static void read_targets(plan_request *request, const json_t *document, const char *list, plan_use use, problem_list *problems)
{
    char place[32];
    snprintf(place, sizeof place, "/%s", list);
    const json_t *targets = json_object_get(document, list), *base = json_object_get(document, "base");
    const size_t count = json_array_size(targets);
    if (!targets && use != PLAN_FITTED) return;
    if (!json_is_array(targets) || count > PLAN_MOST_TARGETS || (use == PLAN_FITTED && count == 0)) {
        problem_list_add(problems, place, "must be a list of %d to %d of them", use == PLAN_FITTED, PLAN_MOST_TARGETS);
        return;
    }
    for (size_t i = 0; i < count; i++) read_target(request, base, json_array_get(targets, i), list, i, use, problems);
}

/* --- when it ends --- */

static int64_t read_whole(const json_t *value, const char *place, int64_t most, int64_t fallback, problem_list *problems)
{
    char must[80];
    snprintf(must, sizeof must, "a whole number in [1, %lld]", (long long)most);
    if (!value) return fallback;
    if (json_is_integer(value) && json_integer_value(value) >= 1 && json_integer_value(value) <= most)
        return json_integer_value(value);
    refuse_value(problems, place, value, must);
    return fallback;
}

static void read_known_to(plan_request *request, const json_t *errors, problem_list *problems)
{
    const char *pointer;
    json_t *value;
    if (errors && !json_is_object(errors)) refuse_value(problems, "/stop/standard_error", errors, "an object");
    json_object_foreach((json_t *)errors, pointer, value)
    {
        char place[LONGEST_POINTER];
        pointer_to_member(place, "/stop/standard_error", pointer);
        size_t p = 0;
        while (p < request->parameters && strcmp(request->parameter[p].pointer, pointer) != 0) p++;
        if (p == request->parameters) problem_list_add(problems, place, "names none of the parameters");
        else if (!json_is_number(value) || !(json_number_value(value) > 0.0)) refuse_value(problems, place, value, "more than 0");
        else request->parameter[p].known_to = json_number_value(value);
    }
}

static void read_end(plan_request *request, const json_t *document, problem_list *problems)
{
    static const char *const known[] = { "jobs", "seconds", "standard_error", NULL };
    const json_t *stop = json_object_get(document, "stop"), *seconds = json_object_get(stop, "seconds");
    if (stop && !json_is_object(stop)) refuse_value(problems, "/stop", stop, "an object");
    refuse_unknown_members(stop, "/stop", known, problems);
    request->most_jobs = read_whole(json_object_get(stop, "jobs"), "/stop/jobs", MOST_JOBS, USUAL_JOBS, problems);
    request->most_seconds = INFINITY;
    if (json_is_number(seconds) && json_number_value(seconds) > 0.0) request->most_seconds = json_number_value(seconds);
    else if (seconds) refuse_value(problems, "/stop/seconds", seconds, "more than 0 s");
    read_known_to(request, json_object_get(stop, "standard_error"), problems);
    request->repeats = (int)read_whole(json_object_get(document, "repeats"), "/repeats", MOST_REPEATS, 1, problems);
    const json_t *seed = json_object_get(document, "seed");
    if (json_is_integer(seed) && json_integer_value(seed) >= 0 && json_integer_value(seed) <= (json_int_t)LARGEST_WHOLE_NUMBER)
        request->seed = (uint64_t)json_integer_value(seed);
    else if (seed) refuse_value(problems, "/seed", seed, "a whole number in [0, 9007199254740991]");
}

/* What only names the calibration and its jobs. */
static void check_names(const json_t *document, problem_list *problems)
{
    static const char *const texts[] = { "name", "description" };
    static const size_t longest[] = { LONGEST_NAME, LONGEST_DESCRIPTION };
    const json_t *label = json_object_get(document, "label");
    const char *name;
    json_t *value;
    char place[LONGEST_POINTER];
    for (size_t k = 0; k < 2; k++) {
        const json_t *text = json_object_get(document, texts[k]);
        pointer_to_member(place, "", texts[k]);
        if (text && (!json_is_string(text) || json_string_length(text) == 0 || json_string_length(text) > longest[k]))
            problem_list_add(problems, place, "must be a text of 1 to %zu bytes", longest[k]);
    }
    if (label && !json_is_object(label)) refuse_value(problems, "/label", label, "an object of texts and numbers");
    json_object_foreach((json_t *)label, name, value)
    {
        pointer_to_member(place, "/label", name);
        if (!json_is_string(value) && !json_is_number(value)) refuse_value(problems, place, value, "a text or a number");
    }
    read_priority(json_object_get(document, "priority"), problems);
}

static void read_all(plan_request *request, const json_t *document, problem_list *problems)
{
    static const char *const known[] = { "name", "description", "base", "parameters", "targets",  "hold_out", "next_tests",
                                         "stop", "repeats",     "seed", "label",      "priority", NULL };
    static const char *const of_base[] = { "process", "inputs", "label", NULL }; /* a spec's; its label is that of another job */
    refuse_unknown_members(document, "", known, problems);
    check_names(document, problems);
    const json_t *base = json_object_get(document, "base"), *inputs = json_object_get(base, "inputs");
    if (!json_is_object(base) || !json_is_object(inputs)) {
        refuse_value(problems, json_is_object(base) ? "/base/inputs" : "/base", json_is_object(base) ? inputs : base, "an object");
        return;
    }
    refuse_unknown_members(base, "/base", of_base, problems);
    read_parameters(request, document, problems);
    read_targets(request, document, "targets", PLAN_FITTED, problems);
    read_targets(request, document, "hold_out", PLAN_HELD_OUT, problems);
    read_targets(request, document, "next_tests", PLAN_PROPOSED, problems);
    read_end(request, document, problems);
}

bool plan_request_parse(const json_t *document, plan_request *request, problem_list *problems)
{
    *request = (plan_request){ .repeats = 1, .most_jobs = USUAL_JOBS, .most_seconds = INFINITY };
    if (!json_is_object(document))
        problem_list_add(problems, "", "must be an object with \"base\", \"parameters\" and \"targets\"");
    else read_all(request, document, problems);
    if (problem_list_is_empty(problems)) plan_tests_check(request, problems);
    if (problem_list_is_empty(problems) && !json_object_get(document, "next_tests"))
        plan_propose(request, json_object_get(document, "base"));
    return problem_list_is_empty(problems);
}

void plan_request_clear(plan_request *request)
{
    for (size_t t = 0; t < request->tests; t++) json_decref(request->test[t].request);
    *request = (plan_request){ .repeats = 1 };
}
