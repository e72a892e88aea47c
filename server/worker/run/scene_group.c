/* The life of an attempt at a scene, of one bed or several:
 *     continue each bed from its checkpoint in the job folder if there is one of this spec, or from the one before it, or from
 *         the bed that another job of the study has settled
 *     until the end: look, take the snapshots that are due, save checkpoints now and then, let the beds advance
 *     measure the results from the tables of frames; result.json is the last thing written
 * Frames, looks and snapshots are due at steps counted from the start of the test (schedule.h), so that an attempt which
 * goes on from checkpoints takes the same ones as an attempt that was never interrupted.
 *
 * Beds depend on nothing but their seeds, and no bed passes a look before all have come to it: where a run ends does not
 * depend on how many threads there are, on which bed was quicker, or on which checkpoint is how old. While they advance, a
 * bed has one thread or more of its own (bed_lanes.c); files are written when none does, in the order of the beds. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "attempt_fence.h"
#include "bed_lanes.h"
#include "failure_report.h"
#include "file_publish.h"
#include "frame_file.h"
#include "json_text.h"
#include "picture_file.h"
#include "process_type.h"
#include "processor_name.h"
#include "run_folder.h"
#include "run_summary.h"
#include "scene_run.h"
#include "shared_bed.h"
#include "size_facts.h"
#include "snapshot_file.h"
#include "start_file.h"
#include "walls_file.h"
#include "worker_log.h"

#define PICTURE_SECONDS 60.0      /* between pictures; a short run has that of its end alone */
#define FIRST_PICTURE_SECONDS 5.0 /* after the start of an attempt */
#define SERIES_SECONDS 2.0        /* between rewrites of a long series */
#define FIRST_CHECKPOINT 0.1      /* of the time between checkpoints, so that little is lost of a run that is short */
#define SERIES_ALWAYS_BELOW 1000  /* snapshots: a short series is rewritten after each */

/* Of several beds, their steps together. */
static int64_t steps_of_all(const scene_group *g)
{
    int64_t steps = 0;
    for (size_t k = 0; k < g->beds; k++) steps += dem_scene_step_count(g->bed[k].scene);
    return steps;
}

static bool add_event(scene_group *g, const char *name, json_t *members)
{
    return scene_event_add(g->job->events, name, steps_of_all(g), dem_scene_time(g->bed->scene), members);
}

static enum worker_exit fail(scene_group *g, const scene_run *r, dem_status status)
{
    if (g->beds > 1) worker_warn("bed %zu of %zu:", r->number, g->beds);
    return failure_report(g->job->events, status, r->scene ? dem_scene_failure(r->scene) : NULL);
}

static enum worker_exit fail_for_disk(scene_group *g, const char *name) { return failure_report_disk(g->job->events, name); }

/* Whether the test is over before its time, told from the frames so far, once every bed has those. */
static enum worker_exit look_if_due(scene_group *g)
{
    for (size_t k = 0; k < g->beds; k++)
        if (!bed_is_at_look(g, &g->bed[k])) return WORKER_DONE;
    run_profile_lap_begin(&g->bed->profile);
    const dem_status status = g->test->look(g, &g->ended_by);
    run_profile_lap(&g->bed->profile, RUN_MEASURES);
    if (status != DEM_OK) return fail(g, g->bed, status);
    for (size_t k = 0; g->ended_by && k < g->beds; k++)
        schedule_end_at(&g->bed[k].plan, scene_run_rotation_step(&g->bed[k]), g->bed[k].next_sample);
    g->look += g->test->frames_between_looks(g->job->spec);
    return WORKER_DONE;
}

static bool write_series(scene_group *g, bool now)
{
    const scene_run *r = g->bed;
    if (!now && r->next_snapshot >= SERIES_ALWAYS_BELOW && monotonic_seconds() - g->last_series < SERIES_SECONDS) return true;
    g->last_series = monotonic_seconds();
    return snapshot_series_write(&r->plan, r->spec.scene.time_step, r->next_snapshot)
           && walls_file_write(r->scene, &r->spec.scene, r->spec.is_mirrored);
}

/* For who looks at the run: nothing depends on it, and where it can't be written the log says so. */
static void draw_picture(scene_group *g)
{
    const scene_run *r = g->bed;
    g->next_picture = monotonic_seconds() + PICTURE_SECONDS;
    picture_files_write(r->scene, &r->spec.scene, r->spec.is_mirrored);
}

static enum worker_exit take_snapshot(scene_group *g)
{
    scene_run *r = g->bed;
    int64_t bytes;
    if (!snapshot_folder_is_there() || !frame_file_write(r->scene, r->spec.is_mirrored, r->next_snapshot)
        || !snapshot_file_write(r->scene, r->spec.is_mirrored, r->next_snapshot, r->params, &bytes))
        return fail_for_disk(g, "a snapshot");
    const long long number = r->next_snapshot++;
    json_t *event =
        json_pack("{s:I, s:o, s:I, s:I}", "number", (json_int_t)number, "file", json_sprintf(JOB_SNAPSHOT_FILE_FORMAT, number),
                  "bytes", (json_int_t)bytes, "particles", (json_int_t)dem_scene_particle_count(r->scene));
    if (!write_series(g, false)) return fail_for_disk(g, JOB_SERIES_FILE);
    return scene_event_add(g->job->events, "snapshot", dem_scene_step_count(r->scene), dem_scene_time(r->scene), event)
               ? WORKER_DONE
               : WORKER_DISK;
}

/* The first that failed of all beds. */
static enum worker_exit failure_of_a_bed(scene_group *g)
{
    for (size_t k = 0; k < g->beds; k++) {
        if (g->bed[k].status != DEM_OK) return fail(g, &g->bed[k], g->bed[k].status);
        if (g->bed[k].is_untold) return WORKER_DISK;
    }
    return WORKER_DONE;
}

static enum worker_exit take_what_is_due(scene_group *g)
{
    for (size_t k = 0; k < g->beds; k++) scene_run_sample(&g->bed[k]);
    enum worker_exit exit = failure_of_a_bed(g);
    if (exit == WORKER_DONE) exit = look_if_due(g);
    run_profile_lap_begin(&g->bed->profile);
    if (exit == WORKER_DONE && scene_run_snapshot_is_due(g->bed)) exit = take_snapshot(g);
    run_profile_lap(&g->bed->profile, RUN_SNAPSHOTS);
    return exit;
}

static enum worker_exit save_checkpoints(scene_group *g)
{
    /* First the events: a checkpoint must not count samples that the log could still lose. */
    bool written = event_log_sync(g->job->events);
    for (size_t k = 0; written && k < g->beds; k++) {
        dem_status status = DEM_OK;
        written = scene_run_save(&g->bed[k], progress_wall_seconds(&g->progress), &status);
        if (status != DEM_OK) return fail(g, &g->bed[k], status);
    }
    g->next_checkpoint = monotonic_seconds() + g->job->options->checkpoint_seconds;
    if (!written) return fail_for_disk(g, JOB_CHECKPOINT_FILE);
    return add_event(g, "checkpoint", json_pack("{s:i}", "attempt", g->job->options->attempt)) ? WORKER_DONE : WORKER_DISK;
}

/* As it is at the first step of rotation. */
static enum worker_exit save_bed(scene_group *g)
{
    char hash[SHA256_HEX_SIZE];
    const scene_run *r = g->bed;
    if (!g->job->options->save_bed || g->beds > 1 || g->has_saved_bed || *r->settled_by || !scene_run_is_rotating(r)
        || scene_run_rotation_step(r) != 0)
        return WORKER_DONE;
    g->has_saved_bed = true;
    const enum worker_exit exit = save_checkpoints(g);
    if (exit != WORKER_DONE || !shared_bed_save(hash)) return exit;
    return add_event(g, "bed", json_pack("{s:s}", "sha256", hash)) ? WORKER_DONE : WORKER_DISK;
}

/* For whoever follows the log. */
static void log_tenth(scene_group *g, const progress_report *report)
{
    const int tenth = (int)(report->percent / 10.0);
    char left[TIME_IN_WORDS_SIZE];
    if (tenth <= g->tenth) return;
    g->tenth = tenth;
    time_in_words(report->eta_seconds, left);
    worker_log("%d %% done at step %lld, about %s left", 10 * tenth, (long long)steps_of_all(g), left);
}

static enum worker_exit report_progress(scene_group *g)
{
    const scene_run *first = g->bed;
    if (dem_scene_phase(first->scene) != g->phase) {
        g->phase = dem_scene_phase(first->scene);
        if (scene_run_is_rotating(first)) run_profile_rotating(&g->bed->profile, first->scene);
        worker_log("%s since step %lld", dem_scene_phase_name(first->scene), (long long)dem_scene_step_count(first->scene));
    }
    const dem_scene *scene[MOST_BEDS];
    for (size_t k = 0; k < g->beds; k++) scene[k] = g->bed[k].scene;
    progress_report report;
    if (!progress_is_due(&g->progress, scene, g->beds, &report)) return WORKER_DONE;
    if (monotonic_seconds() >= g->next_picture) draw_picture(g);
    log_tenth(g, &report);
    const fence_state fence = attempt_fence_look(g->job->options->start_number);
    if (fence == FENCE_IS_LOST) return WORKER_SUPERSEDED;
    if (fence == FENCE_STOPS) job_run_ask_to_stop();
    const char *phase = dem_scene_phase_name(first->scene);
    if (g->job->options->on_terminal) terminal_progress(&report, phase, dem_scene_time(first->scene));
    json_t *event = json_pack("{s:s, s:f, s:o, s:f}", "phase", phase, "progress", report.percent, "eta_seconds",
                              json_real_or_null(report.eta_seconds), "particle_steps_per_second", report.particle_steps_per_second);
    return add_event(g, "progress", event) ? WORKER_DONE : WORKER_DISK;
}

static bool all_are_over(const scene_group *g)
{
    for (size_t k = 0; k < g->beds; k++)
        if (!scene_run_is_over(&g->bed[k])) return false;
    return true;
}

/* Advances until the end of the run, a stop or a failure. */
static enum worker_exit run_to_the_end(scene_group *g)
{
    for (;;) {
        enum worker_exit exit = save_bed(g);
        if (exit == WORKER_DONE) exit = take_what_is_due(g);
        if (exit != WORKER_DONE) return exit;
        if (all_are_over(g)) return WORKER_DONE;
        if (job_run_is_asked_to_stop()) {
            exit = save_checkpoints(g);
            worker_log("stopped at step %lld", (long long)steps_of_all(g));
            return exit == WORKER_DONE ? WORKER_STOPPED : exit;
        }
        run_profile_lap_begin(&g->bed->profile);
        if (monotonic_seconds() >= g->next_checkpoint) exit = save_checkpoints(g);
        run_profile_lap(&g->bed->profile, RUN_CHECKPOINTS);
        if (exit != WORKER_DONE) return exit;
        bed_lanes_advance(g);
        exit = failure_of_a_bed(g);
        if (exit == WORKER_DONE) exit = report_progress(g);
        if (exit != WORKER_DONE) return exit;
    }
}

run_facts scene_run_facts(const scene_group *g, size_t bed)
{
    const scene_run *r = &g->bed[bed];
    const dem_scene_definition *drum = &r->spec.scene;
    const double spheres = (double)dem_scene_sphere_count(r->scene);
    const double steps = (double)dem_scene_step_count(r->scene), wall = progress_wall_seconds(&g->progress);
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
        .bond_number = r->spec.bond_number,
        .samples = (double)r->next_sample,
        .snapshots = (double)r->next_snapshot,
        .threads = g->job->spec->threads,
        .isa = dem_build_isa(),
        .processor = processor_name(),
        .precision = dem_build_precision(),
        .seed = (double)drum->seed,
        .attempt = g->job->options->attempt,
        .settled_by = *r->settled_by ? r->settled_by : NULL,
        .ended_by = g->ended_by ? g->ended_by : g->test->ended_by_time(g->job->spec),
    };
    size_facts_measure(&r->spec, r->scene, &facts);
    return facts;
}

static bool write_files(const scene_group *g)
{
    if (!g->test->write_files) return true;
    double *sum = g->bed->tally;
    for (size_t k = 1; k < g->beds; k++)
        for (size_t i = 0; i < g->bed->tally_size; i++) sum[i] += g->bed[k].tally[i];
    return g->test->write_files(g, sum);
}

static enum worker_exit write_result(scene_group *g)
{
    json_t *document = NULL;
    const dem_status status = g->test->results(g, &document);
    if (status != DEM_OK) return fail(g, g->bed, status);
    /* The series must be safe before the file that says all is done. */
    if (!write_series(g, true)) {
        json_decref(document);
        return fail_for_disk(g, JOB_SERIES_FILE);
    }
    draw_picture(g);
    if (!tracing_write(&g->bed->tracing, g->job->spec, (size_t)g->bed->next_sample, g->job->params)) {
        json_decref(document);
        return fail_for_disk(g, JOB_TRACERS_FILE);
    }
    if (!write_files(g)) {
        json_decref(document);
        return fail_for_disk(g, JOB_FIELDS_FILE);
    }
    return job_run_write_result(g->job->spec, g->job->events, document);
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

/* --- the beginning --- */

static dem_status prepare_anew(scene_group *g, scene_run *r)
{
    const dem_status status = scene_run_prepare(r);
    if (status != DEM_OK || !r->spec.scene.is_placed) return status;
    return start_scene(&r->spec, r->scene, g->start_trouble, sizeof g->start_trouble);
}

/* The scene from the newest checkpoint that is sound, which is the newest from now on, or a new one. */
static enum worker_exit prepare_bed(scene_group *g, scene_run *r, bool *resumed, double *earlier_seconds)
{
    enum { NEWEST, EARLIER, BED, FILES };
    const char *const names[FILES] = { r->names.newest, r->names.before, JOB_BED_FILE };
    dem_status status = DEM_OK;
    *resumed = false;
    for (size_t k = 0; k < (g->beds == 1 ? FILES : BED) && !*resumed; k++) {
        if (access(names[k], F_OK) != 0) continue;
        if (k == BED && access(JOB_BED_HASH_FILE, F_OK) != 0) continue; /* our own, for others */
        status = scene_run_prepare(r);
        if (status != DEM_OK) return fail(g, r, status);
        const file_state state = scene_run_resume(r, names[k], earlier_seconds);
        if (state == FILE_UNREADABLE && k != BED) return fail_for_disk(g, names[k]);
        *resumed = state == FILE_WHOLE;
        if (*resumed && k == EARLIER) rename(names[k], names[NEWEST]);
        if (*resumed && *r->settled_by) worker_log("the bed is that which the job %s has settled", r->settled_by);
        if (!*resumed) worker_warn("starting anew%s", k == NEWEST ? " from the checkpoint before, if there is one" : "");
    }
    if (!*resumed) status = prepare_anew(g, r);
    if (status != DEM_OK && g->start_trouble[0]) return failure_report_as(g->job->events, status, g->start_trouble);
    return status == DEM_OK ? WORKER_DONE : fail(g, r, status);
}

/* The next look is the first that no bed has gone beyond: where one has, it was made, and the run went on. A bed that is
 * at a look may have been saved before it or after: it is made again, and finds the same. */
static void find_next_look(scene_group *g)
{
    const int64_t between = g->test->frames_between_looks ? g->test->frames_between_looks(g->job->spec) : 0;
    g->look = INT64_MAX;
    if (between <= 0) return;
    int64_t beyond = 0;
    for (size_t k = 0; k < g->beds; k++) {
        const int64_t frames = g->bed[k].next_sample - (scene_run_has_just_sampled(&g->bed[k]) ? 1 : 0);
        if (frames > beyond) beyond = frames;
    }
    g->look = (beyond / between + 1) * between;
}

static enum worker_exit tell_start(scene_group *g, bool resumed)
{
    const scene_run *first = g->bed;
    const job_spec *spec = g->job->spec;
    const job_estimate estimate = job_spec_estimate(spec, NULL);
    char beds[40] = "";
    if (g->beds > 1) snprintf(beds, sizeof beds, "%zu beds of ", g->beds);
    worker_log("attempt %d %s step %lld, %s: %s%zu particles, time step %.3g s, about %.3g steps, threads %d, %s, %s precision",
               g->job->options->attempt, resumed ? "goes on from" : "starts at", (long long)steps_of_all(g),
               dem_scene_phase_name(first->scene), beds, dem_scene_particle_count(first->scene), spec->scene.time_step,
               estimate.steps, spec->threads, dem_build_isa(), dem_build_precision());
    json_t *event = json_pack("{s:i, s:b, s:I, s:f, s:I}", "attempt", g->job->options->attempt, "resumed", resumed, "particles",
                              (json_int_t)dem_scene_particle_count(first->scene), "time_step", spec->scene.time_step, "total_steps",
                              (json_int_t)estimate.steps);
    return add_event(g, "start", event) ? WORKER_DONE : WORKER_DISK;
}

static enum worker_exit begin(scene_group *g)
{
    double earlier_seconds = 0.0;
    bool any_resumed = false;
    const dem_scene *scene[MOST_BEDS];
    if (g->beds > 1 && !run_folder_add_beds()) return fail_for_disk(g, JOB_BEDS_FOLDER);
    for (size_t k = 0; k < g->beds; k++) {
        bool resumed;
        double seconds = 0.0;
        const enum worker_exit prepared = prepare_bed(g, &g->bed[k], &resumed, &seconds);
        if (prepared != WORKER_DONE) return prepared;
        any_resumed = any_resumed || resumed;
        if (seconds > earlier_seconds) earlier_seconds = seconds;
        scene[k] = g->bed[k].scene;
    }
    find_next_look(g);
    progress_init(&g->progress, g->job->spec, &g->bed->plan, scene, earlier_seconds);
    g->next_picture = monotonic_seconds() + FIRST_PICTURE_SECONDS;
    g->next_checkpoint = monotonic_seconds() + FIRST_CHECKPOINT * g->job->options->checkpoint_seconds;
    g->phase = dem_scene_phase(g->bed->scene);
    run_profile_begin(&g->bed->profile, g->bed->scene);
    return tell_start(g, any_resumed);
}

/* --- the whole --- */

/* False: no memory. */
static bool group_init(scene_group *g, const job_context *job, const scene_test *test)
{
    *g = (scene_group){ .job = job, .test = test, .beds = job->spec->bed_count };
    g->bed = calloc(g->beds, sizeof *g->bed);
    for (size_t k = 0; g->bed && k < g->beds; k++) {
        scene_run *r = &g->bed[k];
        *r = (scene_run){ .spec = job_spec_of_bed(job->spec, k),
                          .number = k,
                          .test = test,
                          .events = job->events,
                          .program = job->options->program };
        r->plan = schedule_of(&r->spec);
        r->names = checkpoint_names_of(k);
        r->params = k == 0 ? strdup(job->params) : job_spec_to_brief(&r->spec);
        r->profile.is_on = k == 0 && job->options->profile;
        if (!r->params) return false;
    }
    return g->bed;
}

static void group_clear(scene_group *g)
{
    for (size_t k = 0; g->bed && k < g->beds; k++) scene_run_clear(&g->bed[k]);
    free(g->bed);
}

enum worker_exit scene_run_job(const job_context *job, const scene_test *test)
{
    scene_group g;
    enum worker_exit exit = group_init(&g, job, test) ? begin(&g) : failure_report(job->events, DEM_NO_MEMORY, NULL);
    if (exit == WORKER_DONE) exit = run_to_the_end(&g);
    if (exit == WORKER_DONE && job->spec->scene.container == DEM_DRUM)
        exit = save_checkpoints(&g); /* another run may start from here */
    if (exit == WORKER_DONE && !write_profile(g.bed)) exit = fail_for_disk(&g, JOB_PROFILE_FILE);
    if (exit == WORKER_DONE) exit = write_result(&g);
    if (exit == WORKER_DONE) unlink(JOB_EARLIER_CHECKPOINT_FILE); /* whatever happens to the newest now, the result is there */
    if (exit == WORKER_DONE && g.beds > 1) run_folder_empty_beds();
    if (exit == WORKER_DONE && *g.bed->settled_by) shared_bed_remove();
    if (exit == WORKER_DONE) worker_log("done in %.1f s", progress_wall_seconds(&g.progress));
    group_clear(&g);
    return exit;
}
