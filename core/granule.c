/* A point mass on the wall. In units of R, g and m, with theta from the horizontal on the rising side, u = dtheta/dt,
 * w = u^2:
 *     N = w - sin(theta)                                            wall pushes inward; Eq 25 with u = Omega
 *     du/dt = -cos(theta) + T,   |T| <= mu N                        Eq 24 with friction
 * It sticks (u = Omega, T = cos(theta)) while |cos(theta)| <= mu N. It slips with T = mu N where u < Omega, whichever
 * way it moves, and with T = -mu N where u > Omega. As u du/dt = du^2/2 dtheta, slipping is linear in w:
 *     dw/dtheta = 2 s (w - sin(theta)) - 2 cos(theta),   s = +mu or -mu
 *     w = A sin(theta) + B cos(theta) + C exp(2 s theta),   A = (4 s^2 - 2)/(1 + 4 s^2),   B = 6 s/(1 + 4 s^2)
 * so each piece of the motion is known exactly, and only the angles where one piece ends and the next begins are
 * searched. Pieces are walked on a grid that has the top as one of its angles: N can touch zero from above only there
 * (where N = 0, dN/dtheta = -3 cos(theta)), so no loss of contact falls between two angles of the grid. */
#include "dem_granule.h"

#include <math.h>

#include "dem_rules.h"
#include "regime_map.h"

enum { GRID = 1024, MOST_BISECTIONS = 60 }; /* angles a turn, a multiple of 4 */
#define BOTTOM (-0.5 * DEM_PI)
/* Of Omega^2: a few dozen roundings of 2^-53, magnified at most some hundredfold on the way to the top. */
#define ROUNDING 1e-12
/* Where slipping has just begun, w differs from Omega^2 by rounding alone. */
#define GRAZING 1e-13
/* rad: a particle that can, by rounding, neither slip nor stick is carried on so far. */
#define NUDGE 1e-12

/* A piece of slipping motion, through (start, w_start). */
typedef struct slip {
    double s, a, b, c, start;
} slip;

static slip slip_from(double theta, double w, double s)
{
    const double q = 1 + 4 * s * s;
    slip p = { .s = s, .a = (4 * s * s - 2) / q, .b = 6 * s / q, .start = theta };
    p.c = w - p.a * sin(theta) - p.b * cos(theta);
    return p;
}

static double slip_w(const slip *p, double theta)
{
    return p->a * sin(theta) + p->b * cos(theta) + p->c * exp(2 * p->s * (theta - p->start));
}

/* What ends a piece of slipping motion. Each has a number that is negative once it has happened. */
typedef enum slip_event { LEAVES_WALL, COMES_TO_REST, MEETS_WALL_SPEED, SLIP_EVENTS } slip_event;

static double event_value(const slip *p, double omega2, slip_event event, double theta)
{
    const double w = slip_w(p, theta);
    if (event == LEAVES_WALL) return w - sin(theta);
    if (event == COMES_TO_REST) return w;
    return (p->s > 0 ? omega2 - w : w - omega2) + GRAZING * (1 + omega2);
}

/* The event lies between from (not yet) and to (has happened); the last angle at which it has not. */
static double event_angle(const slip *p, double omega2, slip_event event, double from, double to)
{
    for (int k = 0; k < MOST_BISECTIONS; k++) {
        const double middle = 0.5 * (from + to);
        if (event_value(p, omega2, event, middle) < 0) to = middle;
        else from = middle;
    }
    return from;
}

/* Time from one angle to another, the integral of 1/u, by Gauss's rule of 4 points. Who goes round has u >= 1 all the
 * way (w falls to its least, at the top, where N >= 0), so on pieces of 0.006 the error is below rounding. */
static double slip_time(const slip *p, double from, double to)
{
    static const double place[] = { 0.33998104358485626, 0.86113631159405258 };
    static const double weight[] = { 0.65214515486254614, 0.34785484513745386 };
    const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
    double sum = 0.0;
    for (int k = 0; k < 2; k++)
        sum += weight[k] * (1 / sqrt(slip_w(p, middle - half * place[k])) + 1 / sqrt(slip_w(p, middle + half * place[k])));
    return half * sum;
}

typedef struct granule {
    double mu, omega2;
    double theta, w;
    bool sticks;
    double time; /* of the revolution */
    double onset, least_normal_force;
} granule;

static double grid_angle(int k) { return BOTTOM + k * (2 * DEM_PI / GRID); }

/* Where a particle that sticks begins to slip; `end` when not before it. Eq 26 reaches mu, cos + mu sin = mu Omega^2, at
 * delta - a and is below it again from delta + a on, where tan(delta) = mu; on the falling side mirrored. */
static double stick_end(const granule *g, double end)
{
    const double ratio = g->mu * g->omega2 / sqrt(1 + g->mu * g->mu);
    if (ratio >= 1) return end; /* Eq 33 */
    const double delta = atan(g->mu), a = acos(ratio);
    const double begin[] = { delta - a, DEM_PI - delta - a }, last[] = { delta + a, DEM_PI - delta + a };
    for (int k = 0; k < 2; k++)
        if (g->theta < last[k] && begin[k] < end) return fmax(begin[k], g->theta + NUDGE);
    return end;
}

static void note_normal_force(granule *g) { g->least_normal_force = fmin(g->least_normal_force, g->w - sin(g->theta)); }

static void stick_on(granule *g, double end)
{
    const double from = g->theta, to = stick_end(g, end);
    g->time += (to - from) / sqrt(g->omega2);
    /* Sticking, N is least where it is highest. */
    const double highest = from <= -BOTTOM && -BOTTOM <= to ? 1.0 : fmax(sin(from), sin(to));
    g->least_normal_force = fmin(g->least_normal_force, g->omega2 - highest);
    g->theta = to;
    g->sticks = to >= end;
    if (!g->sticks && isnan(g->onset)) g->onset = to;
}

/* Friction is enough to carry it along. */
static bool can_stick(const granule *g) { return fabs(cos(g->theta)) <= g->mu * (g->omega2 - sin(g->theta)); }

/* The first event on the way from theta to next, and its angle; SLIP_EVENTS: none. */
static slip_event first_event(const granule *g, const slip *p, double next, double *at)
{
    slip_event first = SLIP_EVENTS;
    *at = next;
    for (slip_event event = LEAVES_WALL; event < SLIP_EVENTS; event++) {
        if (event_value(p, g->omega2, event, next) >= 0) continue;
        const double angle = event_angle(p, g->omega2, event, g->theta, next);
        if (first != SLIP_EVENTS && angle >= *at) continue;
        first = event;
        *at = angle;
    }
    return first;
}

/* Slips to the next angle of the grid or to the event before it. */
static slip_event slip_on(granule *g, const slip *p, double next)
{
    double at;
    const slip_event event = first_event(g, p, next, &at);
    if (event != COMES_TO_REST) g->time += slip_time(p, g->theta, at);
    g->theta = at;
    g->w = event == MEETS_WALL_SPEED ? g->omega2 : slip_w(p, at);
    note_normal_force(g);
    return event;
}

/* Having come to rest on the rising side it slides back along the very same w(theta), friction being the same, until it
 * rests again on the other side. True: the wall held it all the way, and so it swings for ever. */
static bool swings_back(granule *g, const slip *p)
{
    for (int k = 0; k < GRID; k++) {
        const double theta = g->theta - k * (2 * DEM_PI / GRID), w = slip_w(p, theta);
        if (k > 0 && w <= 0) return true;
        g->least_normal_force = fmin(g->least_normal_force, w - sin(theta));
        if (w - sin(theta) < 0) return false;
    }
    return false;
}

/* Which way it slips from theta: held back by gravity (+), or, at the wall's speed on the falling side, ahead of it. */
static double slip_side(const granule *g)
{
    const bool ahead = g->w > g->omega2 || (g->w == g->omega2 && cos(g->theta) < 0);
    return ahead ? -g->mu : g->mu;
}

/* One piece of slipping, until the revolution's end or an event. */
static slip_event slip_piece(granule *g, slip *p)
{
    *p = slip_from(g->theta, g->w, slip_side(g));
    int k = (int)floor((g->theta - BOTTOM) / (2 * DEM_PI / GRID)) + 1;
    if (grid_angle(k) <= g->theta) k++;
    for (; k <= GRID; k++) {
        const slip_event event = slip_on(g, p, grid_angle(k));
        if (event != SLIP_EVENTS) return event;
    }
    return SLIP_EVENTS;
}

typedef enum turn_end { WENT_ROUND, FELL_OFF, SWINGS } turn_end;

/* From the bottom once round. */
static turn_end turn(granule *g)
{
    const double end = grid_angle(GRID);
    g->theta = BOTTOM;
    g->time = 0.0;
    while (g->theta < end) {
        if (g->sticks) {
            g->w = g->omega2;
            stick_on(g, end);
            continue;
        }
        slip p;
        const slip_event event = slip_piece(g, &p);
        if (event == LEAVES_WALL) return FELL_OFF;
        if (event == COMES_TO_REST) return swings_back(g, &p) ? SWINGS : FELL_OFF;
        g->sticks = event == MEETS_WALL_SPEED && (can_stick(g) || g->theta <= p.start);
    }
    return WENT_ROUND;
}

static dem_regime regime_of(const granule *g, turn_end end)
{
    if (end == FELL_OFF) return DEM_RAINING;
    if (end == SWINGS) return DEM_SLIPPING;
    return isnan(g->onset) ? DEM_CENTRIFUGING : DEM_SLIDING;
}

static void follow(double mu, double omega2, int revolutions, dem_granule_motion *motion)
{
    granule g = { .mu = mu, .omega2 = omega2, .w = omega2, .sticks = true, .onset = NAN, .least_normal_force = INFINITY };
    turn_end end = WENT_ROUND;
    *motion = (dem_granule_motion){ .omega2 = omega2, .slip_per_revolution = NAN };
    bool repeats = false;
    while (motion->revolutions < revolutions && !repeats && (end = turn(&g)) == WENT_ROUND) {
        motion->revolutions++;
        motion->slip_per_revolution = sqrt(omega2) * g.time - 2 * DEM_PI;
        repeats = g.sticks; /* the bottom again as at the start */
    }
    motion->regime = regime_of(&g, end);
    motion->keeps_contact = end != FELL_OFF;
    motion->goes_round = end == WENT_ROUND;
    motion->slip_onset = g.onset;
    motion->least_normal_force = end == FELL_OFF ? 0.0 : g.least_normal_force;
}

dem_status dem_granule_follow(double friction, double omega2, int revolutions, dem_granule_motion *motion)
{
    const bool good = isfinite(friction) && friction > 0 && isfinite(omega2) && omega2 > 0 && revolutions >= 1;
    if (!good) return DEM_BAD_PARAMETER;
    follow(friction, omega2, revolutions, motion);
    return DEM_OK;
}

/* Bisection. At Omega^2 = 1 a particle that has slipped at all is too slow at the top; above Eq 33 it never slips; and
 * with 5 it goes round without friction's help. In between, more speed is more speed at every angle. */
static void find_threshold(const dem_granule_definition *d, dem_granule_result *result)
{
    double fails = 1.0, holds = fmin(5.0, regime_map_stationary(d->friction));
    dem_granule_motion motion;
    while (holds - fails > 2 * d->tolerance) {
        const double middle = 0.5 * (fails + holds);
        follow(d->friction, middle, d->revolutions, &motion);
        if (motion.goes_round) holds = middle;
        else fails = middle;
    }
    follow(d->friction, holds, d->revolutions, &motion);
    result->minimum_omega2 = 0.5 * (fails + holds);
    result->error = 0.5 * (holds - fails) + ROUNDING;
    result->slip_per_revolution = motion.slip_per_revolution;
    result->slip_onset = motion.slip_onset;
}

static bool is_good(const dem_granule_definition *d)
{
    return isfinite(d->friction) && d->friction > 0 && isfinite(d->radius) && d->radius > 0 && isfinite(d->gravity)
           && d->gravity > 0 && !isinf(d->rotation_rate) && !(d->rotation_rate <= 0) && d->revolutions >= 1
           && d->tolerance >= ROUNDING && d->tolerance < 1;
}

dem_status dem_granule_solve(const dem_granule_definition *d, dem_granule_result *result)
{
    if (!is_good(d)) return DEM_BAD_PARAMETER;
    *result = (dem_granule_result){ 0 };
    find_threshold(d, result);
    result->minimum_rotation_rate = sqrt(result->minimum_omega2 * d->gravity / d->radius);
    result->stationary_eq33 = regime_map_stationary(d->friction);
    result->sliding_eq34 = regime_map_sliding_eq34(d->friction);
    result->sliding_eq36 = regime_map_sliding_eq36(d->friction);
    result->stationary_deviation_eq33 = result->stationary_eq33 / result->minimum_omega2 - 1;
    result->sliding_deviation_eq34 = result->sliding_eq34 / result->minimum_omega2 - 1;
    result->sliding_deviation_eq36 = result->sliding_eq36 / result->minimum_omega2 - 1;
    result->has_motion = !isnan(d->rotation_rate);
    result->motion =
        (dem_granule_motion){ .omega2 = NAN, .slip_per_revolution = NAN, .slip_onset = NAN, .least_normal_force = NAN };
    if (result->has_motion)
        follow(d->friction, d->rotation_rate * d->rotation_rate * d->radius / d->gravity, d->revolutions, &result->motion);
    return DEM_OK;
}
