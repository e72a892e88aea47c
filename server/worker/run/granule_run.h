/* A job of one particle: over before anybody could ask how far it is. */
#ifndef GRANULE_RUN_H
#define GRANULE_RUN_H

#include <jansson.h>

#include "job_run.h"

enum worker_exit granule_run(const job_context *job);
void granule_summary(const json_t *result, const char *folder); /* as terminal_summary of run_summary.h */

#endif
