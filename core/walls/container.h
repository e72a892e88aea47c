/* What holds the particles: a few walls, each with its own geometry, friction and motion, and in a drum perhaps a
 * lining of glued spheres. core/NUMERICS.md, "Containers". */
#ifndef CONTAINER_H
#define CONTAINER_H

#include "spheres.h"
#include "wall.h"

enum { MOST_WALLS = 6 + DEM_MAXIMUM_LIFTERS };

typedef struct container {
    dem_container_kind kind;
    double radius, length;         /* m */
    double period, inverse_period; /* m, 1/m along z; both 0 where the axis is not periodic, so that nothing is wrapped */
    double up[3];                  /* unit vector against gravity */
    double rotation_rate;          /* rad/s now: zero until rotation begins */
    double angle;                  /* rad turned */
    double angle_before;           /* rad turned before the time that container_move is told */
    double inner_radius;           /* m, of the free room: radius less the lining's diameter */
    double half_depth;             /* m along y, of a flat vessel, whose radius is half of its width; 0: round */
    double hopper_height;          /* m; 0: a flat floor */
    int funnel;                    /* of a vessel: which wall is its floor or hopper */
    double low[3], high[3];        /* m: the box that particles are looked for in */
    int wall_count;
    int first_bar, bar_count;
    double bars_from; /* m from the axis: no bar is nearer */
    container_wall wall[MOST_WALLS];
} container;

void container_init(container *container, const dem_scene_definition *definition);
/* The walls as they are, at rest (has_begun false) or `time` after the container began to move: places, velocities.
 * True when a wall's velocity is another than before, which lists of contacts in reach do not foresee. */
bool container_move(container *container, const dem_scene_definition *definition, bool has_begun, double time);
/* Friction of every wall; none while particles grow. */
void container_set_friction(container *container, const dem_scene_definition *definition, bool has_friction);
/* m3 below that height; of what stands. */
double container_volume_below(const container *container, double height);
/* Nearest of all walls, as a sphere of that radius at x would overlap it, m; negative: apart. */
double container_overlap(const container *container, const double x[3], double radius);

/* Lining spheres that fit with the pitch asked for: whole numbers around and along. */
size_t container_lining_count(const dem_scene_definition *definition);
void container_place_lining(const container *vessel, const dem_scene_definition *definition, spheres *spheres);
/* Turn the lining to the drum's angle, with the velocity of its place there. */
void container_rotate_lining(const container *vessel, spheres *spheres);

/* z brought into [-length/2, length/2): a function of z alone, so that wrapping gives the same bits whenever done. */
static inline double wrap_axial(double z, double length, double inverse_length) { return z - length * rint(z * inverse_length); }
static inline double squared_distance(const double a[3], const double b[3], double period, double inverse_period)
{
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = wrap_axial(b[2] - a[2], period, inverse_period);
    return dx * dx + dy * dy + dz * dz;
}

#endif
