/* A few particles by their ids, for whoever follows their paths. */
#include <math.h>
#include <string.h>

#include "scene.h"

/* (9): place of the centre of mass, velocity, angular velocity. */
static void look_at(const spheres *s, size_t p, double *numbers)
{
    const bool is_single = p < s->single_count;
    const cluster_body *body = is_single ? NULL : &s->clusters.body[p - s->single_count];
    const vector4 v = is_single ? s->velocity[p] : body->velocity;
    const vector4 omega = s->angular_velocity[is_single ? p : (size_t)body->first_sphere];
    for (int c = 0; c < 3; c++) {
        numbers[c] = particle_place(s, p)[c];
        numbers[3 + c] = v[c];
        numbers[6 + c] = omega[c];
    }
}

void dem_tracers_measure(const dem_scene *scene, const int32_t *ids, size_t count, double *numbers)
{
    const spheres *s = &scene->spheres;
    for (size_t k = 0; k < DEM_TRACER_NUMBERS * count; k++) numbers[k] = NAN;
    for (size_t p = 0; p < particles_count(s); p++)
        for (size_t k = 0; k < count; k++)
            if (ids[k] == particle_id(s, p) && !particle_is_lost(scene, p)) look_at(s, p, numbers + DEM_TRACER_NUMBERS * k);
}
