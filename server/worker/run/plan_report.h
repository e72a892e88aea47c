/* `repose check` of a calibration: what it takes, or what is wrong with it. */
#ifndef PLAN_REPORT_H
#define PLAN_REPORT_H

#include <jansson.h>

#include "calibration.h"
#include "problem.h"

bool plan_report_is_calibration(const json_t *document); /* it has targets, as no study has */
/* {"name", "parameters", "tests": [{"process", "inputs", "targets"}], "estimate"}. machine NULL: estimates by built-in figures. Returns a
 * new reference; NULL: problems say why. */
json_t *plan_report(const json_t *document, const calibration *machine, problem_list *problems);

#endif
