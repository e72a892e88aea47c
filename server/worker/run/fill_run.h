/* One attempt at filling a cylinder. */
#ifndef FILL_RUN_H
#define FILL_RUN_H

#include <jansson.h>

#include "job_run.h"

enum worker_exit fill_run(const job_context *job);
void fill_summary(const json_t *result, const char *folder); /* as terminal_summary of run_summary.h */

#endif
