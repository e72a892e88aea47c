/* Segregation of the species by size: radial, axial, and Lacey's mixing index. */
#include "array.h"
#include "dem_rules.h"
#include "density_grid.h"
#include "measure.h"

static void size_extremes(const dem_scene *scene, int32_t *smallest, int32_t *largest)
{
    const dem_scene_definition *definition = &scene->definition;
    *smallest = *largest = 0;
    for (size_t k = 1; k < definition->species_count; k++) {
        const double volume = dem_species_volume(&definition->species[k]);
        if (volume < dem_species_volume(&definition->species[*smallest])) *smallest = (int32_t)k;
        if (volume > dem_species_volume(&definition->species[*largest])) *largest = (int32_t)k;
    }
    /* Equal sizes (species that differ by density alone): the first against the last. */
    if (*smallest == *largest) *largest = (int32_t)definition->species_count - 1;
}

/* What is compared: species, or, of one species with sizes, the thirds of its particles by size. */
typedef struct size_groups {
    bool are_thirds;
    int32_t smallest, largest;
} size_groups;

static bool are_told_apart(const dem_scene *scene) { return scene->definition.species_count > 1 || scene->spheres.have_sizes; }

static size_groups size_groups_of(const dem_scene *scene)
{
    size_groups groups = { .are_thirds = scene->definition.species_count == 1, .largest = 2 };
    if (!groups.are_thirds) size_extremes(scene, &groups.smallest, &groups.largest);
    return groups;
}

static int32_t group_of(const size_groups *groups, const spheres *s, size_t p)
{
    if (!groups->are_thirds) return particle_species(s, p);
    const double radius = (double)s->full_radius[p];
    return radius < s->small_below ? 0 : radius > s->large_from ? 2 : 1;
}

double measure_radial_index(const dem_scene *scene)
{
    if (!are_told_apart(scene)) return NAN;
    const size_groups groups = size_groups_of(scene);
    double sum[2] = { 0 }, n[2] = { 0 };
    for (size_t p = 0; p < particles_count(&scene->spheres); p++) {
        const int32_t group = group_of(&groups, &scene->spheres, p);
        if (group != groups.smallest && group != groups.largest) continue;
        const double *x = particle_place(&scene->spheres, p);
        sum[group == groups.largest] += hypot(x[0], x[1]);
        n[group == groups.largest] += 1;
    }
    return n[0] > 0 && n[1] > 0 ? (sum[1] / n[1] - sum[0] / n[0]) / scene->container.radius : NAN;
}

/* Number share of the largest in each of `cells` cells; variance between them, weighted by their particles, against
 * that of a random mixture of as many (lacey = (s0^2 - s^2)/(s0^2 - sr^2)). */
typedef struct mixing {
    double variance, random_variance, share;
} mixing;

static mixing mixing_over_cells(const int64_t *cell_of, const spheres *s, const size_groups *groups, double *count,
                                double *of_largest, size_t cells)
{
    memset(count, 0, cells * sizeof *count);
    memset(of_largest, 0, cells * sizeof *of_largest);
    double total = 0.0, total_of_largest = 0.0;
    for (size_t p = 0; p < particles_count(s); p++) {
        const bool of_it = group_of(groups, s, p) == groups->largest;
        count[cell_of[p]] += 1;
        of_largest[cell_of[p]] += of_it;
        total_of_largest += of_it;
        total += 1;
    }
    mixing m = { .share = total_of_largest / total };
    double used = 0.0;
    for (size_t c = 0; c < cells; c++) {
        if (!(count[c] > 0)) continue;
        const double deviation = of_largest[c] / count[c] - m.share;
        m.variance += count[c] * deviation * deviation / total;
        used += 1;
    }
    /* Random mixture: variance p (1-p)/n in a cell of n; weighted by n/N and summed over the cells in use. */
    m.random_variance = m.share * (1 - m.share) * used / total;
    return m;
}

/* Cells three mean diameters wide across the section; whole slices, as many as along the axis, for the axial index. */
static void assign_cells(const dem_scene *scene, bool slices, int64_t *cell_of)
{
    const double side = 3 * mean_diameter(scene), radius = scene->container.radius, length = scene->container.length;
    const int across = slices ? 1 : (int)fmax(1, ceil(2 * radius / side)), along = slices ? (int)fmax(1, floor(length / side)) : 1;
    for (size_t p = 0; p < particles_count(&scene->spheres); p++) {
        const double *x = particle_place(&scene->spheres, p);
        const int a = (int)fmin(across - 1, fmax(0, (x[0] + radius) / (2 * radius) * across));
        const int b = (int)fmin(across - 1, fmax(0, (x[1] + radius) / (2 * radius) * across));
        const int c = (int)fmin(along - 1, fmax(0, (x[2] / length + 0.5) * along));
        cell_of[p] = ((int64_t)a * across + b) * along + c;
    }
}

static int ascending(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* Numbers the cells that have particles from 0 on, in their order: a wide drum has far more that have none. sorted:
 * (particles) to work in. Returns how many there are. */
static size_t number_cells(int64_t *cell_of, int64_t *sorted, size_t particles)
{
    memcpy(sorted, cell_of, particles * sizeof *sorted);
    qsort(sorted, particles, sizeof *sorted, ascending);
    size_t cells = 0;
    for (size_t k = 0; k < particles; k++)
        if (k == 0 || sorted[k] != sorted[cells - 1]) sorted[cells++] = sorted[k];
    for (size_t p = 0; p < particles; p++) {
        const int64_t *found = bsearch(&cell_of[p], sorted, cells, sizeof *sorted, ascending);
        cell_of[p] = found - sorted;
    }
    return cells;
}

/* Standard deviation of the share between slices beyond chance, over that of complete segregation: 0 mixed, 1 not. */
static double axial_index(mixing m)
{
    return sqrt(fmax(m.variance - m.random_variance, 0.0) / (m.share * (1 - m.share) - m.random_variance));
}

static double lacey_index(mixing m)
{
    const double apart = m.share * (1 - m.share);
    return (apart - m.variance) / (apart - m.random_variance);
}

dem_status measure_segregation_results(const dem_scene *scene, dem_segregation_result *result)
{
    *result = (dem_segregation_result){ NAN, NAN, NAN };
    if (!are_told_apart(scene)) return DEM_OK;
    const size_groups groups = size_groups_of(scene);
    result->radial_index = measure_radial_index(scene);
    const size_t particles = particles_count(&scene->spheres);
    int64_t *cell_of = array_create(2 * particles, sizeof *cell_of);
    if (!cell_of) return DEM_NO_MEMORY;
    dem_status status = DEM_OK;
    for (int slices = 0; slices < 2 && status == DEM_OK; slices++) {
        assign_cells(scene, slices, cell_of);
        const size_t cells = number_cells(cell_of, cell_of + particles, particles);
        double *count = array_create(cells, sizeof *count), *of_largest = array_create(cells, sizeof *of_largest);
        if (count && of_largest) {
            const mixing m = mixing_over_cells(cell_of, &scene->spheres, &groups, count, of_largest, cells);
            *(slices ? &result->axial_index : &result->lacey_index) = slices ? axial_index(m) : lacey_index(m);
        } else {
            status = DEM_NO_MEMORY;
        }
        free(count);
        free(of_largest);
    }
    free(cell_of);
    return status;
}
