#include "interface.h"

#include "array.h"
#include "dem_interface.h"
#include "statistics.h"

typedef struct interface_layout {
    density_grid grid; /* of cells and their size alone */
    size_t columns, pairs;
    bool is_sparse;
} interface_layout;

static interface_layout layout_of(const dem_scene *scene)
{
    const int cells = density_grid_cells(scene);
    const size_t most = density_grid_most_columns(scene);
    return (interface_layout){ .grid = { .cells = cells, .size = scene->definition.diameter / cells },
                               .columns = (size_t)cells,
                               .pairs = most,
                               .is_sparse = 2 * most < (size_t)cells };
}

size_t interface_numbers(const dem_scene *scene)
{
    const interface_layout layout = layout_of(scene);
    return layout.is_sparse ? 2 * layout.pairs : layout.columns;
}

void interface_set(const dem_scene *scene, const surface_heights *surface, double *frame)
{
    const interface_layout layout = layout_of(scene);
    double *numbers = frame + DEM_FRAME_SCALARS;
    const size_t count = layout.is_sparse ? 2 * layout.pairs : layout.columns;
    for (size_t k = 0; k < count; k++) numbers[k] = NAN;
    for (size_t k = 0; k < surface->count; k++) {
        if (layout.is_sparse) {
            numbers[2 * k] = surface->column[k];
            numbers[2 * k + 1] = surface->height[k];
        } else {
            numbers[surface->column[k]] = surface->height[k];
        }
    }
}

static void exchange(double *a, double *b)
{
    const double kept = *a;
    *a = *b;
    *b = kept;
}

/* Columns are as far from the middle on either side. */
void interface_mirror(const dem_scene *scene, double *frame)
{
    const interface_layout layout = layout_of(scene);
    double *numbers = frame + DEM_FRAME_SCALARS;
    size_t count = layout.columns;
    if (layout.is_sparse)
        for (count = 0; count < layout.pairs && !isnan(numbers[2 * count]);) count++;
    for (size_t k = 0; k < count / 2; k++) {
        const size_t other = count - 1 - k;
        if (!layout.is_sparse) exchange(&numbers[k], &numbers[other]);
        else exchange(&numbers[2 * k], &numbers[2 * other]), exchange(&numbers[2 * k + 1], &numbers[2 * other + 1]);
    }
    for (size_t k = 0; layout.is_sparse && k < count; k++) numbers[2 * k] = (double)layout.columns - 1 - numbers[2 * k];
}

/* Pairs are ascending, and NaN behind the last. */
static double height_in_frame(const interface_layout *layout, const double *frame, size_t column)
{
    const double *numbers = frame + DEM_FRAME_SCALARS;
    if (!layout->is_sparse) return numbers[column];
    size_t first = 0, end = layout->pairs;
    while (first < end) {
        const size_t middle = first + (end - first) / 2;
        if (numbers[2 * middle] < (double)column) first = middle + 1;
        else end = middle;
    }
    return first < layout->pairs && numbers[2 * first] == (double)column ? numbers[2 * first + 1] : NAN;
}

/* Of one column in all frames: heights (window->count) m. */
static void heights_of_column(const interface_layout *layout, const frame_window *window, size_t column, double *heights)
{
    for (size_t k = 0; k < window->count; k++) heights[k] = height_in_frame(layout, window->frames + k * window->width, column);
}

double interface_chord_angle(const dem_scene *scene, const frame_window *window)
{
    const interface_layout layout = layout_of(scene);
    const double diameter = scene->definition.diameter;
    double *heights = array_create(window->count, sizeof *heights), height[2] = { NAN, NAN };
    for (int side = 0; heights && side < 2; side++) {
        const double at = (side ? 0.1 : -0.1) * diameter / layout.grid.size + 0.5 * layout.grid.cells - 0.5;
        const int a = (int)floor(at);
        if (a < 0 || a + 1 >= layout.grid.cells) continue;
        double mean[2];
        for (int k = 0; k < 2; k++) {
            heights_of_column(&layout, window, (size_t)(a + k), heights);
            mean[k] = statistics_mean(heights, window->count);
        }
        height[side] = mean[0] + (at - a) * (mean[1] - mean[0]);
    }
    free(heights);
    return atan((height[1] - height[0]) / (0.2 * diameter));
}

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Columns that have a height in any frame, ascending, each once: freed with free(); NULL: no memory. */
static int32_t *columns_in_use(const interface_layout *layout, const frame_window *window, size_t *count)
{
    const size_t most = layout->is_sparse ? layout->pairs * window->count : layout->columns;
    int32_t *column = array_create(most, sizeof *column);
    size_t n = 0, used = 0;
    for (size_t k = 0; column && !layout->is_sparse && k < most; k++) column[n++] = (int32_t)k;
    for (size_t k = 0; column && layout->is_sparse && k < most; k++) {
        const double *frame = window->frames + k / layout->pairs * window->width;
        const double one = frame[DEM_FRAME_SCALARS + 2 * (k % layout->pairs)];
        if (!isnan(one)) column[n++] = (int32_t)one;
    }
    if (column && layout->is_sparse) qsort(column, n, sizeof *column, ascending);
    for (size_t k = 0; k < n; k++)
        if (k == 0 || column[k] != column[used - 1]) column[used++] = column[k];
    *count = used;
    return column;
}

double interface_fluctuation(const dem_scene *scene, const frame_window *window, double reach)
{
    const interface_layout layout = layout_of(scene);
    size_t count;
    int32_t *column = columns_in_use(&layout, window, &count);
    double *heights = array_create(window->count, sizeof *heights), *deviation = array_create(count, sizeof *deviation);
    double mean = NAN;
    if (column && heights && deviation) {
        for (size_t k = 0; k < count; k++) {
            deviation[k] = NAN;
            if (!(fabs(density_grid_place(&layout.grid, column[k])) < reach)) continue;
            heights_of_column(&layout, window, (size_t)column[k], heights);
            deviation[k] = statistics_deviation(heights, window->count);
        }
        mean = statistics_mean(deviation, count);
    }
    free(column);
    free(heights);
    free(deviation);
    return mean;
}

/* Of the columns of the grid so many, evenly over the diameter. */
static size_t column_of_point(const interface_layout *layout, size_t point, size_t points)
{
    return (size_t)(((double)point + 0.5) / (double)points * (double)layout->columns);
}

dem_status interface_profile(const dem_scene *scene, const frame_window *window, dem_profile *profile)
{
    const interface_layout layout = layout_of(scene);
    const size_t points = layout.columns < DEM_PROFILE_POINTS ? layout.columns : DEM_PROFILE_POINTS;
    double *heights = array_create(window->count, sizeof *heights);
    if (!heights) return DEM_NO_MEMORY;
    profile->count = 0;
    for (size_t point = 0; point < points; point++) {
        const size_t column = column_of_point(&layout, point, points);
        size_t seen = 0;
        heights_of_column(&layout, window, column, heights);
        for (size_t k = 0; k < window->count; k++) seen += !isnan(heights[k]);
        if (2 * seen < window->count) continue;
        profile->place[profile->count] = density_grid_place(&layout.grid, (int)column);
        profile->value[profile->count] = statistics_mean(heights, window->count);
        profile->standard_error[profile->count++] = frame_window_error(scene, window, heights);
    }
    free(heights);
    return DEM_OK;
}

dem_status dem_drum_interface_measure(const dem_scene *scene, const double *frames, size_t count, const dem_drum_results *measured,
                                      dem_profile *interface)
{
    *interface = (dem_profile){ .count = 0 };
    if (count == 0 || isnan(measured->repose.angle[DEM_CHORD].mean_deg)) return DEM_OK;
    const frame_window all = { frames, count, dem_frame_width(scene) };
    frame_window window = frame_window_from(&all, measured->repose.window_start);
    while (window.count > 1 && window.frames[(window.count - 1) * window.width + FRAME_TIME] > measured->repose.window_end)
        window.count--;
    arrays_begin();
    return arrays_end(interface_profile(scene, &window, interface));
}
