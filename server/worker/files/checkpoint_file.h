/* checkpoint.hdf, and the one before it: everything a run needs to go on bit for bit after its worker has died. */
#ifndef CHECKPOINT_FILE_H
#define CHECKPOINT_FILE_H

#include <hdf5.h>
#include <stdbool.h>
#include <stdint.h>

#include "dem.h"
#include "file_seal.h"
#include "job_id.h"

typedef struct checkpoint {
    int64_t next_sample, next_snapshot; /* numbers of those not yet taken */
    double wall_seconds;                /* s spent so far, by all attempts */
    double time_step, stiffness;        /* as derived by the program that wrote it */
    double *frames;                     /* (next_sample, frame_width) */
    size_t frame_width;
    dem_state state;
    char settled_by[JOB_ID_SIZE]; /* the job that settled the bed; "": the run's own */
    char program[80];             /* version of the program that wrote it; "": from before */
    char *params;                 /* owned: the canonical spec of its run, where that was not given; else NULL */
} checkpoint;

/* Its names. */
typedef struct checkpoint_names {
    char newest[40], before[40];
} checkpoint_names;
checkpoint_names checkpoint_names_of(size_t bed);

/* params: the canonical spec, in brief. The file of before keeps its second name. */
bool checkpoint_write(const checkpoint *saved, const checkpoint_names *names, const char *params);

/* name: one of them. params: NULL takes it of any spec. FILE_DAMAGED: also where it is of another spec (logged). Where it is FILE_WHOLE the checkpoint then
 * owns its frames and the state's arrays. */
file_state checkpoint_read(checkpoint *saved, const char *name, const char *params);
void checkpoint_clear(checkpoint *saved);

/* Whether there is a checkpoint of this spec. */
bool checkpoint_is_of(const char *params);

/* The scene's state alone, of any run's checkpoint that is open. False: not whole; to be cleared either way. */
bool checkpoint_read_state(hid_t file, dem_state *state);
void checkpoint_clear_state(dem_state *state);

#endif
