/* What it takes to turn the drum: the torque of its wall on the bed, beside that of the bed's weight. */
#include "measure.h"
#include "statistics.h"

static double bed_mass(const spheres *s)
{
    double mass = 0.0;
    for (size_t p = 0; p < particles_count(s); p++) mass += particle_mass(s, p);
    return mass;
}

void measure_drive_frame(dem_scene *scene, double *frame)
{
    const spheres *s = &scene->spheres;
    frame[FRAME_TORQUE] = scene->torque.count > 0 ? scene->torque.sum / scene->torque.count : NAN;
    scene->torque = (torque_meter){ 0 };
    double moment = 0.0; /* kg m */
    for (size_t p = 0; p < particles_count(s); p++) moment += particle_mass(s, p) * particle_place(s, p)[0];
    frame[FRAME_WEIGHT_TORQUE] = moment * (scene->definition.gravity * scene->container.up[1]);
}

static dem_mean mean_of_column(const dem_scene *scene, const frame_window *window, size_t column)
{
    double *values = frame_window_column(window, column);
    if (!values) return (dem_mean){ NAN, NAN };
    const dem_mean result = { statistics_mean(values, window->count), frame_window_error(scene, window, values) };
    free(values);
    return result;
}

void measure_drive_results(const dem_scene *scene, const frame_window *window, dem_drive_result *result)
{
    result->torque = mean_of_column(scene, window, FRAME_TORQUE);
    result->weight_torque = mean_of_column(scene, window, FRAME_WEIGHT_TORQUE);
    result->power = result->torque.mean * scene->definition.rotation_rate;
    result->torque_number = result->torque.mean / (bed_mass(&scene->spheres) * scene->definition.gravity * scene->container.radius);
}
