/* How much room particles take up: how full a container can be, how many particles a fill is, how deep a bed lies. */
#include "dem_rules.h"

#include <math.h>

double dem_species_most_solid(const dem_species *s)
{
    if (s->cluster.sphere_count < 2) return DEM_MOST_SOLID;
    const double grain = dem_species_largest_sphere(s) / cbrt(6.0 / DEM_PI * s->cluster.volume);
    const double most = s->cluster.sphere_count < DEM_BLOCK_SPHERES    ? DEM_MOST_SOLID
                        : s->cluster.sphere_count == DEM_BLOCK_SPHERES ? DEM_MOST_SOLID_OF_BLOCKS
                                                                       : DEM_MOST_SOLID_OF_LARGE_BLOCKS;
    return fmin(most, 0.75 * dem_species_compactness(s) + 0.5 * fmax(grain, 0.3) - 0.13);
}

double dem_most_solid(const dem_species *species, size_t count)
{
    double volume = 0.0, solid = 0.0;
    for (size_t s = 0; s < count; s++) {
        const double share = species[s].share * dem_species_volume(&species[s]);
        volume += share;
        solid += share * dem_species_most_solid(&species[s]);
    }
    return solid / volume;
}

double dem_poured_solid(const dem_scene_definition *d)
{
    double volume = 0.0, solid = 0.0, reach = 0.0;
    for (size_t s = 0; s < d->species_count; s++) {
        const double share = d->species[s].share * dem_species_volume(&d->species[s]);
        volume += share;
        solid += share * fmin(0.58, 0.8 * dem_species_compactness(&d->species[s]));
        reach = fmax(reach, dem_species_reach(&d->species[s]));
    }
    return solid / volume * (1.0 - 0.65 * 2.0 * reach / d->diameter);
}

double dem_most_placed(const dem_scene_definition *d)
{
    return d->container == DEM_DRUM ? 0.62 / DEM_MOST_SOLID * dem_most_solid(d->species, d->species_count) : 0.5;
}

double dem_particles_of_fill(double diameter, double length, double fill_fraction, const dem_species *species, size_t count)
{
    const double bed = DEM_PI / 4.0 * diameter * diameter * length * fill_fraction;
    return floor(bed * DEM_BED_SOLID_FRACTION / dem_mean_volume(species, count) + 0.5);
}

double dem_fill_of_particles(double diameter, double length, double particles, const dem_species *species, size_t count)
{
    return particles * dem_mean_volume(species, count) / (DEM_BED_SOLID_FRACTION * DEM_PI / 4.0 * diameter * diameter * length);
}

double dem_circle_below(double y) { return (acos(-y) + y * sqrt(1 - y * y)) / DEM_PI; }

double dem_circle_level(double share)
{
    double low = -1.0, high = 1.0;
    for (int k = 0; k < 60; k++) *(dem_circle_below(0.5 * (low + high)) < share ? &low : &high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}

double dem_bed_layers(double drum_diameter, double share, double mean_diameter)
{
    return (1.0 + dem_circle_level(share)) * 0.5 * drum_diameter / mean_diameter;
}
