#include "contact_constants.h"

#include "dem_rules.h"

/* As `contact` would say it, if the pair's were all contacts. */
static dem_contact_parameters contact_of_pair(const dem_scene_definition *d, const dem_pair *pair)
{
    dem_contact_parameters contact = d->contact;
    contact.stiffness = pair->stiffness;
    contact.restitution = pair->restitution;
    contact.unloading_slope = pair->unloading_slope;
    contact.particle = pair->elasticity[0];
    contact.wall = pair->elasticity[1];
    return contact;
}

/* is_wall: the second of two bodies is of contact.wall. */
static void law_numbers_set(real numbers[LAW_NUMBERS], const dem_contact_parameters *contact, bool is_wall, double dt)
{
    if (contact->law != DEM_WALTON_BRAUN) {
        const damped_law law = damped_law_of(contact, is_wall, dt);
        memcpy(numbers, (real[LAW_NUMBERS]){ law.k_n, law.k_t, law.damping, law.lag }, LAW_NUMBERS * sizeof *numbers);
        return;
    }
    const double k_1 = contact->stiffness, k_t0 = k_1 * contact->tangential_stiffness_ratio;
    numbers[LAW_K_N] = (real)k_1;
    numbers[LAW_K_T] = (real)k_t0;
    numbers[LAW_K_2] =
        (real)(contact->unloading_slope > 0 ? contact->unloading_slope : k_1 / (contact->restitution * contact->restitution));
    numbers[LAW_LATCH] = latch_damping_of(contact);
    numbers[LAW_PUSH] = (real)(k_t0 * dt);
}

static void pair_numbers_set(pair_numbers *numbers, const dem_scene_definition *d, const dem_pair *pair)
{
    const dem_contact_parameters contact = contact_of_pair(d, pair);
    numbers->friction = (real)pair->friction;
    numbers->rolling_friction = (real)pair->rolling_friction;
    law_numbers_set(numbers->law, &contact, true, d->time_step);
}

/* What contact_cohesion.c and jkr_normals read of a contact of this effective radius. JKR's least contact is kept above 1e-5 of the
 * radius, where nothing is felt of it: so a pair without surface energy is Hertz's, to rounding. */
static void cohesion_numbers(dem_cohesion_law law, const pair_numbers *pair, double radius, bool is_wall,
                             real numbers[COHESION_NUMBERS])
{
    const dem_cohesion *const c = &pair->pull;
    const double w = fmax(c->strength, 8e-15 / DEM_PI * pair->effective_modulus * radius);
    const double a_f = dem_jkr_least_contact(w, pair->effective_modulus, radius);
    switch (law) {
    case DEM_SJKR2: numbers[0] = (real)((is_wall ? 2 : 4) * DEM_PI * radius * c->strength); break;
    case DEM_JKR:
        numbers[0] = (real)(radius / (a_f * a_f));
        numbers[1] = (real)(DEM_PI / 6 * w * radius);
        numbers[2] = (real)a_f;
        break;
    case DEM_LIQUID_BRIDGE:
        numbers[0] = (real)dem_pull_off(law, c, radius);
        numbers[1] = (real)(c->liquid_volume / (DEM_PI * radius));
        numbers[2] = (real)dem_cohesive_gap(law, c, pair->effective_modulus, radius);
        break;
    default: numbers[0] = (real)c->strength;
    }
}

/* A surface, but the lining, whose spheres are spheres. */
static bool is_flat(size_t partner) { return partner >= DEM_MAXIMUM_SPECIES && partner != DEM_MAXIMUM_SPECIES + DEM_LINING; }

void contact_constants_of_cohesion(contact_list *list, size_t slot, const pair_table *table, size_t species, size_t partner)
{
    const pair_numbers *pair = &table->of[species][partner];
    real numbers[COHESION_NUMBERS] = { 0 };
    memcpy(numbers, pair->cohesion, sizeof numbers);
    if (list->radius[slot] != pair->radius)
        cohesion_numbers(table->cohesion, pair, (double)list->radius[slot], is_flat(partner), numbers);
    for (int c = 0; c < COHESION_NUMBERS; c++) list->cohesion[c][slot] = numbers[c];
}

/* m: radius of the species' largest sphere. */
static double radius_of(const dem_scene_definition *d, size_t species)
{
    return 0.5 * dem_species_largest_sphere(&d->species[species]);
}

static void set_cohesion(pair_table *table, const dem_scene_definition *d, size_t a, size_t partner)
{
    pair_numbers *const numbers = &table->of[a][partner];
    const bool is_species = partner < DEM_MAXIMUM_SPECIES, is_lining = partner == DEM_MAXIMUM_SPECIES + DEM_LINING;
    const dem_pair *pair = &d->pair[a][partner];
    const double r = radius_of(d, a), other = is_species ? radius_of(d, partner) : is_lining ? 0.5 * d->lining.diameter : 0;
    const double radius = other > 0 ? r * other / (r + other) : r;
    numbers->pull = d->has_pairs ? pair->cohesion : is_species ? d->contact.cohesion : d->contact.wall_cohesion;
    numbers->effective_modulus =
        d->has_pairs ? dem_effective_modulus(pair->elasticity[0], pair->elasticity[1])
                     : dem_effective_modulus(d->contact.particle, is_species ? d->contact.particle : d->contact.wall);
    numbers->radius = (real)radius;
    cohesion_numbers(table->cohesion, numbers, radius, is_flat(partner), numbers->cohesion);
    if (numbers->pull.strength > 0)
        table->gap = fmax(table->gap, dem_cohesive_gap(table->cohesion, &numbers->pull, numbers->effective_modulus, radius));
}

static bool coheres(const pair_table *table, const dem_scene_definition *d, size_t from, size_t to)
{
    bool found = false;
    for (size_t a = 0; table->cohesion && a < d->species_count; a++)
        for (size_t b = from; b < to; b++) found = found || table->of[a][b].pull.strength > 0;
    return found;
}

bool pair_table_spheres_cohere(const pair_table *table, const dem_scene_definition *d)
{
    const size_t lining = DEM_MAXIMUM_SPECIES + DEM_LINING;
    return coheres(table, d, 0, d->species_count) || (d->lining.diameter > 0 && coheres(table, d, lining, lining + 1));
}

bool pair_table_walls_cohere(const pair_table *table, const dem_scene_definition *d)
{
    return coheres(table, d, DEM_MAXIMUM_SPECIES, DEM_MAXIMUM_SPECIES + DEM_SURFACES);
}

void pair_table_set(pair_table *table, const dem_scene_definition *d)
{
    memset(table, 0, sizeof *table);
    table->is_given = d->has_pairs;
    table->cohesion = d->contact.cohesion_law;
    for (size_t a = 0; table->cohesion && a < d->species_count; a++) {
        for (size_t b = 0; b < d->species_count; b++) set_cohesion(table, d, a, b);
        for (size_t s = DEM_MAXIMUM_SPECIES; s < DEM_MAXIMUM_SPECIES + DEM_SURFACES; s++) set_cohesion(table, d, a, s);
    }
    for (size_t a = 0; d->has_pairs && a < d->species_count; a++) {
        for (size_t b = 0; b < d->species_count; b++) pair_numbers_set(&table->of[a][b], d, &d->pair[a][b]);
        for (size_t s = DEM_MAXIMUM_SPECIES; s < DEM_MAXIMUM_SPECIES + DEM_SURFACES; s++)
            pair_numbers_set(&table->of[a][s], d, &d->pair[a][s]);
    }
}

/* Whether any of the species has other numbers with one of the partners from..to-1 than `contact` gives. */
static bool law_differs(const pair_table *table, const dem_scene_definition *d, size_t from, size_t to, bool is_wall)
{
    real of_all[LAW_NUMBERS];
    law_numbers_set(of_all, &d->contact, is_wall, d->time_step);
    bool differs = false;
    for (size_t a = 0; table->is_given && a < d->species_count; a++)
        for (size_t b = from; b < to; b++) differs = differs || memcmp(table->of[a][b].law, of_all, sizeof of_all) != 0;
    return differs;
}

bool pair_table_spheres_differ(const pair_table *table, const dem_scene_definition *d)
{
    const size_t lining = DEM_MAXIMUM_SPECIES + DEM_LINING;
    return law_differs(table, d, 0, d->species_count, false)
           || (d->lining.diameter > 0 && law_differs(table, d, lining, lining + 1, false));
}

bool pair_table_walls_differ(const pair_table *table, const dem_scene_definition *d)
{
    return law_differs(table, d, DEM_MAXIMUM_SPECIES, DEM_MAXIMUM_SPECIES + DEM_SURFACES, true);
}

real rolling_root_of(double inverse_mass, double radius, double second_inverse_mass, double second_radius, double effective_radius)
{
    const double second = second_inverse_mass > 0 ? second_inverse_mass / (second_radius * second_radius) : 0;
    return (real)(sqrt(1.4 / (inverse_mass / (radius * radius) + second)) / effective_radius);
}

void species_roots_set(species_roots *roots, const spheres *s)
{
    for (size_t a = 0; a < s->species_count; a++) {
        for (size_t b = 0; b < s->species_count; b++) roots->of[a][b] = (real)(1 / sqrt(s->inverse_mass[a] + s->inverse_mass[b]));
        roots->of[a][DEM_MAXIMUM_SPECIES] = (real)(1 / sqrt(s->inverse_mass[a]));
    }
}

void contact_constants_of_pair(contact_list *list, size_t slot, const pair_table *table, size_t species, size_t partner)
{
    const pair_numbers *numbers = &table->of[species][partner];
    list->friction[slot] = table->has_friction ? numbers->friction : 0;
    if (list->has_rolling) list->rolling_friction[slot] = table->has_friction ? numbers->rolling_friction : 0;
    if (list->laws_differ)
        for (int c = 0; c < LAW_NUMBERS; c++) list->law[c][slot] = numbers->law[c];
}

static void set_pairs(contact_list *pairs, const spheres *s, const pair_table *table, size_t from, size_t to)
{
    for (size_t k = from; k < to; k++) {
        const size_t first = (size_t)s->species[pairs->first[k]], second = (size_t)pairs->second[k];
        const size_t partner = second < s->mobile_count ? (size_t)s->species[second] : DEM_MAXIMUM_SPECIES + DEM_LINING;
        if (table->is_given) contact_constants_of_pair(pairs, k, table, first, partner);
        if (pairs->coheres) contact_constants_of_cohesion(pairs, k, table, first, partner);
    }
}

/* species_roots of two spheres that need not be alike within a species. */
static real root_of_sizes(const spheres *s, size_t first, size_t second)
{
    return (real)(1 / sqrt(sphere_inverse_mass(s, first) + (second < s->mobile_count ? sphere_inverse_mass(s, second) : 0)));
}

void contact_constants_of_each(contact_list *pairs, const spheres *s, const dem_contact_parameters *contact,
                               const species_roots *roots, const pair_table *table, size_t from, size_t to)
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
    if (s->have_sizes) {
        for (size_t k = from; k < to; k++) pairs->root_mass[k] = root_of_sizes(s, (size_t)first[k], (size_t)second[k]);
    } else {
        for (size_t k = from; k < to; k++)
            pairs->root_mass[k] = roots->of[s->species[first[k]]][second[k] < mobile ? s->species[second[k]] : DEM_MAXIMUM_SPECIES];
    }
    for (size_t k = from; pairs->has_rolling && k < to; k++) {
        pairs->rolling_friction[k] = second[k] < mobile ? mu_r : mu_r_wall;
        pairs->rolling_root[k] = rolling_root_of(sphere_inverse_mass(s, (size_t)first[k]), (double)s->full_radius[first[k]],
                                                 second[k] < mobile ? sphere_inverse_mass(s, (size_t)second[k]) : 0,
                                                 (double)s->full_radius[second[k]], (double)pairs->radius[k]);
    }
    if (table->is_given || pairs->coheres) set_pairs(pairs, s, table, from, to);
}

void contact_constants_of_all(contact_list *pairs, const spheres *s, const dem_contact_parameters *contact, const pair_table *table)
{
    const size_t species = (size_t)s->species[0];
    for (size_t k = 0; k < BLOCK; k++) {
        pairs->friction[k] = (real)contact->friction;
        pairs->first_radius[k] = s->full_radius[0];
        pairs->root_mass[k] = (real)sqrt(0.5 / sphere_inverse_mass(s, 0));
        pairs->radius[k] = s->full_radius[0] / 2;
        if (pairs->has_rolling) {
            const double r = (double)s->full_radius[0], per_mass = sphere_inverse_mass(s, 0);
            pairs->rolling_friction[k] = (real)contact->rolling_friction;
            pairs->rolling_root[k] = rolling_root_of(per_mass, r, per_mass, r, r / 2);
        }
        if (table->is_given) contact_constants_of_pair(pairs, k, table, species, species);
        if (pairs->coheres) contact_constants_of_cohesion(pairs, k, table, species, species);
    }
}
