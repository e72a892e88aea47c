/* Claims about what a drum may do beside turning at one rate: stages of its rotation, a tilted axis, and bars that lean. */
#include "interface.h"
#include "measure.h"
#include "scene_by_hand.h"
#include "small_drum.h"
#include "wall_forces.h"

static const dem_rotation_stage staircase[] = { { 3, 0.02 }, { 0, 0.015 }, { -5, 0.03 }, { 4, 0.01 } };

static void set_stages(dem_scene_definition *d, const dem_rotation_stage *stages, size_t count)
{
    d->stage_count = count;
    for (size_t k = 0; k < count; k++) d->stage[k] = stages[k];
}

static dem_scene_definition drum_of_stages(void)
{
    dem_scene_definition d = small_drum();
    d.lifters = (dem_lifters){ .count = 3, .height = 0.004, .width = 0.003, .friction = 0.4, .angle = 0.4 };
    d.particle_count = 120;
    follow_rules(&d, 0.03);
    set_stages(&d, staircase, 4);
    return d;
}

/* Angle and rate at each moment, summed up by hand; the last stage goes on. */
static void a_drum_turns_as_its_stages_say(void **unused)
{
    (void)unused;
    const dem_scene_definition d = drum_of_stages();
    static const double at[] = { 0.01, 0.025, 0.05, 0.07, 0.09 };
    static const double turned[] = { 0.03, 0.06, 0.06 - 5 * 0.015, 0.06 - 5 * 0.03 + 4 * 0.005, 0.06 - 5 * 0.03 + 4 * 0.025 };
    static const double rate[] = { 3, 0, -5, 4, 4 };
    container c;
    container_init(&c, &d);
    for (int k = 0; k < 5; k++) {
        const bool changes = container_move(&c, &d, true, at[k]);
        CHECK_NEAR(c.angle, turned[k], 1e-15);
        assert_true(c.rotation_rate == rate[k] && c.wall[c.first_bar].rotation_rate == rate[k]);
        assert_true(changes == (k < 4));
        const double foot = turned[k] - 0.4;
        CHECK_NEAR(c.wall[c.first_bar].middle[0], cos(foot), 1e-12);
    }
}

static dem_state state_of(const dem_scene *scene)
{
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    return state;
}

static void check_same(const dem_state *a, const dem_state *b)
{
    static const size_t size[] = { [DEM_FLOAT64] = 8, [DEM_INT64] = 8, [DEM_INT32] = 4 };
    assert_int_equal(a->array_count, b->array_count);
    for (size_t k = 0; k < a->array_count; k++) {
        assert_int_equal(a->array[k].rows, b->array[k].rows);
        assert_memory_equal(a->array[k].data, b->array[k].data, a->array[k].rows * a->array[k].columns * size[a->array[k].element]);
    }
}

/* Through all four stages; saved in the middle of the third, and gone on with by one thread and by two. */
static void a_restart_within_a_stage_has_the_same_bits(void **unused)
{
    (void)unused;
    dem_scene_definition d = drum_of_stages();
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    const int64_t half = (int64_t)(0.05 / d.time_step), rest = (int64_t)(0.04 / d.time_step);
    run(scene, half);
    CHECK_BETWEEN(dem_scene_time(scene), 0.04, 0.06); /* in the third stage */
    dem_state middle = state_of(scene);
    run(scene, rest);
    CHECK_BETWEEN(dem_scene_time(scene), 0.075, 1); /* in the last */
    dem_state end = state_of(scene);
    dem_scene_free(scene);
    for (int threads = 1; threads <= 2; threads++) {
        d.threads = threads;
        scene = drum_scene(&d);
        assert_int_equal(dem_scene_restore(scene, &middle), DEM_OK);
        run(scene, rest);
        dem_state again = state_of(scene);
        check_same(&end, &again);
        dem_state_clear(&again);
        dem_scene_free(scene);
    }
    dem_state_clear(&middle);
    dem_state_clear(&end);
}

/* ---- results of stages ---- */

enum { FRAMES = 200 };

/* Frames of the running drum. */
static double *frames_of(dem_scene *scene, int64_t between)
{
    const size_t width = dem_frame_width(scene);
    double *table = calloc(FRAMES * width, sizeof *table);
    for (size_t k = 0; k < FRAMES; k++) {
        assert_int_equal(dem_frame_measure(scene, table + k * width), DEM_OK);
        run(scene, between);
    }
    return table;
}

/* The bed seen in a mirror, x for -x, as the definitions of the columns have it. */
static void mirror(const dem_scene *scene, double *table)
{
    const size_t width = dem_frame_width(scene), columns = width - DEM_FRAME_SCALARS;
    static const frame_column angles[] = { FRAME_SURFACE_FIT, FRAME_CENTER_OF_MASS, FRAME_THEIL_SEN,
                                           FRAME_CHORD,       FRAME_TORQUE,         FRAME_WEIGHT_TORQUE };
    for (size_t k = 0; k < FRAMES; k++) {
        double *f = table + k * width, reversed[1000];
        for (size_t a = 0; a < 6; a++) f[angles[a]] *= -1;
        const double upper = f[FRAME_UPPER_CHORD];
        f[FRAME_UPPER_CHORD] = -f[FRAME_LOWER_CHORD];
        f[FRAME_LOWER_CHORD] = -upper;
        assert_true(columns <= 1000);
        for (size_t c = 0; c < columns; c++) reversed[c] = f[DEM_FRAME_SCALARS + columns - 1 - c];
        memcpy(f + DEM_FRAME_SCALARS, reversed, columns * sizeof *reversed);
    }
}

static void check_equal_results(const dem_drum_results *a, const dem_drum_results *b)
{
    for (int m = 0; m < DEM_ANGLE_METHODS; m++) {
        CHECK_NEAR(a->repose.angle[m].mean_deg, b->repose.angle[m].mean_deg, 1e-9);
        CHECK_NEAR(a->repose.angle[m].minimum_deg, b->repose.angle[m].minimum_deg, 1e-9);
        if (!isnan(b->repose.angle[m].standard_error_deg))
            CHECK_NEAR(a->repose.angle[m].standard_error_deg, b->repose.angle[m].standard_error_deg, 1e-9);
    }
    CHECK_NEAR(a->repose.interface_fluctuation, b->repose.interface_fluctuation, 1e-12);
    assert_true(a->repose.frames == b->repose.frames && a->repose.verdict == b->repose.verdict);
    assert_true(a->regime.regime == b->regime.regime);
    CHECK_NEAR(a->drive.torque.mean, b->drive.torque.mean, 1e-12);
}

/* The frames of a drum at one rate, given to a drum with stages as those of its only one, of its third, which turns the other way,
 * and of a whole staircase: the results are those of the drum at one rate. */
static void a_stage_is_measured_as_a_run_of_its_own(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    follow_rules(&d, 0.03);
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    const int64_t between = (int64_t)(0.004 / d.time_step);
    double *table = frames_of(scene, between);
    const size_t width = dem_frame_width(scene);
    const double length = table[(FRAMES - 1) * width + FRAME_TIME] + 0.5 * (double)between * d.time_step;
    dem_drum_results alone, staged;
    assert_int_equal(dem_drum_results_measure(scene, table, FRAMES, &alone), DEM_OK);
    CHECK_BETWEEN(alone.repose.angle[DEM_SURFACE_FIT].mean_deg, 10, 50);

    set_stages(&scene->definition, (dem_rotation_stage[]){ { 4, 1 } }, 1);
    assert_int_equal(dem_drum_stage_measure(scene, 0, table, FRAMES, &staged), DEM_OK);
    check_equal_results(&staged, &alone);
    assert_int_equal(dem_drum_results_measure(scene, table, FRAMES, &staged), DEM_OK); /* the last that turns */
    check_equal_results(&staged, &alone);

    const dem_rotation_stage stages[] = { { 2, 0.5 * length }, { 0, 0.5 * length }, { -4, length }, { 0, length } };
    set_stages(&scene->definition, stages, 4);
    mirror(scene, table);
    for (size_t k = 0; k < FRAMES; k++) table[k * width + FRAME_TIME] += length;
    assert_int_equal(dem_drum_stage_measure(scene, 2, table, FRAMES, &staged), DEM_OK);
    check_equal_results(&staged, &alone);
    CHECK_NEAR(staged.repose.window_start - length, alone.repose.window_start, 1e-9);
    assert_int_equal(dem_drum_results_measure(scene, table, FRAMES, &staged), DEM_OK);
    check_equal_results(&staged, &alone);
    assert_int_equal(dem_drum_stage_measure(scene, 0, table, FRAMES, &staged), DEM_TOO_FEW_FRAMES);
    free(table);
    dem_scene_free(scene);
}

static void a_stage_of_rest_has_an_angle_without_error_and_no_regime(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    follow_rules(&d, 0.03);
    set_stages(&d, (dem_rotation_stage[]){ { -4, 0.1 }, { 0, 1 } }, 2);
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    double *table = frames_of(scene, (int64_t)(0.002 / d.time_step));
    dem_drum_results r;
    assert_int_equal(dem_drum_stage_measure(scene, 1, table, FRAMES, &r), DEM_OK);
    const dem_angle *a = &r.repose.angle[DEM_SURFACE_FIT];
    /* it turned the other way: positive is where the surface rose to then */
    CHECK_BETWEEN(a->mean_deg, 5, 45);
    CHECK_BETWEEN(a->maximum_deg - a->minimum_deg, 0, 5); /* it comes to rest within it */
    assert_true(isnan(a->standard_error_deg) && r.repose.verdict == DEM_NO_VERDICT && !r.regime.is_told);
    free(table);
    dem_scene_free(scene);
}

/* ---- tilt ---- */

/* N, of all contacts with the walls of that kind on the bed. */
static void sum_of_walls(const dem_scene *scene, wall_kind kind, double sum[3])
{
    const contact_list *walls = &scene->neighbors.walls;
    sum[0] = sum[1] = sum[2] = 0;
    for (size_t k = 0; k < walls->count; k++) {
        const wall_load load = wall_load_of(walls, k, &scene->spheres, &scene->container);
        if (scene->container.wall[load.wall].kind != kind) continue;
        for (int c = 0; c < 3; c++) sum[c] -= load.force[c];
    }
}

/* At rest in a cylinder without friction, the ends carry m g sin(tilt) and the cylinder m g cos(tilt), the lower end nearly all. */
static void the_ends_of_a_tilted_drum_carry_the_bed_s_weight_along_its_axis(void **unused)
{
    (void)unused;
    for (double tilt = 0.2; tilt < 1.1; tilt += 0.4) {
        dem_scene_definition d = small_drum();
        d.ends = (dem_drum_ends){ .are_walls = true, .friction = 0.3 };
        d.contact.wall_friction = 0;
        d.tilt = tilt;
        d.particle_count = 150;
        follow_rules(&d, 0.03);
        set_stages(&d, (dem_rotation_stage[]){ { 0, 10 } }, 1);
        dem_scene *scene = drum_scene(&d);
        run_to_phase(scene, DEM_PHASE_RUNNING);
        run(scene, (int64_t)(0.5 / d.time_step));
        double ends[3] = { 0 }, cylinder[3] = { 0 };
        enum { TIMES = 200 };
        for (int k = 0; k < TIMES; k++) { /* a bed of latching springs goes on to swing a little */
            double now[2][3];
            sum_of_walls(scene, WALL_PLANE, now[0]);
            sum_of_walls(scene, WALL_CYLINDER, now[1]);
            for (int c = 0; c < 3; c++) ends[c] += now[0][c] / TIMES, cylinder[c] += now[1][c] / TIMES;
            run(scene, 17);
        }
        const double weight = 150 * species_mass(&d.species[0]) * d.gravity;
        CHECK_NEAR(ends[2] / weight, sin(tilt), 5e-3);
        CHECK_NEAR(cylinder[2] / weight, 0, 1e-6);
        CHECK_NEAR((ends[1] + cylinder[1]) / weight, cos(tilt), 5e-3);
        dem_scene_free(scene);
    }
}

static void what_a_drum_cannot_do_is_refused(void **unused)
{
    (void)unused;
    dem_scene_definition d[5];
    for (int k = 0; k < 5; k++) {
        d[k] = small_drum();
        follow_rules(&d[k], 0.03);
    }
    d[0].tilt = 0.3; /* without ends */
    d[1].tilt = 1.6, d[1].ends.are_walls = true;
    set_stages(&d[2], (dem_rotation_stage[]){ { 3, 0 } }, 1);
    set_stages(&d[3], (dem_rotation_stage[]){ { NAN, 1 } }, 1);
    d[4].stage_count = DEM_MAXIMUM_STAGES + 1;
    for (int k = 0; k < 5; k++) {
        dem_scene *scene;
        assert_int_equal(dem_scene_create(&d[k], &scene), DEM_BAD_PARAMETER);
    }
}

/* ---- bars that lean ---- */

/* m from the point to the segment. */
static double distance_to(const double x[2], const double a[2], const double b[2])
{
    const double along[2] = { b[0] - a[0], b[1] - a[1] }, from[2] = { x[0] - a[0], x[1] - a[1] };
    const double share = fmin(fmax((from[0] * along[0] + from[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]), 0), 1);
    return hypot(from[0] - share * along[0], from[1] - share * along[1]);
}

/* Its corners by hand: from the foot on the wall inward along the radius turned by the angle, and half a width to either side. Seen
 * from around, a bar is as far as the nearest of its three sides. */
static void a_bar_that_leans_is_seen_where_it_stands(void **unused)
{
    (void)unused;
    dice r = { 77 };
    for (double lean = -0.9; lean < 1; lean += 0.3) {
        dem_scene_definition d = small_drum();
        d.lifters = (dem_lifters){ .count = 3, .height = 0.005, .width = 0.003, .angle = lean };
        container c;
        container_init(&c, &d);
        const double foot[2] = { -0.02 * 0.5, 0.02 * sqrt(0.75) }, at = 2 * M_PI / 3; /* of the second bar */
        const double inward[2] = { -cos(at - lean), -sin(at - lean) }, left[2] = { -inward[1], inward[0] };
        double near[2][2], far[2][2];
        for (int side = 0; side < 2; side++)
            for (int a = 0; a < 2; a++) {
                const double edge = foot[a] + (side ? 0.0015 : -0.0015) * left[a];
                near[side][a] = edge + 0.005 * inward[a];
                far[side][a] = edge - 0.01 * inward[a];
            }
        /* a positive angle leans the way of a positive rate: its top is ahead of its foot */
        const double top[2] = { foot[0] + 0.005 * inward[0], foot[1] + 0.005 * inward[1] };
        assert_true(fabs(lean) < 0.01 || (foot[0] * top[1] - foot[1] * top[0] > 0) == (lean > 0));
        double nearest = INFINITY;
        for (int k = 0; k < 20000; k++) {
            const double x[3] = { dice_uniform(&r, -0.02, 0.02), dice_uniform(&r, -0.02, 0.02), 0 };
            const wall_sight seen = wall_seen_from(&c.wall[c.first_bar + 1], x);
            if (hypot(x[0], x[1]) > 0.02) continue;
            const double apart =
                fmin(distance_to(x, near[0], near[1]), fmin(distance_to(x, near[0], far[0]), distance_to(x, near[1], far[1])));
            CHECK_NEAR(fabs(seen.distance), apart, 1e-12);
            if (seen.distance <= 0) nearest = fmin(nearest, hypot(x[0], x[1]));
        }
        CHECK_BETWEEN(nearest, c.bars_from, c.bars_from + 1e-3); /* no bar is nearer */
    }
}

UNIT_TESTS(a_drum_turns_as_its_stages_say, a_restart_within_a_stage_has_the_same_bits, a_stage_is_measured_as_a_run_of_its_own,
           a_stage_of_rest_has_an_angle_without_error_and_no_regime,
           the_ends_of_a_tilted_drum_carry_the_bed_s_weight_along_its_axis, what_a_drum_cannot_do_is_refused,
           a_bar_that_leans_is_seen_where_it_stands)
