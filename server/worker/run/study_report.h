/* `repose check` of a study: what it would make, or what is wrong with it. */
#ifndef STUDY_REPORT_H
#define STUDY_REPORT_H

#include <jansson.h>
#include <stdint.h>

#include "job_spec.h"
#include "problem.h"

bool study_report_is_study(const json_t *document); /* it has a base, as no job has */
/* What `repose check` says of a study: {"name", "cases": [{"case", "inputs"}], "repeats", "estimate", "warnings"}. machine NULL:
 * estimates by built-in figures. Returns a new reference; NULL: problems say why. */
json_t *study_report(const json_t *document, const start_source *beds, uint64_t seed_if_missing, const calibration *machine,
                     problem_list *problems);

#endif
