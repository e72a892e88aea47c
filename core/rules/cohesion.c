/* Closed forms of cohesion: what a contact bears before it breaks, and how far it reaches. */
#include <math.h>

#include "dem_rules.h"

double dem_effective_modulus(dem_elasticity a, dem_elasticity b)
{
    return 1
           / ((1 - a.poissons_ratio * a.poissons_ratio) / a.youngs_modulus
              + (1 - b.poissons_ratio * b.poissons_ratio) / b.youngs_modulus);
}

double dem_jkr_least_contact(double surface_energy, double effective_modulus, double radius)
{
    return cbrt(DEM_PI * surface_energy * radius * radius / (8.0 * effective_modulus));
}

double dem_pull_off(dem_cohesion_law law, const dem_cohesion *c, double radius)
{
    switch (law) {
    case DEM_CONSTANT_PULL: return c->strength;
    case DEM_JKR: return 1.5 * DEM_PI * c->strength * radius;
    case DEM_LIQUID_BRIDGE: return 4.0 * DEM_PI * radius * c->strength * cos(c->contact_angle);
    case DEM_SJKR:
    case DEM_SJKR2:
    case DEM_NO_COHESION: break;
    }
    return 0.0;
}

double dem_cohesive_gap(dem_cohesion_law law, const dem_cohesion *c, double effective_modulus, double radius)
{
    if (law == DEM_LIQUID_BRIDGE) return (1.0 + 0.5 * c->contact_angle) * cbrt(c->liquid_volume);
    if (law != DEM_JKR) return 0.0;
    const double a = dem_jkr_least_contact(c->strength, effective_modulus, radius);
    return 3.0 * a * a / radius;
}
