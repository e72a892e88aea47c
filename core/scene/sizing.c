#include "sizing.h"

#include "array.h"
#include "dem_sizes.h"
#include "random.h"

/* Of the diameters that a species can have, as far as one that came through single precision may be off. */
static const double ROUNDED = 1e-6;

static bool is_sized(const spheres *s, size_t i) { return s->have_sizes && (size_t)s->kind[i] >= s->species_count; }

/* The mass is that of the radius as contacts have it, which is what is saved. */
static void set_radius(spheres *s, size_t i, double density, real radius)
{
    const double r = (double)radius, mass = dem_sphere_mass(2 * r, density);
    s->full_radius[i] = radius;
    s->inverse_mass[s->kind[i]] = 1.0 / mass;
    s->inverse_inertia[s->kind[i]] = 1.0 / (0.4 * mass * r * r);
}

static int ascending(const void *a, const void *b)
{
    const real x = *(const real *)a, y = *(const real *)b;
    return (x > y) - (x < y);
}

static dem_status set_thirds(spheres *s)
{
    const size_t n = s->single_count;
    real *radius = array_create(n, sizeof *radius);
    if (!radius) return DEM_NO_MEMORY;
    memcpy(radius, s->full_radius, n * sizeof *radius);
    qsort(radius, n, sizeof *radius, ascending);
    s->small_below = (double)radius[n / 3];
    s->large_from = (double)radius[n - 1 - n / 3];
    free(radius);
    return DEM_OK;
}

dem_status sizing_complete(spheres *s, const dem_scene_definition *definition)
{
    s->smallest_diameter = INFINITY;
    s->largest_diameter = s->largest_reach = 0;
    for (size_t i = 0; i < s->mobile_count; i++) {
        s->smallest_diameter = fmin(s->smallest_diameter, 2 * s->full_radius[i]);
        s->largest_diameter = fmax(s->largest_diameter, 2 * s->full_radius[i]);
    }
    for (size_t p = 0; p < particles_count(s); p++) s->largest_reach = fmax(s->largest_reach, particle_reach(s, p));
    return s->have_sizes && definition->species_count == 1 ? set_thirds(s) : DEM_OK;
}

static void shuffle(double *diameter, size_t count, uint64_t seed)
{
    random_stream random;
    random_seed(&random, seed);
    for (size_t i = count; i > 1; i--) { /* Fisher & Yates */
        const size_t j = (size_t)(random_uniform(&random) * (double)i);
        const double swapped = diameter[i - 1];
        diameter[i - 1] = diameter[j];
        diameter[j] = swapped;
    }
}

static dem_status draw_species(spheres *s, const dem_scene_definition *definition, size_t k)
{
    const dem_species *species = &definition->species[k];
    const size_t count = species_particles(definition, k);
    dem_size_table *table = array_create(1, sizeof *table);
    double *diameter = array_create(count, sizeof *diameter);
    if (table && diameter) {
        dem_size_table_set(table, &species->sizes);
        dem_size_table_draw(table, count, diameter);
        shuffle(diameter, count, definition->seed ^ (UINT64_C(0xd1b54a32d192ed03) * (k + 1)));
        for (size_t i = 0, next = 0; i < s->single_count; i++) {
            if (s->species[i] != (int32_t)k) continue;
            s->kind[i] = kind_of_id(s, (size_t)s->id[i]);
            set_radius(s, i, species->density, (real)(0.5 * diameter[next++]));
        }
    }
    const bool enough = table && diameter;
    free(table);
    free(diameter);
    return enough ? DEM_OK : DEM_NO_MEMORY;
}

dem_status sizing_draw(spheres *s, const dem_scene_definition *definition)
{
    dem_status status = DEM_OK;
    for (size_t k = 0; s->have_sizes && k < definition->species_count && status == DEM_OK; k++)
        if (definition->species[k].sizes.law != DEM_ONE_SIZE) status = draw_species(s, definition, k);
    return status;
}

bool sizing_fits(const spheres *s, const dem_scene_definition *definition, const double *radius)
{
    bool fits = true;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const dem_sizes *sizes = &definition->species[s->species[i]].sizes;
        const double d = 2 * radius[i];
        fits = fits && (!is_sized(s, i) || (d >= sizes->minimum * (1 - ROUNDED) && d <= sizes->maximum * (1 + ROUNDED)));
    }
    return fits;
}

dem_status sizing_restore(dem_scene *scene, const double *radius)
{
    spheres *s = &scene->spheres;
    bool changed = false;
    for (size_t i = 0; i < s->mobile_count; i++) {
        if (!is_sized(s, i) || s->full_radius[i] == (real)radius[i]) continue;
        set_radius(s, i, scene->definition.species[s->species[i]].density, (real)radius[i]);
        changed = true;
    }
    if (!changed) return DEM_OK;
    const dem_status status = sizing_complete(s, &scene->definition);
    if (status == DEM_OK) neighbor_list_sizes_changed(&scene->neighbors, s);
    return status;
}

/* A single sphere, and where it is in memory. */
typedef struct sized {
    real radius;
    int32_t at;
} sized;

static int largest_first(const void *a, const void *b)
{
    const sized *x = a, *y = b;
    return x->radius != y->radius ? (x->radius < y->radius) - (x->radius > y->radius) : (x->at > y->at) - (x->at < y->at);
}

int32_t *sizing_order(const spheres *s)
{
    const size_t n = particles_count(s);
    int32_t *order = array_create(n, sizeof *order);
    sized *all = array_create(n, sizeof *all);
    for (size_t p = 0; order && all && p < n; p++) all[p] = (sized){ (real)particle_reach(s, p), (int32_t)p };
    if (order && all) qsort(all, n, sizeof *all, largest_first);
    for (size_t p = 0; order && all && p < n; p++) order[p] = all[p].at;
    if (!all) {
        free(order);
        order = NULL;
    }
    free(all);
    return order;
}
