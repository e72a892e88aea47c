/* A stage of a drum's rotation, measured as if it were a run of its own: its frames, with their time from its beginning, and those
 * of a drum that turned the other way seen in a mirror. */
#include "array.h"
#include "dem_rules.h"
#include "interface.h"
#include "measure.h"

/* What has a sign in the cross-section changes it; what is of the upper half of the surface becomes that of the lower. */
static void mirror_frame(const dem_scene *scene, double *frame)
{
    static const frame_column signed_columns[] = { FRAME_SURFACE_FIT, FRAME_CENTER_OF_MASS, FRAME_THEIL_SEN,
                                                   FRAME_CHORD,       FRAME_TORQUE,         FRAME_WEIGHT_TORQUE };
    for (size_t k = 0; k < sizeof signed_columns / sizeof *signed_columns; k++)
        frame[signed_columns[k]] = -frame[signed_columns[k]];
    const double upper = frame[FRAME_UPPER_CHORD];
    frame[FRAME_UPPER_CHORD] = -frame[FRAME_LOWER_CHORD];
    frame[FRAME_LOWER_CHORD] = -upper;
    interface_mirror(scene, frame);
}

/* The frames from `since` to `end`, s, as those of a run of their own. Returns how many. to: room for all. */
static size_t frames_of_stage(const dem_scene *scene, double since, double end, const double *frames, size_t count, double sense,
                              double *to)
{
    const size_t width = dem_frame_width(scene);
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        const double *frame = frames + k * width;
        if (!(frame[FRAME_TIME] >= since && frame[FRAME_TIME] < end)) continue;
        double *const copy = to + found++ * width;
        memcpy(copy, frame, width * sizeof *copy);
        copy[FRAME_TIME] -= since;
        if (sense < 0) mirror_frame(scene, copy);
    }
    return found;
}

/* The rate of a stage; of one of rest that of the last before it that turned, which made its bed, or of the first behind it. */
static double sense_of(const dem_scene_definition *d, size_t stage)
{
    for (size_t k = stage + 1; k-- > 0;)
        if (d->stage[k].rate != 0) return d->stage[k].rate;
    for (size_t k = stage; k < d->stage_count; k++)
        if (d->stage[k].rate != 0) return d->stage[k].rate;
    return 0;
}

/* A bed at rest is one draw of many: what another would show, it can't tell. */
static void measure_of_rest(dem_drum_results *results)
{
    results->repose.verdict = DEM_NO_VERDICT;
    results->repose.steady = results->regime.is_told = results->regime.is_certain = false;
    for (int m = 0; m < DEM_ANGLE_METHODS; m++) results->repose.angle[m].standard_error_deg = NAN;
    results->repose.slumps = measure_no_slumps();
    results->drive.torque.standard_error = results->drive.weight_torque.standard_error = NAN;
}

dem_status dem_drum_stage_measure(const dem_scene *scene, size_t stage, const double *frames, size_t count,
                                  dem_drum_results *results)
{
    const dem_scene_definition *d = &scene->definition;
    if (stage >= d->stage_count) return DEM_TOO_FEW_FRAMES;
    const double rate = d->stage[stage].rate;
    double since = 0;
    for (size_t k = 0; k < stage; k++) since += d->stage[k].seconds;
    const double end = stage + 1 < d->stage_count ? since + d->stage[stage].seconds : INFINITY;
    dem_scene *alone = array_create(1, sizeof *alone);
    double *own = array_create(count * dem_frame_width(scene) + 1, sizeof *own);
    dem_status status = DEM_NO_MEMORY;
    if (alone && own) {
        *alone = *scene; /* whose arrays it looks at */
        alone->definition.rotation_rate = fabs(rate);
        status = measure_results(alone, own, frames_of_stage(scene, since, end, frames, count, sense_of(d, stage), own), results);
        if (status == DEM_OK && rate == 0) measure_of_rest(results);
        if (status == DEM_OK) results->repose.window_start += since, results->repose.window_end += since;
    }
    free(alone);
    free(own);
    return status;
}
