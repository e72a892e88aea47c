#include "wall_reach.h"

/* A straight path's distance from the axis is largest at one of its ends. */
static inline bool cylinder_in_reach(const spheres *s, size_t i, double wall, wall_outlook outlook)
{
    const double *a = sphere_place(s, i), t = outlook.duration;
    /* as contact arithmetic has the velocity */
    const double x = a[0] + t * (double)(real)s->velocity[i][0], y = a[1] + t * (double)(real)s->velocity[i][1];
    const double then2 = x * x + y * y, now2 = a[0] * a[0] + a[1] * a[1], rho2 = then2 > now2 ? then2 : now2;
    const double limit = wall - s->full_radius[i] - outlook.margin;
    return limit < 0 || rho2 > limit * limit;
}

/* The distance from a body changes no faster than one moves in the frame of that body. There the sphere starts with
 * u = v - (velocity of the wall at x), and a turning frame adds at most omega |v| t to that: after t it has come closer
 * by at most |u| t + omega |v| t^2/2. */
static bool body_in_reach(const spheres *s, size_t i, const container_wall *w, wall_outlook outlook)
{
    const double *x = sphere_place(s, i), t = outlook.duration;
    const vector4 v = s->velocity[i];
    double at_wall[3];
    wall_velocity(w, x, at_wall);
    const double u[3] = { v[0] - at_wall[0], v[1] - at_wall[1], v[2] - at_wall[2] };
    const double closer =
        sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) * t + 0.5 * fabs(w->rotation_rate) * sqrt(v[0] * v[0] + v[1] * v[1]) * t * t;
    /* a little for the rounding of places and distances */
    return wall_seen_from(w, x).distance - closer < (1 + 1e-6) * s->full_radius[i] + outlook.margin;
}

static bool in_reach(const spheres *s, const container *c, wall_outlook outlook, size_t i, int k)
{
    const container_wall *w = &c->wall[k];
    return w->kind == WALL_CYLINDER ? cylinder_in_reach(s, i, w->radius, outlook) : body_in_reach(s, i, w, outlook);
}

/* Bars are many, and most spheres are too near the axis for any of them. */
static bool bars_are_far(const spheres *s, const container *c, wall_outlook outlook, size_t i)
{
    const double *x = sphere_place(s, i);
    const vector4 v = s->velocity[i];
    const double outermost = sqrt(x[0] * x[0] + x[1] * x[1]) + sqrt(v[0] * v[0] + v[1] * v[1]) * outlook.duration;
    return outermost + (1 + 1e-6) * s->full_radius[i] + outlook.margin < c->bars_from;
}

static size_t walls_in_reach(const spheres *s, const container *c, wall_outlook outlook, size_t i)
{
    const int end = c->bar_count && bars_are_far(s, c, outlook, i) ? c->first_bar : c->wall_count;
    size_t count = 0;
    for (int k = 0; k < end; k++) count += in_reach(s, c, outlook, i, k);
    return count;
}

void wall_reach_count(const spheres *s, const container *c, wall_outlook outlook, size_t from, size_t to, uint32_t *count)
{
    if (c->wall_count == 1 && c->wall[0].kind == WALL_CYLINDER) {
        const double wall = c->wall[0].radius;
        for (size_t i = from; i < to; i++) count[i] = (uint32_t)cylinder_in_reach(s, i, wall, outlook);
        return;
    }
    for (size_t i = from; i < to; i++) count[i] = (uint32_t)walls_in_reach(s, c, outlook, i);
}

void wall_reach_fill(contact_list *walls, size_t slot, size_t end, const spheres *s, const container *c, const pair_table *table,
                     wall_outlook outlook, size_t i)
{
    for (int k = 0; slot < end; k++) {
        if (!in_reach(s, c, outlook, i, k)) continue;
        walls->first[slot] = (int32_t)i;
        walls->second[slot] = k;
        walls->friction[slot] = (real)c->wall[k].friction;
        const double r = (double)s->full_radius[i];
        if (walls->has_rolling) {
            walls->rolling_friction[slot] = (real)c->wall[k].rolling_friction;
            walls->rolling_root[slot] = rolling_root_of(sphere_inverse_mass(s, i), r, 0, 0, r);
        }
        walls->first_radius[slot] = s->full_radius[i];
        walls->root_mass[slot] = (real)(1 / sqrt(sphere_inverse_mass(s, i)));
        walls->radius[slot] = s->full_radius[i];
        const size_t species = (size_t)s->species[i], partner = DEM_MAXIMUM_SPECIES + (size_t)c->wall[k].surface;
        if (table->is_given) contact_constants_of_pair(walls, slot, table, species, partner);
        if (walls->coheres) contact_constants_of_cohesion(walls, slot, table, species, partner);
        slot++;
    }
}
