#include "cluster.h"

#include "array.h"
#include "dem_cluster.h"

/* Lattice shapes come out equal to rounding; what the integral over an overlap leaves is 1e-6 and stays. */
static bool are_equal(const double moment[3])
{
    return fabs(moment[1] - moment[0]) < 1e-12 * moment[0] && fabs(moment[2] - moment[0]) < 1e-12 * moment[0];
}

static void shape_init(cluster_shape *shape, const dem_species *species)
{
    const dem_cluster *from = &species->cluster;
    shape->sphere_count = from->sphere_count;
    for (size_t k = 0; k < from->sphere_count; k++) memcpy(shape->place[k], from->sphere[k].position, sizeof shape->place[k]);
    shape->mass = from->volume * species->density;
    shape->is_isotropic = from->sphere_count > 0 && are_equal(from->inertia);
    for (int c = 0; c < 3; c++) shape->inertia[c] = from->inertia[shape->is_isotropic ? 0 : c] * species->density;
    shape->reach = from->reach;
}

dem_status clusters_init(clusters *c, const dem_scene_definition *definition, size_t count, size_t sphere_count)
{
    *c = (clusters){ .count = count,
                     .sphere_count = sphere_count,
                     .corrector_passes = definition->corrector_passes > 1 ? definition->corrector_passes : 1 };
    c->shape = array_create(definition->species_count, sizeof *c->shape);
    c->body = array_create(count, sizeof *c->body);
    c->of_sphere = array_create(sphere_count, sizeof *c->of_sphere);
    if (!c->shape || !c->body || !c->of_sphere) return DEM_NO_MEMORY;
    for (size_t k = 0; k < definition->species_count; k++) shape_init(&c->shape[k], &definition->species[k]);
    return DEM_OK;
}

void clusters_clear(clusters *c)
{
    free(c->shape);
    free(c->body);
    free(c->of_sphere);
    *c = (clusters){ 0 };
}

/* Eqns 7 and 9: what a step adds to the angular velocity, given the one on the step. */
static void euler_change(double change[3], const double omega[3], const double torque[3], const double inertia[3], double dt)
{
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        change[a] = (torque[a] + omega[b] * omega[c] * (inertia[b] - inertia[c])) * dt / inertia[a];
    }
}

void euler_advance(double omega[3], double change[3], const double torque[3], const double inertia[3], double dt, int corrections)
{
    for (int pass = 0; pass <= corrections; pass++) {
        double on_step[3]; /* Eq 6, then Eq 8 */
        for (int a = 0; a < 3; a++) on_step[a] = omega[a] + 0.5 * change[a];
        euler_change(change, on_step, torque, inertia, dt);
    }
    for (int a = 0; a < 3; a++) omega[a] += change[a]; /* Eq 10 */
}

double clusters_kinetic_energy(const clusters *c)
{
    double energy = 0.0;
    for (size_t k = 0; k < c->count; k++) {
        const cluster_body *b = &c->body[k];
        const cluster_shape *shape = &c->shape[b->species];
        for (int a = 0; a < 3; a++)
            energy += 0.5 * (shape->mass * b->velocity[a] * b->velocity[a] + shape->inertia[a] * b->spin[a] * b->spin[a]);
    }
    return energy;
}
