/* Forces of all contacts in reach: each contact writes its own row, then each sphere sums its rows in order. */
#ifndef CONTACT_FORCES_H
#define CONTACT_FORCES_H

#include "neighbor_list.h"

/* Contact forces at the positions of this step, each into its own row of its list; updates what contacts
 * remember. dt: s, the step since the last call. Returns the largest overlap, m. */
double contact_forces_between_spheres(contact_list *pairs, const spheres *spheres, const container *drum,
                                      const dem_contact_parameters *contact, double dt, int threads);
/* spheres->force and ->torque from the rows. */
void contact_forces_sum(const neighbor_list *list, spheres *spheres, int threads);
#endif
