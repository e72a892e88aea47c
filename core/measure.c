#include "measure.h"

#include "interface.h"
#include "statistics.h"

size_t dem_frame_width(const dem_scene *scene) { return DEM_FRAME_SCALARS + interface_numbers(scene); }

const char *dem_frame_scalar_name(size_t index)
{
    static const char *const name[DEM_FRAME_SCALARS] = {
        "time",         "angle_deg",      "center_of_mass_deg",  "theil_sen_deg",     "upper_chord_deg", "lower_chord_deg",
        "chord_deg",    "solid_fraction", "coordination_number", "airborne_fraction", "wall_slip",       "wall_coverage",
        "flow_speed",   "surface_lag",    "kinetic_energy",      "radial_index",      "torque",          "weight_torque",
        "mean_overlap", "overlap_99",
    };
    return index < DEM_FRAME_SCALARS ? name[index] : NULL;
}

double *frame_window_column(const frame_window *window, size_t column)
{
    double *values = malloc((window->count ? window->count : 1) * sizeof *values);
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

dem_status dem_frame_measure(dem_scene *scene, double *frame)
{
    const size_t n = scene->spheres.mobile_count;
    int32_t *contacts = array_create(n, sizeof *contacts);
    if (!contacts) return DEM_NO_MEMORY;
    neighbor_list_count_contacts(&scene->neighbors, &scene->spheres, &scene->drum, NULL, contacts);
    frame[FRAME_TIME] = dem_scene_time(scene);
    frame[FRAME_COORDINATION] = coordination_number(&scene->spheres, contacts);
    join_contacts(&scene->spheres, contacts);
    dem_status status = measure_repose_frame(scene, contacts, frame);
    if (status == DEM_OK) status = measure_overlap_frame(scene, frame);
    if (status == DEM_OK) {
        measure_drive_frame(scene, frame);
        measure_regime_frame(scene, contacts, frame);
        frame[FRAME_KINETIC_ENERGY] = dem_scene_kinetic_energy(scene);
        frame[FRAME_RADIAL_INDEX] = measure_radial_index(scene);
    }
    free(contacts);
    return status;
}

static bool comes_in_jerks(const dem_drum_results *results)
{
    return results->regime.regime == DEM_SLUMPING || results->regime.regime == DEM_AVALANCHING;
}

/* A bed that flows all the time has no slumps, however its angle may wander. */
static dem_status slumps_of_window(const dem_scene *scene, const frame_window *window, dem_drum_results *results)
{
    results->repose.slumps = (dem_slumps){ NAN, { NAN, NAN }, { NAN, NAN }, { NAN, NAN }, { NAN, NAN } };
    if (!comes_in_jerks(results)) return DEM_OK;
    double *time = frame_window_column(window, FRAME_TIME), *angle = frame_window_column(window, FRAME_CENTER_OF_MASS);
    dem_status status = DEM_NO_MEMORY;
    if (time && angle) {
        if (scene->definition.rotation_rate < 0)
            for (size_t k = 0; k < window->count; k++) angle[k] = -angle[k];
        status = measure_slumps(time, angle, window->count, &results->repose.slumps);
    }
    free(time);
    free(angle);
    return status;
}

dem_status dem_drum_results_measure(const dem_scene *scene, const double *frames, size_t count, dem_drum_results *results)
{
    enum { LEAST_FRAMES = 8 };
    if (count < LEAST_FRAMES) return DEM_TOO_FEW_FRAMES;
    memset(results, 0, sizeof *results);
    frame_window window;
    dem_status status = measure_repose_results(scene, frames, count, dem_frame_width(scene), &results->repose, &window);
    if (status != DEM_OK) return status;
    measure_regime_results(scene, &window, &results->repose, &results->regime);
    /* A block that slides back and forth has no steady angle, however flat its average. */
    if (comes_in_jerks(results)) results->repose.steady = false;
    results->packing.solid_fraction = frame_window_mean(&window, FRAME_SOLID_FRACTION);
    results->packing.coordination_number = frame_window_mean(&window, FRAME_COORDINATION);
    results->packing.mean_overlap = frame_window_mean(&window, FRAME_MEAN_OVERLAP);
    results->packing.overlap_99 = frame_window_mean(&window, FRAME_OVERLAP_99);
    measure_drive_results(scene, &window, &results->drive);
    status = slumps_of_window(scene, &window, results);
    return status == DEM_OK ? measure_segregation_results(scene, &results->segregation) : status;
}
