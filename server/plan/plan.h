/* What a calibration does next (api/CALIBRATION.md): a function of its request and of the runs so far alone.
 *
 *   start -> refine, a batch at a time -> verify -> the answer
 *
 * A batch is decided when all runs before it are over. */
#ifndef PLAN_H
#define PLAN_H

#include <jansson.h>

#include "problem.h"

/* document: {"request", "runs"?, "workers"?}. Returns {"state": "runs" | "waits" | "done", "stage", "cases", "progress"} and, when done,
 * "answer". New reference; NULL: problems say why, or no memory where there are none. */
json_t *plan_next(const json_t *document, problem_list *problems);

#endif
