/* Slurm's own commands, run one after the other, in the forms that are alike from 21.08 on:
 *
 *   sbatch --parsable                  "812" or "812;cluster"
 *   squeue --me -h -t all -o %i|%T|%j|%r    a line a job, also of those that ended within MinJobAge (300 s by default)
 *   sacct -X -n -P -o JobIDRaw,State   of those that squeue does not know any more; an error where nothing is accounted
 *   scancel
 *
 * The JSON forms came with data_parser plugins that differ from release to release (a state is a text until 23.02, then a list;
 * numbers became objects with "set" and "infinite"), so they are not used. */
#ifndef SLURM_COMMANDS_H
#define SLURM_COMMANDS_H

#include <stdbool.h>
#include <stddef.h>

enum { SLURM_ID_SIZE = 32, SLURM_REASON_SIZE = 200 };

/* What a state of Slurm's means to a job. */
typedef enum slurm_state {
    SLURM_UNKNOWN, /* not in the queue, and not accounted */
    SLURM_WAITS,
    SLURM_RUNS,
    SLURM_DONE, /* its script has ended: what that says counts */
    SLURM_OUT_OF_TIME,
    SLURM_OUT_OF_MEMORY,
    SLURM_LOST, /* with its node, or for the sake of another job */
    SLURM_CANCELLED
} slurm_state;

/* "CANCELLED by 1000" and "OUT_OF_ME+" are known, too; a word that is not is taken for a job that waits: it is asked again. */
slurm_state slurm_state_of(const char *word);

/* argv[0] is looked for in PATH. The whole of stdout, for free(); NULL: it failed, or did not end within 60 s, and `reason` has the
 * first line of its stderr. */
char *slurm_run(const char *const *argv, char reason[SLURM_REASON_SIZE]);

#endif
