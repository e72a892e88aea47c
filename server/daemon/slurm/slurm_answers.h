/* How our jobs stand, as squeue and sacct tell. */
#ifndef SLURM_ANSWERS_H
#define SLURM_ANSWERS_H

#include <stddef.h>

#include "slurm_commands.h"

/* What the names of our Slurm jobs begin with; the bundle's follows. */
#define SLURM_NAME_START "reposed-"

typedef struct slurm_answer {
    const char *name; /* of the bundle */
    const char *id, *reason;
    slurm_state state;
} slurm_answer;

typedef struct slurm_answers {
    char *text, *accounts; /* owned, as all below; members point into them */
    slurm_answer *answer;  /* (count) by name, what is alive before what has ended */
    size_t count, room;
} slurm_answers;

/* False: squeue fails, as `reason` says; of use to slurm_answers_clear and slurm_answers_find alone then. */
bool slurm_answers_ask(slurm_answers *answers, char reason[SLURM_REASON_SIZE]);
/* Adds what is accounted of the jobs "812,813". Where nothing is, nothing is added. */
void slurm_answers_ask_accounts(slurm_answers *answers, const char *ids);
/* NULL: nothing is known of the bundle. Of several Slurm jobs of that name one that runs, else one that waits, else the latest. */
const slurm_answer *slurm_answers_find(const slurm_answers *answers, const char *bundle);
void slurm_answers_clear(slurm_answers *answers);

#endif
