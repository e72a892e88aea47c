/* One attempt at a heap. */
#ifndef HEAP_RUN_H
#define HEAP_RUN_H

#include <jansson.h>

#include "job_run.h"

enum worker_exit heap_run(const job_context *job);
void heap_summary(const json_t *result, const char *folder); /* as terminal_summary of run_summary.h */

#endif
