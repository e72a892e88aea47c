/* What a run will take before it is run: time to make the bed, memory, cells of its fields. */
#include "dem_rules.h"

#include <math.h>

double dem_settling_time(const dem_scene_definition *d)
{
    if (d->is_placed || d->stream.rate > 0) return 0.0;
    double reach = 0.0, held = 0.0;
    bool has_clusters = false;
    for (size_t s = 0; s < d->species_count; s++) {
        const double r = dem_species_reach(&d->species[s]);
        reach = fmax(reach, r);
        held += d->species[s].share * 4.0 / 3.0 * DEM_PI * r * r * r;
        has_clusters = has_clusters || d->species[s].cluster.sphere_count > 1;
    }
    const double volume = dem_mean_volume(d->species, d->species_count), particles = (double)d->particle_count;
    const double start_scale = fmin(1.0, cbrt(0.28 / (0.5 * held / volume)));
    if (d->container != DEM_DRUM) {
        const double size = fmax(d->diameter, particles * volume / (0.5 * DEM_PI / 4.0 * d->diameter * d->diameter));
        return sqrt(size / d->gravity) * (80.0 * (1.001 - start_scale) * reach / size + 1.7);
    }
    const double across = cbrt(6.0 / DEM_PI * held) / d->diameter;
    const double rows = particles * across * d->diameter / d->length / (2.0 / sqrt(across));
    const double growing = 80.0 * (1.001 - start_scale) * reach / d->diameter;
    const double settling = (0.5 + 17.0 * across + 6.9 * exp(-rows / 0.33)) * (1.0 + 0.85 * exp(-d->contact.friction / 0.1));
    return (has_clusters ? 0.7 : 1.0) * sqrt(d->diameter / d->gravity) * (growing + settling);
}

double dem_memory_estimate(double sphere_count) { return 15.7e6 + 850.0 * sphere_count; }

double dem_field_cells(double drum_diameter, double mean_diameter, double particles)
{
    const double most = fmin(fmax(64.0, ceil(sqrt(64.0 * particles))), 512.0);
    return fmin(ceil(2.0 * drum_diameter / mean_diameter - 1e-9), most);
}
