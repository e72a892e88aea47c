/* One attempt at a job: from a spec, or from the checkpoint of the attempt before, to result.json. */
#ifndef JOB_RUN_H
#define JOB_RUN_H

#include <stdbool.h>

#include "job_folder.h"
#include "job_spec.h"

typedef struct run_options {
    int attempt;
    double checkpoint_seconds; /* wall time between checkpoints */
    bool on_terminal;          /* show a progress line */
} run_options;

/* Runs in `folder`; afterwards the working directory. threads: spec->drum.threads. */
enum worker_exit job_run(const job_spec *spec, const char *folder, const run_options *options);

/* From now on SIGTERM and SIGINT ask for a checkpoint and the end of job_run with WORKER_STOPPED. */
void job_run_catch_signals(void);

#endif
