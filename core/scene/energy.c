#include "energy.h"

double energy_torque_of_loads(const spheres *s)
{
    double torque = 0.0;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double *x = sphere_place(s, i);
        const vector4 force = row8_force(&s->load[i]), moment = row8_torque(&s->load[i]);
        torque += x[0] * force[1] - x[1] * force[0] + moment[2];
    }
    return torque;
}

double energy_contact_power(const spheres *s, const row8 *load)
{
    double power = 0.0;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const vector4 force = row8_force(&load[i]), moment = row8_torque(&load[i]);
        const vector4 part = force * s->velocity[i] + moment * s->angular_velocity[i];
        power += part[0] + part[1] + part[2];
    }
    return power;
}

double energy_of_particles(const spheres *s, const double up[3], double gravity, double dt)
{
    double energy = spheres_kinetic_energy(s);
    for (size_t p = 0; p < particles_count(s); p++) {
        const vector4 v = p < s->single_count ? s->velocity[p] : s->clusters.body[p - s->single_count].velocity;
        for (int c = 0; c < 3; c++) energy += particle_mass(s, p) * gravity * up[c] * (particle_place(s, p)[c] - 0.5 * dt * v[c]);
    }
    return energy;
}
