#include "orifice_run.h"

#include <math.h>

#include "fields_file.h"
#include "orifice_result.h"
#include "run_summary.h"
#include "scene_run.h"

static size_t frame_width(const dem_scene *scene) { return (void)scene, DEM_FLOW_FRAME; }

static int64_t look_at_every_frame(const job_spec *spec) { return (void)spec, 1; }

static dem_status end_of_flow(const scene_group *group, const char **ended_by)
{
    const scene_run *run = group->bed;
    const dem_flow_end end = dem_flow_ended(run->scene, run->frames, (size_t)run->next_sample);
    if (end != DEM_FLOWS_ON) *ended_by = end == DEM_FLOW_CLOGGED ? "clogged" : "drained";
    return DEM_OK;
}

static const char *ended_by_time(const job_spec *spec) { return (void)spec, "duration"; }

/* The frame is in the table already, and counted after this. */
static dem_status add_outlet(const scene_run *run, double *tally)
{
    dem_outlet_add(run->scene, run->frames + (size_t)run->next_sample * run->frame_width, tally);
    return DEM_OK;
}

static bool write_fields(const scene_group *group, const double *tally)
{
    return fields_file_write_outlet(group->bed->scene, tally, &group->job->spec->scene.orifice, group->job->params);
}

/* Over rings of these radii, or strips, whose share of the orifice grows with the radius. */
static void mean_over_orifice(orifice_result *result, bool is_round)
{
    double area = 0.0, solid = 0.0, flow = 0.0;
    for (size_t k = 0; k < result->velocity.count; k++) {
        const double share = is_round ? result->velocity.place[k] : 1.0, fraction = result->solid_fraction.value[k];
        area += share;
        solid += share * fraction;
        flow += fraction > 0.0 ? share * fraction * result->velocity.value[k] : 0.0;
    }
    result->outlet_solid_fraction = area > 0.0 ? solid / area : NAN;
    result->outlet_velocity = solid > 0.0 ? flow / solid : NAN;
}

static dem_status measure_results(const scene_group *group, json_t **document)
{
    const scene_run *run = group->bed;
    orifice_result result = { .run = scene_run_facts(group, 0) };
    const dem_status status = dem_flow_measure(run->scene, run->frames, (size_t)run->next_sample, &result.measured);
    if (status != DEM_OK) return status;
    dem_outlet_profile(run->scene, run->tally, &result.solid_fraction, &result.velocity);
    mean_over_orifice(&result, run->spec.scene.orifice.depth == 0.0);
    *document = orifice_result_to_json(&result);
    return DEM_OK;
}

enum worker_exit orifice_run(const job_context *job)
{
    static const scene_test test = {
        .frame_width = frame_width,
        .frame_name = dem_flow_frame_name,
        .frame_measure = dem_flow_frame_measure,
        .tally_size = dem_outlet_size,
        .tally_add = add_outlet,
        .frames_between_looks = look_at_every_frame,
        .look = end_of_flow,
        .ended_by_time = ended_by_time,
        .write_files = write_fields,
        .results = measure_results,
    };
    return scene_run_job(job, &test);
}

void orifice_summary(const json_t *result, const char *folder)
{
    summary_fact(result, "flow", "mass_rate", "mass flow", "kg/s");
    summary_fact(result, "flow", "mass_rate_standard_error", "its error", "kg/s");
    summary_fact(result, "flow", "passed", "passed", "particles");
    summary_fact(result, "flow", "left", "left", "particles");
    summary_fact(result, "flow", "clogged_at", "clogged", "s after opening");
    summary_fact(result, "drained", "angle_deg", "drained angle", "degrees");
    summary_run(result, folder);
}
