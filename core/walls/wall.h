/* The walls of a container: how a sphere's centre sees each, and how each moves. A wall is a surface that never ends
 * where a sphere could come behind it, but for thin ones, which are touched from both sides and at their edges. */
#ifndef WALL_H
#define WALL_H

#include "dem_types.h"
#include "real.h"

typedef enum wall_kind {
    WALL_CYLINDER, /* about z, without end, touched from within */
    WALL_PLANE,    /* across z, without end, touched from the side that it faces */
    WALL_DISC,     /* across z, thin: a plate */
    WALL_SHELL,    /* about z, thin: a tube or a rim */
    WALL_BAR,      /* along z, without end: what a lifter has inside its drum */
    WALL_FACE,     /* upright and flat, without end, touched from the side of the axis */
    WALL_FUNNEL    /* thin; its section is a straight line that goes about the axis, or across a flat vessel on both sides */
} wall_kind;

typedef struct container_wall {
    wall_kind kind;
    dem_surface surface; /* whose material it has */
    double friction, rolling_friction;
    /* m: of cylinder, disc and shell; of a bar, the place of its top along the direction of `middle`; of a face and of a funnel's lower
     * edge, the distance from the axis */
    double radius;
    double outer;      /* m: distance of a funnel's upper edge */
    double low, high;  /* m: the edges of shell and funnel along z; plane and disc are at low */
    double facing;     /* plane: 1 up z, -1 down z */
    double half_width; /* m: of the bar */
    double aside;      /* m: by which the bar's middle passes the axis, to the left of its direction; 0 of one along the radius */
    double place[2];   /* bar: unit vector outward along it, before anything turned */
    double middle[2];  /* bar: the same now; face: unit vector from the axis to it; funnel: 1, 0 of a flat vessel, else 0 */
    double rotation_rate; /* rad/s about z, now */
    double rise;          /* m/s along z, now */
} container_wall;

typedef struct wall_sight {
    double toward[3]; /* unit vector from the point to the nearest of the wall */
    double distance;  /* m; negative: behind the surface */
} wall_sight;

/* The wall as seen from x. */
wall_sight wall_seen_from(const container_wall *wall, const double x[3]);
/* Whether x is below a funnel, though not below its hole. */
bool wall_is_beneath_funnel(const container_wall *funnel, const double x[3]);
/* Velocity of the wall's material at a point of it, m/s. */
static inline void wall_velocity(const container_wall *w, const double point[3], double velocity[3])
{
    velocity[0] = -w->rotation_rate * point[1];
    velocity[1] = w->rotation_rate * point[0];
    velocity[2] = w->rise;
}

#endif
