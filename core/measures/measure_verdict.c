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
    dem_trend trend;
    double bound;             /* what the change's size stays below */
    double correlation_times; /* of the angle itself, of all beds */
    double least_times;       /* likewise, of the bed that has fewest */
} drift;

enum { LEAST_TIMES = 5 }; /* so that there are three degrees of freedom */

static drift measure_drift(const dem_scene *scene, const frame_window *window, dem_repose_result *r)
{
    double *time = frame_window_column(window, FRAME_TIME), *angle = frame_window_column(window, FRAME_SURFACE_FIT);
    double *residual = frame_window_column(window, FRAME_SURFACE_FIT);
    drift d = { { NAN, NAN, NAN, NAN }, NAN, NAN, NAN };
    r->drift_deg_per_revolution = r->drift_bound_deg_per_revolution = r->correlation_time = r->correlation_times = NAN;
    if (time && angle && residual && !isnan(r->angle[DEM_SURFACE_FIT].mean_deg)) {
        const size_t memory = frame_window_memory(scene, window);
        const trend found = statistics_trend(time, angle, window->count, memory, residual);
        const double correlation = fmax(statistics_correlation_length(angle, window->count, memory), 1.0);
        const double length = r->window_end - r->window_start, interval = length / (double)(window->count - 1);
        const double values = (double)found.line.points;
        const double times = values / fmax(found.correlation, 1.0), change = found.line.slope * length;
        d.trend = (dem_trend){ change, found.line.slope_error * length, found.deviation, times };
        if (times >= LEAST_TIMES) d.bound = fabs(change) + statistics_student_95(times - 2) * found.line.slope_error * length;
        r->drift_deg_per_revolution = change / r->window_revolutions;
        r->drift_bound_deg_per_revolution = d.bound / r->window_revolutions;
        r->correlation_time = correlation * interval;
        r->correlation_times = d.correlation_times = d.least_times = values / correlation;
    }
    r->trend = d.trend;
    free(time);
    free(angle);
    free(residual);
    return d;
}

static bool is_drifting(const drift *d)
{
    static const double NOTHING = 0.5; /* degrees over the window that are no drift to speak of, however sure */
    const double change = fabs(d->trend.change_deg);
    return d->trend.times >= DEM_LEAST_CORRELATION_TIMES && change >= NOTHING && d->bound < 2 * change;
}

static bool is_steady(const drift *d)
{
    /* Degrees by which definitions of the angle differ; deviations, for a small bed that swings by more. */
    static const double AT_MOST = 2.0, DEVIATIONS = 3.0;
    return d->correlation_times >= DEM_LEAST_CORRELATION_TIMES && d->least_times >= DEM_LEAST_CORRELATION_TIMES_OF_A_BED
           && d->bound <= fmax(AT_MOST, DEVIATIONS * d->trend.deviation_deg);
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
    if (!results->repose.is_long_enough || (is_fast && revolutions(scene, results->repose.window_end) < FAST_REVOLUTIONS))
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
    r->is_long_enough = is_long_enough(scene, window, r);
    if (!has_enough_particles(scene)) r->verdict = DEM_TOO_FEW;
    else if (isnan(r->angle[DEM_SURFACE_FIT].mean_deg)) r->verdict = DEM_NO_VERDICT;
    else if (!r->is_long_enough) r->verdict = DEM_TOO_SHORT;
    else if (measure_comes_in_falls(results->regime.regime) || is_drifting(&d)) r->verdict = DEM_DRIFTING;
    else r->verdict = is_steady(&d) ? DEM_STEADY : DEM_TOO_SHORT;
    if (r->verdict == DEM_TOO_SHORT) r->drift_deg_per_revolution = NAN; /* a moment's slope; the bound stands */
    r->steady = r->verdict == DEM_STEADY;
    results->regime.is_certain = results->regime.is_told && is_certain(scene, window, results);
}

/* --- several beds --- */

/* The mean of the changes, with the error of one of them and the degrees of freedom of all. Where the angle drifts, windows begin
 * where it is flattest, in all beds alike, so that the error of the mean is not smaller by the root of their number. Beds
 * without an angle do not count. */
static drift drift_of_beds(const dem_drum_results *beds, size_t count)
{
    drift d = { .least_times = INFINITY };
    double used = 0.0, errors = 0.0, deviations = 0.0, freedom = 0.0;
    bool is_known = true;
    for (size_t k = 0; k < count; k++) {
        const dem_repose_result *r = &beds[k].repose;
        if (isnan(r->trend.change_deg)) continue;
        used += 1.0;
        d.trend.change_deg += (r->trend.change_deg - d.trend.change_deg) / used;
        errors += r->trend.error_deg * r->trend.error_deg;
        deviations += r->trend.deviation_deg * r->trend.deviation_deg;
        d.trend.times += r->trend.times;
        freedom += r->trend.times - 2.0;
        is_known = is_known && r->trend.times >= LEAST_TIMES;
        d.correlation_times += r->correlation_times;
        d.least_times = fmin(d.least_times, r->correlation_times);
    }
    if (used == 0.0) return (drift){ { NAN, NAN, NAN, NAN }, NAN, NAN, NAN };
    d.trend.error_deg = sqrt(errors / used);
    d.trend.deviation_deg = sqrt(deviations / used);
    d.bound = is_known ? fabs(d.trend.change_deg) + statistics_student_95(freedom) * d.trend.error_deg : NAN;
    return d;
}

/* As measure_verdict, where a verdict that is not of the drift is that of the beds: too few particles are so in each; half
 * of them without an angle, or by falls, are not steady together; and the window of each must be long enough. */
static dem_verdict verdict_of_beds(const dem_drum_results *beds, size_t count, const drift *d)
{
    size_t without = 0, falling = 0, short_of = 0;
    for (size_t k = 0; k < count; k++) {
        const dem_repose_result *r = &beds[k].repose;
        if (r->verdict == DEM_TOO_FEW) return DEM_TOO_FEW;
        without += r->verdict == DEM_NO_VERDICT;
        short_of += r->verdict != DEM_NO_VERDICT && !r->is_long_enough;
        falling += measure_comes_in_falls(beds[k].regime.regime);
    }
    if (2 * without >= count) return DEM_NO_VERDICT;
    if (short_of > 0) return DEM_TOO_SHORT;
    if (2 * falling >= count || is_drifting(d)) return DEM_DRIFTING;
    return is_steady(d) ? DEM_STEADY : DEM_TOO_SHORT;
}

void dem_drum_results_of_beds(const dem_drum_results *beds, size_t count, dem_repose_result *all)
{
    const dem_repose_result *first = &beds[0].repose;
    all->verdict = first->verdict;
    all->steady = first->steady;
    all->drift_deg_per_revolution = first->drift_deg_per_revolution;
    all->drift_bound_deg_per_revolution = first->drift_bound_deg_per_revolution;
    if (count == 1) return;
    const drift d = drift_of_beds(beds, count);
    double revolutions_a_bed = 0.0;
    for (size_t k = 0; k < count; k++) revolutions_a_bed += beds[k].repose.window_revolutions / (double)count;
    all->verdict = verdict_of_beds(beds, count, &d);
    all->steady = all->verdict == DEM_STEADY;
    all->drift_deg_per_revolution = all->verdict == DEM_TOO_SHORT ? NAN : d.trend.change_deg / revolutions_a_bed;
    all->drift_bound_deg_per_revolution = d.bound / revolutions_a_bed;
}
