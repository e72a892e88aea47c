/* Claims about walls: each is as far away, and in that direction, as the nearest of a dense cloud of points on its
 * surface, which is made here from what the wall is said to be; and its points move as a rigid body does. */
#include "container.h"
#include "core_claims.h"
#include "dem_rules.h"

enum { MOST_POINTS = 500000 };
static const double RADIUS = 0.05, LENGTH = 0.04;

/* Points of a surface, none of it farther from the next point than `spacing`. */
typedef struct cloud {
    double (*point)[3];
    size_t count;
    double spacing;
} cloud;

static cloud cloud_create(double spacing)
{
    cloud c = { .point = malloc(MOST_POINTS * sizeof *c.point), .spacing = spacing };
    assert_non_null(c.point);
    return c;
}

static void cloud_add(cloud *c, double x, double y, double z)
{
    if (c->count == MOST_POINTS) {
        fail_msg("the test's own cloud is full");
        return;
    }
    memcpy(c->point[c->count++], (double[]){ x, y, z }, 3 * sizeof(double));
}

/* The nearest point, by looking at all of them. */
static const double *cloud_nearest(const cloud *c, const double x[3])
{
    const double *nearest = NULL;
    double least = INFINITY;
    for (size_t k = 0; k < c->count; k++) {
        const double *p = c->point[k], dx = p[0] - x[0], dy = p[1] - x[1], dz = p[2] - x[2];
        const double d2 = dx * dx + dy * dy + dz * dz;
        if (d2 < least) {
            least = d2;
            nearest = p;
        }
    }
    return nearest;
}

/* `seen` of a place off the wall: no nearer than the wall's nearest point, no farther than a point of the cloud can be
 * from it; what it points at is on the surface. */
static void check_sight(const cloud *c, const container_wall *w, const double x[3])
{
    const wall_sight sight = wall_seen_from(w, x);
    const double *near = cloud_nearest(c, x), *t = sight.toward;
    const double brute = sqrt(pow(near[0] - x[0], 2) + pow(near[1] - x[1], 2) + pow(near[2] - x[2], 2));
    CHECK_BETWEEN(brute, sight.distance - 1e-12, sight.distance + c->spacing);
    CHECK_NEAR(sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]), 1, 1e-12);
    double aim[3];
    for (int k = 0; k < 3; k++) aim[k] = x[k] + sight.distance * t[k];
    const double *at = cloud_nearest(c, aim);
    CHECK_BETWEEN(sqrt(pow(at[0] - aim[0], 2) + pow(at[1] - aim[1], 2) + pow(at[2] - aim[2], 2)), 0, c->spacing);
}

/* Points about z at a radius, from z low to high. */
static void add_tube(cloud *c, double radius, double low, double high)
{
    const int around = (int)ceil(2 * DEM_PI * radius / c->spacing) + 1, along = (int)ceil((high - low) / c->spacing) + 1;
    for (int a = 0; a < around; a++)
        for (int b = 0; b <= along; b++)
            cloud_add(c, radius * cos(2 * DEM_PI * a / around), radius * sin(2 * DEM_PI * a / around),
                      low + (high - low) * b / along);
}

static void add_disc(cloud *c, double radius, double z)
{
    const int rings = (int)ceil(radius / c->spacing) + 1;
    for (int a = 0; a <= rings; a++) {
        const double r = radius * a / rings;
        const int around = (int)ceil(2 * DEM_PI * r / c->spacing) + 1;
        for (int b = 0; b < around; b++) cloud_add(c, r * cos(2 * DEM_PI * b / around), r * sin(2 * DEM_PI * b / around), z);
    }
}

static void check_many(const cloud *c, const container_wall *w, double reach, double low, double high)
{
    dice d = { 11 };
    for (int trial = 0; trial < 100; trial++) {
        const double x[3] = { dice_uniform(&d, -reach, reach), dice_uniform(&d, -reach, reach), dice_uniform(&d, low, high) };
        check_sight(c, w, x);
    }
}

static container_wall wall_of(const dem_scene_definition *d, wall_kind kind, int which)
{
    container c;
    container_init(&c, d);
    for (int k = 0; k < c.wall_count; k++)
        if (c.wall[k].kind == kind && which-- == 0) return c.wall[k];
    fail_msg("this container has no such wall");
    return c.wall[0];
}

static dem_scene_definition tube_and_plate(void)
{
    return (dem_scene_definition){ .container = DEM_TUBE_ON_PLATE,
                                   .diameter = 0.6 * RADIUS,
                                   .length = LENGTH,
                                   .plate = { .diameter = 2 * RADIUS, .rim_height = 0.3 * LENGTH } };
}

static void a_thin_tube_is_seen_from_inside_outside_and_its_edges(void **unused)
{
    (void)unused;
    const dem_scene_definition d = tube_and_plate();
    const container_wall tube = wall_of(&d, WALL_SHELL, 0), rim = wall_of(&d, WALL_SHELL, 1);
    cloud c = cloud_create(2e-4);
    add_tube(&c, 0.3 * RADIUS, 0, 2 * LENGTH); /* and on, without an upper edge */
    check_many(&c, &tube, 1.2 * RADIUS, -LENGTH, 2 * LENGTH);
    c.count = 0;
    add_tube(&c, RADIUS, 0, 0.3 * LENGTH);
    check_many(&c, &rim, 1.2 * RADIUS, -LENGTH, LENGTH);
    free(c.point);
}

static void a_plate_is_seen_from_above_and_below_and_from_beside_its_edge(void **unused)
{
    (void)unused;
    const dem_scene_definition d = tube_and_plate();
    const container_wall plate = wall_of(&d, WALL_DISC, 0);
    cloud c = cloud_create(3e-4);
    add_disc(&c, RADIUS, 0);
    check_many(&c, &plate, 2 * RADIUS, -LENGTH, LENGTH);
    free(c.point);
}

static void a_drum_is_seen_from_within(void **unused)
{
    (void)unused;
    const dem_scene_definition d = { .diameter = 2 * RADIUS, .length = LENGTH, .ends = { .are_walls = true } };
    const container_wall drum = wall_of(&d, WALL_CYLINDER, 0);
    cloud c = cloud_create(3e-4);
    add_tube(&c, RADIUS, -LENGTH / 2, LENGTH / 2);
    check_many(&c, &drum, 0.7 * RADIUS, -LENGTH / 2, LENGTH / 2);
    for (int end = 0; end < 2; end++) {
        const container_wall plane = wall_of(&d, WALL_PLANE, end);
        c.count = 0;
        add_disc(&c, 1.2 * RADIUS, end ? LENGTH / 2 : -LENGTH / 2);
        check_many(&c, &plane, 0.7 * RADIUS, -LENGTH / 2, LENGTH / 2);
    }
    free(c.point);
}

/* A floor with a hole and a hopper, round and flat, and the stopper: from inside, from below and from beside their edges. */
static void a_floor_with_an_orifice_is_seen_from_all_sides(void **unused)
{
    (void)unused;
    for (int which = 0; which < 4; which++) {
        const bool is_flat = which & 1;
        const double half_angle = which & 2 ? 0.6 : 0, hole = 0.2 * RADIUS, depth = 0.5 * RADIUS;
        const dem_scene_definition d = { .container = DEM_VESSEL,
                                         .diameter = 2 * RADIUS,
                                         .length = 0.1,
                                         .orifice = { 2 * hole, is_flat ? 2 * depth : 0, half_angle } };
        container vessel;
        container_init(&vessel, &d);
        container_move(&vessel, &d, true, 0);
        const double rise = half_angle > 0 ? 1 / tan(half_angle) : 0;
        cloud c = cloud_create(6e-4);
        for (double s = hole; s <= RADIUS + 2e-4; s += 2e-4) {
            const double out = fmin(s, RADIUS), z = (out - hole) * rise;
            const int around = (int)ceil(2 * DEM_PI * out / 3e-4);
            for (int b = 0; !is_flat && b < around; b++)
                cloud_add(&c, out * cos(2 * DEM_PI * b / around), out * sin(2 * DEM_PI * b / around), z);
            for (double y = -depth; is_flat && y <= depth; y += 3e-4)
                for (int side = -1; side <= 1; side += 2) cloud_add(&c, side * out, y, z);
        }
        dice own = { 5 };
        for (int trial = 0; trial < 100; trial++) {
            const double x[3] = { dice_uniform(&own, -0.6, 0.6) * RADIUS, dice_uniform(&own, -0.45, 0.45) * RADIUS,
                                  dice_uniform(&own, -0.02, 0.06) };
            check_sight(&c, &vessel.wall[vessel.funnel], x);
        }
        free(c.point);
        assert_int_equal(vessel.wall_count, vessel.funnel + 1);
        container_move(&vessel, &d, false, 0);
        const wall_sight closed = wall_seen_from(&vessel.wall[vessel.wall_count - 1], (double[]){ 0.001, 0.002, 0.004 });
        CHECK_NEAR(closed.distance, 0.004, 1e-15); /* over the middle: the stopper, or a floor that has no hole yet */
    }
}

/* The volume below a height is that of a frustum or wedge and what stands on it. */
static void the_room_of_a_vessel_is_that_of_its_hopper_and_what_is_above(void **unused)
{
    (void)unused;
    const double r = 0.01, R = 0.05, angle = 0.5, h = (R - r) / tan(angle);
    dem_scene_definition d = { .container = DEM_VESSEL, .diameter = 2 * R, .length = 0.2, .orifice = { 2 * r, 0, angle } };
    container c;
    container_init(&c, &d);
    CHECK_NEAR(c.hopper_height, h, 1e-15);
    CHECK_NEAR(container_volume_below(&c, 0.2), DEM_PI * (h / 3 * (R * R + R * r + r * r) + R * R * (0.2 - h)), 1e-15);
    d.orifice.depth = 0.03;
    container_init(&c, &d);
    CHECK_NEAR(container_volume_below(&c, 0.2), 0.03 * (h * (R + r) + 2 * R * (0.2 - h)), 1e-15);
    CHECK_NEAR(container_volume_below(&c, 0.5 * h), 0.03 * 0.5 * h * (2 * r + 0.5 * (R - r)), 1e-15);
    d.orifice.half_angle = 0;
    container_init(&c, &d);
    CHECK_NEAR(container_volume_below(&c, 0.2), 0.03 * 0.1 * 0.2, 1e-15);
}

/* A lifter's bar, turned with its drum: top and both sides, its corners among them. */
static void a_bar_is_seen_from_within_the_drum_wherever_it_has_turned(void **unused)
{
    (void)unused;
    const double height = 0.012, width = 0.008;
    dem_scene_definition d = {
        .diameter = 2 * RADIUS, .length = LENGTH, .rotation_rate = 2, .lifters = { .count = 3, .height = height, .width = width }
    };
    container drum;
    container_init(&drum, &d);
    cloud c = cloud_create(4e-4);
    dice own = { 3 };
    for (int k = 0; k < 3; k++) {
        const double time = 0.7 * k + 0.3, angle = 2 * DEM_PI * k / 3 + 2 * time;
        container_move(&drum, &d, true, time);
        c.count = 0;
        for (double z = -LENGTH / 2; z <= LENGTH / 2; z += 3e-4)
            for (double t = 0; t <= width / 2 + 2 * height; t += 3e-4)
                for (int side = -1; side <= 1; side += 2) {
                    /* along the top from its middle to the corner, then outward along the side, a little past the drum */
                    const double across = side * fmin(t, width / 2), out = RADIUS - height + fmax(t - width / 2, 0);
                    cloud_add(&c, out * cos(angle) - across * sin(angle), out * sin(angle) + across * cos(angle), z);
                }
        c.spacing = 6e-4; /* the grid misses each corner by less than its own spacing */
        const container_wall *bar = &drum.wall[drum.first_bar + k];
        for (int trial = 0; trial < 100; trial++) {
            const double x[3] = { dice_uniform(&own, -0.7, 0.7) * RADIUS, dice_uniform(&own, -0.7, 0.7) * RADIUS, 0 };
            const double out = x[0] * cos(angle) + x[1] * sin(angle), across = x[1] * cos(angle) - x[0] * sin(angle);
            if (fabs(across) < width / 2 && out > RADIUS - height) continue; /* behind its surface: below */
            check_sight(&c, bar, x);
        }
    }
    free(c.point);
}

/* Behind a surface, the distance is negative and the direction that of the wall's inside still. */
static void behind_a_surface_the_distance_is_negative(void **unused)
{
    (void)unused;
    const dem_scene_definition d = { .diameter = 2 * RADIUS,
                                     .length = LENGTH,
                                     .ends = { .are_walls = true },
                                     .lifters = { .count = 1, .height = 0.012, .width = 0.008 } };
    const double behind_top[3] = { RADIUS - 0.011, 0.001, 0 }, behind_side[3] = { RADIUS - 0.003, 0.0035, 0 };
    const container_wall bar = wall_of(&d, WALL_BAR, 0);
    wall_sight sight = wall_seen_from(&bar, behind_top);
    CHECK_NEAR(sight.distance, -0.001, 1e-15);
    CHECK_NEAR(sight.toward[0], 1, 1e-15);
    sight = wall_seen_from(&bar, behind_side);
    CHECK_NEAR(sight.distance, -0.0005, 1e-15);
    CHECK_NEAR(sight.toward[1], -1, 1e-15);
    const container_wall end = wall_of(&d, WALL_PLANE, 0), drum = wall_of(&d, WALL_CYLINDER, 0);
    sight = wall_seen_from(&end, (double[]){ 0, 0, -LENGTH / 2 - 0.002 });
    CHECK_NEAR(sight.distance, -0.002, 1e-15);
    CHECK_NEAR(sight.toward[2], -1, 1e-15);
    sight = wall_seen_from(&drum, (double[]){ 0, RADIUS + 0.001, 0 });
    CHECK_NEAR(sight.distance, -0.001, 1e-15);
    CHECK_NEAR(sight.toward[1], 1, 1e-15);
}

/* The velocity of a wall's point is how far it gets in a short time: from the places before and after. */
static void walls_move_as_their_velocities_say(void **unused)
{
    (void)unused;
    const double dt = 1e-7, t = 0.3;
    dem_scene_definition turning = {
        .diameter = 2 * RADIUS, .length = LENGTH, .rotation_rate = -3, .lifters = { .count = 5, .height = 0.012, .width = 0.008 }
    };
    dem_scene_definition rising = tube_and_plate();
    rising.lift = (dem_lift){ .speed = 0.02, .start = 0.1 };
    container before, after;
    container_init(&before, &turning);
    container_init(&after, &turning);
    assert_true(container_move(&before, &turning, true, t)); /* it stood before */
    assert_false(container_move(&before, &turning, true, t));
    container_move(&after, &turning, true, t + dt);
    for (int k = 0; k < 5; k++) {
        const container_wall *a = &before.wall[before.first_bar + k], *b = &after.wall[after.first_bar + k];
        const double point[3] = { RADIUS * a->middle[0], RADIUS * a->middle[1], 0.01 };
        double v[3];
        wall_velocity(a, point, v);
        for (int c = 0; c < 2; c++) CHECK_NEAR((RADIUS * b->middle[c] - point[c]) / dt, v[c], 3 * 3 * RADIUS * dt + 1e-8);
    }
    container_init(&before, &rising);
    assert_false(container_move(&before, &rising, true, 0.05));
    CHECK_NEAR(before.wall[0].low, 0, 0);
    assert_true(container_move(&before, &rising, true, t)); /* it starts to rise */
    CHECK_NEAR(before.wall[0].low, 0.02 * 0.2, 1e-15);
    assert_true(isinf(before.wall[0].high)); /* no upper edge at any time */
    CHECK_NEAR(before.wall[0].rise, 0.02, 0);
    assert_false(container_move(&before, &rising, true, 2 * t));
}

UNIT_TESTS(a_floor_with_an_orifice_is_seen_from_all_sides, the_room_of_a_vessel_is_that_of_its_hopper_and_what_is_above,
           a_thin_tube_is_seen_from_inside_outside_and_its_edges, a_plate_is_seen_from_above_and_below_and_from_beside_its_edge,
           a_drum_is_seen_from_within, a_bar_is_seen_from_within_the_drum_wherever_it_has_turned,
           behind_a_surface_the_distance_is_negative, walls_move_as_their_velocities_say)
