/* The stream that fills a cylinder: where its inlet is, how fast particles enter, and how many of them it lets through. */
#include "dem_stream.h"

#include <math.h>

double dem_stream_widest(const dem_scene_definition *d)
{
    double reach = 0.0;
    for (size_t s = 0; s < d->species_count; s++) reach = fmax(reach, dem_species_reach(&d->species[s]));
    return 2.0 * reach;
}

double dem_stream_clearance(const dem_scene_definition *d) { return 0.25 * d->diameter + 3.0 * dem_stream_widest(d); }

double dem_stream_height(const dem_scene_definition *d, double particles, double solid_fraction)
{
    const double area = DEM_PI / 4.0 * d->diameter * d->diameter;
    return particles * dem_mean_volume(d->species, d->species_count) / (solid_fraction * area);
}

double dem_stream_usual_fraction(const dem_scene_definition *d)
{
    return dem_has_clusters(d->species, d->species_count) ? 0.5 : DEM_BED_SOLID_FRACTION;
}

double dem_stream_bed_fraction(const dem_scene_definition *d)
{
    const double usual = dem_stream_usual_fraction(d), poured = dem_poured_solid(d);
    const double all = (double)d->particle_count, over = dem_stream_height(d, all, poured) - dem_stream_height(d, all, usual);
    return over > 0.5 * dem_stream_clearance(d) ? poured : usual;
}

double dem_stream_level(const dem_scene_definition *d, double particles)
{
    return dem_stream_height(d, particles, dem_stream_bed_fraction(d));
}

double dem_stream_inlet_height(const dem_scene_definition *d, double particles)
{
    return dem_stream_level(d, particles) + dem_stream_clearance(d);
}

double dem_stream_least_impact_speed(const dem_scene_definition *d) { return sqrt(2.0 * d->gravity * dem_stream_clearance(d)); }

double dem_stream_entry_speed(const dem_scene_definition *d)
{
    return sqrt(d->stream.impact_speed * d->stream.impact_speed - 2.0 * d->gravity * dem_stream_clearance(d));
}

double dem_stream_rate(const dem_scene_definition *d, double solid, double speed)
{
    const double area = DEM_PI / 4.0 * d->stream.diameter * d->stream.diameter;
    return solid * area * speed / dem_mean_volume(d->species, d->species_count);
}

double dem_stream_most_rate(const dem_scene_definition *d)
{
    return dem_stream_rate(d, DEM_STREAM_MOST_SOLID, dem_stream_entry_speed(d));
}
