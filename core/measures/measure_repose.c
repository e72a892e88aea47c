/* The angle of repose under every definition in use. How each is computed: core/NUMERICS.md, "Angles". */
#include "array.h"
#include "dem_rules.h"
#include "density_grid.h"
#include "interface.h"
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

static line_fit fit_between(const surface_heights *surface, double from, double to)
{
    size_t first = 0, last = surface->count;
    while (first < last && surface->place[first] < from) first++;
    while (last > first && surface->place[last - 1] > to) last--;
    return statistics_line(surface->place + first, surface->height + first, last - first, 1.0);
}

/* m, half of the fitted part of the chord at the surface's mean height, of which half is sqrt(R^2 - h^2). */
static double half_length_of(const surface_heights *surface, double drum_radius)
{
    double sum = 0.0;
    int n = 0;
    for (size_t a = 0; a < surface->count; a++)
        if (fabs(surface->place[a]) < 0.5 * drum_radius) {
            sum += surface->height[a];
            n++;
        }
    const double height = n ? fmin(fabs(sum / n), 0.9 * drum_radius) : 0.0;
    return CHORD_SHARE * sqrt(drum_radius * drum_radius - height * height);
}

/* Turns the frame until the fitted line is level; the frame's angle is then the surface's. NaN without a surface. */
static double level_frame(density_grid *grid, const dem_scene *scene, double start, double *half_length)
{
    enum { MOST_TURNS = 8 };
    double angle = start;
    for (int turn = 0; turn < MOST_TURNS; turn++) {
        density_grid_deposit(grid, scene, angle);
        density_grid_find_surface(grid);
        *half_length = half_length_of(&grid->surface, scene->container.radius);
        const line_fit fit = fit_between(&grid->surface, -*half_length, *half_length);
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

/* A bed spread over the whole wall has no surface to speak of: a ring is level in every frame. */
static bool is_ring(const dem_scene *scene)
{
    enum { SECTORS = 36 };
    const double outer = scene->container.inner_radius - mean_diameter(scene);
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

static void measure_angles(const dem_scene *scene, const int32_t *contacts, density_grid *grid, double *frame)
{
    const double center = center_of_mass_angle(&scene->spheres);
    const bool ring = is_ring(scene) || !measure_has_bed(scene);
    double half_length = 0.0;
    const double angle = ring ? NAN : level_frame(grid, scene, center, &half_length);
    if (ring) density_grid_deposit(grid, scene, 0.0); /* for the solid fraction */
    frame[FRAME_CENTER_OF_MASS] = ring ? NAN : degrees(center);
    frame[FRAME_SURFACE_FIT] = degrees(angle);
    frame[FRAME_SOLID_FRACTION] = grid->core;
    frame[FRAME_UPPER_CHORD] = frame[FRAME_LOWER_CHORD] = frame[FRAME_THEIL_SEN] = NAN;
    if (!isnan(angle)) {
        frame[FRAME_UPPER_CHORD] = degrees(grid->turned + atan(fit_between(&grid->surface, 0, half_length).slope));
        frame[FRAME_LOWER_CHORD] = degrees(grid->turned + atan(fit_between(&grid->surface, -half_length, 0).slope));
        frame[FRAME_THEIL_SEN] = degrees(theil_sen_angle(scene, contacts, angle, half_length));
    }
    density_grid_deposit(grid, scene, 0.0);
    density_grid_find_surface(grid);
    interface_set(scene, &grid->surface, frame);
    frame[FRAME_CHORD] = ring ? NAN : degrees(interface_chord_angle(scene, &(frame_window){ frame, 1, dem_frame_width(scene) }));
}

dem_status measure_repose_frame(const dem_scene *scene, const int32_t *contacts, double *frame)
{
    density_grid grid;
    dem_status status = density_grid_init(&grid, scene);
    if (status != DEM_OK) return status;
    measure_angles(scene, contacts, &grid, frame);
    if (grid.lacks_memory) status = DEM_NO_MEMORY;
    density_grid_clear(&grid);
    return status;
}

/* ---- results over the window ---- */

/* A bed that loses its surface, or has it now and then, has no angle. Where it has one most of the time, the moments without it
 * are not like those with it: another bed, of which others are missing, shows more than these tell. */
static dem_angle angle_of_column(const dem_scene *scene, const frame_window *window, size_t column)
{
    static const double LEAST_SEEN = 0.5, LEAST_SEEN_FOR_ERROR = 0.9; /* shares of the frames */
    dem_angle angle = { NAN, NAN, NAN, NAN };
    const double seen = frame_window_share_seen(window, column);
    if (seen < LEAST_SEEN) return angle;
    double *values = frame_window_column(window, column);
    if (!values) return angle;
    angle.mean_deg = statistics_mean(values, window->count);
    if (seen >= LEAST_SEEN_FOR_ERROR) angle.standard_error_deg = frame_window_error(scene, window, values);
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
    dem_angle angle = angle_of_column(scene, window, FRAME_CHORD);
    *fluctuation = NAN;
    if (!isnan(angle.mean_deg)) {
        /* The ends of the interface, where the bed meets the wall, come and go. */
        *fluctuation = interface_fluctuation(scene, window, 0.5 * CHORD_SHARE * scene->definition.diameter);
        angle.mean_deg = degrees(interface_chord_angle(scene, window));
    }
    return angle;
}

void measure_repose_results(const dem_scene *scene, const frame_window *window, dem_repose_result *result)
{
    static const struct {
        dem_angle_method method;
        frame_column column;
    } columns[] = {
        { DEM_SURFACE_FIT, FRAME_SURFACE_FIT }, { DEM_CENTER_OF_MASS, FRAME_CENTER_OF_MASS }, { DEM_THEIL_SEN, FRAME_THEIL_SEN },
        { DEM_UPPER_CHORD, FRAME_UPPER_CHORD }, { DEM_LOWER_CHORD, FRAME_LOWER_CHORD },
    };
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++)
        result->angle[columns[k].method] = angle_of_column(scene, window, columns[k].column);
    result->angle[DEM_CHORD] = angle_of_mean_interface(scene, window, &result->interface_fluctuation);
    result->frames = window->count;
    result->window_start = window->frames[FRAME_TIME];
    result->window_end = window->frames[(window->count - 1) * window->width + FRAME_TIME];
    result->window_revolutions = fabs(scene->definition.rotation_rate) * (result->window_end - result->window_start) / (2 * DEM_PI);
    result->layers = measure_layers(scene);
}
