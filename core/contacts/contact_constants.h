/* What does not change in a step of a contact: friction, radii, masses, and what its two materials are to its law. A law may ask for
 * any of it, whatever the species. */
#ifndef CONTACT_CONSTANTS_H
#define CONTACT_CONSTANTS_H

#include "contact_list.h"
#include "spheres.h"

/* kg^(1/2), roots of effective masses: of two species, and last of one species against what is fixed. */
typedef struct species_roots {
    real of[DEM_MAXIMUM_SPECIES][DEM_MAXIMUM_SPECIES + 1];
} species_roots;

/* What contacts of two materials have as constants. */
typedef struct pair_numbers {
    real friction, rolling_friction, law[LAW_NUMBERS];
    /* Cohesion: what a contact of this effective radius has; of other radii it is computed from the rest. */
    real radius, cohesion[COHESION_NUMBERS];
    dem_cohesion pull;
    double effective_modulus; /* Pa */
} pair_numbers;

/* The same for each pair of a definition; where it has none, everything is as `contact` and the walls say. */
typedef struct pair_table {
    bool is_given;
    bool has_friction; /* else the present phase has none */
    dem_cohesion_law cohesion;
    double gap; /* m: the largest at which contacts hold that have touched */
    pair_numbers of[DEM_MAXIMUM_SPECIES][DEM_MAXIMUM_SPECIES + DEM_SURFACES];
} pair_table;

void pair_table_set(pair_table *table, const dem_scene_definition *definition);
/* Whether contacts with others than themselves, or with walls, have other numbers of the law than `contact` gives to all. */
bool pair_table_spheres_differ(const pair_table *table, const dem_scene_definition *definition);
bool pair_table_walls_differ(const pair_table *table, const dem_scene_definition *definition);

/* kg^(1/2): root of I_r/R*^2, 1/I_r the sum of 1/(7/5 m R^2) over both ends (Ai et al. 2011). The second's inverse mass, 1/kg, is 0 where
 * it is fixed. */
real rolling_root_of(double inverse_mass, double radius, double second_inverse_mass, double second_radius, double effective_radius);
void species_roots_set(species_roots *roots, const spheres *spheres);
/* Of the pairs from..to-1. */
void contact_constants_of_each(contact_list *pairs, const spheres *spheres, const dem_contact_parameters *contact,
                               const species_roots *roots, const pair_table *table, size_t from, size_t to);
/* Of a block of pairs, which are all alike. */
void contact_constants_of_all(contact_list *pairs, const spheres *spheres, const dem_contact_parameters *contact,
                              const pair_table *table);
/* Whether contacts between spheres cohere, or those with walls. */
bool pair_table_spheres_cohere(const pair_table *table, const dem_scene_definition *definition);
bool pair_table_walls_cohere(const pair_table *table, const dem_scene_definition *definition);
/* Of one contact of a list, whose effective radius is set: its cohesion. */
void contact_constants_of_cohesion(contact_list *list, size_t slot, const pair_table *table, size_t species, size_t partner);
/* Of one contact of a list: what it has by its two materials. partner: index into the table's second. */
void contact_constants_of_pair(contact_list *list, size_t slot, const pair_table *table, size_t species, size_t partner);

#endif
