/* One Slurm job: one attempt at a job of ours, or several that are run one after the other in one allocation, each in its own
 * folder and with an end of its own. DATA/slurm/NAME.sh is its script, and what a daemon that comes later knows it by: it is there
 * before sbatch is called, and until every attempt in it has been told of. */
#ifndef SLURM_BUNDLE_H
#define SLURM_BUNDLE_H

#include <stdbool.h>

#include "data_folder.h"
#include "job_id.h"
#include "job_resources.h"
#include "slurm_commands.h"

enum { BUNDLE_MOST = 64, BUNDLE_NAME_SIZE = JOB_ID_SIZE + 16, SLURM_PATH_SIZE = 4200 };

typedef struct bundle_member {
    char job[JOB_ID_SIZE];
    int start, attempt, threads;
    bool save_bed;
    double seconds, memory_bytes; /* that it is given */
    bool is_followed;             /* by the supervisor, which has not been told of its end yet */
    bool is_asked_to_stop, is_sent_away;
    bool has_begun;    /* its fence is there */
    int code;          /* its exit code; -1: none is known */
    double code_since; /* monotonic s, when that was seen; */
    double stop_asked; /* and when it was asked to stop */
} bundle_member;

typedef struct slurm_bundle {
    char name[BUNDLE_NAME_SIZE]; /* the id of its first job and which start of that it is */
    char id[SLURM_ID_SIZE];      /* Slurm's; "": none yet */
    enum {
        BUNDLE_OPEN,     /* takes more */
        BUNDLE_CLOSED,   /* to be submitted */
        BUNDLE_DOUBTFUL, /* may have been: the queue is asked first */
        BUNDLE_QUEUED
    } stage;
    slurm_state state;
    char resources[RESOURCES_SIZE]; /* that all of its jobs ask for, as JSON; "": nothing */
    char reason[SLURM_REASON_SIZE]; /* why it waits, or why sbatch refused it */
    double opened, next_try, gone;  /* monotonic s; gone: when it was first seen to have ended, 0: it has not */
    int refusals, misses;           /* in a row: of sbatch, and answers of squeue without it */
    bool is_written, is_cancelled;  /* its script is there; scancel was called */
    int current, count;             /* current: no member before it is without an end */
    bundle_member member[BUNDLE_MOST];
} slurm_bundle;

/* How a worker is run. */
typedef struct bundle_worker {
    const char *program;
    bool confine;
} bundle_worker;

/* False: errno. */
bool slurm_bundle_write(const slurm_bundle *bundle, const data_folder *data, const bundle_worker *worker);
void slurm_bundle_remove(const slurm_bundle *bundle, const data_folder *data);
/* Where Slurm writes what it has to say to the script, and whether that was that it took too much memory: not every way in which
 * a Slurm may be set up to see to that shows in the job's state. */
void slurm_bundle_words_path(const slurm_bundle *bundle, const data_folder *data, char path[SLURM_PATH_SIZE]);
bool slurm_bundle_took_too_much_memory(const slurm_bundle *bundle, const data_folder *data);
/* What slurm_bundle_write wrote under that name, nobody following it; for free(). NULL: not there, or none of ours. */
slurm_bundle *slurm_bundle_read(const data_folder *data, const char *name);

/* The fence of a start (attempt_fence.h), as it stands: whether it is there, and the exit code that it tells, or -1. */
void slurm_fence_read(const data_folder *data, const bundle_member *member, bool *has_begun, int *code);
/* "stop" or "leave". Where no worker has taken that start yet none ever will: *has_begun is false then. */
void slurm_fence_tell(const data_folder *data, const bundle_member *member, const char *word, bool *has_begun);

#endif
