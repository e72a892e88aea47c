#include "wall.h"

static wall_sight along(double x, double y, double z, double distance)
{
    /* Right on a thin wall there is no direction; that deep, a run has failed. */
    const double to_unit = 1.0 / fmax(distance, 1e-300);
    return (wall_sight){ { x * to_unit, y * to_unit, z * to_unit }, distance };
}

static wall_sight cylinder_seen(const container_wall *w, const double x[3])
{
    const double rho = sqrt(x[0] * x[0] + x[1] * x[1]);
    wall_sight sight = along(x[0], x[1], 0, rho);
    sight.distance = w->radius - rho;
    return sight;
}

static wall_sight plane_seen(const container_wall *w, const double x[3])
{
    return (wall_sight){ { 0, 0, -w->facing }, w->facing * (x[2] - w->low) };
}

/* To the point of the profile (rho, z) = (radius, z_nearest) on x's own side of the axis. */
static wall_sight circle_seen(const double x[3], double radius, double z_nearest)
{
    const double rho = sqrt(x[0] * x[0] + x[1] * x[1]), outward = radius - rho, up = z_nearest - x[2];
    const double e_x = rho > 0 ? x[0] / rho : 1, e_y = rho > 0 ? x[1] / rho : 0;
    return along(e_x * outward, e_y * outward, up, sqrt(outward * outward + up * up));
}

static wall_sight disc_seen(const container_wall *w, const double x[3])
{
    if (x[0] * x[0] + x[1] * x[1] > w->radius * w->radius) return circle_seen(x, w->radius, w->low);
    return along(0, 0, w->low - x[2], fabs(w->low - x[2]));
}

static wall_sight shell_seen(const container_wall *w, const double x[3])
{
    return circle_seen(x, w->radius, fmin(fmax(x[2], w->low), w->high));
}

/* Its section is a strip from `radius` on outward, where the drum's own wall takes over. */
static wall_sight bar_seen(const container_wall *w, const double x[3])
{
    const double e_x = w->middle[0], e_y = w->middle[1]; /* outward; (-e_y, e_x) is across */
    const double out = x[0] * e_x + x[1] * e_y, across = x[1] * e_x - x[0] * e_y - w->aside, back = across < 0 ? 1 : -1;
    const double to_top = w->radius - out, to_side = fabs(across) - w->half_width;
    if (to_top <= 0 && to_side <= 0) /* behind the surface: by the least of both */
        return to_top > to_side ? (wall_sight){ { e_x, e_y, 0 }, to_top } : (wall_sight){ { -back * e_y, back * e_x, 0 }, to_side };
    const double radial = fmax(to_top, 0), sideways = back * fmax(to_side, 0);
    return along(radial * e_x - sideways * e_y, radial * e_y + sideways * e_x, 0, sqrt(radial * radial + sideways * sideways));
}

static wall_sight face_seen(const container_wall *w, const double x[3])
{
    return (wall_sight){ { w->middle[0], w->middle[1], 0 }, w->radius - (x[0] * w->middle[0] + x[1] * w->middle[1]) };
}

static double out_of_middle(const container_wall *w, const double x[3])
{
    return w->middle[0] != 0 ? fabs(x[0]) : sqrt(x[0] * x[0] + x[1] * x[1]);
}

bool wall_is_beneath_funnel(const container_wall *w, const double x[3])
{
    const double out = out_of_middle(w, x) - w->radius;
    return out > 0 && (x[2] - w->low) * (w->outer - w->radius) < out * (w->high - w->low);
}

/* The nearest point of the line from (radius, low) to (outer, high), on x's own side of the axis. */
static wall_sight funnel_seen(const container_wall *w, const double x[3])
{
    const bool is_flat = w->middle[0] != 0;
    const double s = out_of_middle(w, x);
    const double e_x = is_flat ? (x[0] < 0 ? -1 : 1) : s > 0 ? x[0] / s : 1, e_y = is_flat || !(s > 0) ? 0 : x[1] / s;
    const double out = w->outer - w->radius, up = w->high - w->low;
    const double share = fmin(fmax(((s - w->radius) * out + (x[2] - w->low) * up) / (out * out + up * up), 0.0), 1.0);
    const double outward = w->radius + share * out - s, upward = w->low + share * up - x[2];
    return along(e_x * outward, e_y * outward, upward, sqrt(outward * outward + upward * upward));
}

wall_sight wall_seen_from(const container_wall *w, const double x[3])
{
    switch (w->kind) {
    case WALL_CYLINDER: return cylinder_seen(w, x);
    case WALL_PLANE: return plane_seen(w, x);
    case WALL_DISC: return disc_seen(w, x);
    case WALL_SHELL: return shell_seen(w, x);
    case WALL_FACE: return face_seen(w, x);
    case WALL_FUNNEL: return funnel_seen(w, x);
    case WALL_BAR: break;
    }
    return bar_seen(w, x);
}
