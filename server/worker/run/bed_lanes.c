/* A lane is a thread that takes the bed which is furthest behind, advances it by a short stretch, and takes the next: so beds
 * that are more than the threads share them evenly. */
#include "bed_lanes.h"

#include <pthread.h>

#define SECONDS_SIDE_BY_SIDE 0.5

bool bed_is_at_look(const scene_group *g, const scene_run *r) { return r->next_sample == g->look && scene_run_has_just_sampled(r); }

static bool may_advance(const scene_group *g, const scene_run *r)
{
    return !r->is_busy && !scene_run_is_over(r) && !bed_is_at_look(g, r) && !scene_run_snapshot_is_due(r);
}

typedef struct bed_lanes {
    scene_group *group;
    pthread_mutex_t mutex; /* over is_busy of all beds, and over what a bed is while it is not busy */
    double until;          /* s, monotonic */
    bool is_stopped;
} bed_lanes;

/* NULL: none may. */
static scene_run *take_furthest_behind(bed_lanes *lanes)
{
    scene_group *g = lanes->group;
    scene_run *found = NULL;
    pthread_mutex_lock(&lanes->mutex);
    if (monotonic_seconds() >= lanes->until || job_run_is_asked_to_stop()) lanes->is_stopped = true;
    for (size_t k = 0; !lanes->is_stopped && k < g->beds; k++) {
        scene_run *r = &g->bed[k];
        if (may_advance(g, r) && (!found || dem_scene_step_count(r->scene) < dem_scene_step_count(found->scene))) found = r;
    }
    if (found) found->is_busy = true;
    pthread_mutex_unlock(&lanes->mutex);
    return found;
}

static void *run_lane(void *context)
{
    bed_lanes *lanes = context;
    const int64_t steps = progress_short_run(&lanes->group->progress);
    for (scene_run *r; (r = take_furthest_behind(lanes)) != NULL;) {
        scene_run_advance(r, steps);
        pthread_mutex_lock(&lanes->mutex);
        r->is_busy = false;
        if (r->status != DEM_OK || r->is_untold) lanes->is_stopped = true;
        pthread_mutex_unlock(&lanes->mutex);
    }
    return NULL;
}

void bed_lanes_advance(scene_group *g)
{
    if (g->beds == 1) {
        scene_run_advance(g->bed, progress_short_run(&g->progress));
        return;
    }
    bed_lanes lanes = { .group = g, .until = monotonic_seconds() + SECONDS_SIDE_BY_SIDE };
    pthread_t thread[MOST_BEDS];
    const int others = job_beds_at_once(g->job->spec) - 1;
    int started = 0;
    pthread_mutex_init(&lanes.mutex, NULL);
    while (started < others && pthread_create(&thread[started], NULL, run_lane, &lanes) == 0) started++;
    run_lane(&lanes); /* where a thread was not to be had, the others do its work */
    for (int k = 0; k < started; k++) pthread_join(thread[k], NULL);
    pthread_mutex_destroy(&lanes.mutex);
}
