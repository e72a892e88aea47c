/* What does not change in a step of a contact between spheres: friction, radii, masses. A law may ask for any of it, whatever
 * the species. */
#ifndef CONTACT_CONSTANTS_H
#define CONTACT_CONSTANTS_H

#include "contact_list.h"
#include "spheres.h"

/* kg^(1/2), roots of effective masses: of two species, and last of one species against what is fixed. */
typedef struct species_roots {
    real of[DEM_MAXIMUM_SPECIES][DEM_MAXIMUM_SPECIES + 1];
} species_roots;

void species_roots_set(species_roots *roots, const spheres *spheres);
/* Of the pairs from..to-1. */
void contact_constants_of_each(contact_list *pairs, const spheres *spheres, const dem_contact_parameters *contact,
                               const species_roots *roots, size_t from, size_t to);
/* Of a block of pairs, which are all alike. */
void contact_constants_of_all(contact_list *pairs, const spheres *spheres, const dem_contact_parameters *contact);

#endif
