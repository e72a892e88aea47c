#include "contact_constants.h"

void species_roots_set(species_roots *roots, const spheres *s)
{
    for (size_t a = 0; a < s->species_count; a++) {
        for (size_t b = 0; b < s->species_count; b++) roots->of[a][b] = (real)(1 / sqrt(s->inverse_mass[a] + s->inverse_mass[b]));
        roots->of[a][DEM_MAXIMUM_SPECIES] = (real)(1 / sqrt(s->inverse_mass[a]));
    }
}

void contact_constants_of_each(contact_list *pairs, const spheres *s, const dem_contact_parameters *contact,
                               const species_roots *roots, size_t from, size_t to)
{
    const int32_t mobile = (int32_t)s->mobile_count;
    const real mu = (real)contact->friction, mu_wall = (real)contact->wall_friction;
    const real mu_r = (real)contact->rolling_friction, mu_r_wall = (real)contact->wall_rolling_friction;
    const int32_t *restrict first = pairs->first, *restrict second = pairs->second;
    for (size_t k = from; k < to; k++) {
        const bool between_mobile = second[k] < mobile;
        const real r_i = s->full_radius[first[k]], r_j = s->full_radius[second[k]];
        pairs->friction[k] = between_mobile ? mu : mu_wall;
        pairs->first_radius[k] = r_i;
        pairs->radius[k] = r_i * r_j / (r_i + r_j);
    }
    for (size_t k = from; k < to; k++)
        pairs->root_mass[k] = roots->of[s->species[first[k]]][second[k] < mobile ? s->species[second[k]] : DEM_MAXIMUM_SPECIES];
    if (pairs->has_rolling)
        for (size_t k = from; k < to; k++) pairs->rolling_friction[k] = second[k] < mobile ? mu_r : mu_r_wall;
}

void contact_constants_of_all(contact_list *pairs, const spheres *s, const dem_contact_parameters *contact)
{
    for (size_t k = 0; k < BLOCK; k++) {
        pairs->friction[k] = (real)contact->friction;
        pairs->first_radius[k] = s->full_radius[0];
        pairs->root_mass[k] = (real)sqrt(0.5 / sphere_inverse_mass(s, 0));
        pairs->radius[k] = s->full_radius[0] / 2;
        if (pairs->has_rolling) pairs->rolling_friction[k] = (real)contact->rolling_friction;
    }
}
