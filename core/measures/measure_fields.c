/* Fields over the cross-section: solid fraction, velocity and its fluctuation, summed over frames on cells half a diameter
 * wide, or wider where particles are few.
 *
 * A sphere gives each cell the volume that it has in it, and counts there with the velocity of its centre. The centres
 * that a cell sees lie up to half a diameter around it, where the mean velocity is another: a cell therefore keeps the
 * moments of centres and velocities, and a plane through them gives the velocity at the cell's own centre and, as what is
 * left, the fluctuation about it. A bed that turns rigidly has omega x r, and no fluctuation, to rounding. */
#include "array.h"
#include "dem_rules.h"
#include "density_grid.h"
#include "measure.h"

/* What a cell sums up, weighted by w, the volume in it over the cell's own; x, y: of the sphere's centre from the cell's,
 * in cells. */
enum cell_sum {
    SUM_W,
    SUM_W2,
    SUM_X,
    SUM_Y,
    SUM_XX,
    SUM_XY,
    SUM_YY,
    SUM_V,       /* of three components */
    SUM_XV = 10, /* likewise */
    SUM_YV = 13, /* likewise */
    SUM_VV = 16, /* square of the velocity */
    CELL_SUMS = 17
};
/* Before the cells: frames (the table's first number, which whoever keeps it may read). */
enum { HEADER = 1 };

enum { POINTS_A_CELL = 4 };

size_t dem_fields_cells(const dem_scene *scene)
{
    return (size_t)dem_field_cells(2 * scene->container.radius, mean_diameter(scene), (double)scene->definition.particle_count);
}

size_t dem_fields_size(const dem_scene *scene)
{
    const size_t cells = dem_fields_cells(scene);
    return HEADER + cells * cells * CELL_SUMS;
}

/* The cells that a sphere covers: of each, the length of the sphere along the axis averaged over a grid of points. A sphere
 * between the points of wide cells is all in its centre's. */
typedef struct footprint {
    int first[2], count[2];
    double *share; /* (count[0], count[1]) m, room for the largest sphere */
    double sum;
} footprint;

static void footprint_of(footprint *f, const double *x, double radius, double size, int cells)
{
    for (int c = 0; c < 2; c++) {
        const int first = (int)floor((x[c] - radius) / size + 0.5 * cells), last = (int)floor((x[c] + radius) / size + 0.5 * cells);
        f->first[c] = first < 0 ? 0 : first;
        f->count[c] = (last >= cells ? cells - 1 : last) - f->first[c] + 1;
    }
    f->sum = 0.0;
    for (int a = 0; a < f->count[0]; a++)
        for (int b = 0; b < f->count[1]; b++) {
            const double left = (f->first[0] + a - 0.5 * cells) * size - x[0], low = (f->first[1] + b - 0.5 * cells) * size - x[1];
            double length = 0.0;
            for (int p = 0; p < POINTS_A_CELL * POINTS_A_CELL; p++) {
                const double u = left + (p % POINTS_A_CELL + 0.5) * size / POINTS_A_CELL;
                const double v = low + (p / POINTS_A_CELL + 0.5) * size / POINTS_A_CELL;
                length += sqrt(fmax(radius * radius - u * u - v * v, 0.0));
            }
            f->share[a * f->count[1] + b] = length;
            f->sum += length;
        }
    if (f->sum > 0) return;
    for (int c = 0; c < 2; c++) {
        const int of_centre = (int)floor(x[c] / size + 0.5 * cells);
        f->first[c] = of_centre < 0 ? 0 : of_centre < cells ? of_centre : cells - 1;
        f->count[c] = 1;
    }
    f->share[0] = f->sum = 1.0;
}

static void cell_add(double *sums, double w, double x, double y, vector4 v)
{
    sums[SUM_W] += w;
    sums[SUM_W2] += w * w;
    sums[SUM_X] += w * x;
    sums[SUM_Y] += w * y;
    sums[SUM_XX] += w * x * x;
    sums[SUM_XY] += w * x * y;
    sums[SUM_YY] += w * y * y;
    for (int c = 0; c < 3; c++) {
        sums[SUM_V + c] += w * v[c];
        sums[SUM_XV + c] += w * x * v[c];
        sums[SUM_YV + c] += w * y * v[c];
        sums[SUM_VV] += w * v[c] * v[c];
    }
}

/* Spheres that overlap in a cluster count for less, so that together they have its volume. */
static double volume_of(const dem_scene *scene, size_t i)
{
    const spheres *s = &scene->spheres;
    const double own = 4.0 / 3 * DEM_PI * pow(sphere_radius(s, i), 3);
    if (i < s->single_count) return own;
    const cluster_body *body = &s->clusters.body[particle_of_sphere(s, i) - s->single_count];
    const dem_species *species = &scene->definition.species[body->species];
    double all = 0.0;
    for (size_t m = 0; m < species->cluster.sphere_count; m++) all += DEM_PI / 6 * pow(species->cluster.sphere[m].diameter, 3);
    return own * species->cluster.volume / all;
}

static void sphere_add(const dem_scene *scene, size_t i, footprint *f, int cells, double size, double *sums)
{
    const double *x = sphere_place(&scene->spheres, i);
    footprint_of(f, x, sphere_radius(&scene->spheres, i), size, cells);
    const double weight = volume_of(scene, i) / (f->sum * size * size * scene->container.length);
    for (int a = 0; a < f->count[0]; a++)
        for (int b = 0; b < f->count[1]; b++) {
            const int column = f->first[0] + a, row = f->first[1] + b;
            const double share = f->share[a * f->count[1] + b];
            if (!(share > 0)) continue;
            cell_add(sums + ((size_t)row * (size_t)cells + (size_t)column) * CELL_SUMS, weight * share,
                     x[0] / size + 0.5 * cells - column - 0.5, x[1] / size + 0.5 * cells - row - 0.5, scene->spheres.velocity[i]);
        }
}

dem_status dem_fields_add(const dem_scene *scene, double *sums)
{
    const int cells = (int)dem_fields_cells(scene);
    const double size = 2 * scene->container.radius / cells;
    const size_t across = (size_t)(scene->spheres.largest_diameter / size) + 3;
    footprint f = { .share = array_create(across * across, sizeof *f.share) };
    if (!f.share) return DEM_NO_MEMORY;
    sums[0] += 1;
    for (size_t i = 0; i < scene->spheres.mobile_count; i++) sphere_add(scene, i, &f, cells, size, sums + HEADER);
    free(f.share);
    return DEM_OK;
}

/* ---- from sums to fields ---- */

typedef struct cell_means {
    double samples, velocity[3], temperature;
} cell_means;

/* Least values that a plane's three numbers may be taken from. */
static const double LEAST_SAMPLES = 8;

/* The plane v = v_0 + g_x x + g_y y of least squares, at x = y = 0, and what is left of the square about it: of n values a
 * plane takes three. */
static cell_means means_of_cell(const double *sums)
{
    cell_means m = { 0, { NAN, NAN, NAN }, NAN };
    const double w = sums[SUM_W];
    if (!(w > 0)) return m;
    m.samples = w * w / sums[SUM_W2];
    const double x = sums[SUM_X] / w, y = sums[SUM_Y] / w;
    const double xx = sums[SUM_XX] / w - x * x, xy = sums[SUM_XY] / w - x * y, yy = sums[SUM_YY] / w - y * y;
    const double determinant = xx * yy - xy * xy;
    const bool has_plane = m.samples >= LEAST_SAMPLES && determinant > 1e-6 * (xx + yy) * (xx + yy);
    double square = sums[SUM_VV] / w;
    for (int c = 0; c < 3; c++) {
        const double v = sums[SUM_V + c] / w;
        m.velocity[c] = v;
        square -= v * v;
        if (!has_plane) continue;
        const double xv = sums[SUM_XV + c] / w - x * v, yv = sums[SUM_YV + c] / w - y * v;
        const double g_x = (yy * xv - xy * yv) / determinant, g_y = (xx * yv - xy * xv) / determinant;
        m.velocity[c] -= g_x * x + g_y * y;
        square -= g_x * xv + g_y * yv;
    }
    if (has_plane) m.temperature = fmax(square, 0.0) / 3 * m.samples / (m.samples - 3);
    return m;
}

void dem_fields_measure(const dem_scene *scene, const double *sums, const dem_field_arrays *arrays)
{
    const size_t cells = dem_fields_cells(scene);
    for (size_t k = 0; k < cells * cells; k++) {
        const double *cell = sums + HEADER + k * CELL_SUMS;
        const cell_means m = means_of_cell(cell);
        if (arrays->solid_fraction) arrays->solid_fraction[k] = sums[0] > 0 ? cell[SUM_W] / sums[0] : NAN;
        if (arrays->velocity) memcpy(arrays->velocity + 3 * k, m.velocity, sizeof m.velocity);
        if (arrays->temperature) arrays->temperature[k] = m.temperature;
        if (arrays->samples) arrays->samples[k] = m.samples;
    }
}
