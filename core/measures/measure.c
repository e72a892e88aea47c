#include "measure.h"

#include "array.h"
#include "dem_rules.h"
#include "interface.h"
#include "statistics.h"

size_t dem_frame_width(const dem_scene *scene) { return DEM_FRAME_SCALARS + interface_numbers(scene); }

const char *dem_frame_scalar_name(size_t index)
{
    static const char *const name[DEM_FRAME_SCALARS] = {
        "time",         "angle_deg",      "center_of_mass_deg",  "theil_sen_deg",     "upper_chord_deg", "lower_chord_deg",
        "chord_deg",    "solid_fraction", "coordination_number", "airborne_fraction", "wall_slip",       "wall_coverage",
        "flow_speed",   "surface_lag",    "kinetic_energy",      "radial_index",      "torque",          "weight_torque",
        "mean_overlap", "overlap_99",     "tension_share",
    };
    return index < DEM_FRAME_SCALARS ? name[index] : NULL;
}

double *frame_window_column(const frame_window *window, size_t column)
{
    double *values = array_create(window->count ? window->count : 1, sizeof *values);
    for (size_t k = 0; values && k < window->count; k++) values[k] = window->frames[k * window->width + column];
    return values;
}

double frame_window_mean(const frame_window *window, size_t column)
{
    double *values = frame_window_column(window, column);
    const double mean = values ? statistics_mean(values, window->count) : NAN;
    free(values);
    return mean;
}

double frame_window_deviation(const frame_window *window, size_t column)
{
    double *values = frame_window_column(window, column);
    const double deviation = values ? statistics_deviation(values, window->count) : NAN;
    free(values);
    return deviation;
}

size_t frame_window_memory(const dem_scene *scene, const frame_window *window)
{
    if (!(frame_window_mean(window, FRAME_WALL_SLIP) > DEM_SLIPS_FROM)) return 0;
    const double length = window->frames[(window->count - 1) * window->width + FRAME_TIME] - window->frames[FRAME_TIME];
    const double revolution = 2 * DEM_PI / fabs(scene->definition.rotation_rate); /* infinite of a drum at rest */
    const double frames = fmin(revolution / length, 1.0) * (double)window->count;
    return frames >= 1 ? (size_t)frames : 0;
}

double frame_window_error(const dem_scene *scene, const frame_window *window, const double *column)
{
    return statistics_standard_error_of_memory(column, window->count, frame_window_memory(scene, window));
}

double frame_window_share_seen(const frame_window *window, size_t column)
{
    size_t seen = 0;
    for (size_t k = 0; k < window->count; k++) seen += !isnan(window->frames[k * window->width + column]);
    return (double)seen / (double)window->count;
}

static double coordination_number(const spheres *s, const int32_t *contacts)
{
    double sum = 0.0;
    for (size_t i = 0; i < s->mobile_count; i++) sum += contacts[i];
    return sum / (double)particles_count(s);
}

/* From each sphere's own contacts to those of the particle that it is a part of. */
static void join_contacts(const spheres *s, int32_t *contacts)
{
    for (size_t b = 0; b < s->clusters.count; b++) {
        const cluster_body *body = &s->clusters.body[b];
        const size_t first = (size_t)body->first_sphere, end = first + s->clusters.shape[body->species].sphere_count;
        int32_t sum = 0;
        for (size_t i = first; i < end; i++) sum += contacts[i];
        for (size_t i = first; i < end; i++) contacts[i] = sum;
    }
}

static dem_status measure_frame(dem_scene *scene, double *frame)
{
    const size_t n = scene->spheres.mobile_count;
    int32_t *contacts = array_create(n, sizeof *contacts);
    if (!contacts) return DEM_NO_MEMORY;
    neighbor_list_count_contacts(&scene->neighbors, &scene->spheres, &scene->container, NULL, contacts);
    frame[FRAME_TIME] = dem_scene_time(scene);
    frame[FRAME_COORDINATION] = coordination_number(&scene->spheres, contacts);
    join_contacts(&scene->spheres, contacts);
    dem_status status = measure_repose_frame(scene, contacts, frame);
    if (status == DEM_OK) status = measure_overlap_frame(scene, frame);
    if (status == DEM_OK) {
        frame[FRAME_TENSION] = measure_tension_share(scene);
        measure_drive_frame(scene, frame);
        measure_regime_frame(scene, contacts, frame);
        frame[FRAME_KINETIC_ENERGY] = dem_scene_kinetic_energy(scene);
        frame[FRAME_RADIAL_INDEX] = measure_radial_index(scene);
    }
    free(contacts);
    return status;
}

dem_status dem_frame_measure(dem_scene *scene, double *frame)
{
    arrays_begin();
    return arrays_end(measure_frame(scene, frame));
}

bool measure_comes_in_falls(dem_regime regime) { return regime == DEM_SLUMPING || regime == DEM_AVALANCHING; }

/* Falls in all frames, those before any window included: the climb from rest shows where the first begins. falls, or those one by
 * one: either may be NULL. */
static dem_status find_falls(const dem_scene *scene, const frame_window *all, dem_slumps *falls, dem_slump *slump, size_t room,
                             size_t *found)
{
    double *time = frame_window_column(all, FRAME_TIME), *angle = frame_window_column(all, FRAME_CENTER_OF_MASS);
    dem_status status = DEM_NO_MEMORY;
    if (time && angle) {
        if (scene->definition.rotation_rate < 0)
            for (size_t k = 0; k < all->count; k++) angle[k] = -angle[k];
        status = falls ? measure_slumps(time, angle, all->count, falls)
                       : measure_slumps_list(time, angle, all->count, slump, room, found);
    }
    free(time);
    free(angle);
    return status;
}

static bool falls_within(const dem_scene *scene, const frame_window *window, dem_drum_results *results)
{
    measure_repose_results(scene, window, &results->repose);
    measure_regime_results(scene, window, &results->repose, &results->regime);
    return measure_comes_in_falls(results->regime.regime);
}

/* Angles and regime over the frames that tell them. A bed that moves by falls shows it after the transient, or after its
 * first fall, which for a bed that flows is the transient. It keeps all its falls. */
static frame_window measure_window(const dem_scene *scene, const frame_window *all, const dem_slumps *falls,
                                   dem_drum_results *results)
{
    const frame_window flow = measure_window_of_flow(scene, all);
    bool comes_in_falls = falls_within(scene, &flow, results);
    if (!comes_in_falls && falls->count >= 2) {
        const frame_window later = frame_window_from(all, falls->first_end);
        comes_in_falls = falls_within(scene, &later, results);
    }
    if (comes_in_falls && !isnan(falls->first_start)) {
        const frame_window every = measure_window_of_falls(scene, all, falls->first_start);
        if (falls_within(scene, &every, results)) return every;
    }
    falls_within(scene, &flow, results);
    return flow;
}

/* What one run cannot know has no error. A bed that has slipped for a few revolutions only is still like its start. A bed that slides as a block keeps its shape, which another bed has not: all but
 * the direction of its centre of mass differs from bed to bed by more than over time. The drum's torque and that of the
 * weight have the same mean; of a bed that falls, the forces that stop each fall balance those that began it, so that the
 * torque's own error knows nothing of how the falls differ. */
static void claim_what_a_repeat_would_show(const dem_scene *scene, const frame_window *window, dem_drum_results *results)
{
    dem_drive_result *drive = &results->drive;
    dem_slumps *slumps = &results->repose.slumps;
    if (!measure_comes_in_falls(results->regime.regime)) {
        if (measure_has_forgotten(scene, window)) return;
        for (int m = 0; m < DEM_ANGLE_METHODS; m++) results->repose.angle[m].standard_error_deg = NAN;
        drive->torque.standard_error = drive->weight_torque.standard_error = NAN;
        return;
    }
    drive->torque.standard_error = fmax(drive->torque.standard_error, drive->weight_torque.standard_error);
    if (results->regime.regime != DEM_SLUMPING) return;
    for (int m = 0; m < DEM_ANGLE_METHODS; m++)
        if (m != DEM_CENTER_OF_MASS) results->repose.angle[m].standard_error_deg = NAN;
    slumps->start_deg.standard_error = slumps->stop_deg.standard_error = slumps->size_deg.standard_error = NAN;
}

dem_status measure_results(const dem_scene *scene, const double *frames, size_t count, dem_drum_results *results)
{
    enum { LEAST_FRAMES = 8 };
    if (count < LEAST_FRAMES) return DEM_TOO_FEW_FRAMES;
    arrays_begin();
    memset(results, 0, sizeof *results);
    const frame_window all = { frames, count, dem_frame_width(scene) };
    dem_slumps falls;
    const dem_status status = find_falls(scene, &all, &falls, NULL, 0, NULL);
    if (status != DEM_OK) return status;
    const frame_window window = measure_window(scene, &all, &falls, results);
    /* A bed that flows all the time has no slumps, however its angle may wander. */
    const bool comes_in_falls = results->regime.is_told && measure_comes_in_falls(results->regime.regime);
    results->repose.slumps = comes_in_falls ? falls : measure_no_slumps();
    measure_verdict(scene, &window, results);
    results->packing.solid_fraction = frame_window_mean(&window, FRAME_SOLID_FRACTION);
    results->packing.coordination_number = frame_window_mean(&window, FRAME_COORDINATION);
    results->packing.mean_overlap = frame_window_mean(&window, FRAME_MEAN_OVERLAP);
    results->packing.overlap_99 = frame_window_mean(&window, FRAME_OVERLAP_99);
    results->packing.tension_share = frame_window_mean(&window, FRAME_TENSION);
    measure_drive_results(scene, &window, &results->drive);
    claim_what_a_repeat_would_show(scene, &window, results);
    return arrays_end(measure_segregation_results(scene, &results->segregation));
}

dem_status dem_drum_results_measure(const dem_scene *scene, const double *frames, size_t count, dem_drum_results *results)
{
    double since;
    if (scene->definition.stage_count == 0) return measure_results(scene, frames, count, results);
    return dem_drum_stage_measure(scene, dem_last_turning_stage(&scene->definition, &since), frames, count, results);
}

dem_status dem_drum_slumps_list(const dem_scene *scene, const double *frames, size_t count, dem_slump *slump, size_t room,
                                size_t *found)
{
    const frame_window all = { frames, count, dem_frame_width(scene) };
    *found = 0;
    arrays_begin();
    return arrays_end(find_falls(scene, &all, NULL, slump, room, found));
}
