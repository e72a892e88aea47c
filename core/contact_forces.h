/* Forces of all contacts between spheres in reach, and each sphere's sums over them. */
#ifndef CONTACT_FORCES_H
#define CONTACT_FORCES_H

#include "leap_frog.h"

/* Contact forces at the positions of this step, and the spheres' loads of them and of the walls' rows; updates what contacts
 * remember. dt: s, the step since the last call. Returns the largest overlap, m.
 *
 * walls: whose contacts get their rows on the way, while their spheres are in the cache. NULL: they have them
 * (contact_forces_with_walls).
 *
 * Each load is one running sum, in the list's order and then of the walls: contacts in reach that do not touch, whose
 * number depends on when the list was made, add zeros.
 *
 * leap: single spheres take their step as soon as they have all their forces, while both are in the cache; strayed: of
 * these, what spheres_advance returns. NULL: none does. */
double contact_forces_between_spheres(neighbor_list *list, spheres *spheres, const container *walls,
                                      const dem_contact_parameters *contact, double dt, const leap_frog *leap, vector4 *strayed);

#endif
