#include "density_grid.h"

#include "dem_rules.h"
#include "statistics.h"

enum { KERNEL_POINTS = 128, CELLS_A_DIAMETER = 4 };

double mean_diameter(const dem_scene *scene)
{
    return cbrt(6 / DEM_PI * dem_mean_volume(scene->definition.species, scene->definition.species_count));
}

int density_grid_cells(const dem_scene *scene)
{
    return (int)ceil(scene->definition.diameter / (mean_diameter(scene) / CELLS_A_DIAMETER));
}

double density_grid_place(const density_grid *grid, int cell) { return ((double)cell + 0.5 - 0.5 * grid->cells) * grid->size; }

/* Length of a sphere along the axis, averaged over a disc of diameter `spread` whose centre is r from its own. */
static double kernel_value(double r, double radius, double spread)
{
    enum { RINGS = 16, SPOKES = 32 };
    double sum = 0.0;
    for (int a = 0; a < RINGS; a++) {
        const double rho = 0.5 * spread * sqrt((a + 0.5) / RINGS); /* rings of equal area */
        for (int b = 0; b < SPOKES; b++) {
            const double phi = 2 * DEM_PI * (b + 0.5) / SPOKES;
            const double u = r + rho * cos(phi), v = rho * sin(phi);
            sum += 2 * sqrt(fmax(radius * radius - u * u - v * v, 0.0));
        }
    }
    return sum / (RINGS * SPOKES);
}

/* over: m, the length along the axis that the volume is spread over. */
static void kernel_fill(density_grid *grid, size_t kernel, double diameter, double over, double spread)
{
    for (int p = 0; p < KERNEL_POINTS; p++)
        grid->kernel[kernel * KERNEL_POINTS + (size_t)p] =
            kernel_value(grid->reach * p / (KERNEL_POINTS - 1), 0.5 * diameter, spread) / over;
}

/* One kernel for each diameter that a species' spheres have. Spheres that overlap in a cluster count for less, so that
 * together they have its volume. Returns how many kernels are in use then. */
static size_t species_kernels(density_grid *grid, const dem_drum_definition *definition, size_t k, size_t used, double spread)
{
    const dem_species *species = &definition->species[k];
    const dem_cluster *cluster = &species->cluster;
    int32_t *of = grid->kernel_of + k * DEM_MAXIMUM_CLUSTER;
    if (cluster->sphere_count == 0) {
        kernel_fill(grid, used, species->diameter, definition->length, spread);
        of[0] = (int32_t)used;
        return used + 1;
    }
    double volume = 0.0;
    for (size_t m = 0; m < cluster->sphere_count; m++) volume += dem_sphere_mass(cluster->sphere[m].diameter, 1.0);
    for (size_t m = 0; m < cluster->sphere_count; m++) {
        size_t like = 0;
        while (cluster->sphere[like].diameter != cluster->sphere[m].diameter) like++;
        of[m] = like < m ? of[like] : (int32_t)used;
        if (like == m)
            kernel_fill(grid, used++, cluster->sphere[m].diameter, definition->length * volume / cluster->volume, spread);
    }
    return used;
}

dem_status density_grid_init(density_grid *grid, const dem_scene *scene)
{
    const dem_drum_definition *definition = &scene->definition;
    const double spread = mean_diameter(scene);
    size_t most = definition->species_count;
    for (size_t k = 0; k < definition->species_count; k++) most += definition->species[k].cluster.sphere_count;
    memset(grid, 0, sizeof *grid);
    grid->cells = density_grid_cells(scene);
    grid->size = definition->diameter / grid->cells;
    grid->reach = 0.5 * (scene->spheres.largest_diameter + spread);
    grid->value = array_create((size_t)grid->cells * (size_t)grid->cells, sizeof *grid->value);
    grid->kernel = array_create(most * KERNEL_POINTS, sizeof *grid->kernel);
    grid->kernel_of = array_create(definition->species_count * DEM_MAXIMUM_CLUSTER, sizeof *grid->kernel_of);
    if (!grid->value || !grid->kernel || !grid->kernel_of) {
        density_grid_clear(grid);
        return DEM_NO_MEMORY;
    }
    size_t used = 0;
    for (size_t k = 0; k < definition->species_count; k++) used = species_kernels(grid, definition, k, used, spread);
    return DEM_OK;
}

void density_grid_clear(density_grid *grid)
{
    free(grid->value);
    free(grid->kernel);
    free(grid->kernel_of);
    memset(grid, 0, sizeof *grid);
}

static int bounded(int cell, int cells) { return cell < 0 ? 0 : cell > cells ? cells : cell; }

static void deposit_one(density_grid *grid, double s, double h, const double *kernel)
{
    const double half = 0.5 * grid->cells, inverse = 1 / grid->size, points = (KERNEL_POINTS - 1) / grid->reach;
    const int s0 = bounded((int)floor((s - grid->reach) * inverse + half), grid->cells);
    const int s1 = bounded((int)ceil((s + grid->reach) * inverse + half), grid->cells);
    const int h0 = bounded((int)floor((h - grid->reach) * inverse + half), grid->cells);
    const int h1 = bounded((int)ceil((h + grid->reach) * inverse + half), grid->cells);
    for (int a = s0; a < s1; a++) {
        const double ds = density_grid_place(grid, a) - s;
        for (int b = h0; b < h1; b++) {
            const double dh = density_grid_place(grid, b) - h;
            const double at = sqrt(ds * ds + dh * dh) * points;
            if (at < KERNEL_POINTS - 1) grid->value[a * grid->cells + b] += (float)kernel[(int)(at + 0.5)];
        }
    }
}

/* Median, over cells above half of the densest, by counting: a bed has far more cells than values matter. */
static double core_value(const density_grid *grid)
{
    enum { BINS = 1024 };
    const size_t n = (size_t)grid->cells * (size_t)grid->cells;
    size_t count[BINS] = { 0 }, above = 0;
    float densest = 0;
    for (size_t k = 0; k < n; k++) densest = fmaxf(densest, grid->value[k]);
    if (!(densest > 0)) return 0.0;
    for (size_t k = 0; k < n; k++)
        if (grid->value[k] > 0.5f * densest) {
            count[(int)fminf(BINS - 1, grid->value[k] / densest * BINS)]++;
            above++;
        }
    size_t passed = 0;
    int bin = 0;
    while (bin < BINS - 1 && (passed += count[bin]) * 2 < above) bin++;
    return (bin + 0.5) / BINS * (double)densest;
}

void density_grid_deposit(density_grid *grid, const dem_scene *scene, double turned)
{
    const spheres *s = &scene->spheres;
    const double c = cos(turned), sine = sin(turned);
    grid->turned = turned;
    memset(grid->value, 0, (size_t)grid->cells * (size_t)grid->cells * sizeof *grid->value);
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double *x = sphere_place(s, i);
        const size_t of_body =
            i < s->single_count ? 0 : i - (size_t)s->clusters.body[particle_of_sphere(s, i) - s->single_count].first_sphere;
        const int32_t kernel = grid->kernel_of[(size_t)s->species[i] * DEM_MAXIMUM_CLUSTER + of_body];
        deposit_one(grid, c * x[0] + sine * x[1], c * x[1] - sine * x[0], grid->kernel + kernel * KERNEL_POINTS);
    }
    grid->core = core_value(grid);
}

void density_grid_heights(const density_grid *grid, double *heights)
{
    const double half = 0.5 * grid->core;
    for (int a = 0; a < grid->cells; a++) {
        const float *column = grid->value + (size_t)a * (size_t)grid->cells;
        int b = 0;
        while (b < grid->cells && !((double)column[b] >= half)) b++;
        while (b < grid->cells && (double)column[b] >= half) b++;
        heights[a] = NAN;
        if (b == 0 || b == grid->cells || !(half > 0)) continue;
        const double below = (double)column[b - 1], above = (double)column[b];
        heights[a] = density_grid_place(grid, b - 1) + grid->size * (below - half) / (below - above);
    }
}
