/* Starts, watches and stops workers; nothing outside knows how. `local` forks here (executor_local.c). Where the workers of an
 * executor live on when the daemon ends, the next daemon goes on with them by what each is called. */
#ifndef EXECUTOR_H
#define EXECUTOR_H

#include <stdbool.h>
#include <stdint.h>

typedef struct worker_order {
    const char *job;        /* its id */
    const char *job_folder; /* absolute path; holds spec.json */
    int job_folder_file;    /* descriptor of the same */
    int attempt, threads;
    int start;                                        /* how often the job was started, with this: no two starts have the same */
    bool save_bed;                                    /* for other jobs that would settle the same */
    double estimated_seconds, estimated_memory_bytes; /* what the job is expected to take, */
    int more_time, more_memory;                       /* and how often that was too little and has been doubled */
    const char *resources;                            /* what the job asks of a cluster (job_resources.h); "": nothing */
    double cpu_seconds, memory_bytes, file_bytes;     /* limits, against a worker gone wild */
} worker_order;

enum { WORKER_NAME_SIZE = 120, WORKER_NEWS_SIZE = 300 };

/* A worker that was started: plain data, the executor's to write. */
typedef struct worker_handle {
    char name[WORKER_NAME_SIZE];      /* in messages, and for adopt() */
    char waits_for[WORKER_NEWS_SIZE]; /* why it has not begun to work; "": it has */
    int64_t own[3];                   /* what the executor finds it by */
} worker_handle;

/* How an attempt ended. */
typedef enum worker_end_kind {
    WORKER_LEFT,          /* with the exit code */
    WORKER_KILLED,        /* by the signal */
    WORKER_STARVED,       /* because the machine, not the worker alone, was out of memory */
    WORKER_LOST,          /* through no fault of the job's, as `why` says */
    WORKER_WITHDRAWN,     /* by somebody who is not the daemon's client: not to be tried again */
    WORKER_OUT_OF_TIME,   /* more than `more_time` allowed */
    WORKER_OUT_OF_MEMORY, /* more than `more_memory` allowed */
} worker_end_kind;

typedef struct worker_end {
    worker_end_kind kind;
    int code;      /* exit code, or the signal's number */
    char why[200]; /* "": nothing to say */
} worker_end;

/* What an executor that hands workers on to somebody else has seen of him, since its start. */
typedef struct executor_counts {
    int64_t submissions, refusals, questions; /* handed on; not taken; how often he was asked how they are */
    int64_t waiting, running;                 /* that he has now, of what was handed on */
    double pause;                             /* s until what was refused is tried again; 0: nothing is */
} executor_counts;

typedef struct worker_executor {
    /* False: errno. */
    bool (*start)(struct worker_executor *executor, const worker_order *order, worker_handle *worker);
    /* True once; then the handle is void. Brings name and waits_for up to date. */
    bool (*has_ended)(struct worker_executor *executor, worker_handle *worker, worker_end *end);
    void (*ask_to_stop)(struct worker_executor *executor, const worker_handle *worker); /* checkpoint and leave */
    void (*kill)(struct worker_executor *executor, const worker_handle *worker);
    /* The worker of that name, which an earlier daemon started by this order. False: it is not there any more. NULL: workers end
     * with their daemon. */
    bool (*adopt)(struct worker_executor *executor, const worker_order *order, const char *name, worker_handle *worker);
    /* Whether one more would be taken now; NULL: as long as there are places. */
    bool (*has_room)(struct worker_executor *executor);
    /* NULL: nothing is handed on. From any thread. */
    void (*count)(struct worker_executor *executor, executor_counts *counts);
    int places;          /* most workers at once */
    bool shares_threads; /* of one machine, so that workers have only so many together */
    int bell;            /* becomes readable when a worker may have ended; whoever heard it asks has_ended; -1: none */
    void *own;
} worker_executor;

/* Workers as processes here. False: no descriptor. */
bool executor_local_init(worker_executor *executor, const char *program, bool confine, int places);
void executor_local_clear(worker_executor *executor);

#endif
