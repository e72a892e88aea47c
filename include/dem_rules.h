/* The rules that turn a user's wishes into a definition: how many particles a fill is, how stiff a contact
 * must be for the overlap allowed, how long a time step may be. Inline, because the daemon, which gives
 * estimates, does not link the core. Sources and measurements: core/NUMERICS.md. */
#ifndef DEM_RULES_H
#define DEM_RULES_H

#include <math.h>

#include "dem_types.h"

#define DEM_PI 3.14159265358979323846

/* Time steps in one collision of the two lightest particles: between 20 and 25 is safe. */
#define DEM_STEPS_PER_CONTACT 20.0
/* Solid fraction of a bed at rest by which fill_fraction counts particles. */
#define DEM_BED_SOLID_FRACTION 0.6

/* What a run can tell, of its bed and of its length: core/NUMERICS.md, "What a run can tell". Fewer particles or layers
 * than of a bed have no angle; fewer than of a verdict have one that nobody can judge. */
#define DEM_LEAST_BED_PARTICLES 30
#define DEM_LEAST_BED_LAYERS 2
#define DEM_LEAST_PARTICLES 100
#define DEM_LEAST_LAYERS 4
#define DEM_LEAST_REVOLUTIONS 0.5         /* turned in all */
#define DEM_LEAST_WINDOW_REVOLUTIONS 0.25 /* and in the window */
#define DEM_LEAST_WINDOW_FRAMES 40
#define DEM_LEAST_CORRELATION_TIMES 20 /* as the window itself shows them, which may be twice too many */
#define DEM_LEAST_FALLS 3              /* slumps or avalanches that tell as much as so many revolutions */

static inline double dem_sphere_mass(double diameter, double density)
{
    return DEM_PI / 6.0 * diameter * diameter * diameter * density;
}

/* Of one particle of a species; a cluster's must be complete (dem_cluster.h). */
static inline double dem_species_volume(const dem_species *s)
{
    return s->cluster.sphere_count ? s->cluster.volume : dem_sphere_mass(s->diameter, 1.0);
}

static inline double dem_species_mass(const dem_species *s)
{
    return s->cluster.sphere_count ? s->cluster.volume * s->density : dem_sphere_mass(s->diameter, s->density);
}

/* Diameter of the sphere of the same volume, m. */
static inline double dem_species_diameter(const dem_species *s)
{
    return s->cluster.sphere_count ? cbrt(6.0 / DEM_PI * s->cluster.volume) : s->diameter;
}

/* Radius of the sphere about its centre of mass that holds the particle, m. */
static inline double dem_species_reach(const dem_species *s)
{
    return s->cluster.sphere_count ? s->cluster.reach : 0.5 * s->diameter;
}

/* Diameter of its smallest sphere, m. */
static inline double dem_species_smallest_sphere(const dem_species *s)
{
    double smallest = s->cluster.sphere_count ? INFINITY : s->diameter;
    for (size_t k = 0; k < s->cluster.sphere_count; k++) smallest = fmin(smallest, s->cluster.sphere[k].diameter);
    return smallest;
}

static inline double dem_species_largest_sphere(const dem_species *s)
{
    double largest = s->cluster.sphere_count ? 0.0 : s->diameter;
    for (size_t k = 0; k < s->cluster.sphere_count; k++) largest = fmax(largest, s->cluster.sphere[k].diameter);
    return largest;
}

/* Diameter of the largest sphere of all, m: of particles or of the lining. */
static inline double dem_largest_sphere(const dem_scene_definition *d)
{
    double largest = d->lining.diameter;
    for (size_t k = 0; k < d->species_count; k++) largest = fmax(largest, dem_species_largest_sphere(&d->species[k]));
    return largest;
}

/* The least mass, kg, that a contact can move: a cluster pushed beside its centre also turns,
 * 1/m + |r|^2/I with r from its centre to the sphere's, which is as long as the arm of the force can be. */
static inline double dem_species_contact_mass(const dem_species *s)
{
    const dem_cluster *c = &s->cluster;
    if (c->sphere_count == 0) return dem_species_mass(s);
    double arm2 = 0.0;
    for (size_t k = 0; k < c->sphere_count; k++) {
        const double *x = c->sphere[k].position;
        arm2 = fmax(arm2, x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    }
    return s->density / (1.0 / c->volume + arm2 / fmin(c->inertia[0], fmin(c->inertia[1], c->inertia[2])));
}

/* Mean volume of a particle, m3, for shares by number. */
static inline double dem_mean_volume(const dem_species *species, size_t count)
{
    double volume = 0.0;
    for (size_t s = 0; s < count; s++) volume += species[s].share * dem_species_volume(&species[s]);
    return volume;
}

/* How much of the ellipsoid of the same mass and moments of inertia a particle fills: a sphere all of it, chains of touching
 * spheres 0.8, tetrahedra 0.61, cubes 0.54, blocks of 27 spheres 0.50, crosses of seven 0.40. */
static inline double dem_species_compactness(const dem_species *s)
{
    const dem_cluster *c = &s->cluster;
    if (c->sphere_count < 2) return 1.0;
    double axes2 = 1.0; /* product of the squares of the semi-axes, over (5/V)^3 */
    for (int a = 0; a < 3; a++) axes2 *= 0.5 * (c->inertia[(a + 1) % 3] + c->inertia[(a + 2) % 3] - c->inertia[a]);
    return c->volume / (4.0 / 3.0 * DEM_PI * sqrt(axes2 * pow(5.0 / c->volume, 3.0)));
}

/* Solid fraction that particles of one shape can be packed to. What bulges in stays empty, and particles of many small spheres
 * reach less far into each other's pores. From beds of eight shapes: core/NUMERICS.md, "How full a container can be". */
#define DEM_MOST_SOLID 0.57 /* of spheres */
#define DEM_MOST_SOLID_OF_BLOCKS 0.522
#define DEM_BLOCK_SPHERES 8
static inline double dem_species_most_solid(const dem_species *s)
{
    if (s->cluster.sphere_count < 2) return DEM_MOST_SOLID;
    const double grain = dem_species_largest_sphere(s) / cbrt(6.0 / DEM_PI * s->cluster.volume);
    const double most = s->cluster.sphere_count < DEM_BLOCK_SPHERES ? DEM_MOST_SOLID : DEM_MOST_SOLID_OF_BLOCKS;
    return fmin(most, 0.75 * dem_species_compactness(s) + 0.5 * fmax(grain, 0.3) - 0.13);
}

/* The mean of that by volume. */
static inline double dem_most_solid(const dem_species *species, size_t count)
{
    double volume = 0.0, solid = 0.0;
    for (size_t s = 0; s < count; s++) {
        const double share = species[s].share * dem_species_volume(&species[s]);
        volume += share;
        solid += share * dem_species_most_solid(&species[s]);
    }
    return solid / volume;
}

/* How much a bed fills of an upright container that it was poured into with much friction: it is loose along the wall. */
static inline double dem_poured_solid(const dem_scene_definition *d)
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

/* Share of a container's free volume, without the layer of a lining and without bars, that particles may have the volume of for
 * all of them to find a place at the start and to grow there: in a drum a little more than they can be packed to; half of one
 * that is open at the top, which growing particles would leave. */
static inline double dem_most_placed(const dem_scene_definition *d)
{
    return d->container == DEM_DRUM ? 0.62 / DEM_MOST_SOLID * dem_most_solid(d->species, d->species_count) : 0.5;
}

/* How many particles fill `fill_fraction` of a drum's cross-section. */
static inline double dem_particles_of_fill(double diameter, double length, double fill_fraction, const dem_species *species,
                                           size_t count)
{
    const double bed = DEM_PI / 4.0 * diameter * diameter * length * fill_fraction;
    return floor(bed * DEM_BED_SOLID_FRACTION / dem_mean_volume(species, count) + 0.5);
}

static inline double dem_fill_of_particles(double diameter, double length, double particles, const dem_species *species,
                                           size_t count)
{
    return particles * dem_mean_volume(species, count) / (DEM_BED_SOLID_FRACTION * DEM_PI / 4.0 * diameter * diameter * length);
}

/* Largest speed, m/s, at which one of many particles meets the wall or a bed that backs another in a drum: falling
 * down the surface, which friction steepens, and thrown by the wall; a bed few diameters across is jerkier. Fitted to
 * the largest overlaps that the runs listed in core/NUMERICS.md ("Stiffness") ever showed. */
static inline double dem_impact_speed(double drum_diameter, double largest_diameter, double gravity, double friction,
                                      double rotation_rate)
{
    const double steepness = 0.59 * pow(fmin(fmax(friction, 0.02), 1.0), 0.25);
    const double falling = steepness * (1.0 + 3.0 * largest_diameter / drum_diameter) * sqrt(gravity * drum_diameter);
    const double thrown = 1.4 * fabs(rotation_rate) * 0.5 * drum_diameter;
    return sqrt(falling * falling + thrown * thrown);
}

/* The same for a particle that a lifter drops from the top of the drum onto the bed, or onto the wall where the bed is
 * shallow, on top of what the wall throws. */
static inline double dem_lifted_speed(double drum_diameter, double gravity, double fill_fraction, double rotation_rate)
{
    const double thrown = 1.4 * fabs(rotation_rate) * 0.5 * drum_diameter;
    return sqrt(2.0 * gravity * drum_diameter * (1.0 - fill_fraction) + thrown * thrown);
}

/* Friction of the bed of spheres that is as steep: clusters interlock, whatever their friction. */
static inline double dem_bed_friction(double friction, const dem_species *species, size_t count)
{
    bool interlock = false;
    for (size_t s = 0; s < count; s++) interlock = interlock || species[s].cluster.sphere_count > 1;
    return interlock ? fmax(friction, 0.5) : friction;
}

/* K1, N/m, for the heaviest particle to overlap with what does not give way by at most `overlap` (m) at that speed:
 * alpha = v sqrt(m/K1). */
static inline double dem_stiffness_for_overlap(double impact_speed, double heaviest_mass, double overlap)
{
    const double v = impact_speed / overlap;
    return heaviest_mass * v * v;
}

/* Hertz-Mindlin: E* (Pa) for the same; alpha = (15 m v^2/(16 E* sqrt(R)))^(2/5). radius: effective, m. */
static inline double dem_hertz_modulus_for_overlap(double impact_speed, double heaviest_mass, double radius, double overlap)
{
    return 15.0 / 16.0 * heaviest_mass * impact_speed * impact_speed / (sqrt(radius) * pow(overlap, 2.5));
}

/* Duration of an elastic Hertzian collision, 2.868 (m^2/(R E*^2 v))^(1/5), over DEM_STEPS_PER_CONTACT. */
static inline double dem_hertz_time_step(double effective_modulus, double lightest_mass, double radius, double impact_speed)
{
    const double m = 0.5 * lightest_mass;
    return 2.868 * pow(m * m / (radius * effective_modulus * effective_modulus * impact_speed), 0.2) / DEM_STEPS_PER_CONTACT;
}

/* Walton-Braun: below this restitution the unloading branch alone, e of the loading's time, sets the step: it is to have no
 * fewer steps than here. */
#define DEM_SHORTEST_UNLOADING 0.3

/* Duration of a collision, t_c = (pi/2) sqrt(m_eff/K1) (1 + e), over DEM_STEPS_PER_CONTACT. */
static inline double dem_time_step(double stiffness, double lightest_mass, double restitution)
{
    return DEM_PI / 2.0 * sqrt(0.5 * lightest_mass / stiffness) * (1.0 + restitution) / DEM_STEPS_PER_CONTACT;
}

static inline double dem_latching_time_step(double stiffness, double lightest_mass, double restitution)
{
    const double step = dem_time_step(stiffness, lightest_mass, fmax(restitution, DEM_SHORTEST_UNLOADING));
    return restitution < DEM_SHORTEST_UNLOADING ? step * restitution / DEM_SHORTEST_UNLOADING : step;
}

/* Share of a unit circle's area below the height y. */
static inline double dem_circle_below(double y) { return (acos(-y) + y * sqrt(1 - y * y)) / DEM_PI; }

/* Height, as a share of a circle's radius, below which `share` of its area lies: -1 for 0, 1 for 1. */
static inline double dem_circle_level(double share)
{
    double low = -1.0, high = 1.0;
    for (int k = 0; k < 60; k++) *(dem_circle_below(0.5 * (low + high)) < share ? &low : &high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}

/* Depth of a bed at mid-chord, in mean diameters. share: of the cross-section, that the bed takes up. */
static inline double dem_bed_layers(double drum_diameter, double share, double mean_diameter)
{
    return (1.0 + dem_circle_level(share)) * 0.5 * drum_diameter / mean_diameter;
}

/* Time to make the bed of a drum or tube, s of simulated time. Growing takes what the core's filling.c says. Settling ends when
 * little kinetic energy is left for each particle: in a drum, grains that lie side by side on the wall roll down to its lowest
 * line, held back by the drag, and do so the longer the fewer they are beside the row that the random start has room for,
 * 2 sqrt(D/d) of them in a cross-section, and the less friction holds them; where they lie on each other they stop at once.
 * Clusters interlock, and stop sooner than the spheres that hold them would. Seeds scatter by 0.3 of the time for less than such
 * a row, by 0.1 to 0.2 above. From beds of 8 to 2700 particles, D/d from 8.5 to 100: core/NUMERICS.md, "How long a bed takes". */
static inline double dem_settling_time(const dem_scene_definition *d)
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

/* Resident memory of a run, bytes, without its tables of results: from drums of 1 to 20,000 spheres. */
static inline double dem_memory_estimate(double sphere_count) { return 15.7e6 + 850.0 * sphere_count; }

/* Cells a side of a drum's fields: half a mean diameter wide; wider where there would be more than 512, or more than 64 for
 * each particle, which beds of a few hundredths of the drum have not. No less than 64 a side for that. */
static inline double dem_field_cells(double drum_diameter, double mean_diameter, double particles)
{
    const double most = fmin(fmax(64.0, ceil(sqrt(64.0 * particles))), 512.0);
    return fmin(ceil(2.0 * drum_diameter / mean_diameter - 1e-9), most);
}

/* Of particles, walls, ends or plate: then every contact carries a moment. */
static inline bool dem_has_rolling_friction(const dem_scene_definition *d)
{
    return d->contact.rolling_friction > 0 || d->contact.wall_rolling_friction > 0 || d->ends.rolling_friction > 0
           || d->plate.rolling_friction > 0;
}

#endif
