#include "density_grid.h"

#include <assert.h>

#include "array.h"
#include "dem_rules.h"
#include "statistics.h"

enum { KERNEL_POINTS = 128, CELLS_A_DIAMETER = 4, SIZE_KERNELS = 32 };

double mean_diameter(const dem_scene *scene)
{
    return cbrt(6 / DEM_PI * dem_mean_volume(scene->definition.species, scene->definition.species_count));
}

int density_grid_cells(const dem_scene *scene)
{
    return (int)ceil(scene->definition.diameter / (mean_diameter(scene) / CELLS_A_DIAMETER));
}

double density_grid_place(const density_grid *grid, int cell) { return ((double)cell + 0.5 - 0.5 * grid->cells) * grid->size; }

enum { RINGS = 16, SPOKES = 32 };

/* Points spread evenly over a disc about the origin. */
typedef struct disc_points {
    double u[RINGS * SPOKES], v[RINGS * SPOKES]; /* m */
} disc_points;

static void disc_points_set(disc_points *disc, double diameter)
{
    for (int a = 0; a < RINGS; a++) {
        const double rho = 0.5 * diameter * sqrt((a + 0.5) / RINGS); /* rings of equal area */
        for (int b = 0; b < SPOKES; b++) {
            const double phi = 2 * DEM_PI * (b + 0.5) / SPOKES;
            disc->u[a * SPOKES + b] = rho * cos(phi);
            disc->v[a * SPOKES + b] = rho * sin(phi);
        }
    }
}

/* Length of a sphere along the axis, averaged over a disc whose centre is r from its own. */
static double kernel_value(double r, double radius, const disc_points *disc)
{
    double sum = 0.0;
    for (int k = 0; k < RINGS * SPOKES; k++) {
        const double u = r + disc->u[k], v = disc->v[k];
        sum += 2 * sqrt(fmax(radius * radius - u * u - v * v, 0.0));
    }
    return sum / (RINGS * SPOKES);
}

/* over: m, the length along the axis that the volume is spread over. */
static void kernel_fill(density_grid *grid, size_t kernel, double diameter, double over, const disc_points *disc)
{
    for (int p = 0; p < KERNEL_POINTS; p++)
        grid->kernel[kernel * KERNEL_POINTS + (size_t)p] =
            kernel_value(grid->reach * p / (KERNEL_POINTS - 1), 0.5 * diameter, disc) / over;
}

/* Of SIZE_KERNELS classes of the diameters that a species can have, as wide as each other by ratio, the one that a diameter is in. */
static int size_class(const dem_sizes *sizes, double diameter)
{
    const double at = log(diameter / sizes->minimum) / log(sizes->maximum / sizes->minimum) * SIZE_KERNELS;
    return (int)fmin(fmax(at, 0), SIZE_KERNELS - 1);
}

/* The middle of each class. Returns how many kernels are in use then. */
static size_t size_kernels(density_grid *grid, const dem_scene_definition *definition, const dem_sizes *sizes, size_t used,
                           const disc_points *disc)
{
    for (int c = 0; c < SIZE_KERNELS; c++) {
        const double middle = sizes->minimum * pow(sizes->maximum / sizes->minimum, (c + 0.5) / SIZE_KERNELS);
        kernel_fill(grid, used++, middle, definition->length, disc);
    }
    return used;
}

/* One kernel for each diameter that a species' spheres have. Spheres that overlap in a cluster count for less, so that
 * together they have its volume. Returns how many kernels are in use then. */
static size_t species_kernels(density_grid *grid, const dem_scene_definition *definition, size_t k, size_t used,
                              const disc_points *disc)
{
    const dem_species *species = &definition->species[k];
    const dem_cluster *cluster = &species->cluster;
    int32_t *of = grid->kernel_of + k * DEM_MAXIMUM_CLUSTER;
    if (species->sizes.law) {
        of[0] = (int32_t)used;
        return size_kernels(grid, definition, &species->sizes, used, disc);
    }
    if (cluster->sphere_count == 0) {
        kernel_fill(grid, used, species->diameter, definition->length, disc);
        of[0] = (int32_t)used;
        return used + 1;
    }
    double volume = 0.0;
    for (size_t m = 0; m < cluster->sphere_count; m++) volume += dem_sphere_mass(cluster->sphere[m].diameter, 1.0);
    for (size_t m = 0; m < cluster->sphere_count; m++) {
        size_t like = 0;
        while (cluster->sphere[like].diameter != cluster->sphere[m].diameter) like++;
        of[m] = like < m ? of[like] : (int32_t)used;
        if (like == m) kernel_fill(grid, used++, cluster->sphere[m].diameter, definition->length * volume / cluster->volume, disc);
    }
    return used;
}

dem_status density_grid_init(density_grid *grid, const dem_scene *scene)
{
    const dem_scene_definition *definition = &scene->definition;
    const double spread = mean_diameter(scene);
    size_t most = definition->species_count;
    for (size_t k = 0; k < definition->species_count; k++)
        most += definition->species[k].sizes.law ? SIZE_KERNELS : definition->species[k].cluster.sphere_count;
    memset(grid, 0, sizeof *grid);
    grid->cells = density_grid_cells(scene);
    grid->size = definition->diameter / grid->cells;
    grid->reach = 0.5 * (scene->spheres.largest_diameter + spread);
    grid->kernel = array_create(most * KERNEL_POINTS, sizeof *grid->kernel);
    grid->kernel_of = array_create(definition->species_count * DEM_MAXIMUM_CLUSTER, sizeof *grid->kernel_of);
    if (!grid->kernel || !grid->kernel_of) {
        density_grid_clear(grid);
        return DEM_NO_MEMORY;
    }
    size_t used = 0;
    disc_points disc;
    disc_points_set(&disc, spread);
    for (size_t k = 0; k < definition->species_count; k++) used = species_kernels(grid, definition, k, used, &disc);
    return DEM_OK;
}

void density_grid_clear(density_grid *grid)
{
    free(grid->tile);
    free(grid->slot);
    free(grid->order);
    free(grid->surface.column);
    free(grid->surface.place);
    free(grid->surface.height);
    free(grid->kernel);
    free(grid->kernel_of);
    memset(grid, 0, sizeof *grid);
}

/* ---- tiles ---- */

static size_t slot_of(const density_grid *grid, int32_t column, int32_t row)
{
    const uint64_t mixed = ((uint64_t)(uint32_t)column << 32 | (uint32_t)row) * UINT64_C(0x9e3779b97f4a7c15);
    size_t at = (size_t)(mixed >> 32) & (grid->slot_count - 1);
    for (; grid->slot[at] >= 0; at = (at + 1) & (grid->slot_count - 1)) {
        const density_tile *tile = &grid->tile[grid->slot[at]];
        if (tile->column == column && tile->row == row) break;
    }
    return at;
}

/* Room for twice as many tiles, of which a quarter of the slots are used. */
static bool more_tiles(density_grid *grid)
{
    const size_t capacity = grid->tile_capacity ? 2 * grid->tile_capacity : 64;
    density_tile *tile = realloc(grid->tile, capacity * sizeof *tile);
    if (tile) grid->tile = tile;
    int32_t *slot = realloc(grid->slot, 4 * capacity * sizeof *slot);
    if (slot) grid->slot = slot;
    if (!tile || !slot) {
        arrays_refused();
        return false;
    }
    grid->tile_capacity = capacity;
    grid->slot_count = 4 * capacity;
    memset(grid->slot, 0xff, grid->slot_count * sizeof *slot);
    for (size_t k = 0; k < grid->tile_count; k++) grid->slot[slot_of(grid, grid->tile[k].column, grid->tile[k].row)] = (int32_t)k;
    return true;
}

/* The tile there, made if need be; NULL: no memory. */
static density_tile *tile_at(density_grid *grid, int32_t column, int32_t row)
{
    if (grid->tile_count == grid->tile_capacity && !more_tiles(grid)) return NULL;
    assert(grid->slot);
    const size_t at = slot_of(grid, column, row);
    if (grid->slot[at] >= 0) return &grid->tile[grid->slot[at]];
    grid->slot[at] = (int32_t)grid->tile_count;
    density_tile *tile = &grid->tile[grid->tile_count++];
    memset(tile, 0, sizeof *tile);
    tile->column = column;
    tile->row = row;
    return tile;
}

/* ---- from spheres to a density ---- */

static int bounded(int cell, int cells) { return cell < 0 ? 0 : cell > cells ? cells : cell; }

/* A sphere at (s, h) and the cells of the grid, from..to-1 along either, that its volume is spread over. */
typedef struct deposit {
    double s, h;
    const double *kernel;
    int from[2], to[2];
} deposit;

static void deposit_in_tile(const density_grid *grid, density_tile *tile, const deposit *d)
{
    const int s_0 = tile->column * TILE_CELLS, h_0 = tile->row * TILE_CELLS;
    const int s_from = d->from[0] > s_0 ? d->from[0] : s_0, s_to = d->to[0] < s_0 + TILE_CELLS ? d->to[0] : s_0 + TILE_CELLS;
    const int h_from = d->from[1] > h_0 ? d->from[1] : h_0, h_to = d->to[1] < h_0 + TILE_CELLS ? d->to[1] : h_0 + TILE_CELLS;
    const double points = (KERNEL_POINTS - 1) / grid->reach;
    for (int a = s_from; a < s_to; a++) {
        const double ds = density_grid_place(grid, a) - d->s;
        float *value = tile->value + (a - s_0) * TILE_CELLS;
        for (int b = h_from; b < h_to; b++) {
            const double dh = density_grid_place(grid, b) - d->h;
            const double at = sqrt(ds * ds + dh * dh) * points;
            if (at < KERNEL_POINTS - 1) value[b - h_0] += (float)d->kernel[(int)(at + 0.5)];
        }
    }
}

static void deposit_one(density_grid *grid, double s, double h, const double *kernel)
{
    const double half = 0.5 * grid->cells, inverse = 1 / grid->size;
    deposit d = { .s = s, .h = h, .kernel = kernel };
    for (int axis = 0; axis < 2; axis++) {
        const double at = axis == 0 ? s : h;
        d.from[axis] = bounded((int)floor((at - grid->reach) * inverse + half), grid->cells);
        d.to[axis] = bounded((int)ceil((at + grid->reach) * inverse + half), grid->cells);
        if (d.from[axis] >= d.to[axis]) return;
    }
    for (int column = d.from[0] / TILE_CELLS; column <= (d.to[0] - 1) / TILE_CELLS; column++)
        for (int row = d.from[1] / TILE_CELLS; row <= (d.to[1] - 1) / TILE_CELLS; row++) {
            density_tile *tile = tile_at(grid, column, row);
            if (tile) deposit_in_tile(grid, tile, &d);
            else grid->lacks_memory = true;
        }
}

/* Median, over cells above half of the densest, by counting: a bed has far more cells than values matter. */
static double core_value(const density_grid *grid)
{
    enum { BINS = 1024, CELLS = TILE_CELLS * TILE_CELLS };
    size_t count[BINS] = { 0 }, above = 0;
    float densest = 0;
    for (size_t t = 0; t < grid->tile_count; t++)
        for (int k = 0; k < CELLS; k++) densest = fmaxf(densest, grid->tile[t].value[k]);
    if (!(densest > 0)) return 0.0;
    for (size_t t = 0; t < grid->tile_count; t++)
        for (int k = 0; k < CELLS; k++) {
            const float value = grid->tile[t].value[k];
            if (!(value > 0.5f * densest)) continue;
            count[(int)fminf(BINS - 1, value / densest * BINS)]++;
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
    grid->tile_count = 0;
    if (grid->slot) memset(grid->slot, 0xff, grid->slot_count * sizeof *grid->slot);
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double *x = sphere_place(s, i);
        const size_t of_body =
            i < s->single_count ? 0 : i - (size_t)s->clusters.body[particle_of_sphere(s, i) - s->single_count].first_sphere;
        const dem_sizes *sizes = &scene->definition.species[s->species[i]].sizes;
        const int32_t kernel = grid->kernel_of[(size_t)s->species[i] * DEM_MAXIMUM_CLUSTER + of_body]
                               + (sizes->law ? size_class(sizes, 2 * sphere_radius(s, i)) : 0);
        deposit_one(grid, c * x[0] + sine * x[1], c * x[1] - sine * x[0], grid->kernel + kernel * KERNEL_POINTS);
    }
    grid->core = core_value(grid);
}

/* ---- from a density to its surface ---- */

size_t density_grid_most_columns(const dem_scene *scene)
{
    const double size = scene->definition.diameter / density_grid_cells(scene);
    const double reach = 0.5 * (scene->spheres.largest_diameter + mean_diameter(scene));
    return scene->spheres.mobile_count * (size_t)ceil(2 * reach / size + 2);
}

static int by_place(const void *a, const void *b)
{
    const tile_place *x = a, *y = b;
    return x->column != y->column ? (x->column > y->column) - (x->column < y->column) : (x->row > y->row) - (x->row < y->row);
}

/* Room for the order of the tiles, and for a height in each column of them. */
static bool prepare_surface(density_grid *grid)
{
    surface_heights *surface = &grid->surface;
    surface->count = 0;
    const size_t columns = grid->tile_count * TILE_CELLS;
    if (columns > surface->capacity) {
        free(grid->order);
        free(surface->column);
        free(surface->place);
        free(surface->height);
        grid->order = array_create(grid->tile_count, sizeof *grid->order);
        surface->column = array_create(columns, sizeof *surface->column);
        surface->place = array_create(columns, sizeof *surface->place);
        surface->height = array_create(columns, sizeof *surface->height);
        surface->capacity = grid->order && surface->column && surface->place && surface->height ? columns : 0;
        if (!surface->capacity) return false;
    }
    for (size_t k = 0; k < grid->tile_count; k++)
        grid->order[k] = (tile_place){ grid->tile[k].column, grid->tile[k].row, (int32_t)k };
    qsort(grid->order, grid->tile_count, sizeof *grid->order, by_place);
    return true;
}

/* The height in one column of `count` tiles that stand over each other, with gaps in which nothing is; NaN: none. */
static double height_of_column(const density_grid *grid, const tile_place *places, size_t count, int column)
{
    const double half = 0.5 * grid->core;
    double below = 0, above = 0;
    int32_t row = -1; /* the one that was looked at last; from the bed up, once it was found */
    bool found = false, fallen = false;
    for (size_t t = 0; t < count && !fallen; t++) {
        const density_tile *tile = &grid->tile[places[t].tile];
        const float *value = tile->value + column * TILE_CELLS;
        if (found && tile->row * TILE_CELLS != row + 1) break;
        for (int b = 0; b < TILE_CELLS && !fallen; b++) {
            above = (double)value[b];
            row = tile->row * TILE_CELLS + b;
            fallen = found && !(above >= half);
            if (fallen) break;
            found = above >= half;
            below = above;
        }
    }
    if (found && !fallen) {
        above = 0;
        row++;
    }
    if (!found || row >= grid->cells || !(half > 0)) return NAN;
    return density_grid_place(grid, row - 1) + grid->size * (below - half) / (below - above);
}

void density_grid_find_surface(density_grid *grid)
{
    surface_heights *surface = &grid->surface;
    if (grid->lacks_memory || !prepare_surface(grid)) {
        surface->count = 0;
        grid->lacks_memory = true;
        return;
    }
    for (size_t first = 0, end = 0; first < grid->tile_count; first = end) {
        const int32_t tiles = grid->order[first].column;
        while (end < grid->tile_count && grid->order[end].column == tiles) end++;
        for (int a = 0; a < TILE_CELLS; a++) {
            const double height = height_of_column(grid, grid->order + first, end - first, a);
            if (isnan(height)) continue;
            const int32_t column = tiles * TILE_CELLS + a;
            surface->column[surface->count] = column;
            surface->place[surface->count] = density_grid_place(grid, column);
            surface->height[surface->count++] = height;
        }
    }
}
