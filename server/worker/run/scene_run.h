/* One attempt at a test that advances a scene through time: what drums, fills and heaps have in common. The test says what
 * a frame of measurement is, whether it is over before its time, and what comes out of it. A drum may be asked for several
 * beds, which run side by side (scene_group.c); all that one of them is and does is in scene_run.c. */
#ifndef SCENE_RUN_H
#define SCENE_RUN_H

#include "checkpoint_file.h"
#include "dem.h"
#include "job_id.h"
#include "job_run.h"
#include "progress.h"
#include "result_fields.h"
#include "run_facts.h"
#include "run_profile.h"
#include "schedule.h"
#include "tracing.h"

typedef struct scene_run scene_run;
typedef struct scene_group scene_group;

typedef struct scene_test {
    size_t (*frame_width)(const dem_scene *scene); /* numbers of a frame */
    const char *(*frame_name)(size_t index);       /* of the numbers that become a sample; NULL beyond the last */
    dem_status (*frame_measure)(dem_scene *scene, double *frame);
    /* A table of numbers beside the frames, all zero at first, that grows with every frame; those of several beds add up.
     * NULL: there is none. */
    size_t (*tally_size)(const dem_scene *scene);
    dem_status (*tally_add)(const scene_run *run, double *tally);
    /* After every so many frames (0: never), once all beds have them: *ended_by becomes the reason why the run ends here, or
     * stays. NULL: it always runs its time. */
    int64_t (*frames_between_looks)(const job_spec *spec);
    dem_status (*look)(const scene_group *group, const char **ended_by);
    const char *(*ended_by_time)(const job_spec *spec); /* what is said of a run that ran its whole time */
    /* Files beside the result, written before it, from the sum of the tallies; false: the disk. NULL: there are none. */
    bool (*write_files)(const scene_group *group, const double *tally);
    /* The results document, a new reference; NULL: no memory. */
    dem_status (*results)(const scene_group *group, json_t **document);
} scene_test;

/* A bed. */
struct scene_run {
    job_spec spec; /* of this bed alone: its seed, its share of the threads; owns nothing */
    size_t number; /* 0: the first, of which samples and snapshots are told */
    const scene_test *test;
    event_log *events;   /* NULL: not told */
    char *params;        /* its own canonical spec in brief, of the first the job's: what its checkpoint carries */
    const char *program; /* its version, with the commit */
    checkpoint_names names;
    dem_scene *scene;
    schedule plan;
    double *frames; /* (plan.samples, frame_width), those before next_sample taken */
    size_t frame_width;
    double *tally; /* (tally_size) */
    size_t tally_size;
    tracing tracing; /* of the first bed alone */
    int64_t next_sample, next_snapshot;
    char settled_by[JOB_ID_SIZE]; /* the job that settled the bed; "": this one */
    bool is_busy;                 /* a thread advances it */
    dem_status status;            /* how its last stretch ended */
    bool is_untold;               /* an event could not be written */
    run_profile profile;
};

/* All beds of a job. */
struct scene_group {
    const job_context *job;
    const scene_test *test;
    scene_run *bed; /* (beds) */
    size_t beds;
    int64_t look;                                      /* frames of each bed at which the test looks next; INT64_MAX: never */
    char start_trouble[300];                           /* why it can't start from the bed that it was given; "": none */
    bool has_saved_bed;                                /* of one bed alone */
    const char *ended_by;                              /* NULL: not yet, or by its time */
    double next_checkpoint, last_series, next_picture; /* s, monotonic */
    dem_phase phase;                                   /* the first bed's, the last one logged */
    int tenth;                                         /* of the run, likewise */
    progress progress;
};

enum worker_exit scene_run_job(const job_context *job, const scene_test *test);

/* The output "run" of a bed that is over. */
run_facts scene_run_facts(const scene_group *group, size_t bed);

/* --- of one bed (scene_run.c) --- */

bool scene_run_is_rotating(const scene_run *r);
int64_t scene_run_rotation_step(const scene_run *r); /* steps since rotation began */
bool scene_run_is_over(const scene_run *r);
/* It is at the step of its newest frame. */
bool scene_run_has_just_sampled(const scene_run *r);
bool scene_run_snapshot_is_due(const scene_run *r);

/* A new scene, in place of the one there may be. */
dem_status scene_run_prepare(scene_run *r);
/* Takes up where the checkpoint `name` left off, of an earlier attempt or of the job that settled the bed. Where it is not
 * FILE_WHOLE the scene may be half restored. earlier_seconds: becomes what the attempts before have spent. */
file_state scene_run_resume(scene_run *r, const char *name, double *earlier_seconds);
/* wall_seconds: spent by all attempts. False: *status is DEM_OK where it was the disk. */
bool scene_run_save(const scene_run *r, double wall_seconds, dem_status *status);

/* Advances by so many steps, or to what is due before, and takes its frame there, but for that of the first step of rotation,
 * which the next stretch takes. Touches nothing that another bed does. */
void scene_run_advance(scene_run *r, int64_t steps);
/* The frame that is due at this step, if one is. */
void scene_run_sample(scene_run *r);
void scene_run_clear(scene_run *r);

/* An event of the scene; takes over `members`, which follow its name, step and time. */
bool scene_event_add(event_log *events, const char *name, int64_t step, double time, json_t *members);

#endif
