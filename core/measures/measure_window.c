/* Which frames of a run are measured: of a bed that flows, those after the transient; of one that falls in events, all from
 * the first fall on. */
#include "dem_rules.h"
#include "measure.h"
#include "statistics.h"

frame_window frame_window_from(const frame_window *window, double time)
{
    size_t start = 0;
    while (start + 1 < window->count && window->frames[start * window->width + FRAME_TIME] < time) start++;
    return (frame_window){ window->frames + start * window->width, window->count - start, window->width };
}

frame_window measure_window_of_flow(const dem_scene *scene, const frame_window *all)
{
    const double quarter_turn = scene->definition.rotation_rate != 0 ? 0.5 * DEM_PI / fabs(scene->definition.rotation_rate) : 0.0;
    const double last = all->frames[(all->count - 1) * all->width + FRAME_TIME];
    const frame_window rest = frame_window_from(all, fmin(quarter_turn, 0.25 * last));
    /* A bed that loses its surface shows the transient in the moment of its weight alone. */
    const bool has_surface = frame_window_share_seen(&rest, FRAME_SURFACE_FIT) >= 0.5;
    double *angle = frame_window_column(&rest, has_surface || !measure_has_bed(scene) ? FRAME_SURFACE_FIT : FRAME_WEIGHT_TORQUE);
    const size_t cut = angle ? statistics_transient(angle, rest.count) : 0;
    free(angle);
    return (frame_window){ rest.frames + cut * rest.width, rest.count - cut, rest.width };
}

frame_window measure_window_of_falls(const dem_scene *scene, const frame_window *all, double first_start)
{
    const double sense = scene->definition.rotation_rate < 0 ? -1 : 1;
    size_t top = 0;
    double steepest = -INFINITY;
    for (size_t k = 0; k < all->count && all->frames[k * all->width + FRAME_TIME] <= first_start; k++) {
        const double angle = sense * all->frames[k * all->width + FRAME_SURFACE_FIT];
        if (!(angle > steepest)) continue;
        steepest = angle;
        top = k;
    }
    return (frame_window){ all->frames + top * all->width, all->count - top, all->width };
}
