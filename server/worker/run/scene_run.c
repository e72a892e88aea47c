/* One bed of a run: advanced from one step at which something is due to the next, its frames taken on the way, saved and
 * taken up again. Several beds do so side by side, so nothing here is shared among them. */
#include "scene_run.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json_text.h"
#include "shared_bed.h"
#include "worker_log.h"

bool scene_event_add(event_log *events, const char *name, int64_t step, double time, json_t *members)
{
    json_t *event =
        json_pack("{s:s, s:I, s:f}", "event", name, "step", (json_int_t)step, "time", time + 0.0 /* no -0 at the start */);
    if (!members || !event || json_object_update(event, members) != 0) {
        json_decref(event);
        event = NULL;
    }
    json_decref(members);
    return event_log_add(events, event);
}

int64_t scene_run_rotation_step(const scene_run *r) { return dem_scene_step_count(r->scene) - dem_scene_run_start(r->scene); }

bool scene_run_is_rotating(const scene_run *r) { return dem_scene_phase(r->scene) == DEM_PHASE_RUNNING; }

bool scene_run_is_over(const scene_run *r)
{
    return scene_run_is_rotating(r) && scene_run_rotation_step(r) >= r->plan.rotation_steps;
}

static bool sample_is_due(const scene_run *r)
{
    return scene_run_is_rotating(r) && r->next_sample < r->plan.samples
           && schedule_sample_step(&r->plan, r->next_sample) == scene_run_rotation_step(r);
}

bool scene_run_has_just_sampled(const scene_run *r)
{
    return scene_run_is_rotating(r) && r->next_sample > 0
           && schedule_sample_step(&r->plan, r->next_sample - 1) == scene_run_rotation_step(r);
}

bool scene_run_snapshot_is_due(const scene_run *r)
{
    return scene_run_is_rotating(r) && r->number == 0 && r->next_snapshot < r->plan.snapshots
           && schedule_snapshot_step(&r->plan, r->next_snapshot) == scene_run_rotation_step(r);
}

static dem_status advance_to_what_is_due(const scene_run *r, int64_t steps)
{
    if (!scene_run_is_rotating(r)) return dem_scene_advance_to_run(r->scene, steps);
    int64_t due = r->plan.rotation_steps;
    if (r->next_sample < r->plan.samples && schedule_sample_step(&r->plan, r->next_sample) < due)
        due = schedule_sample_step(&r->plan, r->next_sample);
    if (r->number == 0 && r->next_snapshot < r->plan.snapshots && schedule_snapshot_step(&r->plan, r->next_snapshot) < due)
        due = schedule_snapshot_step(&r->plan, r->next_snapshot);
    const int64_t until_due = due - scene_run_rotation_step(r);
    assert(until_due > 0);
    return dem_scene_advance(r->scene, steps < until_due ? steps : until_due);
}

static json_t *frame_values(const scene_test *test, const double *frame)
{
    json_t *values = json_object();
    for (size_t s = 0; test->frame_name(s); s++) json_object_set_new(values, test->frame_name(s), json_real_or_null(frame[s]));
    return values;
}

void scene_run_sample(scene_run *r)
{
    if (!sample_is_due(r)) return;
    double *frame = r->frames + (size_t)r->next_sample * r->frame_width;
    run_profile_lap_begin(&r->profile);
    r->status = r->test->frame_measure(r->scene, frame);
    if (r->status == DEM_OK && r->test->tally_add) r->status = r->test->tally_add(r, r->tally);
    run_profile_lap(&r->profile, RUN_MEASURES);
    run_profile_look(&r->profile, r->scene);
    if (r->status != DEM_OK) return;
    const int64_t number = r->next_sample++;
    if (r->number > 0) return;
    tracing_take(&r->tracing, r->scene, (size_t)number);
    json_t *event = json_pack("{s:I, s:o}", "number", (json_int_t)number, "values", frame_values(r->test, frame));
    r->is_untold =
        !scene_event_add(r->events, "sample", dem_scene_step_count(r->scene), dem_scene_time(r->scene), event) || r->is_untold;
}

void scene_run_advance(scene_run *r, int64_t steps)
{
    scene_run_sample(r);
    if (r->status == DEM_OK) r->status = advance_to_what_is_due(r, steps);
    if (r->status == DEM_OK && scene_run_is_rotating(r) && scene_run_rotation_step(r) > 0) scene_run_sample(r);
}

#define TALLY_NAME "tally"

/* The tally is saved as one more array of the state. */
static dem_status save_tally(const scene_run *r, dem_state *state)
{
    if (r->tally_size == 0) return DEM_OK;
    double *copy = malloc(r->tally_size * sizeof *copy);
    if (!copy || state->array_count == DEM_STATE_ARRAYS) {
        free(copy);
        return DEM_NO_MEMORY;
    }
    memcpy(copy, r->tally, r->tally_size * sizeof *copy);
    state->array[state->array_count++] = (dem_state_array){ TALLY_NAME, DEM_FLOAT64, r->tally_size, 1, copy };
    return DEM_OK;
}

static bool restore_tally(scene_run *r, const dem_state *state)
{
    if (r->tally_size == 0) return true;
    for (size_t k = 0; k < state->array_count; k++) {
        const dem_state_array *a = &state->array[k];
        if (strcmp(a->name, TALLY_NAME) != 0 || a->element != DEM_FLOAT64 || a->rows * a->columns != r->tally_size) continue;
        memcpy(r->tally, a->data, r->tally_size * sizeof *r->tally);
        return true;
    }
    return false;
}

bool scene_run_save(const scene_run *r, double wall_seconds, dem_status *status)
{
    checkpoint saved = {
        .next_sample = r->next_sample,
        .next_snapshot = r->next_snapshot,
        .wall_seconds = wall_seconds,
        .time_step = r->spec.scene.time_step,
        .stiffness = r->spec.scene.contact.stiffness,
        .frames = r->frames,
        .frame_width = r->frame_width,
    };
    snprintf(saved.settled_by, sizeof saved.settled_by, "%s", r->settled_by);
    snprintf(saved.program, sizeof saved.program, "%s", r->program);
    *status = dem_scene_save(r->scene, &saved.state);
    if (*status == DEM_OK) *status = save_tally(r, &saved.state);
    if (*status == DEM_OK) *status = tracing_save(&r->tracing, (size_t)r->next_sample, &saved.state);
    const bool written = *status == DEM_OK && checkpoint_write(&saved, &r->names, r->params);
    dem_state_clear(&saved.state);
    return written;
}

file_state scene_run_resume(scene_run *r, const char *name, double *earlier_seconds)
{
    checkpoint saved;
    const bool is_bed = strcmp(name, JOB_BED_FILE) == 0;
    const file_state state = is_bed ? shared_bed_read(&r->spec, r->program, &saved) : checkpoint_read(&saved, name, r->params);
    if (state != FILE_WHOLE) return state;
    /* Another version of the program may derive other numbers from the same inputs. */
    const bool fits = saved.time_step == r->spec.scene.time_step && saved.stiffness == r->spec.scene.contact.stiffness
                      && saved.frame_width == r->frame_width && saved.next_sample <= r->plan.samples && saved.next_snapshot >= 0
                      && saved.next_snapshot <= r->plan.snapshots && restore_tally(r, &saved.state)
                      && tracing_restore(&r->tracing, (size_t)saved.next_sample, &saved.state);
    const dem_status status = fits ? dem_scene_restore(r->scene, &saved.state) : DEM_STATE_MISMATCH;
    if (status == DEM_OK) {
        memcpy(r->frames, saved.frames, (size_t)saved.next_sample * saved.frame_width * sizeof *saved.frames);
        r->next_sample = saved.next_sample;
        r->next_snapshot = saved.next_snapshot;
        *earlier_seconds = saved.wall_seconds;
        memcpy(r->settled_by, saved.settled_by, sizeof r->settled_by);
    } else {
        worker_warn("%s can't be used (%s)", name, dem_status_text(status));
    }
    checkpoint_clear(&saved);
    return status == DEM_OK ? FILE_WHOLE : FILE_DAMAGED;
}

dem_status scene_run_prepare(scene_run *r)
{
    dem_scene_free(r->scene);
    free(r->frames);
    free(r->tally);
    r->frames = r->tally = NULL;
    const dem_status status = dem_scene_create(&r->spec.scene, &r->scene);
    if (status != DEM_OK) return status;
    r->frame_width = r->test->frame_width(r->scene);
    r->frames = calloc((size_t)r->plan.samples, r->frame_width * sizeof *r->frames);
    r->tally_size = r->test->tally_size ? r->test->tally_size(r->scene) : 0;
    r->tally = calloc(r->tally_size + 1, sizeof *r->tally);
    if (!r->frames || !r->tally) return DEM_NO_MEMORY;
    return r->number == 0 ? tracing_begin(&r->tracing, &r->spec, (size_t)r->plan.samples) : DEM_OK;
}

void scene_run_clear(scene_run *r)
{
    dem_scene_free(r->scene);
    free(r->frames);
    free(r->tally);
    tracing_clear(&r->tracing);
    free(r->params);
}
