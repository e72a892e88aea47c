#include "drum_run.h"

#include <math.h>
#include <stdlib.h>

#include "dem_interface.h"
#include "dem_rules.h"
#include "dem_slumps.h"
#include "drum_result.h"
#include "fields_file.h"
#include "scene_run.h"
#include "worker_log.h"

/* Where an error is asked for. Counted in frames, so that a run which was interrupted ends at the same one. */
static int64_t frames_between_looks(const job_spec *spec)
{
    enum { FRAMES_BETWEEN_LOOKS = 4 };
    return spec->until_standard_error > 0 ? FRAMES_BETWEEN_LOOKS : 0;
}

/* bed: (group->beds). */
static dem_status measure_beds(const scene_group *group, drum_result *bed)
{
    for (size_t k = 0; k < group->beds; k++) {
        const scene_run *run = &group->bed[k];
        drum_result_init(&bed[k]);
        const dem_status status = dem_drum_results_measure(run->scene, run->frames, (size_t)run->next_sample, &bed[k].measured);
        if (status != DEM_OK) return status;
        bed[k].has_regime = bed[k].measured.regime.is_told;
    }
    return DEM_OK;
}

/* Whether the angle is steady and known that well. */
static dem_status end_when_known(const scene_group *group, const char **ended_by)
{
    drum_result bed[MOST_BEDS], all;
    const dem_status status = measure_beds(group, bed);
    if (status == DEM_TOO_FEW_FRAMES) return DEM_OK;
    if (status != DEM_OK) return status;
    drum_result_of_beds(bed, group->beds, &all);
    if (all.measured.repose.steady
        && all.measured.repose.angle[DEM_SURFACE_FIT].standard_error_deg <= group->job->spec->until_standard_error)
        *ended_by = "standard-error";
    return DEM_OK;
}

/* Fields are of a bed that has begun to flow: from a quarter of a revolution on, or of the run where that is shorter; of
 * a drum with stages, in the last one that turns. */
static dem_status add_fields(const scene_run *run, double *tally)
{
    const dem_scene_definition *drum = &run->spec.scene;
    double since, rate = drum->rotation_rate, seconds = run->spec.duration;
    const size_t last = dem_last_turning_stage(drum, &since);
    if (drum->stage_count > 0) rate = drum->stage[last].rate, seconds = drum->stage[last].seconds;
    const double quarter = rate != 0 ? asin(1) / fabs(rate) : 0.0, time = dem_scene_time(run->scene) - since;
    const bool is_over = last + 1 < drum->stage_count && time >= seconds;
    return is_over || time < fmin(quarter, 0.25 * seconds) ? DEM_OK : dem_fields_add(run->scene, tally);
}

static bool write_fields(const scene_group *group, const double *tally)
{
    const job_spec *spec = group->job->spec;
    return fields_file_write(group->bed->scene, spec->is_mirrored, tally, &spec->scene, group->job->params);
}

static const char *ended_by_time(const job_spec *spec)
{
    return spec->until_standard_error > 0 ? "at-most-revolutions" : "duration";
}

static dem_status measure_stage(const scene_run *run, size_t k, drum_stage_result *stage)
{
    const dem_drum_results *const m = &stage->measured;
    const dem_status status = dem_drum_stage_measure(run->scene, k, run->frames, (size_t)run->next_sample, &stage->measured);
    if (status == DEM_TOO_FEW_FRAMES) {
        drum_stage_result_init(stage);
        return DEM_OK;
    }
    if (status != DEM_OK) return status;
    stage->verdict = dem_verdict_name(m->repose.verdict);
    stage->steady = m->repose.verdict == DEM_STEADY ? 1.0 : m->repose.verdict == DEM_DRIFTING ? 0.0 : NAN;
    stage->regime = m->regime.is_told ? dem_regime_name(m->regime.regime) : NULL;
    stage->certain = m->regime.is_told ? (double)m->regime.is_certain : NAN;
    return DEM_OK;
}

/* The list of stages: empty where there are none. */
static dem_status add_stages(const scene_run *run, json_t *document)
{
    const dem_scene_definition *drum = &run->spec.scene;
    json_t *list = json_array();
    double begins = 0;
    dem_status status = list ? DEM_OK : DEM_NO_MEMORY;
    for (size_t k = 0; status == DEM_OK && k < drum->stage_count; k++) {
        drum_stage_result stage;
        drum_stage_result_init(&stage);
        status = measure_stage(run, k, &stage);
        stage.rate = run->spec.is_mirrored ? -drum->stage[k].rate : drum->stage[k].rate;
        stage.begins = begins;
        stage.ends = begins += drum->stage[k].seconds;
        if (status == DEM_OK && json_array_append_new(list, drum_stage_result_to_json(&stage)) != 0) status = DEM_NO_MEMORY;
    }
    return json_object_set_new(document, "stages", list) == 0 ? status : DEM_NO_MEMORY;
}

/* Of the first bed, whose samples are told: each that its count has; null where that is null, and of a drum of several stages. */
static dem_status add_slumps(const scene_run *run, const drum_result *bed, json_t *document)
{
    enum { MOST = 10000 };
    const bool any = !isnan(bed->measured.repose.slumps.count) && run->spec.scene.stage_count <= 1;
    dem_slump *slump = any ? malloc(MOST * sizeof *slump) : NULL;
    size_t found = 0;
    dem_status status = any && !slump ? DEM_NO_MEMORY : DEM_OK;
    if (slump) status = dem_drum_slumps_list(run->scene, run->frames, (size_t)run->next_sample, slump, MOST, &found);
    json_t *events = any ? json_array() : json_null();
    for (size_t k = 0; slump && status == DEM_OK && k < found && k < MOST; k++)
        json_array_append_new(events, json_pack("{s:f, s:f, s:f, s:f}", "start", slump[k].start_time, "stop", slump[k].stop_time,
                                                "start_deg", slump[k].start_deg, "stop_deg", slump[k].stop_deg));
    free(slump);
    json_t *slumps = json_object_get(json_object_get(document, "repose"), "slumps");
    return json_object_set_new(slumps, "events", events) == 0 ? status : DEM_NO_MEMORY;
}

static dem_status measure_interfaces(const scene_group *group, drum_result *bed)
{
    dem_status status = DEM_OK;
    for (size_t k = 0; status == DEM_OK && k < group->beds; k++) {
        const scene_run *run = &group->bed[k];
        status = dem_drum_interface_measure(run->scene, run->frames, (size_t)run->next_sample, &bed[k].measured, &bed[k].interface);
    }
    return status;
}

static dem_status measure_results(const scene_group *group, json_t **document)
{
    drum_result bed[MOST_BEDS];
    dem_status status = measure_beds(group, bed);
    if (status == DEM_OK) status = measure_interfaces(group, bed);
    if (status != DEM_OK && status != DEM_TOO_FEW_FRAMES) return status;
    if (status == DEM_TOO_FEW_FRAMES) {
        worker_warn("%s: the results have no measures", dem_status_text(status));
        for (size_t k = 0; k < group->beds; k++) drum_result_init(&bed[k]);
    }
    for (size_t k = 0; k < group->beds; k++) bed[k].run = scene_run_facts(group, k);
    *document = drum_result_to_json(bed, group->beds);
    if (!*document) return DEM_NO_MEMORY;
    status = add_slumps(group->bed, bed, *document);
    return status == DEM_OK ? add_stages(group->bed, *document) : status;
}

enum worker_exit drum_run(const job_context *job)
{
    static const scene_test test = {
        .frame_width = dem_frame_width,
        .frame_name = dem_frame_scalar_name,
        .frame_measure = dem_frame_measure,
        .tally_size = dem_fields_size,
        .tally_add = add_fields,
        .frames_between_looks = frames_between_looks,
        .look = end_when_known,
        .ended_by_time = ended_by_time,
        .write_files = write_fields,
        .results = measure_results,
    };
    return scene_run_job(job, &test);
}
