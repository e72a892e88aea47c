/* Speeds of impact, stiffnesses for an overlap, and the time steps that follow. */
#include "dem_rules.h"

#include <math.h>

double dem_impact_speed(double drum_diameter, double largest_diameter, double gravity, double friction, double rotation_rate)
{
    const double steepness = 0.59 * pow(fmin(fmax(friction, 0.02), 1.0), 0.25);
    const double falling = steepness * (1.0 + 3.0 * largest_diameter / drum_diameter) * sqrt(gravity * drum_diameter);
    const double thrown = 1.4 * fabs(rotation_rate) * 0.5 * drum_diameter;
    return sqrt(falling * falling + thrown * thrown);
}

double dem_lifted_speed(double drum_diameter, double gravity, double fill_fraction, double rotation_rate)
{
    const double thrown = 1.4 * fabs(rotation_rate) * 0.5 * drum_diameter;
    return sqrt(2.0 * gravity * drum_diameter * (1.0 - fill_fraction) + thrown * thrown);
}

double dem_stiffness_for_overlap(double impact_speed, double heaviest_mass, double overlap)
{
    const double v = impact_speed / overlap;
    return heaviest_mass * v * v;
}

double dem_hertz_modulus_for_overlap(double impact_speed, double heaviest_mass, double radius, double overlap)
{
    return 15.0 / 16.0 * heaviest_mass * impact_speed * impact_speed / (sqrt(radius) * pow(overlap, 2.5));
}

double dem_hertz_time_step(double effective_modulus, double lightest_mass, double radius, double impact_speed)
{
    const double m = 0.5 * lightest_mass;
    return 2.868 * pow(m * m / (radius * effective_modulus * effective_modulus * impact_speed), 0.2) / DEM_STEPS_PER_CONTACT;
}

double dem_time_step(double stiffness, double lightest_mass, double restitution)
{
    return DEM_PI / 2.0 * sqrt(0.5 * lightest_mass / stiffness) * (1.0 + restitution) / DEM_STEPS_PER_CONTACT;
}

double dem_latching_time_step(double stiffness, double lightest_mass, double restitution)
{
    const double step = dem_time_step(stiffness, lightest_mass, fmax(restitution, DEM_SHORTEST_UNLOADING));
    return restitution < DEM_SHORTEST_UNLOADING ? step * restitution / DEM_SHORTEST_UNLOADING : step;
}
