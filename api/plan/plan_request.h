/* A calibration: measured values are given, and the inputs that give them are wanted (api/CALIBRATION.md).
 *
 *   {"base":       {"process"?, "inputs"},                                              as a job's request
 *    "parameters": {"/inputs/contact/friction": {"range": [0.05, 1], "scale": "log"}},   what is wanted, 1 to 4 of them
 *    "targets":    [{"process"?, "inputs"?, "result": "/repose/angle_deg", "value", "standard_error", "name"?},
 *                   {..., "curve": "profile", "points": [[x, value, error], ...]}],     what was measured
 *    "hold_out":   [targets that are predicted and not fitted],
 *    "next_tests": [{"process"?, "inputs"?, "result", "standard_error", "name"?}],      tests that might be done next; without, an
 *                                                                                      orifice where that may tell more
 *    "stop":       {"jobs", "seconds", "standard_error": {pointer: value}}, "repeats", "seed", "name", "label"}
 *
 * Targets of the same process and inputs share a test, one run of which answers for all of them. */
#ifndef PLAN_REQUEST_H
#define PLAN_REQUEST_H

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

#include "job_spec.h"
#include "json_pointer.h"
#include "problem.h"

enum {
    PLAN_MOST_PARAMETERS = 4,
    PLAN_MOST_TARGETS = 20, /* as asked for; a curve is one of them and becomes a measure a point */
    PLAN_MOST_MEASURES = 60,
    PLAN_MOST_TESTS = 40,
    PLAN_NAME_SIZE = 161
};

typedef struct plan_parameter {
    char pointer[JSON_POINTER_SIZE]; /* of a job's request, or "/targets/1/inputs/...": of that target's test alone */
    double low, high;
    bool is_log;     /* flat in its logarithm */
    double known_to; /* the standard deviation that is enough; NaN: none said */
} plan_parameter;

/* What a measure is for. */
typedef enum plan_use { PLAN_FITTED, PLAN_HELD_OUT, PLAN_PROPOSED } plan_use;

/* A number that a run tells: of a target, of a hold-out, or of a test that might be done next. */
typedef struct plan_measure {
    plan_use use;
    char name[PLAN_NAME_SIZE];
    char pointer[JSON_POINTER_SIZE]; /* into the results; of a curve: of the object of its lists */
    const char *across, *along;      /* the lists' names; NULL: no curve */
    double at;                       /* where along the curve */
    size_t test;
    double value, error; /* as measured; value NaN: nothing was */
} plan_measure;

/* What is run for one or several measures. */
typedef struct plan_test {
    json_t *request; /* owned: {"process", "inputs", "label"} without the parameters */
    size_t target;   /* the place of the first of its targets in the list it comes from */
    plan_use use;    /* fitted, when any of its measures is */
    bool is_own;     /* nobody asked for it: plan_propose did */
} plan_test;

typedef struct plan_request {
    size_t parameters, measures, tests;
    plan_parameter parameter[PLAN_MOST_PARAMETERS];
    plan_measure measure[PLAN_MOST_MEASURES];
    plan_test test[PLAN_MOST_TESTS];
    int repeats;
    int64_t most_jobs;
    double most_seconds; /* of the clock; infinite: as long as it takes */
    uint64_t seed;
} plan_request;

/* False: problems lists all that is wrong. Clear the request either way. */
bool plan_request_parse(const json_t *document, plan_request *request, problem_list *problems);
void plan_request_clear(plan_request *request);

/* The request of the job that runs the test with these values of the parameters: a number for each, or NULL for none of them.
 * A drum that is told nothing of its duration turns until its angle is known twice as well as the best of its targets. New reference; NULL: no memory. */
json_t *plan_test_request(const plan_request *request, size_t test, const double *values);

/* That job with the parameters in the middle of their ranges: of a logarithmic one, the middle of the logarithm. False: problems. */
bool plan_middle_spec(const plan_request *request, size_t test, job_spec *spec, problem_list *problems);
/* What was found of a test's job, said where it comes from, once: the range of a parameter, the target, or the base. */
void plan_tell(const plan_request *request, size_t test, const problem_list *found, problem_list *problems);

/* plan_reading.c: what the results of a run of its test say of the measure, and their standard error of that (NaN: they tell none).
 * False: they say nothing. */
bool plan_measure_read(const plan_measure *measure, const json_t *results, double *value, double *error);

/* plan_tests.c, for plan_request.c alone: the test of a target with this process and these inputs, one there is or a new one.
 * False: problems say why there is none. */
bool plan_test_add(plan_request *request, const json_t *base, const json_t *target, const char *place, plan_use use, size_t index,
                   size_t *test, problem_list *problems);
/* Refuses parameters that no test takes, and values at the ends of the ranges that a job would be refused for. */
void plan_tests_check(const plan_request *request, problem_list *problems);
/* One test alone. */
void plan_test_check(const plan_request *request, size_t test, problem_list *problems);
/* plan_proposal.c, for plan_request.c alone: where friction and rolling friction are sought and no test is an orifice, one is proposed. */
void plan_propose(plan_request *request, const json_t *base);
/* plan_measures.c, likewise: the measures of one target, once its test is known. */
void plan_measures_add(plan_request *request, const json_t *target, const char *place, plan_use use, size_t test,
                       problem_list *problems);

#endif
