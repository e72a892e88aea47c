/* One attempt at a rotating drum: from a spec, or from the checkpoint of the attempt before, to result.json. */
#ifndef DRUM_RUN_H
#define DRUM_RUN_H

#include "job_run.h"

enum worker_exit drum_run(const job_context *job);

#endif
