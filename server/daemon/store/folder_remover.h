/* Removes the folders of deleted jobs, apart from the handlers, because one may hold thousands of files.
 *
 * The transaction that deletes a job's row writes its id into `leaving`; then its folder is put aside by a rename, then
 * emptied and removed. Whatever dies in between, `leaving` tells the next daemon what is left to do. A row stays there for
 * a minute: in the moment of its deletion a worker may just be started, which makes the folder once more. */
#ifndef FOLDER_REMOVER_H
#define FOLDER_REMOVER_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "job_store.h"
#include "prune.h"

typedef struct folder_remover {
    job_store *store;
    prune_rules rules;  /* what is not to be kept; looked at now and then. Under the lock, as are the next two */
    prune_tally pruned; /* since the start */
    double prune_next;  /* monotonic s */
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t wakes;
    bool is_due;
    atomic_bool stopping;
} folder_remover;

/* Begins with what an earlier daemon left. */
bool folder_remover_start(folder_remover *remover, job_store *store, const prune_rules *rules);
/* What has been pruned since the start. */
prune_tally folder_remover_pruned(folder_remover *remover);
/* `reposed prune`, while no daemon is at work: once, folders included. False: logged. */
bool prune_once(const char *data, const prune_rules *rules);
/* From any thread: other rules hold, and are looked at now. */
void folder_remover_set_rules(folder_remover *remover, const prune_rules *rules);
/* From any thread: something was deleted. */
void folder_remover_wake(folder_remover *remover);
/* Ends within the removal of one file. */
void folder_remover_stop(folder_remover *remover);

#endif
