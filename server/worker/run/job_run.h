/* One attempt at a job, of whatever process: from a spec to result.json. */
#ifndef JOB_RUN_H
#define JOB_RUN_H

#include <stdbool.h>

#include "event_log.h"
#include "job_folder.h"
#include "job_spec.h"

typedef struct run_options {
    int attempt;
    double checkpoint_seconds; /* wall time between checkpoints */
    bool on_terminal;          /* show a progress line */
    bool profile;              /* write what the time went into */
    bool save_bed;             /* for others that settle the same: shared_bed.h */
    const char *program;       /* its version, with the commit */
    int start_number;          /* which start of the job it is, for its fence (attempt_fence.h); 0: it has none */
    const char *start;         /* the file that the spec starts from, absolute; NULL: none, or it is in the folder already */
} run_options;

/* What a process's runner is given. The job folder is the working directory, and this worker's alone. */
typedef struct job_context {
    const job_spec *spec;
    const run_options *options;
    const char *params; /* the canonical spec, in brief: what files carry */
    event_log *events;
} job_context;

/* Runs in `folder`; afterwards the working directory. */
enum worker_exit job_run(const job_spec *spec, const char *folder, const run_options *options);

/* What a person at a terminal reads of a result. folder: as the user named it. */
void job_run_summarize(const job_spec *spec, const json_t *result, const char *folder);

/* From now on JOB_STOP_SIGNALS ask for a checkpoint and the end of job_run with WORKER_STOPPED. Those that are held wait
 * until they are caught, also where another program takes over in between. */
void job_run_hold_signals(void);
void job_run_catch_signals(void);
bool job_run_is_asked_to_stop(void);
void job_run_ask_to_stop(void);

/* The last thing a runner does: adds the warnings. Takes over the reference; NULL: there was no memory for it. */
enum worker_exit job_run_write_result(const job_spec *spec, event_log *events, json_t *document);

#endif
