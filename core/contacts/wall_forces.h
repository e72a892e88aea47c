/* Forces of contacts between spheres and walls. A contact is (first: sphere, second: index of the wall), in the same kind
 * of list and under the same law as contacts between spheres. */
#ifndef WALL_FORCES_H
#define WALL_FORCES_H

#include "neighbor_list.h"

/* At the positions of this step, each contact into its own row of the list of walls, and its torque; updates what contacts
 * remember. dt: s, the step since the last call. Returns the largest overlap, m. */
double contact_forces_with_walls(neighbor_list *list, const spheres *spheres, const container *container,
                                 const dem_contact_parameters *contact, double dt);

/* N m about the axis, of all walls on the bed, as contact_forces_with_walls left it; positive turns counter-clockwise. */
double wall_torque(const neighbor_list *list);

/* contact_forces_with_walls, torques apart, of the contacts from..to-1, which are all in one block; nobody reads or writes
 * others. largest: m, the largest overlaps so far. */
void contact_forces_with_some_walls(neighbor_list *list, size_t from, size_t to, const spheres *spheres, const container *container,
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
