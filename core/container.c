#include "container.h"

#include "dem_rules.h"

void container_init(container *drum, const dem_drum_definition *definition)
{
    *drum = (container){ .radius = 0.5 * definition->diameter, .length = definition->length };
    drum->inner_radius = drum->radius - definition->lining.diameter;
}

/* Centres lie half a diameter inside the wall, so the lining touches it from within. */
static double lining_radius(const dem_drum_definition *definition)
{
    return 0.5 * (definition->diameter - definition->lining.diameter);
}

static size_t lining_around(const dem_drum_definition *definition)
{
    return (size_t)floor(2 * DEM_PI * lining_radius(definition) / definition->lining.pitch + 1e-9);
}

static size_t lining_along(const dem_drum_definition *definition)
{
    return (size_t)floor(definition->length / definition->lining.pitch + 1e-9);
}

size_t container_lining_count(const dem_drum_definition *definition)
{
    return definition->lining.diameter > 0 ? lining_around(definition) * lining_along(definition) : 0;
}

void container_place_lining(const container *drum, const dem_drum_definition *definition, spheres *s)
{
    if (s->lining_count == 0) return;
    const size_t around = lining_around(definition), along = lining_along(definition);
    for (size_t k = 0; k < s->lining_count; k++) {
        const double angle = 2 * DEM_PI * (double)(k / along) / (double)around;
        vector4 *place = &s->lining_place[k];
        (*place)[0] = lining_radius(definition) * cos(angle);
        (*place)[1] = lining_radius(definition) * sin(angle);
        (*place)[2] = drum->length * (((double)(k % along) + 0.5) / (double)along - 0.5);
        s->row[s->mobile_count + k].radius = (real)(0.5 * definition->lining.diameter);
        s->full_radius[s->mobile_count + k] = (double)s->row[s->mobile_count + k].radius;
    }
    container_turn_lining(drum, s);
}

void container_turn_lining(const container *drum, spheres *s)
{
    const double c = cos(drum->angle), sine = sin(drum->angle);
    for (size_t k = 0; k < s->lining_count; k++) {
        sphere_row *row = &s->row[s->mobile_count + k];
        const vector4 place = s->lining_place[k];
        row->x[0] = c * place[0] - sine * place[1];
        row->x[1] = sine * place[0] + c * place[1];
        row->x[2] = place[2];
        row->v[0] = (real)(-drum->rotation_rate * row->x[1]);
        row->v[1] = (real)(drum->rotation_rate * row->x[0]);
        row->omega[2] = (real)drum->rotation_rate;
        row->r_omega[2] = row->radius * row->omega[2];
    }
}

/* Share of a unit circle's area below the height y. */
static double area_below(double y) { return (acos(-y) + y * sqrt(1 - y * y)) / DEM_PI; }

double circle_level(double share)
{
    double low = -1.0, high = 1.0;
    for (int k = 0; k < 60; k++) *(area_below(0.5 * (low + high)) < share ? &low : &high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}
