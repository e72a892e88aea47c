#include "fill_run.h"

#include "fill_result.h"
#include "run_summary.h"
#include "scene_run.h"

static size_t frame_width(const dem_scene *scene) { return (void)scene, DEM_FILL_FRAME; }

static int64_t look_at_every_frame(const job_spec *spec) { return (void)spec, 1; }

static dem_status end_at_rest(const scene_group *group, const char **ended_by)
{
    const scene_run *run = group->bed;
    if (dem_fill_is_over(run->frames, (size_t)run->next_sample)) *ended_by = "at-rest";
    return DEM_OK;
}

static const char *ended_by_time(const job_spec *spec) { return (void)spec, "duration"; }

static dem_status measure_results(const scene_group *group, json_t **document)
{
    const scene_run *run = group->bed;
    fill_result result = { .azimuths = DEM_AZIMUTHS, .run = scene_run_facts(group, 0) };
    const dem_status status = dem_fill_scene_measure(run->scene, run->frames, (size_t)run->next_sample, &result.measured,
                                                     &result.while_filling, &result.standing);
    if (status == DEM_OK) *document = fill_result_to_json(&result);
    return status;
}

enum worker_exit fill_run(const job_context *job)
{
    static const scene_test test = {
        .frame_width = frame_width,
        .frame_name = dem_fill_frame_name,
        .frame_measure = dem_fill_frame_measure,
        .frames_between_looks = look_at_every_frame,
        .look = end_at_rest,
        .ended_by_time = ended_by_time,
        .results = measure_results,
    };
    return scene_run_job(job, &test);
}

void fill_summary(const json_t *result, const char *folder)
{
    summary_angle(result);
    summary_fact(result, "surface", "height", "height", "m");
    summary_fact(result, "packing", "solid_fraction", "solid fraction", "of the core");
    summary_run(result, folder);
}
