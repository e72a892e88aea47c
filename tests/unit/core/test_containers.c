/* Claims about one sphere and the walls of each container, against closed forms. */
#include "container_by_hand.h"
#include "step.h"
#include "wall_forces.h"

static const double R = 0.002, K_1 = 4000;

/* ---- weight ---- */

/* Set down where K1 alpha = m g, a sphere stays, and all that its contacts do to the walls is its weight. */
static void check_rest(dem_scene *scene, const double x[3], const double down[3], int walls_touched)
{
    const double weight = sphere_mass_of(scene) * scene->definition.gravity, alpha = weight / K_1;
    double place[3];
    for (int c = 0; c < 3; c++) place[c] = x[c] + alpha * down[c];
    put(scene, place, NULL, NULL);
    go_on(scene, 3000);
    for (int c = 0; c < 3; c++) CHECK_NEAR(sphere_place(&scene->spheres, 0)[c], place[c], 1e-3 * alpha);
    const contact_list *walls = &scene->neighbors.walls;
    contact_forces_with_walls(&scene->neighbors, &scene->spheres, &scene->container, &scene->contact, 0.0);
    double force[3] = { 0 };
    int touched = 0;
    for (size_t k = 0; k < walls->count; k++) {
        const wall_load load = wall_load_of(walls, k, &scene->spheres, &scene->container);
        for (int c = 0; c < 3; c++) force[c] += load.force[c];
        const bool touches = load.force[0] != 0 || load.force[1] != 0 || load.force[2] != 0;
        touched += touches;
        if (touches) /* the point is on the way down, a radius less the overlap away */
            for (int c = 0; c < 3; c++) CHECK_NEAR(load.point[c], place[c] + (R - alpha) * down[c], 1e-6 * R);
    }
    /* rounding of the overlap: a few of the radius's last digits, against alpha */
    for (int c = 0; c < 3; c++) CHECK_NEAR(force[c], weight * down[c], 1e-3 * weight);
    assert_int_equal(touched, walls_touched);
    dem_scene_free(scene);
}

static void a_sphere_at_rest_on_any_wall_carries_its_weight(void **unused)
{
    (void)unused;
    static const double along_y[3] = { 0, -1, 0 }, along_z[3] = { 0, 0, -1 };
    dem_scene_definition d = container_definition(DEM_CYLINDER, 1);
    check_rest(container_scene(&d), (double[]){ 0.01, 0.02, R }, along_z, 1);
    d = container_definition(DEM_TUBE_ON_PLATE, 1);
    check_rest(container_scene(&d), (double[]){ 0.01, 0.02, R }, along_z, 1); /* the plate, within the tube */
    check_rest(container_scene(&d), (double[]){ 0.08, 0, R }, along_z, 1);    /* and beside it */
    d.lift.speed = 0.3;
    check_rest(container_scene(&d), (double[]){ 0.08, 0, R }, along_z, 1); /* while the tube rises */
    d = container_definition(DEM_VESSEL, 1);
    check_rest(container_scene(&d), (double[]){ 0.016, 0.02, R }, along_z, 1); /* beside the hole */
    check_rest(container_scene(&d), (double[]){ 0.015, 0, R }, along_z, 1);    /* right over its edge */
    d.orifice.depth = 0.08;
    check_rest(container_scene(&d), (double[]){ -0.016, 0.03, R }, along_z, 1); /* beside a slot */
    d = container_definition(DEM_DRUM, 1);
    d.ends.are_walls = true;
    check_rest(container_scene(&d), (double[]){ 0, -0.05 + R, 0.01 }, along_y, 1);
    d.lifters = (dem_lifters){ .count = 4, .height = 0.01, .width = 0.008, .friction = 0.3 };
    check_rest(container_scene(&d), (double[]){ 0, -0.04 + R, 0.01 }, along_y, 1);     /* the lowest bar's top */
    check_rest(container_scene(&d), (double[]){ 0.045, 0.004 + R, 0.01 }, along_y, 1); /* the right bar's upper side */
}

/* ---- normal impacts ---- */

typedef struct shot {
    const char *at;
    dem_container_kind container;
    double from[3], direction[3]; /* m, of the place of first touch; unit */
} shot;

/* Every wall gives back e of the normal speed: K1/K2 = e^2. Some 75 steps a collision (20 give 0.1 %). */
static void a_normal_impact_on_any_wall_leaves_e_of_the_speed(void **unused)
{
    (void)unused;
    const double h = sqrt(0.5), corner = 0.004 + h * R; /* of a bar 8 mm wide and 10 mm high */
    const shot shots[] = {
        { "low end", DEM_DRUM, { 0.01, -0.02, -0.03 + R }, { 0, 0, -1 } },
        { "high end", DEM_DRUM, { 0.01, -0.02, 0.03 - R }, { 0, 0, 1 } },
        { "drum", DEM_DRUM, { -h * (0.05 - R), h * (0.05 - R), 0 }, { -h, h, 0 } },
        { "bar's top", DEM_DRUM, { 0.04 - R, 0.001, 0 }, { 1, 0, 0 } },
        { "bar's side", DEM_DRUM, { 0.044, 0.004 + R, 0 }, { 0, -1, 0 } },
        { "bar's other side", DEM_DRUM, { 0.044, -0.004 - R, 0 }, { 0, 1, 0 } },
        { "bar's corner", DEM_DRUM, { 0.04 - h * R, corner, 0 }, { h, -h, 0 } },
        { "floor", DEM_CYLINDER, { 0.01, 0.02, R }, { 0, 0, -1 } },
        { "cylinder, high up", DEM_CYLINDER, { 0.05 - R, 0, 0.3 }, { 1, 0, 0 } },
        { "tube from within", DEM_TUBE_ON_PLATE, { 0, 0.05 - R, 0.02 }, { 0, 1, 0 } },
        { "tube from outside", DEM_TUBE_ON_PLATE, { 0, 0.05 + R, 0.02 }, { 0, -1, 0 } },
        { "tube above what was its height", DEM_TUBE_ON_PLATE, { 0, 0.05 - R, 0.2 }, { 0, 1, 0 } },
        { "plate", DEM_TUBE_ON_PLATE, { -0.07, 0, R }, { 0, 0, -1 } },
        { "plate's edge", DEM_TUBE_ON_PLATE, { 0.1 + R, 0, 0 }, { -1, 0, 0 } },
        { "rim", DEM_TUBE_ON_PLATE, { 0.1 - R, 0, 0.003 }, { 1, 0, 0 } },
        { "rim's upper edge", DEM_TUBE_ON_PLATE, { 0, 0.1, 0.006 + R }, { 0, 0, -1 } },
        { "rim's upper edge, aslant", DEM_TUBE_ON_PLATE, { 0.1 - h * R, 0, 0.006 + h * R }, { h, 0, -h } },
        { "vessel's side", DEM_VESSEL, { 0, 0.05 - R, 0.03 }, { 0, 1, 0 } },
        { "orifice's edge, aslant", DEM_VESSEL, { 0, 0.015 - h * R, h * R }, { 0, h, -h } },
        { "orifice's edge, from within", DEM_VESSEL, { -0.015 + R, 0, 0 }, { -1, 0, 0 } },
        { "slot's edge, aslant", DEM_VESSEL, { -0.015 + h * R, 0.03, h * R }, { -h, 0, -h } },
        { "slot's side", DEM_VESSEL, { 0.02, -0.04 + R, 0.02 }, { 0, -1, 0 } },
        { "slot's end", DEM_VESSEL, { -0.05 + R, 0.01, 0.02 }, { -1, 0, 0 } },
        /* 45 degrees: the wall goes through (0.025, 0.01) */
        { "hopper's wall", DEM_VESSEL, { 0.025 - h * R, 0, 0.01 + h * R }, { h, 0, -h } },
        { "hopper's edge", DEM_VESSEL, { 0.015 - R, 0, 0 }, { 1, 0, 0 } },
        { "hopper's wall from outside", DEM_VESSEL, { 0, 0.025 + h * R, 0.01 - h * R }, { 0, -h, h } },
    };
    for (size_t k = 0; k < sizeof shots / sizeof *shots; k++) {
        const shot *s = &shots[k];
        dem_scene_definition d = container_definition(s->container, 1);
        if (strncmp(s->at, "slot", 4) == 0) d.orifice.depth = 0.08;
        if (strncmp(s->at, "hopper", 6) == 0) d.orifice.half_angle = DEM_PI / 4;
        d.ends.are_walls = s->container == DEM_DRUM;
        if (strncmp(s->at, "bar", 3) == 0) d.lifters = (dem_lifters){ .count = 1, .height = 0.01, .width = 0.008, .friction = 0.3 };
        if (strncmp(s->at, "rim", 3) == 0) d.plate.rim_height = 0.006;
        d.time_step = 5e-6;
        dem_scene *scene = container_scene(&d);
        scene->definition.gravity = 0;
        double x[3], v[3], speed = 0.2, away = 0, sideways = 0;
        for (int c = 0; c < 3; c++) x[c] = s->from[c] - 1e-4 * s->direction[c];
        for (int c = 0; c < 3; c++) v[c] = speed * s->direction[c];
        put(scene, x, v, NULL);
        go_on(scene, 400);
        const vector4 after = scene->spheres.velocity[0];
        for (int c = 0; c < 3; c++) away -= after[c] * s->direction[c];
        for (int c = 0; c < 3; c++) sideways = fmax(sideways, fabs(after[c] + away * s->direction[c]));
        if (!(fabs(away / speed - 0.8) < 1e-3)) fail_msg("%s gives back %g of the speed, not 0.8", s->at, away / speed);
        /* aimed as well as single precision points */
        if (!(sideways < 1e-4 * speed)) fail_msg("%s turns the sphere aside by %g m/s", s->at, sideways);
        dem_scene_free(scene);
    }
}

/* A sphere that touches the edge of the hole alone, without friction, leaves it where a particle that slides off a circle of its
 * radius does: from rest at the angle a_0 from the vertical the push vanishes at cos a = 2/3 cos a_0, at the speed
 * sqrt(g r cos a). Then it falls freely. */
static void a_sphere_slides_over_the_edge_of_an_orifice_and_falls_freely(void **unused)
{
    (void)unused;
    dem_scene_definition d = container_definition(DEM_VESSEL, 1);
    d.contact.wall_friction = d.ends.friction = 0;
    d.contact.stiffness = 40000;
    d.time_step = 2e-6;
    dem_scene *scene = container_scene(&d);
    const double from = 0.3, g = scene->definition.gravity;
    put(scene, (double[]){ 0.015 - R * sin(from), 0, R * cos(from) }, NULL, NULL);
    double last = 0, fall = 0;
    while (dem_scene_lost_count(scene) == 0 && dem_scene_time(scene) < 1) {
        const wall_sight edge = wall_seen_from(&scene->container.wall[scene->container.funnel], sphere_place(&scene->spheres, 0));
        const bool touches = edge.distance < R;
        if (touches) last = -edge.toward[2]; /* the cosine */
        if (touches) fall = 0;
        else if (fall == 0) fall = dem_scene_time(scene);
        go_on(scene, 5);
    }
    CHECK_NEAR(last, 2.0 / 3 * cos(from), 0.01); /* the spring rings: it leaves up to 2e-3 of the way early or late */
    const double at = acos(last), speed = sqrt(g * R * last), down = speed * sin(at);
    /* found below two radii at the latest 50 steps late: 0.1 ms of some 20 */
    const double expected = (-down + sqrt(down * down + 2 * g * (2 * R + R * last))) / g;
    CHECK_NEAR(dem_scene_time(scene) - fall, expected, 0.01 * expected + 50 * d.time_step);
    assert_int_equal(dem_scene_lost_count(scene), 1);
    dem_scene_free(scene);
}

/* Dropped along the axis of the hole, a sphere touches nothing, and is counted when it is two radii below: sqrt(2 h/g). */
static void a_sphere_falls_through_an_orifice_that_is_open_and_rests_on_a_stopper_before(void **unused)
{
    (void)unused;
    for (int hopper = 0; hopper < 2; hopper++) {
        dem_scene_definition d = container_definition(DEM_VESSEL, 1);
        d.orifice.half_angle = hopper ? 0.5 : 0;
        d.length = 0.2;
        dem_scene *scene = container_scene(&d);
        while (dem_scene_phase(scene) < DEM_PHASE_RUNNING) go_on(scene, 50);
        CHECK_BETWEEN(sphere_place(&scene->spheres, 0)[2], 0.9 * R, (hopper ? 2 : 1.1) * R); /* by the wall of the hopper, too */
        put(scene, (double[]){ 0, 0, 0.03 }, NULL, NULL);
        const double time = sqrt(2 * (0.03 + 2 * R) / d.gravity);
        go_on(scene, (int64_t)(time / d.time_step) - 2);
        assert_int_equal(dem_scene_lost_count(scene), 0);
        CHECK_NEAR(scene->spheres.velocity[0][2], -d.gravity * time, 1e-3 * d.gravity * time);
        go_on(scene, 52);
        assert_int_equal(dem_scene_lost_count(scene), 1);
        go_on(scene, 5000);
        CHECK_BETWEEN(sphere_place(&scene->spheres, 0)[2], -0.06, -0.04); /* held on the tray */
        dem_scene_free(scene);
    }
}

/* ---- friction ---- */

/* As on any plane: v/v_0 = 1/(1 + 0.4 r^2/r_a^2), 5/7 for r_a = r, once slip has ended after 2 v_0/(7 mu g). */
static void a_sphere_set_sliding_on_a_floor_ends_rolling_at_five_sevenths(void **unused)
{
    (void)unused;
    for (int plate = 0; plate < 2; plate++) {
        dem_scene_definition d = container_definition(plate ? DEM_TUBE_ON_PLATE : DEM_CYLINDER, 1);
        d.ends.friction = d.plate.friction = 0.4;
        d.contact.wall_friction = 0; /* the floor's own friction counts, not the cylinder's */
        dem_scene *scene = container_scene(&d);
        const double v_0 = 0.2, alpha = sphere_mass_of(scene) * 9.81 / K_1, slip_time = 2 * v_0 / (7 * 0.4 * 9.81);
        put(scene, (double[]){ -0.03, 0, R - alpha }, (double[]){ v_0, 0, 0 }, NULL);
        go_on(scene, (int64_t)(0.5 * slip_time / d.time_step));
        CHECK_NEAR(scene->spheres.velocity[0][0], v_0 - 0.4 * 9.81 * 0.5 * slip_time, 1e-3 * v_0);
        go_on(scene, (int64_t)(0.7 * slip_time / d.time_step));
        enum { SAMPLES = 4000 }; /* many periods of the tangential spring, which rings on */
        double sum = 0;
        for (int k = 0; k < SAMPLES; k++) {
            go_on(scene, 1);
            sum += scene->spheres.velocity[0][0];
        }
        CHECK_NEAR(sum / SAMPLES, 5.0 / 7 * v_0, 4e-4 * v_0); /* ringing 2e-4; r_a below r by alpha/2: 1e-4 */
        dem_scene_free(scene);
    }
}

/* Coasting over a floor or a plate: m a = F and I a/R = mu_r R m g - F R, a = 5/7 mu_r g, by the rolling friction of what it
 * rolls on alone. The lever is short of R by alpha/2, 1e-4 of it, and the spring yields after a way of 1e-6 m. */
static void a_sphere_that_rolls_is_slowed_by_the_rolling_friction_of_the_floor(void **unused)
{
    (void)unused;
    for (int plate = 0; plate < 2; plate++) {
        dem_scene_definition d = container_definition(plate ? DEM_TUBE_ON_PLATE : DEM_CYLINDER, 1);
        d.ends.rolling_friction = d.plate.rolling_friction = 0.05;
        d.contact.wall_rolling_friction = 0.9; /* not the floor's */
        dem_scene *scene = container_scene(&d);
        const double v_0 = 0.06, alpha = sphere_mass_of(scene) * 9.81 / K_1, a = 5.0 / 7 * 0.05 * 9.81, time = 0.5 * v_0 / a;
        put(scene, (double[]){ -0.03, 0, R - alpha }, (double[]){ v_0, 0, 0 }, (double[]){ 0, v_0 / (R - alpha / 2), 0 });
        go_on(scene, (int64_t)(time / d.time_step));
        CHECK_NEAR((v_0 - scene->spheres.velocity[0][0]) / time, a, 3e-3 * a);
        dem_scene_free(scene);
    }
}

/* A sphere that meets a turning end wall slides throughout where the wall is fast: it takes mu times the normal impulse
 * m v (1 + e) in the direction of the wall, and spins by r times that over the moment of inertia. */
static void a_turning_end_wall_drives_a_sphere_by_coulombs_impulse(void **unused)
{
    (void)unused;
    for (int end = -1; end <= 1; end += 2) {
        dem_scene_definition d = container_definition(DEM_DRUM, 1);
        d.ends = (dem_drum_ends){ .are_walls = true, .friction = 0.25 };
        d.contact.wall_friction = 0.9; /* not the end's */
        d.rotation_rate = 40;
        d.time_step = 2e-6;
        dem_scene *scene = container_scene(&d);
        scene->definition.gravity = 0;
        const double v = 0.2, x = 0.03;
        put(scene, (double[]){ x, 0, end * (0.03 - R - 1e-5) }, (double[]){ 0, 0, end * v }, NULL);
        go_on(scene, 600);
        /* the wall is at 1.2 m/s, far above what slides to an end: 3.5 mu v (1 + e) = 0.32 */
        const double change = 0.25 * v * 1.8;
        const vector4 after = scene->spheres.velocity[0], spin = scene->spheres.angular_velocity[0];
        CHECK_NEAR(after[2], -end * 0.8 * v, 1e-3 * v);
        /* the wall's direction turns by 40 rad/s * 0.4 ms, 0.9 degrees to either side of the mean, during the contact */
        CHECK_NEAR(hypot(after[0], after[1]), change, 2e-3 * change);
        CHECK_NEAR(after[1], change, 5e-3 * change);
        /* the arm is less by up to half the overlap, 2.9e-5 m */
        CHECK_BETWEEN(hypot(spin[0], spin[1]) / (change * R / (0.4 * R * R)), 1 - 0.01, 1);
        CHECK_BETWEEN(-end * spin[0], 0, INFINITY); /* pushed to +y where it touches, at end z from its centre */
        dem_scene_free(scene);
    }
}

/* ---- lifters ---- */

/* Without friction, a slow bar carries a ball between itself and the wall until its face is level (the ball could not
 * roll off before) and not much longer: then the ball slides inward over the edge and falls. */
static void a_lifter_carries_a_ball_up_until_its_face_is_level(void **unused)
{
    (void)unused;
    dem_scene_definition d = container_definition(DEM_DRUM, 1);
    d.contact.wall_friction = 0;
    d.rotation_rate = 1; /* omega^2 R/g: half a percent */
    d.lifters = (dem_lifters){ .count = 4, .height = 0.01, .width = 0.008 };
    d.time_step = 2e-5;
    dem_scene *scene = container_scene(&d);
    /* at rest at the bottom, ahead of the bar that comes from 270 degrees */
    put(scene, (double[]){ 0.012, -sqrt(0.048 * 0.048 - 0.012 * 0.012), 0 }, NULL, NULL);
    const double offset = asin((0.004 + R) / 0.048);       /* by which the ball is ahead of the bar's middle */
    for (double bar = 0.6; bar < DEM_PI / 2; bar += 0.1) { /* turned since the bar was at the bottom */
        while (dem_scene_time(scene) < bar) go_on(scene, 100);
        const double *x = sphere_place(&scene->spheres, 0), turned = scene->container.angle;
        /* carried without play: a ball that bounced would be off by more than a tenth of its radius */
        CHECK_NEAR(hypot(x[0], x[1]), 0.048, 0.02 * R);
        CHECK_NEAR(atan2(x[0], -x[1]), turned + offset, 0.02 * R / 0.048);
    }
    CHECK_BETWEEN(sphere_place(&scene->spheres, 0)[1], -0.002, 0.01); /* at the height of the axis, nearly */
    /* off the bar after some (6 l/(g omega))^(1/3) = 0.2 s, l = 1 cm; down in 0.1 s */
    double lowest = 1;
    for (int k = 0; k < 50; k++) {
        go_on(scene, (int64_t)(0.01 / d.time_step));
        lowest = fmin(lowest, sphere_place(&scene->spheres, 0)[1]);
    }
    CHECK_BETWEEN(lowest, -0.05, -0.02);
    dem_scene_free(scene);
}

/* ---- the inside ---- */

static void check_escape(dem_scene_definition *d, const double x[3], const double v[3], const char *quantity)
{
    dem_scene *scene = container_scene(d);
    scene->definition.gravity = 0;
    put(scene, x, v, NULL);
    dem_status status = DEM_OK;
    for (int k = 0; k < 100 && status == DEM_OK; k++) status = dem_scene_advance(scene, 10);
    assert_int_equal(status, DEM_PARTICLE_ESCAPED);
    assert_string_equal(dem_scene_failure(scene)->quantity, quantity);
    dem_scene_free(scene);
}

/* Thrown so fast that it is through within a step. */
static void a_particle_beyond_any_wall_has_escaped(void **unused)
{
    (void)unused;
    dem_scene_definition d = container_definition(DEM_CYLINDER, 1);
    check_escape(&d, (double[]){ 0, 0, 0.01 }, (double[]){ 0, 0, -3000 }, "height above the floor");
    check_escape(&d, (double[]){ 0, 0, 0.01 }, (double[]){ 9000, 0, 0 }, "distance from the axis");
    d = container_definition(DEM_TUBE_ON_PLATE, 1);
    check_escape(&d, (double[]){ 0, 0, 0.01 }, (double[]){ 0, 0, -3000 }, "height above the plate");
    d = container_definition(DEM_VESSEL, 1);
    check_escape(&d, (double[]){ 0.03, 0, 0.01 }, (double[]){ 0, 0, -3000 }, "height above the orifice");
    d.orifice = (dem_orifice){ .opening = 0.03, .depth = 0.06, .half_angle = 0.7 };
    check_escape(&d, (double[]){ 0.04, 0, 0.05 }, (double[]){ 0, 0, -9000 }, "height above the orifice");
    check_escape(&d, (double[]){ 0.03, 0, 0.05 }, (double[]){ 0, 9000, 0 }, "distance before the side");
    d = container_definition(DEM_DRUM, 1);
    d.ends.are_walls = true;
    check_escape(&d, (double[]){ 0, 0, 0.02 }, (double[]){ 0, 0, 3000 }, "distance before the end wall");
    d.lifters = (dem_lifters){ .count = 4, .height = 0.01, .width = 0.008 };
    check_escape(&d, (double[]){ 0.035, 0, 0 }, (double[]){ 1000, 0, 0 }, "distance before a lifter");
}

/* Past the edge at 2.7 mm from it, its radius is 2: it touches nothing, and the plate is above it 2 ms later. */
static void a_sphere_that_goes_around_the_edge_and_beneath_the_plate_is_lost(void **unused)
{
    (void)unused;
    const dem_scene_definition d = container_definition(DEM_TUBE_ON_PLATE, 1);
    dem_scene *scene = container_scene(&d);
    put(scene, (double[]){ 0.101, 0, -0.0025 }, (double[]){ -0.6, 0, -0.1 }, NULL);
    assert_int_equal(dem_scene_lost_count(scene), 0);
    go_on(scene, 300);
    assert_int_equal(dem_scene_lost_count(scene), 1);
    dem_scene_free(scene);
}

static void a_failure_names_its_own_container(void **unused)
{
    (void)unused;
    static const char *const name[] = {
        [DEM_DRUM] = "drum", [DEM_CYLINDER] = "cylinder", [DEM_TUBE_ON_PLATE] = "heap", [DEM_VESSEL] = "vessel"
    };
    for (int kind = DEM_DRUM; kind <= DEM_VESSEL; kind++) {
        const dem_scene_definition d = container_definition(kind, 1);
        dem_scene *scene = container_scene(&d);
        put(scene, (double[]){ 0.02, 0, 0.01 }, (double[]){ kind == DEM_DRUM ? 9000 : 0, 0, -3000 }, NULL);
        assert_int_equal(dem_scene_advance(scene, 100), DEM_PARTICLE_ESCAPED);
        const char *cause = dem_scene_failure(scene)->likely_cause;
        for (int k = DEM_DRUM; k <= DEM_VESSEL; k++)
            if ((strstr(cause, name[k]) != NULL) != (k == kind)) fail_msg("of a %s it is said: %s", name[kind], cause);
        dem_scene_free(scene);
    }
    assert_null(strstr(dem_status_text(DEM_PARTICLE_ESCAPED), "drum"));
    assert_null(strstr(dem_status_text(DEM_DOES_NOT_FIT), "drum"));
}

static void a_container_that_cannot_be_is_refused(void **unused)
{
    (void)unused;
    dem_scene *scene = NULL;
    const dem_lifters bad_lifters[] = { { .count = 65, .height = 0.01, .width = 0.001 },
                                        { .count = 4, .height = 0.05, .width = 0.004 },
                                        { .count = 4, .height = 0, .width = 0.004 },
                                        { .count = 4, .height = 0.01, .width = 0.08 },   /* corners outside the drum */
                                        { .count = 60, .height = 0.01, .width = 0.005 }, /* one into the next */
                                        { .count = 4, .height = 0.01, .width = 0.004, .friction = -1 } };
    for (size_t k = 0; k < sizeof bad_lifters / sizeof *bad_lifters; k++) {
        dem_scene_definition d = container_definition(DEM_DRUM, 10);
        d.lifters = bad_lifters[k];
        if (dem_scene_create(&d, &scene) != DEM_BAD_PARAMETER) fail_msg("lifters %zu were not refused", k);
    }
    dem_scene_definition d = container_definition(DEM_DRUM, 10);
    d.ends = (dem_drum_ends){ .are_walls = true, .friction = NAN };
    assert_int_equal(dem_scene_create(&d, &scene), DEM_BAD_PARAMETER);
    d = container_definition(DEM_TUBE_ON_PLATE, 10);
    d.plate.diameter = 0.09; /* narrower than the tube */
    assert_int_equal(dem_scene_create(&d, &scene), DEM_BAD_PARAMETER);
    d = container_definition(DEM_TUBE_ON_PLATE, 10);
    d.lift.speed = -0.1;
    assert_int_equal(dem_scene_create(&d, &scene), DEM_BAD_PARAMETER);
    const dem_orifice bad_orifices[] = { { .opening = 0 },
                                         { .opening = 0.1 }, /* as wide as the vessel */
                                         { .opening = 0.03, .depth = -0.01 },
                                         { .opening = 0.03, .half_angle = 2 },
                                         { .opening = 0.03, .half_angle = 0.1 } }; /* a hopper higher than the vessel */
    for (size_t k = 0; k < sizeof bad_orifices / sizeof *bad_orifices; k++) {
        d = container_definition(DEM_VESSEL, 10);
        d.orifice = bad_orifices[k];
        if (dem_scene_create(&d, &scene) != DEM_BAD_PARAMETER) fail_msg("orifice %zu was not refused", k);
    }
}

UNIT_TESTS(a_sphere_at_rest_on_any_wall_carries_its_weight, a_normal_impact_on_any_wall_leaves_e_of_the_speed,
           a_sphere_slides_over_the_edge_of_an_orifice_and_falls_freely,
           a_sphere_falls_through_an_orifice_that_is_open_and_rests_on_a_stopper_before,
           a_sphere_set_sliding_on_a_floor_ends_rolling_at_five_sevenths,
           a_sphere_that_rolls_is_slowed_by_the_rolling_friction_of_the_floor,
           a_turning_end_wall_drives_a_sphere_by_coulombs_impulse, a_lifter_carries_a_ball_up_until_its_face_is_level,
           a_particle_beyond_any_wall_has_escaped, a_sphere_that_goes_around_the_edge_and_beneath_the_plate_is_lost,
           a_failure_names_its_own_container, a_container_that_cannot_be_is_refused)
