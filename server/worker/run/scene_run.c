/* The life of an attempt at a scene:
 *     continue from the checkpoint of the job folder if there is one of this spec, or from the one before it, or from the bed
 *         that another job of the study has settled
 *     until the end: take the frames and snapshots that are due, save a checkpoint now and then, advance
 *     measure the results from the table of frames; result.json is the last thing written
 * Frames and snapshots are due at steps counted from the start of the test (schedule.h), so that an attempt which
 * goes on from a checkpoint takes the same ones as an attempt that was never interrupted. */
#include "scene_run.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "checkpoint_file.h"
#include "failure_report.h"
#include "file_publish.h"
#include "json_text.h"
#include "process_type.h"
#include "run_summary.h"
#include "shared_bed.h"
#include "size_facts.h"
#include "snapshot_file.h"
#include "start_file.h"
#include "walls_file.h"
#include "worker_log.h"

#define SERIES_SECONDS 2.0       /* between rewrites of a long series */
#define FIRST_CHECKPOINT 0.1     /* of the time between checkpoints, so that little is lost of a run that is short */
#define SERIES_ALWAYS_BELOW 1000 /* snapshots: a short series is rewritten after each */

/* Takes over `members`, which follow the event's name, step and time. */
static bool add_event(scene_run *r, const char *name, json_t *members)
{
    json_t *event = json_pack("{s:s, s:I, s:f}", "event", name, "step", (json_int_t)dem_scene_step_count(r->scene), "time",
                              dem_scene_time(r->scene) + 0.0 /* no -0 at the start */);
    if (!members || !event || json_object_update(event, members) != 0) {
        json_decref(event);
        event = NULL;
    }
    json_decref(members);
    return event_log_add(r->events, event);
}

static enum worker_exit fail(scene_run *r, dem_status status)
{
    return failure_report(r->events, status, r->scene ? dem_scene_failure(r->scene) : NULL);
}

static enum worker_exit fail_for_disk(scene_run *r, const char *name) { return failure_report_disk(r->events, name); }

/* Steps since rotation began. */
static int64_t rotation_step(const scene_run *r) { return dem_scene_step_count(r->scene) - dem_scene_run_start(r->scene); }

static bool is_rotating(const scene_run *r) { return dem_scene_phase(r->scene) == DEM_PHASE_RUNNING; }

static dem_status advance(scene_run *r)
{
    int64_t steps = progress_short_run(&r->progress);
    if (!is_rotating(r)) return dem_scene_advance_to_run(r->scene, steps);
    int64_t due = r->plan.rotation_steps;
    if (r->next_sample < r->plan.samples && schedule_sample_step(&r->plan, r->next_sample) < due)
        due = schedule_sample_step(&r->plan, r->next_sample);
    if (r->next_snapshot < r->plan.snapshots && schedule_snapshot_step(&r->plan, r->next_snapshot) < due)
        due = schedule_snapshot_step(&r->plan, r->next_snapshot);
    const int64_t until_due = due - rotation_step(r);
    assert(until_due > 0);
    return dem_scene_advance(r->scene, steps < until_due ? steps : until_due);
}

static json_t *frame_values(const scene_test *test, const double *frame)
{
    json_t *values = json_object();
    for (size_t s = 0; test->frame_name(s); s++) json_object_set_new(values, test->frame_name(s), json_real_or_null(frame[s]));
    return values;
}

static enum worker_exit take_sample(scene_run *r)
{
    double *frame = r->frames + (size_t)r->next_sample * r->frame_width;
    run_profile_lap_begin(&r->profile);
    dem_status status = r->test->frame_measure(r->scene, frame);
    if (status == DEM_OK && r->test->tally_add) status = r->test->tally_add(r, r->tally);
    run_profile_lap(&r->profile, RUN_MEASURES);
    run_profile_look(&r->profile, r->scene);
    if (status != DEM_OK) return fail(r, status);
    json_t *event = json_pack("{s:I, s:o}", "number", (json_int_t)r->next_sample, "values", frame_values(r->test, frame));
    r->next_sample++;
    return add_event(r, "sample", event) ? WORKER_DONE : WORKER_DISK;
}

/* Whether the test is over before its time, told from the frames so far: so a run that was interrupted ends at the same
 * one. */
static enum worker_exit end_when_over(scene_run *r)
{
    if (!r->test->look) return WORKER_DONE;
    run_profile_lap_begin(&r->profile);
    const dem_status status = r->test->look(r, &r->ended_by);
    run_profile_lap(&r->profile, RUN_MEASURES);
    if (status != DEM_OK) return fail(r, status);
    if (r->ended_by) schedule_end_at(&r->plan, rotation_step(r), r->next_sample, r->next_snapshot);
    return WORKER_DONE;
}

static bool write_series(scene_run *r, bool now)
{
    if (!now && r->next_snapshot >= SERIES_ALWAYS_BELOW && monotonic_seconds() - r->last_series < SERIES_SECONDS) return true;
    r->last_series = monotonic_seconds();
    return snapshot_series_write(&r->plan, r->spec->scene.time_step, r->next_snapshot)
           && walls_file_write(r->scene, &r->spec->scene, r->spec->is_mirrored);
}

static enum worker_exit take_snapshot(scene_run *r)
{
    int64_t bytes;
    if (!snapshot_file_write(r->scene, r->spec->is_mirrored, r->next_snapshot, r->params, &bytes))
        return fail_for_disk(r, "a snapshot");
    const long long number = r->next_snapshot++;
    json_t *event =
        json_pack("{s:I, s:o, s:I, s:I}", "number", (json_int_t)number, "file", json_sprintf(JOB_SNAPSHOT_FILE_FORMAT, number),
                  "bytes", (json_int_t)bytes, "particles", (json_int_t)dem_scene_particle_count(r->scene));
    if (!write_series(r, false)) return fail_for_disk(r, JOB_SERIES_FILE);
    return add_event(r, "snapshot", event) ? WORKER_DONE : WORKER_DISK;
}

static enum worker_exit take_what_is_due(scene_run *r)
{
    if (!is_rotating(r)) return WORKER_DONE;
    const int64_t step = rotation_step(r);
    enum worker_exit exit = WORKER_DONE;
    const bool sampled = r->next_sample < r->plan.samples && schedule_sample_step(&r->plan, r->next_sample) == step;
    if (sampled) exit = take_sample(r);
    if (exit == WORKER_DONE && sampled) exit = end_when_over(r);
    run_profile_lap_begin(&r->profile);
    if (exit == WORKER_DONE && r->next_snapshot < r->plan.snapshots && schedule_snapshot_step(&r->plan, r->next_snapshot) == step)
        exit = take_snapshot(r);
    run_profile_lap(&r->profile, RUN_SNAPSHOTS);
    return exit;
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

static enum worker_exit save_checkpoint(scene_run *r)
{
    checkpoint saved = {
        .next_sample = r->next_sample,
        .next_snapshot = r->next_snapshot,
        .wall_seconds = progress_wall_seconds(&r->progress),
        .time_step = r->spec->scene.time_step,
        .stiffness = r->spec->scene.contact.stiffness,
        .frames = r->frames,
        .frame_width = r->frame_width,
    };
    snprintf(saved.settled_by, sizeof saved.settled_by, "%s", r->settled_by);
    snprintf(saved.program, sizeof saved.program, "%s", r->options->program);
    dem_status status = dem_scene_save(r->scene, &saved.state);
    if (status == DEM_OK) status = save_tally(r, &saved.state);
    if (status != DEM_OK) {
        dem_state_clear(&saved.state);
        return fail(r, status);
    }
    /* First the events: a checkpoint must not count samples that the log could still lose. */
    const bool written = event_log_sync(r->events) && checkpoint_write(&saved, r->params);
    dem_state_clear(&saved.state);
    r->next_checkpoint = monotonic_seconds() + r->options->checkpoint_seconds;
    if (!written) return fail_for_disk(r, JOB_CHECKPOINT_FILE);
    return add_event(r, "checkpoint", json_pack("{s:i}", "attempt", r->options->attempt)) ? WORKER_DONE : WORKER_DISK;
}

/* As it is at the first step of rotation. */
static enum worker_exit save_bed(scene_run *r)
{
    char hash[SHA256_HEX_SIZE];
    if (!r->options->save_bed || r->has_saved_bed || *r->settled_by || !is_rotating(r) || rotation_step(r) != 0) return WORKER_DONE;
    r->has_saved_bed = true;
    const enum worker_exit exit = save_checkpoint(r);
    if (exit != WORKER_DONE || !shared_bed_save(hash)) return exit;
    return add_event(r, "bed", json_pack("{s:s}", "sha256", hash)) ? WORKER_DONE : WORKER_DISK;
}

/* For whoever follows the log. */
static void log_tenth(scene_run *r, const progress_report *report)
{
    const int tenth = (int)(report->percent / 10.0);
    char left[TIME_IN_WORDS_SIZE];
    if (tenth <= r->tenth) return;
    r->tenth = tenth;
    time_in_words(report->eta_seconds, left);
    worker_log("%d %% done at step %lld, about %s left", 10 * tenth, (long long)dem_scene_step_count(r->scene), left);
}

static enum worker_exit report_progress(scene_run *r)
{
    if (dem_scene_phase(r->scene) != r->phase) {
        r->phase = dem_scene_phase(r->scene);
        if (is_rotating(r)) run_profile_rotating(&r->profile, r->scene);
        worker_log("%s since step %lld", dem_scene_phase_name(r->scene), (long long)dem_scene_step_count(r->scene));
    }
    progress_report report;
    if (!progress_is_due(&r->progress, r->scene, &report)) return WORKER_DONE;
    log_tenth(r, &report);
    if (r->options->on_terminal) terminal_progress(&report, dem_scene_phase_name(r->scene), dem_scene_time(r->scene));
    json_t *event =
        json_pack("{s:s, s:f, s:o, s:f}", "phase", dem_scene_phase_name(r->scene), "progress", report.percent, "eta_seconds",
                  json_real_or_null(report.eta_seconds), "particle_steps_per_second", report.particle_steps_per_second);
    return add_event(r, "progress", event) ? WORKER_DONE : WORKER_DISK;
}

/* Advances until the end of the run, a stop or a failure. */
static enum worker_exit run_to_the_end(scene_run *r)
{
    for (;;) {
        enum worker_exit exit = save_bed(r);
        if (exit == WORKER_DONE) exit = take_what_is_due(r);
        if (exit != WORKER_DONE) return exit;
        if (is_rotating(r) && rotation_step(r) >= r->plan.rotation_steps) return WORKER_DONE;
        if (job_run_is_asked_to_stop()) {
            exit = save_checkpoint(r);
            worker_log("stopped at step %lld", (long long)dem_scene_step_count(r->scene));
            return exit == WORKER_DONE ? WORKER_STOPPED : exit;
        }
        run_profile_lap_begin(&r->profile);
        if (monotonic_seconds() >= r->next_checkpoint) exit = save_checkpoint(r);
        run_profile_lap(&r->profile, RUN_CHECKPOINTS);
        if (exit != WORKER_DONE) return exit;
        const dem_status status = advance(r);
        if (status != DEM_OK) return fail(r, status);
        exit = report_progress(r);
        if (exit != WORKER_DONE) return exit;
    }
}

run_facts scene_run_facts(const scene_run *r)
{
    const dem_scene_definition *drum = &r->spec->scene;
    const double spheres = (double)dem_scene_sphere_count(r->scene);
    const double steps = (double)dem_scene_step_count(r->scene), wall = progress_wall_seconds(&r->progress);
    run_facts facts = {
        .particles = (double)dem_scene_particle_count(r->scene),
        .spheres = spheres,
        .steps = steps,
        .time_step = drum->time_step,
        .simulated_seconds = dem_scene_time(r->scene),
        .settling_seconds = (double)dem_scene_run_start(r->scene) * drum->time_step,
        .wall_seconds = wall,
        .particle_steps_per_second = spheres * steps / wall,
        .maximum_overlap = dem_scene_maximum_overlap(r->scene),
        .stiffness = drum->contact.stiffness,
        .fill_fraction = drum->fill_fraction,
        .samples = (double)r->next_sample,
        .snapshots = (double)r->next_snapshot,
        .threads = drum->threads,
        .isa = dem_build_isa(),
        .precision = dem_build_precision(),
        .seed = (double)drum->seed,
        .attempt = r->options->attempt,
        .settled_by = *r->settled_by ? r->settled_by : NULL,
        .ended_by = r->ended_by ? r->ended_by : r->test->ended_by_time(r->spec),
    };
    size_facts_measure(r->spec, r->scene, &facts);
    return facts;
}

static enum worker_exit write_result(scene_run *r)
{
    json_t *document = NULL;
    const dem_status status = r->test->results(r, &document);
    if (status != DEM_OK) return fail(r, status);
    /* The series must be safe before the file that says all is done. */
    if (!write_series(r, true)) {
        json_decref(document);
        return fail_for_disk(r, JOB_SERIES_FILE);
    }
    if (r->test->write_files && !r->test->write_files(r)) {
        json_decref(document);
        return fail_for_disk(r, "the fields");
    }
    return job_run_write_result(r->spec, r->events, document);
}

static bool write_profile(const scene_run *r)
{
    if (!r->profile.is_on) return true;
    json_t *report = run_profile_report(&r->profile, r->scene);
    char *text = report ? json_text_write(report) : NULL;
    const bool written = text && file_write(JOB_PROFILE_FILE, text, strlen(text));
    free(text);
    json_decref(report);
    return written;
}

/* Takes up where the checkpoint `name` left off, of an earlier attempt or of the job that settled the bed. Where it is not
 * FILE_WHOLE the scene may be half restored. */
static file_state resume(scene_run *r, const char *name, double *earlier_seconds)
{
    checkpoint saved;
    const bool is_bed = strcmp(name, JOB_BED_FILE) == 0;
    const file_state state =
        is_bed ? shared_bed_read(r->spec, r->options->program, &saved) : checkpoint_read(&saved, name, r->params);
    if (state != FILE_WHOLE) return state;
    /* Another version of the program may derive other numbers from the same inputs. */
    const bool fits = saved.time_step == r->spec->scene.time_step && saved.stiffness == r->spec->scene.contact.stiffness
                      && saved.frame_width == r->frame_width && saved.next_sample <= r->plan.samples && saved.next_snapshot >= 0
                      && saved.next_snapshot <= r->plan.snapshots && restore_tally(r, &saved.state);
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

/* A new scene, in place of the one there may be. */
static dem_status prepare_scene(scene_run *r, bool with_start)
{
    dem_scene_free(r->scene);
    free(r->frames);
    free(r->tally);
    r->frames = r->tally = NULL;
    dem_status status = dem_scene_create(&r->spec->scene, &r->scene);
    if (status == DEM_OK && r->spec->scene.is_placed && with_start)
        status = start_scene(r->spec, r->scene, r->start_trouble, sizeof r->start_trouble);
    if (status != DEM_OK) return status;
    r->frame_width = r->test->frame_width(r->scene);
    r->frames = calloc((size_t)r->plan.samples, r->frame_width * sizeof *r->frames);
    r->tally_size = r->test->tally_size ? r->test->tally_size(r->scene) : 0;
    r->tally = calloc(r->tally_size + 1, sizeof *r->tally);
    return r->frames && r->tally ? DEM_OK : DEM_NO_MEMORY;
}

/* A checkpoint is also saved at the very end: an attempt that finds it, but no result, has nothing to do but to see once
 * more that it was the end. */
static enum worker_exit end_again(scene_run *r)
{
    const bool sampled_now =
        is_rotating(r) && r->next_sample > 0 && schedule_sample_step(&r->plan, r->next_sample - 1) == rotation_step(r);
    const int64_t snapshots = r->next_snapshot;
    const enum worker_exit exit = sampled_now ? end_when_over(r) : WORKER_DONE;
    if (exit == WORKER_DONE && r->ended_by) r->plan.snapshots = snapshots;
    return exit;
}

/* The scene from the newest checkpoint that is sound, which is the newest from now on, or a new one. */
static enum worker_exit prepare(scene_run *r, bool *resumed, double *earlier_seconds)
{
    enum { NEWEST, EARLIER, BED, FILES };
    static const char *const names[FILES] = { JOB_CHECKPOINT_FILE, JOB_EARLIER_CHECKPOINT_FILE, JOB_BED_FILE };
    dem_status status = DEM_OK;
    *resumed = false;
    for (size_t k = 0; k < FILES && !*resumed; k++) {
        if (access(names[k], F_OK) != 0) continue;
        if (k == BED && access(JOB_BED_HASH_FILE, F_OK) != 0) continue; /* our own, for others */
        status = prepare_scene(r, false);
        if (status != DEM_OK) return fail(r, status);
        const file_state state = resume(r, names[k], earlier_seconds);
        if (state == FILE_UNREADABLE && k != BED) return fail_for_disk(r, names[k]);
        *resumed = state == FILE_WHOLE;
        if (*resumed && k == EARLIER) rename(names[k], names[NEWEST]);
        if (*resumed && *r->settled_by) worker_log("the bed is that which the job %s has settled", r->settled_by);
        if (!*resumed) worker_warn("starting anew%s", k == NEWEST ? " from the checkpoint before, if there is one" : "");
    }
    if (!*resumed) status = prepare_scene(r, true);
    if (status != DEM_OK && r->start_trouble[0]) return failure_report_as(r->events, status, r->start_trouble);
    return status == DEM_OK ? WORKER_DONE : fail(r, status);
}

static enum worker_exit begin(scene_run *r)
{
    double earlier_seconds = 0.0;
    bool resumed;
    const enum worker_exit prepared = prepare(r, &resumed, &earlier_seconds);
    if (prepared != WORKER_DONE) return prepared;
    progress_init(&r->progress, r->spec, &r->plan, r->scene, earlier_seconds);
    r->next_checkpoint = monotonic_seconds() + FIRST_CHECKPOINT * r->options->checkpoint_seconds;
    r->phase = dem_scene_phase(r->scene);
    run_profile_begin(&r->profile, r->scene);
    const job_estimate estimate = job_spec_estimate(r->spec, NULL);
    worker_log("attempt %d %s step %lld, %s: %zu particles, time step %.3g s, about %.3g steps, threads %d, %s, %s precision",
               r->options->attempt, resumed ? "goes on from" : "starts at", (long long)dem_scene_step_count(r->scene),
               dem_scene_phase_name(r->scene), dem_scene_particle_count(r->scene), r->spec->scene.time_step, estimate.steps,
               r->spec->scene.threads, dem_build_isa(), dem_build_precision());
    json_t *event = json_pack("{s:i, s:b, s:I, s:f, s:I}", "attempt", r->options->attempt, "resumed", resumed, "particles",
                              (json_int_t)dem_scene_particle_count(r->scene), "time_step", r->spec->scene.time_step, "total_steps",
                              (json_int_t)estimate.steps);
    if (!add_event(r, "start", event)) return WORKER_DISK;
    return resumed ? end_again(r) : WORKER_DONE;
}

enum worker_exit scene_run_job(const job_context *job, const scene_test *test)
{
    scene_run r = { .spec = job->spec,
                    .test = test,
                    .options = job->options,
                    .params = job->params,
                    .events = job->events,
                    .profile = { .is_on = job->options->profile },
                    .plan = schedule_of(job->spec) };
    enum worker_exit exit = begin(&r);
    if (exit == WORKER_DONE) exit = run_to_the_end(&r);
    if (exit == WORKER_DONE && job->spec->scene.container == DEM_DRUM)
        exit = save_checkpoint(&r); /* another run may start from here */
    if (exit == WORKER_DONE && !write_profile(&r)) exit = fail_for_disk(&r, JOB_PROFILE_FILE);
    if (exit == WORKER_DONE) exit = write_result(&r);
    if (exit == WORKER_DONE) unlink(JOB_EARLIER_CHECKPOINT_FILE); /* whatever happens to the newest now, the result is there */
    if (exit == WORKER_DONE && *r.settled_by) shared_bed_remove();
    if (exit == WORKER_DONE) worker_log("done in %.1f s", progress_wall_seconds(&r.progress));
    dem_scene_free(r.scene);
    free(r.frames);
    free(r.tally);
    return exit;
}
