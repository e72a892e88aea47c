/* One attempt at a flow through an orifice. */
#ifndef ORIFICE_RUN_H
#define ORIFICE_RUN_H

#include <jansson.h>

#include "job_run.h"

enum worker_exit orifice_run(const job_context *job);
void orifice_summary(const json_t *result, const char *folder); /* as terminal_summary of run_summary.h */

#endif
