#include "parameters.h"

#include <math.h>

#include "dem_cluster.h"
#include "dem_rules.h"
#include "dem_sizes.h"
#include "dem_stream.h"

static bool is_positive(double x) { return isfinite(x) && x > 0; }

/* A modulus may be infinite: rigid; not both. */
static bool is_elastic(dem_elasticity e) { return e.youngs_modulus > 0 && e.poissons_ratio > -1 && e.poissons_ratio <= 0.5; }

static bool is_law(const dem_contact_parameters *c)
{
    switch (c->law) {
    case DEM_WALTON_BRAUN:
    case DEM_SPRING_DASHPOT: return is_positive(c->stiffness) && is_positive(c->tangential_stiffness_ratio);
    case DEM_HERTZ_MINDLIN: return isfinite(c->particle.youngs_modulus) && is_elastic(c->particle) && is_elastic(c->wall);
    }
    return false;
}

/* One body, of spheres each of which adds to it. */
static bool is_cluster(const dem_cluster *c)
{
    int in;
    bool good = c->sphere_count <= DEM_MAXIMUM_CLUSTER;
    for (size_t k = 0; good && k < c->sphere_count; k++) {
        const dem_cluster_sphere *s = &c->sphere[k];
        good = is_positive(s->diameter) && isfinite(s->position[0]) && isfinite(s->position[1]) && isfinite(s->position[2]);
    }
    return good && dem_cluster_loose_sphere(c) < 0 && dem_cluster_hidden_sphere(c, &in) < 0;
}

static bool is_not_negative(double x) { return x >= 0 && isfinite(x); }

static bool are_frictions(double sliding, double rolling) { return is_not_negative(sliding) && is_not_negative(rolling); }

static bool is_cohesion(const dem_scene_definition *d, const dem_cohesion *c)
{
    return is_not_negative(c->strength) && is_not_negative(c->liquid_volume) && c->contact_angle >= 0
           && c->contact_angle < DEM_PI / 2
           && (d->contact.cohesion_law == DEM_NO_COHESION ? c->strength == 0 : d->contact.cohesion_law <= DEM_LIQUID_BRIDGE)
           && (d->contact.cohesion_law != DEM_JKR || d->contact.law == DEM_HERTZ_MINDLIN);
}

static bool is_pair(const dem_pair *p, const dem_scene_definition *d)
{
    dem_contact_parameters c = d->contact;
    c.stiffness = p->stiffness;
    c.particle = p->elasticity[0];
    c.wall = p->elasticity[1];
    return is_law(&c) && are_frictions(p->friction, p->rolling_friction) && p->restitution > 0 && p->restitution <= 1
           && is_not_negative(p->unloading_slope) && (p->unloading_slope > 0) == (d->contact.unloading_slope > 0)
           && is_cohesion(d, &p->cohesion);
}

/* The contact of two is the same seen from either. */
static bool are_pairs(const dem_scene_definition *d)
{
    bool good = true;
    for (size_t a = 0; d->has_pairs && a < d->species_count; a++) {
        for (size_t b = 0; b < d->species_count; b++)
            good = good && is_pair(&d->pair[a][b], d) && d->pair[a][b].friction == d->pair[b][a].friction;
        for (size_t s = DEM_MAXIMUM_SPECIES; s < DEM_MAXIMUM_SPECIES + DEM_SURFACES; s++) good = good && is_pair(&d->pair[a][s], d);
    }
    return good;
}

/* Bars whose corners lie within the drum, and which leave room between each other. */
static bool are_lifters(const dem_lifters *l, double radius)
{
    const double top = radius - l->height, half = 0.5 * l->width;
    if (l->count == 0) return true;
    if (l->count > DEM_MAXIMUM_LIFTERS || !is_positive(l->height) || !is_positive(l->width) || !is_not_negative(l->friction))
        return false;
    return top > 0 && hypot(top, half) <= radius && (l->count < 3 || half < top * tan(DEM_PI / (double)l->count));
}

/* Nothing below is of use before species are known to be good. */
static bool is_stream(const dem_scene_definition *d)
{
    const double rate = d->stream.rate;
    if (rate == 0) return true;
    return d->container == DEM_CYLINDER && is_positive(rate) && d->stream.diameter <= d->diameter
           && d->stream.diameter >= dem_stream_widest(d) && d->stream.impact_speed >= dem_stream_least_impact_speed(d);
}

/* A hole within the floor, and a hopper below the top. */
static bool is_vessel(const dem_scene_definition *d)
{
    const dem_orifice *o = &d->orifice;
    const double hopper = o->half_angle > 0 ? 0.5 * (d->diameter - o->opening) / tan(o->half_angle) : 0;
    return are_frictions(d->ends.friction, d->ends.rolling_friction) && is_positive(o->opening) && o->opening < d->diameter
           && is_not_negative(o->depth) && o->half_angle >= 0 && o->half_angle < DEM_PI / 2 && hopper < d->length;
}

/* Beside the measures that every container has. */
static bool is_container(const dem_scene_definition *d)
{
    const bool is_lined = d->lining.diameter != 0;
    switch (d->container) {
    case DEM_DRUM:
        return (!d->ends.are_walls || are_frictions(d->ends.friction, d->ends.rolling_friction))
               && are_lifters(&d->lifters, 0.5 * d->diameter) && !(is_lined && d->lifters.count > 0);
    case DEM_CYLINDER: return are_frictions(d->ends.friction, d->ends.rolling_friction) && !is_lined && d->lifters.count == 0;
    case DEM_TUBE_ON_PLATE:
        return d->plate.diameter > d->diameter && isfinite(d->plate.diameter) && is_not_negative(d->plate.rim_height)
               && are_frictions(d->plate.friction, d->plate.rolling_friction) && is_not_negative(d->lift.speed)
               && is_not_negative(d->lift.start) && !is_lined && d->lifters.count == 0;
    case DEM_VESSEL: return is_vessel(d) && !is_lined && d->lifters.count == 0;
    }
    return false;
}

/* A stream that has clusters takes spheres for clusters, too, which are all alike. */
static bool are_sizes(const dem_scene_definition *d, const dem_species *s)
{
    if (s->sizes.law == DEM_ONE_SIZE) return true;
    bool alone = s->cluster.sphere_count == 0;
    for (size_t k = 0; d->stream.rate > 0 && k < d->species_count; k++) alone = alone && d->species[k].cluster.sphere_count == 0;
    return alone && dem_sizes_are_good(&s->sizes);
}

static bool is_rotation(const dem_scene_definition *d)
{
    bool good =
        isfinite(d->rotation_rate) && d->stage_count <= DEM_MAXIMUM_STAGES && (d->stage_count == 0 || d->container == DEM_DRUM);
    for (size_t k = 0; good && k < d->stage_count; k++) good = isfinite(d->stage[k].rate) && is_positive(d->stage[k].seconds);
    return good;
}

static bool is_tilt(const dem_scene_definition *d)
{
    return d->tilt >= 0 && d->tilt < DEM_PI / 2 && (d->tilt == 0 || (d->container == DEM_DRUM && d->ends.are_walls));
}

static dem_status parameters_check(const dem_scene_definition *d)
{
    const dem_contact_parameters *c = &d->contact;
    bool good = is_positive(d->diameter) && is_positive(d->length) && is_rotation(d) && is_tilt(d) && is_positive(d->gravity)
                && is_positive(d->time_step) && d->particle_count > 0 && d->particle_count < INT32_MAX / 2 && d->threads >= 1
                && d->species_count >= 1 && d->species_count <= DEM_MAXIMUM_SPECIES && d->corrector_passes >= 0;
    good = good && is_law(c) && c->unloading_slope >= 0 && isfinite(c->unloading_slope) && c->restitution > 0 && c->restitution <= 1
           && is_not_negative(c->latch_damping) && is_not_negative(c->friction) && is_not_negative(c->wall_friction)
           && is_not_negative(c->rolling_friction) && is_not_negative(c->wall_rolling_friction)
           && c->rolling_law <= DEM_CONSTANT_TORQUE && is_not_negative(c->rolling_damping) && is_cohesion(d, &c->cohesion)
           && is_cohesion(d, &c->wall_cohesion);
    double shares = 0.0, largest = 0.0;
    for (size_t k = 0; good && k < d->species_count; k++) {
        const dem_species *s = &d->species[k];
        good = (s->cluster.sphere_count ? is_positive(s->cluster.volume) : is_positive(s->diameter)) && is_positive(s->density)
               && s->share >= 0 && are_sizes(d, s);
        shares += s->share;
        largest = fmax(largest, 2 * dem_species_reach(s));
    }
    /* As much of an axis as its own image along it needs not to be felt: rows tell places apart modulo the period (spheres.h). */
    const bool is_periodic = d->container == DEM_DRUM && !d->ends.are_walls;
    good = good && fabs(shares - 1) < 1e-6 && largest < 0.5 * d->diameter && d->length > 2 * largest
           && (!is_periodic || d->length > 3 * dem_largest_sphere(d) * (1 - 1e-6));
    if (good && d->lining.diameter != 0)
        good = is_positive(d->lining.diameter) && is_positive(d->lining.pitch) && d->lining.diameter < 0.25 * d->diameter
               && d->lining.pitch <= d->length;
    return good && are_pairs(d) && is_container(d) && is_stream(d) ? DEM_OK : DEM_BAD_PARAMETER;
}

dem_status parameters_complete(dem_scene_definition *d)
{
    for (size_t k = 0; k < d->species_count && k < DEM_MAXIMUM_SPECIES; k++) {
        if (!is_cluster(&d->species[k].cluster)) return DEM_BAD_PARAMETER;
        if (d->species[k].cluster.volume == 0) dem_cluster_complete(&d->species[k].cluster);
        if (dem_sizes_are_good(&d->species[k].sizes)) dem_sizes_complete(&d->species[k]);
    }
    return parameters_check(d);
}
