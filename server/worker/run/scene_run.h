/* One attempt at a test that advances a scene through time: what drums, fills and heaps have in common. The test says what
 * a frame of measurement is, whether it is over before its time, and what comes out of it. */
#ifndef SCENE_RUN_H
#define SCENE_RUN_H

#include "dem.h"
#include "job_id.h"
#include "job_run.h"
#include "progress.h"
#include "run_facts.h"
#include "run_profile.h"
#include "schedule.h"

typedef struct scene_run scene_run;

typedef struct scene_test {
    size_t (*frame_width)(const dem_scene *scene); /* numbers of a frame */
    const char *(*frame_name)(size_t index);       /* of the numbers that become a sample; NULL beyond the last */
    dem_status (*frame_measure)(dem_scene *scene, double *frame);
    /* A table of numbers beside the frames, all zero at first, that grows with every frame; NULL: there is none. */
    size_t (*tally_size)(const dem_scene *scene);
    dem_status (*tally_add)(const scene_run *run, double *tally);
    /* After every frame: *ended_by becomes the reason why the run ends here, or stays. NULL: it always runs its time. */
    dem_status (*look)(const scene_run *run, const char **ended_by);
    const char *(*ended_by_time)(const job_spec *spec); /* what is said of a run that ran its whole time */
    /* Files beside the result, written before it; false: the disk. NULL: there are none. */
    bool (*write_files)(const scene_run *run);
    /* The results document, a new reference; NULL: no memory. */
    dem_status (*results)(const scene_run *run, json_t **document);
} scene_test;

struct scene_run {
    const job_spec *spec;
    const scene_test *test;
    const run_options *options;
    const char *params; /* canonical spec */
    dem_scene *scene;
    event_log *events;
    schedule plan;
    double *frames; /* (plan.samples, frame_width), those before next_sample taken */
    size_t frame_width;
    double *tally; /* (tally_size) */
    size_t tally_size;
    int64_t next_sample, next_snapshot;
    char start_trouble[300];      /* why it can't start from the bed that it was given; "": none */
    char settled_by[JOB_ID_SIZE]; /* the job that settled the bed; "": this one */
    bool has_saved_bed;
    const char *ended_by;                /* NULL: not yet, or by its time */
    double next_checkpoint, last_series; /* s, monotonic */
    dem_phase phase;                     /* the last one logged */
    int tenth;                           /* of the run, likewise */
    progress progress;
    run_profile profile;
};

enum worker_exit scene_run_job(const job_context *job, const scene_test *test);

/* The output "run" of a run that is over. */
run_facts scene_run_facts(const scene_run *run);

#endif
