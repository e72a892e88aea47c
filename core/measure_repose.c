/* The angle of repose under every definition in use. How each is computed: core/NUMERICS.md, "Angles". */
#include "dem_rules.h"
#include "density_grid.h"
#include "measure.h"
#include "statistics.h"

static const double CHORD_SHARE = 0.6; /* of the chord, about its middle, that a line is fitted to */

static double degrees(double radians) { return radians * (180 / DEM_PI); }

static double center_of_mass_angle(const spheres *s)
{
    double x = 0.0, y = 0.0;
    for (size_t p = 0; p < particles_count(s); p++) {
        const double *place = particle_place(s, p), mass = particle_mass(s, p);
        x += place[0] * mass;
        y += place[1] * mass;
    }
    return atan2(x, -y);
}

/* Surface heights in a frame, and the half length of the fitted part of the chord. */
typedef struct surface_heights {
    double *place, *height; /* (cells) m */
    int cells;
    double half_length; /* m */
} surface_heights;

static line_fit fit_between(const surface_heights *surface, double from, double to)
{
    int first = 0, last = surface->cells;
    while (first < last && surface->place[first] < from) first++;
    while (last > first && surface->place[last - 1] > to) last--;
    return statistics_line(surface->place + first, surface->height + first, (size_t)(last - first), 1.0);
}

/* The chord at the surface's mean height: half of it is sqrt(R^2 - h^2). */
static void set_half_length(surface_heights *surface, double drum_radius)
{
    double sum = 0.0;
    int n = 0;
    for (int a = 0; a < surface->cells; a++)
        if (fabs(surface->place[a]) < 0.5 * drum_radius && !isnan(surface->height[a])) {
            sum += surface->height[a];
            n++;
        }
    const double height = n ? fmin(fabs(sum / n), 0.9 * drum_radius) : 0.0;
    surface->half_length = CHORD_SHARE * sqrt(drum_radius * drum_radius - height * height);
}

/* Turns the frame until the fitted line is level; the frame's angle is then the surface's. NaN without a surface. */
static double level_frame(density_grid *grid, const dem_scene *scene, surface_heights *surface, double start)
{
    enum { MOST_TURNS = 8 };
    double angle = start;
    for (int turn = 0; turn < MOST_TURNS; turn++) {
        density_grid_deposit(grid, scene, angle);
        density_grid_heights(grid, surface->height);
        set_half_length(surface, scene->drum.radius);
        const line_fit fit = fit_between(surface, -surface->half_length, surface->half_length);
        if (isnan(fit.slope) || fit.points < 4) return NAN;
        angle += atan(fit.slope);
        if (fabs(fit.slope) < 1e-4) break;
    }
    return angle;
}

/* Tops of columns one diameter wide, of particles with two contacts or more, in the frame of the surface. */
static double theil_sen_angle(const dem_scene *scene, const int32_t *contacts, double angle, double half_length)
{
    const spheres *s = &scene->spheres;
    const double width = mean_diameter(scene), c = cos(angle), sine = sin(angle);
    const int columns = (int)(2 * half_length / width);
    if (columns < 3) return NAN;
    double *place = array_create((size_t)columns, sizeof *place), *top = array_create((size_t)columns, sizeof *top);
    double result = NAN;
    if (place && top) {
        for (int a = 0; a < columns; a++) top[a] = -INFINITY;
        for (size_t i = 0; i < s->mobile_count; i++) {
            const double *x = sphere_place(s, i);
            const int a = (int)floor((c * x[0] + sine * x[1] + half_length) / width);
            if (contacts[i] < 2 || a < 0 || a >= columns) continue;
            top[a] = fmax(top[a], c * x[1] - sine * x[0] + s->full_radius[i]);
        }
        size_t n = 0;
        for (int a = 0; a < columns; a++)
            if (isfinite(top[a])) {
                place[n] = (a + 0.5) * width - half_length;
                top[n++] = top[a];
            }
        result = angle + atan(statistics_theil_sen(place, top, n));
    }
    free(place);
    free(top);
    return result;
}

/* Slope between +-D/10 of an interface over x: what a GranuDrum reports. */
static double chord_angle(const double *interface, const density_grid *grid, double diameter)
{
    double height[2];
    for (int side = 0; side < 2; side++) {
        const double at = (side ? 0.1 : -0.1) * diameter / grid->size + 0.5 * grid->cells - 0.5;
        const int a = (int)floor(at);
        if (a < 0 || a + 1 >= grid->cells) return NAN;
        height[side] = interface[a] + (at - a) * (interface[a + 1] - interface[a]);
    }
    return atan((height[1] - height[0]) / (0.2 * diameter));
}

/* A bed spread over the whole wall has no surface to speak of: a ring is level in every frame. */
static bool is_ring(const dem_scene *scene)
{
    enum { SECTORS = 36 };
    const double outer = scene->drum.inner_radius - mean_diameter(scene);
    bool covered[SECTORS] = { false };
    for (size_t i = 0; i < scene->spheres.mobile_count; i++) {
        const double *x = sphere_place(&scene->spheres, i);
        if (x[0] * x[0] + x[1] * x[1] > outer * outer)
            covered[(int)((atan2(x[1], x[0]) / (2 * DEM_PI) + 0.5) * (SECTORS - 1e-9))] = true;
    }
    int count = 0;
    for (int k = 0; k < SECTORS; k++) count += covered[k];
    return count > 0.95 * SECTORS;
}

static void measure_angles(const dem_scene *scene, const int32_t *contacts, density_grid *grid, surface_heights *surface,
                           double *frame)
{
    const double center = center_of_mass_angle(&scene->spheres);
    const bool ring = is_ring(scene);
    const double angle = ring ? NAN : level_frame(grid, scene, surface, center);
    if (ring) density_grid_deposit(grid, scene, 0.0); /* for the solid fraction */
    frame[FRAME_CENTER_OF_MASS] = ring ? NAN : degrees(center);
    frame[FRAME_SURFACE_FIT] = degrees(angle);
    frame[FRAME_SOLID_FRACTION] = grid->core;
    frame[FRAME_UPPER_CHORD] = frame[FRAME_LOWER_CHORD] = frame[FRAME_THEIL_SEN] = NAN;
    if (!isnan(angle)) {
        frame[FRAME_UPPER_CHORD] = degrees(grid->turned + atan(fit_between(surface, 0, surface->half_length).slope));
        frame[FRAME_LOWER_CHORD] = degrees(grid->turned + atan(fit_between(surface, -surface->half_length, 0).slope));
        frame[FRAME_THEIL_SEN] = degrees(theil_sen_angle(scene, contacts, angle, surface->half_length));
    }
    double *interface = frame + DEM_FRAME_SCALARS;
    density_grid_deposit(grid, scene, 0.0);
    density_grid_heights(grid, interface);
    frame[FRAME_CHORD] = ring ? NAN : degrees(chord_angle(interface, grid, scene->definition.diameter));
}

dem_status measure_repose_frame(const dem_scene *scene, const int32_t *contacts, double *frame)
{
    density_grid grid;
    dem_status status = density_grid_init(&grid, scene);
    if (status != DEM_OK) return status;
    surface_heights surface = { .cells = grid.cells };
    surface.place = array_create((size_t)grid.cells, sizeof *surface.place);
    surface.height = array_create((size_t)grid.cells, sizeof *surface.height);
    if (surface.place && surface.height) {
        for (int a = 0; a < grid.cells; a++) surface.place[a] = density_grid_place(&grid, a);
        measure_angles(scene, contacts, &grid, &surface, frame);
    } else {
        status = DEM_NO_MEMORY;
    }
    free(surface.place);
    free(surface.height);
    density_grid_clear(&grid);
    return status;
}

/* ---- results over the window ---- */

static dem_angle angle_of_column(const frame_window *window, size_t column)
{
    dem_angle angle = { NAN, NAN, NAN, NAN };
    double *values = frame_window_column(window, column);
    if (!values) return angle;
    angle.mean_deg = statistics_mean(values, window->count);
    angle.standard_error_deg = statistics_standard_error(values, window->count);
    for (size_t k = 0; k < window->count; k++) {
        angle.minimum_deg = fmin(angle.minimum_deg, values[k]);
        angle.maximum_deg = fmax(angle.maximum_deg, values[k]);
    }
    free(values);
    return angle;
}

/* From the interface averaged over time; its error and range from the frames' own chords. */
static dem_angle angle_of_mean_interface(const dem_scene *scene, const frame_window *window, double *fluctuation)
{
    dem_angle angle = angle_of_column(window, FRAME_CHORD);
    const int cells = density_grid_cells(scene);
    const density_grid grid = { .cells = cells, .size = scene->definition.diameter / cells };
    double *mean = array_create((size_t)cells, sizeof *mean), *deviation = array_create((size_t)cells, sizeof *deviation);
    *fluctuation = NAN;
    if (mean && deviation && !isnan(angle.mean_deg)) {
        for (int a = 0; a < cells; a++) {
            mean[a] = frame_window_mean(window, DEM_FRAME_SCALARS + (size_t)a);
            /* The ends of the interface, where the bed meets the wall, come and go. */
            const bool inside = fabs(density_grid_place(&grid, a)) < 0.5 * CHORD_SHARE * scene->definition.diameter;
            deviation[a] = inside ? frame_window_deviation(window, DEM_FRAME_SCALARS + (size_t)a) : NAN;
        }
        *fluctuation = statistics_mean(deviation, (size_t)cells);
        angle.mean_deg = degrees(chord_angle(mean, &grid, scene->definition.diameter));
    }
    free(mean);
    free(deviation);
    return angle;
}

/* The window starts after a quarter revolution or when the angle has stopped drifting, whichever is later; a
 * quarter of the run where that is shorter. */
static size_t window_start(const dem_scene *scene, const double *frames, size_t count, size_t width)
{
    const double quarter_turn = scene->definition.rotation_rate != 0 ? 0.5 * DEM_PI / fabs(scene->definition.rotation_rate) : 0.0;
    const double last = frames[(count - 1) * width + FRAME_TIME];
    const double earliest = fmin(quarter_turn, 0.25 * last);
    size_t start = 0;
    while (start + 1 < count && frames[start * width + FRAME_TIME] < earliest) start++;
    const frame_window rest = { frames + start * width, count - start, width };
    double *angle = frame_window_column(&rest, FRAME_SURFACE_FIT);
    if (angle) start += statistics_transient(angle, rest.count);
    free(angle);
    return start;
}

/* Steady: over the window the angle drifts by less than half a degree, or by no more than chance allows. */
static void measure_drift(const dem_scene *scene, const frame_window *window, dem_repose_result *result)
{
    double *time = frame_window_column(window, FRAME_TIME), *angle = frame_window_column(window, FRAME_SURFACE_FIT);
    result->drift_deg_per_revolution = NAN;
    if (time && angle && window->count > 2) {
        const double correlation = statistics_correlation_length(angle, window->count);
        const line_fit fit = statistics_line(time, angle, window->count, correlation);
        const double revolution = 2 * DEM_PI / fabs(scene->definition.rotation_rate);
        const double length = time[window->count - 1] - time[0];
        result->drift_deg_per_revolution = fit.slope * revolution;
        result->correlation_time = correlation * length / (double)(window->count - 1);
        result->steady = fabs(fit.slope * length) < 0.5 || fabs(fit.slope) < 2 * fit.slope_error;
    }
    free(time);
    free(angle);
}

dem_status measure_repose_results(const dem_scene *scene, const double *frames, size_t count, size_t width,
                                  dem_repose_result *result, frame_window *window)
{
    static const struct {
        dem_angle_method method;
        frame_column column;
    } columns[] = {
        { DEM_SURFACE_FIT, FRAME_SURFACE_FIT }, { DEM_CENTER_OF_MASS, FRAME_CENTER_OF_MASS }, { DEM_THEIL_SEN, FRAME_THEIL_SEN },
        { DEM_UPPER_CHORD, FRAME_UPPER_CHORD }, { DEM_LOWER_CHORD, FRAME_LOWER_CHORD },
    };
    const size_t start = window_start(scene, frames, count, width);
    *window = (frame_window){ frames + start * width, count - start, width };
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++)
        result->angle[columns[k].method] = angle_of_column(window, columns[k].column);
    result->angle[DEM_CHORD] = angle_of_mean_interface(scene, window, &result->interface_fluctuation);
    result->frames = window->count;
    result->window_start = window->frames[FRAME_TIME];
    result->window_end = frames[(count - 1) * width + FRAME_TIME];
    measure_drift(scene, window, result);
    return DEM_OK;
}
