/* Starts, watches and stops workers; nothing outside knows how. `local` forks here; a batch system would fill the
 * same four functions. */
#ifndef EXECUTOR_H
#define EXECUTOR_H

#include <stdbool.h>
#include <sys/types.h>

typedef struct worker_order {
    const char *job_folder; /* absolute path; holds spec.json */
    int job_folder_file;    /* descriptor of the same */
    int attempt, threads;
    bool save_bed;                                /* for other jobs that would settle the same */
    double cpu_seconds, memory_bytes, file_bytes; /* limits */
} worker_order;

/* A worker that was started: plain data, the executor's to read. */
typedef struct worker_handle {
    pid_t process;
    int watch; /* becomes readable when the worker has ended; -1: none */
} worker_handle;

typedef struct worker_end {
    bool by_signal;
    int code; /* exit code, or the signal's number */
} worker_end;

typedef struct worker_executor {
    bool (*start)(struct worker_executor *executor, const worker_order *order, worker_handle *worker); /* false: errno */
    bool (*has_ended)(struct worker_executor *executor, worker_handle *worker,
                      worker_end *end);                                                 /* true once; then the handle is void */
    void (*ask_to_stop)(struct worker_executor *executor, const worker_handle *worker); /* checkpoint and leave */
    void (*kill)(struct worker_executor *executor, const worker_handle *worker);
    const char *program; /* path of the worker program */
    bool confine;        /* to the job's folder; the worker does it itself */
} worker_executor;

void executor_local_init(worker_executor *executor, const char *program, bool confine);

#endif
