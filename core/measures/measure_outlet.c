/* Solid fraction and velocity near the orifice of a vessel, summed over the frames of its steady flow. A ball stands as points of equal
 * volume, each of which counts in the cell that it is in. */
#include <math.h>

#include "ball_points.h"
#include "dem_flow.h"
#include "dem_rules.h"
#include "drained.h"

enum { HEADER = 1 /* frames */, SUM_SOLID = 0, SUM_OUTWARD, SUM_DOWNWARD, CELL_SUMS };
enum { MOST_CELLS_A_SIDE = 64 };
static const double WIDTH = 0.75, HEIGHT = 2.0; /* in D: outward and upward, that cells are kept of */
static const double CELLS_A_GRAIN = 2;

dem_outlet_grid dem_outlet_grid_of(const dem_scene *scene, const double *sums)
{
    const double grain = cbrt(6 / DEM_PI * dem_mean_volume(scene->definition.species, scene->definition.species_count));
    const double opening = scene->definition.orifice.opening;
    dem_outlet_grid grid = { .frames = sums ? sums[0] : 0 };
    /* the orifice has a whole number of them */
    const double across = fmin(fmax(floor(0.5 * opening * CELLS_A_GRAIN / grain), 2.0), MOST_CELLS_A_SIDE / (2 * HEIGHT));
    grid.size = 0.5 * opening / across;
    grid.columns = (size_t)ceil(2 * WIDTH * across);
    grid.rows = (size_t)ceil(2 * HEIGHT * across);
    return grid;
}

size_t dem_outlet_size(const dem_scene *scene)
{
    const dem_outlet_grid grid = dem_outlet_grid_of(scene, NULL);
    return HEADER + grid.columns * grid.rows * CELL_SUMS;
}

/* Row 0 has its middle in the orifice. */
static void sphere_add(const dem_scene *scene, size_t i, const dem_outlet_grid *grid, double points[BALL_POINTS][3], double *cells)
{
    const double *x = sphere_place(&scene->spheres, i), r = sphere_radius(&scene->spheres, i);
    const vector4 v = scene->spheres.velocity[i];
    const double volume = volume_of_sphere(scene, i) / BALL_POINTS, out = distance_from_middle(scene, x);
    const double outward = scene->container.half_depth > 0 ? (x[0] < 0 ? -v[0] : v[0])
                           : out > 0                       ? (x[0] * v[0] + x[1] * v[1]) / out
                                                           : 0;
    for (int k = 0; k < BALL_POINTS; k++) {
        const double p[3] = { x[0] + r * points[k][0], x[1] + r * points[k][1], x[2] + r * points[k][2] };
        const double column = floor(distance_from_middle(scene, p) / grid->size), row = floor(p[2] / grid->size + 0.5);
        if (!(row >= 0 && row < (double)grid->rows && column < (double)grid->columns)) continue;
        double *cell = cells + ((size_t)row * grid->columns + (size_t)column) * CELL_SUMS;
        cell[SUM_SOLID] += volume;
        cell[SUM_OUTWARD] += volume * outward;
        cell[SUM_DOWNWARD] -= volume * v[2];
    }
}

void dem_outlet_add(const dem_scene *scene, const double *frame, double *sums)
{
    if (!dem_flow_is_steady(scene, frame)) return;
    double points[BALL_POINTS][3];
    ball_points(points);
    const dem_outlet_grid grid = dem_outlet_grid_of(scene, NULL);
    const double broad = (double)grid.columns * grid.size, high = (double)grid.rows * grid.size;
    sums[0] += 1;
    for (size_t i = 0; i < scene->spheres.mobile_count; i++) {
        const double *x = sphere_place(&scene->spheres, i), r = sphere_radius(&scene->spheres, i);
        if (x[2] < -grid.size - r || x[2] > high + r || distance_from_middle(scene, x) > broad + r) continue;
        sphere_add(scene, i, &grid, points, sums + HEADER);
    }
}

/* m3: a ring, or a bar on either side of the slot's middle. */
static double cell_volume(const dem_scene *scene, const dem_outlet_grid *grid, size_t column)
{
    const double size = grid->size, depth = 2 * scene->container.half_depth;
    return depth > 0 ? 2 * depth * size * size : DEM_PI * size * size * size * (2 * (double)column + 1);
}

void dem_outlet_fields(const dem_scene *scene, const double *sums, double *solid_fraction, double *outward, double *downward)
{
    const dem_outlet_grid grid = dem_outlet_grid_of(scene, sums);
    for (size_t k = 0; k < grid.rows * grid.columns; k++) {
        const double *cell = sums + HEADER + k * CELL_SUMS, solid = cell[SUM_SOLID];
        solid_fraction[k] = grid.frames > 0 ? solid / grid.frames / cell_volume(scene, &grid, k % grid.columns) : NAN;
        outward[k] = solid > 0 ? cell[SUM_OUTWARD] / solid : NAN;
        downward[k] = solid > 0 ? cell[SUM_DOWNWARD] / solid : NAN;
    }
}

void dem_outlet_profile(const dem_scene *scene, const double *sums, dem_profile *solid_fraction, dem_profile *velocity)
{
    const dem_outlet_grid grid = dem_outlet_grid_of(scene, sums);
    const size_t across = (size_t)(0.5 * scene->definition.orifice.opening / grid.size + 0.5);
    solid_fraction->count = velocity->count = grid.frames > 0 ? across : 0;
    for (size_t k = 0; k < velocity->count; k++) {
        const double *cell = sums + HEADER + k * CELL_SUMS, solid = cell[SUM_SOLID];
        velocity->place[k] = solid_fraction->place[k] = ((double)k + 0.5) * grid.size;
        solid_fraction->value[k] = solid / grid.frames / cell_volume(scene, &grid, k);
        velocity->value[k] = solid > 0 ? cell[SUM_DOWNWARD] / solid : NAN;
        velocity->standard_error[k] = solid_fraction->standard_error[k] = NAN;
    }
}
