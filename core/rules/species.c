/* One particle of a species: volume, mass, size and shape. */
#include "dem_rules.h"

#include <math.h>

double dem_sphere_mass(double diameter, double density) { return DEM_PI / 6.0 * diameter * diameter * diameter * density; }

double dem_species_volume(const dem_species *s)
{
    return s->cluster.sphere_count ? s->cluster.volume : dem_sphere_mass(s->diameter, 1.0);
}

double dem_species_mass(const dem_species *s)
{
    return s->cluster.sphere_count ? s->cluster.volume * s->density : dem_sphere_mass(s->diameter, s->density);
}

static double largest_of(const dem_species *s) { return s->sizes.law ? s->sizes.maximum : s->diameter; }

static double smallest_of(const dem_species *s) { return s->sizes.law ? s->sizes.minimum : s->diameter; }

double dem_species_heaviest(const dem_species *s)
{
    return s->sizes.law ? dem_sphere_mass(s->sizes.maximum, s->density) : dem_species_mass(s);
}

double dem_species_diameter(const dem_species *s)
{
    return s->cluster.sphere_count ? cbrt(6.0 / DEM_PI * s->cluster.volume) : largest_of(s);
}

double dem_species_reach(const dem_species *s) { return s->cluster.sphere_count ? s->cluster.reach : 0.5 * largest_of(s); }

double dem_species_smallest_sphere(const dem_species *s)
{
    double smallest = s->cluster.sphere_count ? INFINITY : smallest_of(s);
    for (size_t k = 0; k < s->cluster.sphere_count; k++) smallest = fmin(smallest, s->cluster.sphere[k].diameter);
    return smallest;
}

double dem_species_largest_sphere(const dem_species *s)
{
    double largest = s->cluster.sphere_count ? 0.0 : largest_of(s);
    for (size_t k = 0; k < s->cluster.sphere_count; k++) largest = fmax(largest, s->cluster.sphere[k].diameter);
    return largest;
}

double dem_largest_sphere(const dem_scene_definition *d)
{
    double largest = d->lining.diameter;
    for (size_t k = 0; k < d->species_count; k++) largest = fmax(largest, dem_species_largest_sphere(&d->species[k]));
    return largest;
}

double dem_species_contact_mass(const dem_species *s)
{
    const dem_cluster *c = &s->cluster;
    if (c->sphere_count == 0) return dem_sphere_mass(smallest_of(s), s->density);
    double arm2 = 0.0;
    for (size_t k = 0; k < c->sphere_count; k++) {
        const double *x = c->sphere[k].position;
        arm2 = fmax(arm2, x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    }
    return s->density / (1.0 / c->volume + arm2 / fmin(c->inertia[0], fmin(c->inertia[1], c->inertia[2])));
}

double dem_mean_volume(const dem_species *species, size_t count)
{
    double volume = 0.0;
    for (size_t s = 0; s < count; s++) volume += species[s].share * dem_species_volume(&species[s]);
    return volume;
}

double dem_species_compactness(const dem_species *s)
{
    const dem_cluster *c = &s->cluster;
    if (c->sphere_count < 2) return 1.0;
    double axes2 = 1.0; /* product of the squares of the semi-axes, over (5/V)^3 */
    for (int a = 0; a < 3; a++) axes2 *= 0.5 * (c->inertia[(a + 1) % 3] + c->inertia[(a + 2) % 3] - c->inertia[a]);
    return c->volume / (4.0 / 3.0 * DEM_PI * sqrt(axes2 * pow(5.0 / c->volume, 3.0)));
}

bool dem_have_sizes(const dem_species *species, size_t count)
{
    bool have = false;
    for (size_t s = 0; s < count; s++) have = have || species[s].sizes.law != DEM_ONE_SIZE;
    return have;
}

bool dem_has_clusters(const dem_species *species, size_t count)
{
    bool has = false;
    for (size_t s = 0; s < count; s++) has = has || species[s].cluster.sphere_count > 1;
    return has;
}

double dem_bed_friction(double friction, const dem_species *species, size_t count)
{
    return dem_has_clusters(species, count) ? fmax(friction, 0.5) : friction;
}

static bool have_pairs_rolling_friction(const dem_scene_definition *d)
{
    bool have = false;
    for (size_t a = 0; d->has_pairs && a < d->species_count; a++) {
        for (size_t b = 0; b < d->species_count; b++) have = have || d->pair[a][b].rolling_friction > 0;
        for (size_t s = 0; s < DEM_SURFACES; s++) have = have || d->pair[a][DEM_MAXIMUM_SPECIES + s].rolling_friction > 0;
    }
    return have;
}

bool dem_has_rolling_friction(const dem_scene_definition *d)
{
    if (d->has_pairs) return have_pairs_rolling_friction(d);
    return d->contact.rolling_friction > 0 || d->contact.wall_rolling_friction > 0 || d->ends.rolling_friction > 0
           || d->plate.rolling_friction > 0;
}
