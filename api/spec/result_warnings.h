/* What a run that came to its end knows of itself and its numbers do not show at a glance: run/warnings of its results. */
#ifndef RESULT_WARNINGS_H
#define RESULT_WARNINGS_H

#include "job_spec.h"

/* Puts them into the output "run" of the results: [{"field": pointer into the results, "text": ...}], empty where there are
 * none. False: no memory. */
bool result_warnings_add(const job_spec *spec, json_t *results);

/* Where a job has ended well, its message: "done", and how many warnings there are with the first of them. */
void result_message(const json_t *results, char *text, size_t size);

#endif
