#include "plan_report.h"

#include <math.h>

#include "plan_budget.h"
#include "process_type.h"

bool plan_report_is_calibration(const json_t *document) { return json_object_get(document, "targets") != NULL; }

static json_t *targets_of(const plan_request *request, size_t test)
{
    json_t *targets = json_array();
    for (size_t m = 0; m < request->measures; m++)
        if (request->measure[m].test == test) json_array_append_new(targets, json_string(request->measure[m].name));
    return targets;
}

static json_t *tests_of(const plan_request *request)
{
    json_t *tests = json_array();
    for (size_t t = 0; t < request->tests; t++) {
        json_t *test = plan_test_request(request, t, NULL);
        if (test) json_object_set_new(test, "targets", targets_of(request, t));
        json_array_append_new(tests, test);
    }
    return tests;
}

json_t *plan_report(const json_t *document, const calibration *machine, problem_list *problems)
{
    plan_request request;
    problem_list warnings;
    json_t *report = NULL;
    if (plan_request_parse(document, &request, problems) && problem_list_init(&warnings)) {
        const plan_estimate estimate = plan_estimate_make(&request, machine);
        const json_t *name = json_object_get(document, "name");
        plan_check(&request, machine, NULL, NAN, problems, &warnings);
        report = json_pack("{s:s, s:O, s:o, s:o, s:o}", "name", name ? json_string_value(name) : "calibration", "parameters",
                           json_object_get(document, "parameters"), "tests", tests_of(&request), "estimate",
                           plan_estimate_to_json(&estimate), "warnings", job_warnings_to_json(&warnings));
        problem_list_clear(&warnings);
    }
    plan_request_clear(&request);
    return report;
}
