/* The supervisor: takes jobs from the queue, starts workers, follows what they write, records how they end. It runs
 * on the main thread and is the only one that forks. */
#ifndef DISPATCHER_H
#define DISPATCHER_H

#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "config.h"
#include "event_tail.h"
#include "executor.h"
#include "job_store.h"
#include "queue_pause.h"

/* One worker at work. */
typedef struct worker_slot {
    enum { SLOT_FREE, SLOT_WORKING, SLOT_ENDED } state; /* ended: gone, but not recorded yet */
    job_claim claim;
    worker_handle worker;
    worker_end end;
    int events;                 /* descriptor of events.ndjson; -1: not there yet */
    int64_t events_at;          /* recorded up to this offset, */
    int64_t events_before;      /* and before the transaction that is open */
    uint64_t told, told_before; /* what the job's row has of the worker's name and news, likewise; 0: nothing */
    char trouble[600];          /* what the machine lacked when it ended; "": nothing, the end is the job's own */
    int doubts;                 /* how often what it left was looked at in vain */
    bool claim_lost;            /* dismissed: what it writes does not count any more */
    double stop_asked;          /* monotonic s; 0: not asked to stop */
    double started;             /* monotonic s */
    double last_word;           /* monotonic s: when it last wrote an event, or was started */
    bool silent;                /* and that this is long ago was told */
    bool settles;               /* a bed that other jobs wait for */
    double speed;               /* particle steps a second, as it last said; NaN: not yet */
    json_t *failure;            /* the failure event; NULL: none */
} worker_slot;

typedef struct job_dispatcher {
    job_store *store;
    worker_executor *executor;
    int workers, slots;  /* slots: one more, the lane of short jobs */
    int used;            /* no slot from this on is in use, but for the lane */
    int taken;           /* slots that are, with it */
    _Atomic int threads; /* of all workers together, but for the lane's */
    worker_slot *slot;   /* (slots) the last is the lane */
    char *beds;          /* room for the list of those that are being settled */
    int wake, signals;   /* eventfds */
    queue_pause pause;
    _Atomic bool recovered; /* what an earlier daemon left running is settled */
    bool stopping;
    double stopping_from;                /* monotonic s */
    void (*jobs_changed)(void *context); /* told after every recorded change of a job's state */
    void *context;
    /* for the metrics, written here, read by any thread */
    _Atomic double last_round, speed; /* monotonic s; particle steps a second of all workers */
    _Atomic int64_t started, put_back, ended[JOB_STATUSES], store_failures;
    _Atomic int running;
} job_dispatcher;

/* The signals that end the daemon in good order: JOB_STOP_SIGNALS. To be blocked in all threads. */
void dispatcher_end_signals(sigset_t *ends);
/* signals: becomes readable when one of them has come (end_signals.h); the caller's. */
bool dispatcher_init(job_dispatcher *dispatcher, job_store *store, worker_executor *executor, int threads_per_job, int signals);
/* What an earlier daemon left running is gone on with, recorded where it is done, or put back. False: not all of it; a round
 * tries again. */
bool dispatcher_recover(job_dispatcher *dispatcher);
/* From any thread: those of a job that does not ask, which make those of all. */
void dispatcher_set_threads(job_dispatcher *dispatcher, int threads_per_job);
void dispatcher_clear(job_dispatcher *dispatcher);
/* Returns after one of the end signals, when every worker has left and its job is back in the queue, or can't be put there
 * now: then the next start does it. leaving is called once, when the workers know. */
void dispatcher_run(job_dispatcher *dispatcher, void (*leaving)(void *context));
/* From any thread: look at the queue and at the jobs now. */
void dispatcher_wake(job_dispatcher *dispatcher);

#endif
