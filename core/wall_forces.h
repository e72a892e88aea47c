/* Forces of contacts between spheres and walls. A contact is (first: sphere, second: index of the wall), in the same kind
 * of list and under the same law as contacts between spheres. */
#ifndef WALL_FORCES_H
#define WALL_FORCES_H

#include "neighbor_list.h"

/* At the positions of this step, each contact into its own row of the list of walls; updates what contacts remember. dt: s,
 * the step since the last call. Returns the largest overlap, m. */
double contact_forces_with_walls(neighbor_list *list, const spheres *spheres, const container *container,
                                 const dem_contact_parameters *contact, double dt);

/* The same of the contacts from `start` on, a whole block. largest: m, the largest overlaps so far. */
void contact_forces_with_walls_of_block(neighbor_list *list, size_t start, const spheres *spheres, const container *container,
                                        const dem_contact_parameters *contact, double dt, wide *largest);

/* What a contact does to the container. True only between contact_forces_with_walls and the move that follows: then
 * spheres and walls are still where the forces were computed. */
typedef struct wall_load {
    int wall;           /* index into the container's walls */
    double point[3];    /* m: of the wall, nearest to the sphere's centre */
    double force[3];    /* N, on the wall */
    double velocity[3]; /* m/s, of the wall's material there */
} wall_load;

wall_load wall_load_of(const contact_list *walls, size_t slot, const spheres *spheres, const container *container);

#endif
