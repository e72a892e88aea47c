/* Workers on the machines of a cluster: each attempt is handed to Slurm, alone or in a bundle with others (slurm_bundle.h). They
 * live on when the daemon ends. What the supervisor asks is answered from memory and from the job folders; a thread of its own
 * speaks with Slurm (slurm_queue.h), since any of its commands may take a minute. */
#ifndef EXECUTOR_SLURM_H
#define EXECUTOR_SLURM_H

#include "data_folder.h"
#include "executor.h"

/* The strings live as long as the executor. NULL or 0: not given. */
typedef struct slurm_settings {
    const char *partition, *account, *qos, *constraint;
    const char *const *lines; /* more options of sbatch, as "--reservation=drums": they have the last word */
    int line_count;
    int queue;          /* most jobs of ours in Slurm's queue */
    int bundle_seconds; /* jobs are put together until they are expected to take so long; 0: none is */
    double longest;     /* s that one Slurm job is given at most; what takes longer goes on in another */
} slurm_settings;

/* False: it is logged. */
bool executor_slurm_init(worker_executor *executor, const slurm_settings *settings, const data_folder *data, const char *program,
                         bool confine);
/* Ends the thread; jobs in Slurm's queue stay there. */
void executor_slurm_clear(worker_executor *executor);

#endif
