/* The tests of a calibration: base and targets as requests of jobs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "merge_patch.h"
#include "plan_request.h"
#include "process_type.h"
#include "spec_text.h"

/* A copy of the base's inputs with those alone that the process has: a heap knows nothing of a drum. pointer: of the object,
 * "" or "drum"; with room for its members. */
static json_t *known_inputs(const process_type *type, const json_t *inputs, char pointer[JSON_POINTER_SIZE])
{
    json_t *known = json_object();
    const size_t length = strlen(pointer);
    const char *name;
    json_t *member;
    json_object_foreach((json_t *)inputs, name, member)
    {
        if (length + strlen(name) + 2 > JSON_POINTER_SIZE) continue;
        snprintf(pointer + length, JSON_POINTER_SIZE - length, "%s%s", length ? "/" : "", name);
        const spec_field *field = spec_field_at(type->inputs, pointer);
        const bool is_plain = field && field->kind == FIELD_OBJECT && json_is_object(member);
        if (is_plain) json_object_set_new(known, name, known_inputs(type, member, pointer));
        else if (field) json_object_set(known, name, member);
        pointer[length] = '\0';
        json_t *kept = json_object_get(known, name);
        if (is_plain && json_object_size(kept) == 0 && json_object_size(member) > 0) json_object_del(known, name);
    }
    return known;
}

static bool are_alternatives(const spec_field *one, const char *name)
{
    return (one->excludes && strcmp(one->excludes, name) == 0) || (one->excludes_too && strcmp(one->excludes_too, name) == 0);
}

/* What the target gives takes the place of what may not stand beside it: a particle_count that of a fill_fraction. How long a
 * run lasts is one thing, however it is said. */
static void remove_alternatives(const process_type *type, json_t *base, const json_t *given)
{
    const char *name, *other;
    json_t *member, *value;
    void *next;
    json_object_foreach((json_t *)given, name, member)
    {
        const spec_field *field = spec_field_find(type->inputs, SPEC_INPUTS, name);
        json_object_foreach_safe(base, next, other, value)
        {
            const spec_field *beside = spec_field_find(type->inputs, SPEC_INPUTS, other);
            if (field && beside && (are_alternatives(field, other) || are_alternatives(beside, name))) json_object_del(base, other);
        }
    }
    if (json_object_get(given, "duration")) json_object_del(base, "duration");
}

static json_t *test_of(const process_type *type, const json_t *base, const json_t *target)
{
    char pointer[JSON_POINTER_SIZE] = "";
    const json_t *given = json_object_get(target, "inputs");
    json_t *inputs = known_inputs(type, json_object_get(base, "inputs"), pointer);
    if (given) remove_alternatives(type, inputs, given);
    json_t *merged = given ? json_merge_patch(inputs, given) : json_incref(inputs);
    json_decref(inputs);
    return json_pack("{s:s, s:o}", "process", type->name, "inputs", merged);
}

/* Has a parameter of its own: "/targets/1/inputs/...". */
static const char *own_input(const char *pointer, size_t target)
{
    char head[40];
    snprintf(head, sizeof head, "/targets/%zu/inputs/", target);
    return strncmp(pointer, head, strlen(head)) == 0 ? pointer + strlen(head) : NULL;
}

/* Where in a job's request of this test the parameter stands, below its inputs; NULL: the test has no such input. */
static const char *input_of(const plan_request *request, size_t test, const plan_parameter *parameter)
{
    const plan_test *one = &request->test[test];
    const process_type *type = process_type_find(json_string_value(json_object_get(one->request, "process")));
    const char *own = one->use == PLAN_FITTED ? own_input(parameter->pointer, one->target) : NULL;
    const char *input = own ? own : strncmp(parameter->pointer, "/inputs/", 8) == 0 ? parameter->pointer + 8 : NULL;
    const spec_field *field = type && input ? spec_field_at(type->inputs, input) : NULL;
    return field && field->kind <= FIELD_INTEGER ? input : NULL;
}

/* Some parameter is this target's own, so that it shares its test with no other. */
static bool is_apart(const plan_request *request, size_t target)
{
    for (size_t p = 0; p < request->parameters; p++)
        if (own_input(request->parameter[p].pointer, target)) return true;
    return false;
}

static const process_type *type_of(const json_t *base, const json_t *target, const char *place, problem_list *problems)
{
    const json_t *own = json_object_get(target, "process"), *of_base = json_object_get(base, "process");
    const json_t *process = own ? own : of_base;
    const process_type *type = process ? process_type_find(json_is_string(process) ? json_string_value(process) : "") : NULL;
    if (!process) return process_type_find("drum");
    if (type) return type;
    char at[LONGEST_POINTER], seen[80], names[200];
    pointer_to_member(at, own ? place : "/base", "process");
    json_value_text(process, seen, sizeof seen);
    process_type_names(names, sizeof names);
    problem_list_add(problems, at, "is %s; must be one of %s", seen, names);
    return NULL;
}

bool plan_test_add(plan_request *request, const json_t *base, const json_t *target, const char *place, plan_use use, size_t index,
                   size_t *test, problem_list *problems)
{
    const process_type *type = type_of(base, target, place, problems);
    if (!type) return false;
    const json_t *given = json_object_get(target, "inputs");
    if (given && !json_is_object(given)) {
        char at[LONGEST_POINTER];
        pointer_to_member(at, place, "inputs");
        problem_list_add(problems, at, "must be an object");
        return false;
    }
    json_t *made = test_of(type, base, target);
    const bool apart = use == PLAN_FITTED && is_apart(request, index);
    for (*test = 0; *test < request->tests && !apart; ++*test)
        if (json_equal(request->test[*test].request, made) && !is_apart(request, request->test[*test].target)) break;
    if (apart) *test = request->tests;
    if (*test == PLAN_MOST_TESTS) {
        problem_list_add(problems, place, "makes more than %d tests, each with inputs of its own", PLAN_MOST_TESTS);
        json_decref(made);
        return false;
    }
    if (*test < request->tests) json_decref(made);
    else request->test[request->tests++] = (plan_test){ .request = made, .target = index, .use = use };
    return true;
}

/* Of the bed: the angle or one of its other definitions. */
static bool is_angle(const char *pointer)
{
    return strcmp(pointer, "/repose/angle_deg") == 0 || strncmp(pointer, "/repose/other_methods/", 22) == 0;
}

/* Until its angle is known twice as well as the best of its targets, where the process can do so and the test doesn't say how long
 * it takes. */
static void shorten(const plan_request *request, size_t test, const process_type *type, json_t *inputs)
{
    double least = INFINITY;
    for (size_t m = 0; m < request->measures; m++)
        if (request->measure[m].test == test && is_angle(request->measure[m].pointer))
            least = fmin(least, 0.5 * request->measure[m].error);
    if (!isfinite(least) || json_object_get(inputs, "duration")) return;
    const spec_field *until = spec_field_find(type->inputs, SPEC_DURATION, "until_standard_error_deg");
    if (!until) return;
    json_object_set_new(inputs, "duration",
                        json_pack("{s:f}", "until_standard_error_deg", fmin(fmax(least, until->minimum), until->maximum)));
}

json_t *plan_test_request(const plan_request *request, size_t test, const double *values)
{
    json_t *job = json_deep_copy(request->test[test].request);
    bool is_set = job != NULL;
    for (size_t p = 0; values && is_set && p < request->parameters; p++) {
        const char *input = input_of(request, test, &request->parameter[p]);
        if (!input) continue;
        const process_type *type = process_type_find(json_string_value(json_object_get(job, "process")));
        char pointer[JSON_POINTER_SIZE + 8];
        snprintf(pointer, sizeof pointer, "/inputs/%s", input);
        const bool is_whole = spec_field_at(type->inputs, input)->kind == FIELD_INTEGER;
        json_t *value = is_whole ? json_integer((json_int_t)rint(values[p])) : json_real(values[p]);
        is_set = json_pointer_set(job, pointer, value);
        json_decref(value);
    }
    if (is_set) {
        const process_type *type = process_type_find(json_string_value(json_object_get(job, "process")));
        shorten(request, test, type, json_object_get(job, "inputs"));
        return job;
    }
    json_decref(job);
    return NULL;
}

/* --- checking --- */

void plan_tell(const plan_request *request, size_t test, const problem_list *found, problem_list *problems)
{
    static const char *const lists[] = { "targets", "hold_out", "next_tests" };
    size_t i;
    json_t *one;
    json_array_foreach(found->errors, i, one)
    {
        const char *pointer = json_string_value(json_object_get(one, "pointer"));
        char place[LONGEST_POINTER + 32], range[LONGEST_POINTER];
        snprintf(place, sizeof place, "/%s/%zu%.200s", lists[request->test[test].use], request->test[test].target, pointer);
        for (size_t p = 0; p < request->parameters; p++) {
            const char *input = input_of(request, test, &request->parameter[p]);
            if (!input || strncmp(pointer, "/inputs/", 8) != 0 || strcmp(pointer + 8, input) != 0) continue;
            pointer_to_member(range, "/parameters", request->parameter[p].pointer);
            snprintf(place, sizeof place, "%.230s/range", range);
        }
        bool is_said = false;
        size_t k;
        json_t *earlier;
        json_array_foreach(problems->errors, k, earlier)
        {
            is_said = is_said || strcmp(json_string_value(json_object_get(earlier, "pointer")), place) == 0;
        }
        if (!is_said) problem_list_add(problems, place, "%s", json_string_value(json_object_get(one, "detail")));
    }
}

bool plan_middle_spec(const plan_request *request, size_t test, job_spec *spec, problem_list *problems)
{
    double values[PLAN_MOST_PARAMETERS];
    for (size_t p = 0; p < request->parameters; p++) {
        const plan_parameter *parameter = &request->parameter[p];
        values[p] = parameter->is_log ? sqrt(parameter->low * parameter->high) : 0.5 * (parameter->low + parameter->high);
    }
    json_t *job = plan_test_request(request, test, values);
    const bool good = job && job_spec_parse(NULL, job, 1, spec, problems);
    json_decref(job);
    return good;
}

/* The job with all parameters at one end of their ranges. */
static void check_end(const plan_request *request, size_t test, bool is_high, problem_list *problems)
{
    double values[PLAN_MOST_PARAMETERS];
    for (size_t p = 0; p < request->parameters; p++) values[p] = is_high ? request->parameter[p].high : request->parameter[p].low;
    json_t *job = plan_test_request(request, test, values);
    problem_list found;
    job_spec spec;
    if (!problem_list_init(&found)) return;
    if (!job) {
        problem_list_add(&found, "", "can't take the parameters: one of them leads through something that has no such member");
        plan_tell(request, test, &found, problems);
    } else if (job_spec_parse(NULL, job, 1, &spec, &found)) {
        const bool is_of_a_job = strcmp(spec.process, "drum") == 0 && *spec.inputs.start.job;
        if (is_of_a_job)
            problem_list_add(&found, "/inputs/start", "is another job's bed: the runs of a calibration make beds of their own");
        plan_tell(request, test, &found, problems);
        job_spec_clear(&spec);
    } else {
        plan_tell(request, test, &found, problems);
    }
    problem_list_clear(&found);
    json_decref(job);
}

static void check_parameter(const plan_request *request, const plan_parameter *parameter, problem_list *problems)
{
    char place[LONGEST_POINTER];
    const size_t length = strlen(parameter->pointer);
    pointer_to_member(place, "/parameters", parameter->pointer);
    const bool is_of_run = length > 5
                           && (strcmp(parameter->pointer + length - 5, "/seed") == 0
                               || (length > 8 && strcmp(parameter->pointer + length - 8, "/threads") == 0));
    bool is_taken = false;
    for (size_t t = 0; t < request->tests; t++) is_taken = is_taken || input_of(request, t, parameter);
    if (is_of_run) problem_list_add(problems, place, "is no property of a material: it can't be calibrated");
    else if (!is_taken) problem_list_add(problems, place, "names no input: no target's process has a number of that name");
}

void plan_test_check(const plan_request *request, size_t test, problem_list *problems)
{
    check_end(request, test, false, problems);
    check_end(request, test, true, problems);
}

void plan_tests_check(const plan_request *request, problem_list *problems)
{
    for (size_t p = 0; p < request->parameters; p++) check_parameter(request, &request->parameter[p], problems);
    for (size_t t = 0; t < request->tests; t++) plan_test_check(request, t, problems);
}
