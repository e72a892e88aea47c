/* Forces of contacts between spheres and walls. A contact is (first: sphere, second: index of the wall), in the same kind
 * of list and under the same law as contacts between spheres. */
#ifndef WALL_FORCES_H
#define WALL_FORCES_H

#include "neighbor_list.h"

/* Computes all contacts with walls at the places of now: the force and moment of each contact go into its row of list->walls, and
 * its torque about the axis into list->wall_torques. Updates the contacts' histories. dt: s, the step since the last call.
 * Returns the largest overlap, m. */
double contact_forces_with_walls(neighbor_list *list, const spheres *spheres, const container *container,
                                 const dem_contact_parameters *contact, double dt);

/* N m about the axis: the torque of all walls on the bed, summed from what contact_forces_with_walls has left. Positive turns
 * counter-clockwise. */
double wall_torque(const neighbor_list *list);

/* Computes the contacts from..to-1 with walls, which are all in one block, as contact_forces_with_walls does, but without the
 * torques. Other threads may work on the other contacts of that block. largest: m, in each lane the largest overlap so far. */
void contact_forces_with_some_walls(neighbor_list *list, size_t from, size_t to, const spheres *spheres, const container *container,
                                    const dem_contact_parameters *contact, double dt, wide *largest);

/* What a contact does to the container. It may be asked for only between contact_forces_with_walls and the motion that follows,
 * while spheres and walls are still where the forces were computed. */
typedef struct wall_load {
    int wall;           /* index into the container's walls */
    double point[3];    /* m: of the wall, nearest to the sphere's centre */
    double force[3];    /* N, on the wall */
    double velocity[3]; /* m/s, of the wall's material there */
} wall_load;

wall_load wall_load_of(const contact_list *walls, size_t slot, const spheres *spheres, const container *container);

#endif
