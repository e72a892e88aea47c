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

/* Torque, N m about the axis, of a drum with its lining on the bed; positive turns counter-clockwise. It is the sum over the loads of
 * all mobile spheres, in which the moments of contacts between them cancel, because both act at one point. */
double energy_torque_of_loads(const spheres *spheres);
/* Power, W, of the contacts' forces `load` on the particles at their present velocities. */
double energy_contact_power(const spheres *spheres, const row8 *load);
/* Kinetic and potential energy, J, of the particles half a step ago, where velocities are known; height counts from the axis. Only
 * the contacts' work changes it: leap-frog keeps that balance to the last digit, where the work is taken with the forces at a
 * step and the mean of the velocities half a step before and after. */
double energy_of_particles(const spheres *spheres, const double up[3], double gravity, double dt);

#endif
