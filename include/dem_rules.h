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

static inline double dem_sphere_mass(double diameter, double density)
{
    return DEM_PI / 6.0 * diameter * diameter * diameter * density;
}

/* Mean volume of a particle, m3, for shares by number. */
static inline double dem_mean_volume(const dem_species *species, size_t count)
{
    double volume = 0.0;
    for (size_t s = 0; s < count; s++) volume += species[s].share * dem_sphere_mass(species[s].diameter, 1.0);
    return volume;
}

/* How many particles fill `fill_fraction` of a drum's cross-section. */
static inline double dem_particles_of_fill(double diameter, double length, double fill_fraction,
                                           const dem_species *species, size_t count)
{
    const double bed = DEM_PI / 4.0 * diameter * diameter * length * fill_fraction;
    return floor(bed * DEM_BED_SOLID_FRACTION / dem_mean_volume(species, count) + 0.5);
}

static inline double dem_fill_of_particles(double diameter, double length, double particles,
                                           const dem_species *species, size_t count)
{
    return particles * dem_mean_volume(species, count)
         / (DEM_BED_SOLID_FRACTION * DEM_PI / 4.0 * diameter * diameter * length);
}

/* Largest speed, m/s, at which one of many particles meets the wall or a bed that backs another in a drum: falling
 * down the surface, which friction steepens, and thrown by the wall; a bed few diameters across is jerkier. Fitted to
 * the largest overlaps that the runs listed in core/NUMERICS.md ("Stiffness") ever showed. */
static inline double dem_impact_speed(double drum_diameter, double largest_diameter, double gravity, double friction,
                                      double rotation_rate)
{
    const double steepness = 0.55 * pow(fmin(fmax(friction, 0.02), 1.0), 0.25);
    const double falling = steepness * (1.0 + 3.0 * largest_diameter / drum_diameter) * sqrt(gravity * drum_diameter);
    const double thrown = 1.4 * fabs(rotation_rate) * 0.5 * drum_diameter;
    return sqrt(falling * falling + thrown * thrown);
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

/* Duration of a collision, t_c = (pi/2) sqrt(m_eff/K1) (1 + e), over DEM_STEPS_PER_CONTACT. */
static inline double dem_time_step(double stiffness, double lightest_mass, double restitution)
{
    return DEM_PI / 2.0 * sqrt(0.5 * lightest_mass / stiffness) * (1.0 + restitution) / DEM_STEPS_PER_CONTACT;
}

/* Rough cost of settling the bed, in seconds of simulated time: a few times the fall through the drum. */
static inline double dem_settling_time_estimate(double drum_diameter, double gravity)
{
    return 3.0 * sqrt(drum_diameter / gravity);
}

/* Resident memory of a run, bytes. */
static inline double dem_memory_estimate(double particles)
{
    return 20e6 + 1500.0 * particles;
}

#endif
