/* What a run will take before it is run: time to make the bed, memory, cells of its fields. */
#include "dem_rules.h"

#include <math.h>

/* What the spheres that hold the particles come to. */
typedef struct holding {
    double reach, volume; /* m, of the largest; m3, of one in the mean */
} holding;

static holding holding_of(const dem_scene_definition *d)
{
    holding h = { 0.0, 0.0 };
    for (size_t s = 0; s < d->species_count; s++) {
        const double r = dem_species_reach(&d->species[s]);
        h.reach = fmax(h.reach, r);
        h.volume +=
            d->species[s].share * (d->species[s].sizes.law ? dem_species_volume(&d->species[s]) : 4.0 / 3.0 * DEM_PI * r * r * r);
    }
    return h;
}

/* Diameter of such a sphere over the drum's. */
static double width_across(const dem_scene_definition *d, const holding *h) { return cbrt(6.0 / DEM_PI * h->volume) / d->diameter; }

/* How many of the rows there are that the random start has room for in a cross-section. */
static double rows_of(const dem_scene_definition *d, double across)
{
    return (double)d->particle_count * across * d->diameter / d->length / (2.0 / sqrt(across));
}

double dem_settling_time(const dem_scene_definition *d)
{
    if (d->is_placed || d->stream.rate > 0) return 0.0;
    const holding h = holding_of(d);
    const double volume = dem_mean_volume(d->species, d->species_count), particles = (double)d->particle_count;
    const double start_scale = fmin(1.0, cbrt(0.28 / (0.5 * h.volume / volume)));
    if (d->container != DEM_DRUM) {
        const double size = fmax(d->diameter, particles * volume / (0.5 * DEM_PI / 4.0 * d->diameter * d->diameter));
        return sqrt(size / d->gravity) * (80.0 * (1.001 - start_scale) * h.reach / size + 1.7);
    }
    const double across = width_across(d, &h), rows = rows_of(d, across);
    const double growing = 80.0 * (1.001 - start_scale) * h.reach / d->diameter;
    const double settling = (0.5 + 17.0 * across + 6.9 * exp(-rows / 0.33)) * (1.0 + 0.85 * exp(-d->contact.friction / 0.1));
    return (dem_has_clusters(d->species, d->species_count) ? 0.7 : 1.0) * sqrt(d->diameter / d->gravity) * (growing + settling);
}

dem_range dem_settling_range(const dem_scene_definition *d)
{
    static const double MANY_ROWS = 5.0;
    static const dem_range of_many = { 0.7, 1.6 }, of_few = { 0.5, 1.9 };
    const holding h = holding_of(d);
    return rows_of(d, width_across(d, &h)) >= MANY_ROWS ? of_many : of_few;
}

double dem_memory_estimate(double sphere_count) { return 15.7e6 + 850.0 * sphere_count; }

double dem_field_cells(double drum_diameter, double mean_diameter, double particles)
{
    const double most = fmin(fmax(64.0, ceil(sqrt(64.0 * particles))), 512.0);
    return fmin(ceil(2.0 * drum_diameter / mean_diameter - 1e-9), most);
}
