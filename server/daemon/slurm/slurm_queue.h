/* What we have in Slurm's queue, and the thread that speaks with Slurm: submits what is to be, looks how it stands, cancels what
 * nobody wants any more. Only this thread calls commands and frees bundles. */
#ifndef SLURM_QUEUE_H
#define SLURM_QUEUE_H

#include <pthread.h>
#include <stdbool.h>

#include "executor.h"
#include "executor_slurm.h"
#include "slurm_bundle.h"

typedef struct slurm_queue {
    slurm_settings settings;
    const data_folder *data;
    bundle_worker worker;
    pthread_t thread;
    pthread_mutex_t lock; /* for all below */
    pthread_cond_t there_is_work;
    bool ends;
    bool is_recovered;     /* what an earlier daemon left is followed by now, or by nobody */
    slurm_bundle **bundle; /* (count) owned */
    int count, room;
    slurm_bundle *open;                /* takes more jobs; NULL: none */
    double next_submission, next_look; /* monotonic s: not before */
    double pause;                      /* s until something that sbatch refused is tried again */
    char trouble[SLURM_REASON_SIZE];   /* why squeue does not answer; "": it does */
    executor_counts counts;
    int bell; /* an eventfd for the supervisor */
} slurm_queue;

/* With the bundles that an earlier daemon left in DATA/slurm. False: it is logged. */
bool slurm_queue_start(slurm_queue *queue);
void slurm_queue_stop(slurm_queue *queue);
/* With the lock: a bundle of that name that takes jobs. NULL: no memory. */
slurm_bundle *slurm_queue_open_bundle(slurm_queue *queue, const char *job, int start);
void slurm_queue_close_bundle(slurm_queue *queue);
/* With the lock: of those that have not ended. */
int slurm_queue_length(const slurm_queue *queue);

#endif
