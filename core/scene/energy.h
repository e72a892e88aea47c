/* What the drum gives to the bed, and what becomes of it. */
#ifndef ENERGY_H
#define ENERGY_H

#include "contact_list.h"
#include "spheres.h"

/* The drum's torque, looked at every STEPS_BETWEEN_TORQUES steps of rotation: a contact lasts as many, so that
 * looking more often would tell no more. */
enum { STEPS_BETWEEN_TORQUES = 20 };

typedef struct torque_meter {
    double sum;   /* N m */
    double count; /* looks since the last frame of measurement */
} torque_meter;

/* Work of the contacts' forces, summed over every step while it is switched on. */
typedef struct energy_audit {
    bool is_on;
    double contact_work; /* J, done on the particles by all contacts */
    double wall_work;    /* J, done by the drum: its torque times what it turned */
} energy_audit;

/* N m about the axis, of a drum with its lining on the bed, from the loads; positive turns counter-clockwise: contacts between spheres exchange momentum at one point, so their moments about
 * the axis cancel in the sum over all mobile spheres. */
double energy_torque_of_loads(const spheres *spheres);
/* W, of the contacts' forces `load` on the particles, with the velocities of now. */
double energy_contact_power(const spheres *spheres, const row8 *load);
/* J: kinetic energy and that of height above the axis, half a step ago, where velocities are known. What changes it is the
 * contacts' work: with forces at a step and the mean of the velocities half a step before and after, leap-frog keeps
 * that balance to the last digit. */
double energy_of_particles(const spheres *spheres, double gravity, double dt);

#endif
