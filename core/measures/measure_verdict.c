/* What a run lets be said: whether its angle is steady, and whether its regime is certain. The least windows are in
 * dem_rules.h; why they are so: core/NUMERICS.md, "What a run can tell". */
#include "dem_rules.h"
#include "density_grid.h"
#include "measure.h"
#include "statistics.h"

double measure_layers(const dem_scene *scene)
{
    return dem_bed_layers(scene->definition.diameter, fmin(scene->definition.fill_fraction, 1.0), mean_diameter(scene));
}

bool measure_has_bed(const dem_scene *scene)
{
    return particles_count(&scene->spheres) >= DEM_LEAST_BED_PARTICLES && measure_layers(scene) >= DEM_LEAST_BED_LAYERS;
}

static bool has_enough_particles(const dem_scene *scene)
{
    return particles_count(&scene->spheres) >= DEM_LEAST_PARTICLES && measure_layers(scene) >= DEM_LEAST_LAYERS;
}

static double revolutions(const dem_scene *scene, double time)
{
    return fabs(scene->definition.rotation_rate) * time / (2 * DEM_PI);
}

bool measure_has_forgotten(const dem_scene *scene, const frame_window *window)
{
    static const double LAST_FRAME = 0.01; /* revolutions that the last frame may come before the end */
    const double time = window->frames[(window->count - 1) * window->width + FRAME_TIME];
    return frame_window_memory(scene, window) == 0 || revolutions(scene, time) >= DEM_LEAST_SLIPPING_REVOLUTIONS - LAST_FRAME;
}

static bool is_long_enough(const dem_scene *scene, const frame_window *window, const dem_repose_result *r)
{
    if (r->frames < DEM_LEAST_WINDOW_FRAMES) return false;
    return r->slumps.count >= DEM_LEAST_FALLS
           || (revolutions(scene, r->window_end) >= DEM_LEAST_REVOLUTIONS && r->window_revolutions >= DEM_LEAST_WINDOW_REVOLUTIONS
               && measure_has_forgotten(scene, window));
}

/* The angle's trend over the window, degrees; NaN where there is no angle. */
typedef struct drift {
    double change, bound; /* over the window; what the change's size stays below */
    double deviation;     /* about the trend */
    double times;         /* correlation times of what is left without the trend */
} drift;

static drift measure_drift(const dem_scene *scene, const frame_window *window, dem_repose_result *r)
{
    enum { LEAST_TIMES = 5 }; /* so that there are three degrees of freedom */
    double *time = frame_window_column(window, FRAME_TIME), *angle = frame_window_column(window, FRAME_SURFACE_FIT);
    double *residual = frame_window_column(window, FRAME_SURFACE_FIT);
    drift d = { NAN, NAN, NAN, NAN };
    r->drift_deg_per_revolution = r->drift_bound_deg_per_revolution = r->correlation_time = r->correlation_times = NAN;
    if (time && angle && residual && !isnan(r->angle[DEM_SURFACE_FIT].mean_deg)) {
        const size_t memory = frame_window_memory(scene, window);
        const trend found = statistics_trend(time, angle, window->count, memory, residual);
        const double correlation = fmax(statistics_correlation_length(angle, window->count, memory), 1.0);
        const double length = r->window_end - r->window_start, interval = length / (double)(window->count - 1);
        const double values = (double)found.line.points;
        d.times = values / fmax(found.correlation, 1.0);
        d.deviation = found.deviation;
        d.change = found.line.slope * length;
        if (d.times >= LEAST_TIMES) d.bound = fabs(d.change) + statistics_student_95(d.times - 2) * found.line.slope_error * length;
        r->drift_deg_per_revolution = d.change / r->window_revolutions;
        r->drift_bound_deg_per_revolution = d.bound / r->window_revolutions;
        r->correlation_time = correlation * interval;
        r->correlation_times = values / correlation;
    }
    free(time);
    free(angle);
    free(residual);
    return d;
}

static bool is_drifting(const drift *d)
{
    static const double NOTHING = 0.5; /* degrees over the window that are no drift to speak of, however sure */
    return d->times >= DEM_LEAST_CORRELATION_TIMES && fabs(d->change) >= NOTHING && d->bound < 2 * fabs(d->change);
}

static bool is_steady(const drift *d, const dem_repose_result *r)
{
    /* Degrees by which definitions of the angle differ; deviations, for a small bed that swings by more. */
    static const double AT_MOST = 2.0, DEVIATIONS = 3.0;
    return r->correlation_times >= DEM_LEAST_CORRELATION_TIMES && d->bound <= fmax(AT_MOST, DEVIATIONS * d->deviation);
}

/* The regime seen alike in either half of the window. A bed all around the wall takes some eight revolutions to settle. */
static bool is_certain(const dem_scene *scene, const frame_window *window, const dem_drum_results *results)
{
    static const double FAST_REVOLUTIONS = 8;
    const dem_regime regime = results->regime.regime;
    const bool is_fast = regime == DEM_RAINING || regime == DEM_SLIDING || regime == DEM_CENTRIFUGING;
    const size_t half = window->count / 2;
    const frame_window halves[2] = { { window->frames, half, window->width },
                                     { window->frames + half * window->width, window->count - half, window->width } };
    if (!is_long_enough(scene, window, &results->repose)
        || (is_fast && revolutions(scene, results->repose.window_end) < FAST_REVOLUTIONS))
        return false;
    for (int k = 0; k < 2; k++) {
        dem_regime_result of_half;
        measure_regime_results(scene, &halves[k], &results->repose, &of_half);
        if (of_half.regime != regime) return false;
    }
    return is_fast || has_enough_particles(scene);
}

void measure_verdict(const dem_scene *scene, const frame_window *window, dem_drum_results *results)
{
    dem_repose_result *r = &results->repose;
    const drift d = measure_drift(scene, window, r);
    if (!has_enough_particles(scene)) r->verdict = DEM_TOO_FEW;
    else if (isnan(r->angle[DEM_SURFACE_FIT].mean_deg)) r->verdict = DEM_NO_VERDICT;
    else if (!is_long_enough(scene, window, r)) r->verdict = DEM_TOO_SHORT;
    else if (measure_comes_in_falls(results->regime.regime) || is_drifting(&d)) r->verdict = DEM_DRIFTING;
    else r->verdict = is_steady(&d, r) ? DEM_STEADY : DEM_TOO_SHORT;
    if (r->verdict == DEM_TOO_SHORT) r->drift_deg_per_revolution = NAN; /* a moment's slope; the bound stands */
    r->steady = r->verdict == DEM_STEADY;
    results->regime.is_certain = results->regime.is_told && is_certain(scene, window, results);
}
