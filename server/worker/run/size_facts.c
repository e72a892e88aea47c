#include "size_facts.h"

#include <math.h>
#include <stdlib.h>

#include "dem_rules.h"
#include "size_rules.h"

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The diameters of the particles whose species has sizes, ascending, for free(); NULL: no memory. */
static double *sizes_of(const dem_scene_definition *definition, const dem_scene *scene, size_t *count)
{
    const size_t n = dem_scene_sphere_count(scene);
    double *diameter = malloc((n ? n : 1) * sizeof *diameter);
    int32_t *species = malloc((n ? n : 1) * sizeof *species);
    *count = 0;
    if (diameter && species) {
        dem_scene_particles(scene, &(dem_particle_arrays){ .radius = diameter, .species = species });
        for (size_t i = 0; i < n; i++)
            if (definition->species[species[i]].sizes.law) diameter[(*count)++] = 2.0 * diameter[i];
        qsort(diameter, *count, sizeof *diameter, ascending);
    }
    free(species);
    return diameter;
}

static double weight_of(double diameter, int power) { return power ? diameter * diameter * diameter : 1.0; }

/* The size that `share` of the particles by number (power 0), or of their volume (3), is smaller than: half of each particle counts
 * as smaller than itself, and it goes in straight lines from one to the next. */
static double percentile(const double *diameter, size_t count, int power, double share)
{
    double all = 0.0, below = 0.0, before = 0.0;
    for (size_t k = 0; k < count; k++) all += weight_of(diameter[k], power);
    for (size_t k = 0; k < count; k++) {
        const double weight = weight_of(diameter[k], power), at = (below + 0.5 * weight) / all;
        if (at >= share) return k == 0 ? diameter[0] : diameter[k] - (diameter[k] - diameter[k - 1]) * (at - share) / (at - before);
        before = at;
        below += weight;
    }
    return count ? diameter[count - 1] : NAN;
}

static double sauter_mean(const double *diameter, size_t count)
{
    double area = 0.0, volume = 0.0;
    for (size_t k = 0; k < count; k++) {
        area += diameter[k] * diameter[k];
        volume += diameter[k] * diameter[k] * diameter[k];
    }
    return volume / area;
}

void size_facts_measure(const job_spec *spec, const dem_scene *scene, run_facts *facts)
{
    const dem_scene_definition *definition = &spec->scene;
    size_t count = 0;
    double *d = dem_have_sizes(definition->species, definition->species_count) ? sizes_of(definition, scene, &count) : NULL;
    double none = NAN;
    const double *at = count ? d : &none;
    const size_t last = count ? count - 1 : 0;
    facts->sizes.d10 = percentile(d, count, 3, 0.1);
    facts->sizes.d50 = percentile(d, count, 3, 0.5);
    facts->sizes.d90 = percentile(d, count, 3, 0.9);
    facts->sizes.number_d10 = percentile(d, count, 0, 0.1);
    facts->sizes.number_d50 = percentile(d, count, 0, 0.5);
    facts->sizes.number_d90 = percentile(d, count, 0, 0.9);
    facts->sizes.sauter_mean = sauter_mean(d, count);
    facts->sizes.smallest = at[0];
    facts->sizes.largest = at[last];
    facts->sizes.cut_off_below = facts->sizes.cut_off_above = NAN;
    for (size_t s = 0; s < definition->species_count; s++) {
        const dem_sizes *sizes = &definition->species[s].sizes;
        if (!sizes->law) continue;
        facts->sizes.cut_off_below = fmax(facts->sizes.cut_off_below, sizes_cut_below(sizes)); /* fmax passes over NaN */
        facts->sizes.cut_off_above = fmax(facts->sizes.cut_off_above, sizes_cut_above(sizes));
    }
    free(d);
}
