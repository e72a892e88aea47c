/* Making room by rule: jobs that ended long ago go, and where the folders of jobs are larger than they may be, snapshots go first
 * and results last, the oldest of each first. Jobs that wait or run, and pinned ones, stay whole. */
#ifndef PRUNE_H
#define PRUNE_H

#include <stdatomic.h>

#include "job_store.h"

typedef struct prune_rules {
    int keep_days;     /* after its end; 0: for ever */
    double keep_bytes; /* of all folders of jobs; 0: any number */
    bool only_tell;    /* what would go, and nothing goes */
} prune_rules;

/* What has gone. */
typedef struct prune_tally {
    int64_t jobs, studies, stripped; /* stripped: jobs whose snapshots and checkpoints went */
    double bytes, left;              /* of files: gone, and still there (NaN: not counted) */
} prune_tally;

/* The tally is added to. Ends early where *stopping. Folders of deleted jobs are out of the way afterwards, but not yet removed:
 * folder_remover.h. */
store_status store_prune(job_store *store, const prune_rules *rules, const atomic_bool *stopping, prune_tally *tally);

#endif
