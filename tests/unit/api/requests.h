/* Requests that tests of specifications start from, and what they look for in the answers. */
#ifndef REQUESTS_H
#define REQUESTS_H

#include "claims.h"
#include "job_spec.h"

static const char minimal[] = "{\"inputs\": {\"drum\": {\"diameter\": 0.05, \"length\": 0.02, \"rotation_rate\": 3},"
                              " \"particles\": [{\"diameter\": 0.005}]}}";

static inline json_t *load(const char *text)
{
    json_error_t error;
    json_t *document = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    if (!document) fail_msg("test's own JSON: %s in %s", error.text, text);
    return document;
}

/* The minimal request with one more member of the inputs, or another value of one: path as "contact/friction". */
static inline json_t *minimal_with(const char *path, const char *value)
{
    json_t *request = load(minimal);
    json_t *object = json_object_get(request, "inputs");
    char name[100], wrapped[300];
    snprintf(name, sizeof name, "%s", path);
    char *member = name;
    for (char *slash; (slash = strchr(member, '/')); member = slash + 1) {
        *slash = '\0';
        if (json_is_array(object)) {
            object = json_array_get(object, (size_t)atoi(member));
            continue;
        }
        if (!json_object_get(object, member)) json_object_set_new(object, member, json_object());
        object = json_object_get(object, member);
    }
    snprintf(wrapped, sizeof wrapped, "[%s]", value);
    json_t *list = load(wrapped);
    json_object_set(object, member, json_array_get(list, 0));
    json_decref(list);
    return request;
}

/* Parses and frees the request; the pointers and details of all problems, one a line. */
static inline char *problems_of(json_t *request)
{
    job_spec spec;
    problem_list problems;
    assert_true(problem_list_init(&problems));
    char *text = calloc(1, 100000);
    if (job_spec_parse("drum", request, 1, &spec, &problems)) {
        assert_true(problem_list_is_empty(&problems));
        job_spec_clear(&spec);
    }
    size_t p;
    json_t *problem;
    json_array_foreach(problems.errors, p, problem)
    {
        strcat(text, json_string_value(json_object_get(problem, "pointer")));
        strcat(text, ": ");
        strcat(text, json_string_value(json_object_get(problem, "detail")));
        strcat(text, "\n");
    }
    problem_list_clear(&problems);
    json_decref(request);
    return text;
}

static inline void expect_problem(const char *path, const char *value, const char *expected)
{
    char *problems = problems_of(minimal_with(path, value));
    if (strcmp(problems, expected) != 0) fail_msg("%s = %s gives:\n%sexpected:\n%s", path, value, problems, expected);
    free(problems);
}

static inline void expect_fine(const char *path, const char *value) { expect_problem(path, value, ""); }

static inline job_spec parse_or_fail(json_t *request)
{
    job_spec spec;
    problem_list problems;
    problem_list_init(&problems);
    if (!job_spec_parse(NULL, request, 42, &spec, &problems)) {
        char *text = json_dumps(problems.errors, JSON_INDENT(1));
        fail_msg("not read: %s", text);
    }
    problem_list_clear(&problems);
    json_decref(request);
    return spec;
}

/* The minimal request with these members beside its own, or in the place of its own. */
static inline json_t *request_with(const char *members)
{
    json_t *request = load(minimal), *more = load(members);
    json_object_update(json_object_get(request, "inputs"), more);
    json_decref(more);
    return request;
}

static inline void expect_problems(const char *members, const char *expected)
{
    char *problems = problems_of(request_with(members));
    assert_string_equal(problems, expected);
    free(problems);
}

#endif
