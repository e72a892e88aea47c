#include "spheres.h"

#include "dem_rules.h"

size_t spheres_count(const spheres *s) { return s->mobile_count + s->lining_count; }

static void null_sphere_set(spheres *s)
{
    sphere_row *row = &s->row[spheres_count(s)];
    row->x[0] = row->x[1] = 1e6; /* far from everything, and from no period's image */
}

dem_status spheres_init(spheres *s, const dem_drum_definition *definition, size_t lining_count)
{
    const size_t n = definition->particle_count, all = n + lining_count + 1;
    memset(s, 0, sizeof *s);
    s->mobile_count = n;
    s->lining_count = lining_count;
    s->row = array_create(all, sizeof *s->row);
    s->species = array_create(n, sizeof *s->species);
    s->full_radius = array_create(all, sizeof *s->full_radius);
    s->velocity = array_create(n, sizeof *s->velocity);
    s->angular_velocity = array_create(n, sizeof *s->angular_velocity);
    s->force = array_create(n, sizeof *s->force);
    s->torque = array_create(n, sizeof *s->torque);
    s->inverse_mass = array_create(n, sizeof *s->inverse_mass);
    s->inverse_inertia = array_create(n, sizeof *s->inverse_inertia);
    s->fallen_time = array_create(n, sizeof *s->fallen_time);
    s->lining_place = array_create(lining_count, sizeof *s->lining_place);
    if (!s->row || !s->species || !s->full_radius || !s->velocity || !s->angular_velocity || !s->force || !s->torque
        || !s->inverse_mass || !s->inverse_inertia || !s->fallen_time || !s->lining_place) {
        spheres_clear(s);
        return DEM_NO_MEMORY;
    }
    null_sphere_set(s);
    for (size_t i = 0; i < n; i++) s->fallen_time[i] = -1e300;
    return DEM_OK;
}

void spheres_clear(spheres *s)
{
    free(s->row);
    free(s->species);
    free(s->full_radius);
    free(s->velocity);
    free(s->angular_velocity);
    free(s->force);
    free(s->torque);
    free(s->inverse_mass);
    free(s->inverse_inertia);
    free(s->fallen_time);
    free(s->lining_place);
    memset(s, 0, sizeof *s);
}

void spheres_set_scale(spheres *s, double scale)
{
    for (size_t i = 0; i < s->mobile_count; i++) sphere_row_set_radius(&s->row[i], scale * s->full_radius[i]);
}

double spheres_kinetic_energy(const spheres *s)
{
    double energy = 0.0;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double *v = s->velocity[i], *w = s->angular_velocity[i];
        energy += 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / s->inverse_mass[i]
                + 0.5 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) / s->inverse_inertia[i];
    }
    return energy;
}
