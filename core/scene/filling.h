/* The random start of a bed: particles placed and turned at random in the lower part of the container at a share of their
 * size, grown to full size without gravity or friction, then let fall and come to rest. */
#ifndef FILLING_H
#define FILLING_H

#include "container.h"
#include "quaternion.h"
#include "random.h"
#include "spheres.h"

enum { STEPS_BETWEEN_RESTS = 100 }; /* of settling, between two looks whether the bed is at rest */

typedef struct filling {
    double start_scale; /* share of full size at which particles are placed */
    int64_t growing_steps;
    double growing_drag;  /* 1/s */
    double settling_drag; /* 1/s */
    int64_t settling_steps_least, settling_steps_most;
    double rest_energy; /* J: the bed is at rest when its kinetic energy is below */
} filling;

/* Mass, inertia and species of every particle, its place and orientation at start_scale.
 * Errors: DEM_DOES_NOT_FIT, DEM_NO_MEMORY. */
dem_status filling_place(filling *filling, spheres *spheres, const container *vessel, const dem_scene_definition *definition);
/* Mass, inertia and species alone, of particles in the order of their species (particles). */
dem_status filling_assign_in_order(spheres *spheres, const dem_scene_definition *definition, const int32_t *order);
quaternion filling_random_orientation(random_stream *random); /* evenly over all */
/* The same without places: for particles that are put somewhere by other means, and are of full size at once. */
dem_status filling_leave_out(filling *filling, spheres *spheres, const dem_scene_definition *definition);
/* Share of full size after so many steps of growing. */
double filling_scale(const filling *filling, int64_t steps);

#endif
