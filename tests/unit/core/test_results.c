/* Claims about the results that a table of frames gives, with tables written by hand: means and their errors, what is
 * left out, drift, regimes. */
#include "dem_interface.h"
#include "measure.h"
#include "scene_by_hand.h"

enum { FRAMES = 400 };
static const double INTERVAL = 0.05, RADIUS = 0.06; /* s, m */

/* A drum at 2 rad/s and a table of frames of a steady rolling bed: 25 degrees, +-0.5 alternating, a level interface. */
static double *steady_table(const dem_scene *scene)
{
    const size_t width = dem_frame_width(scene);
    double *table = calloc(FRAMES * width, sizeof *table);
    assert_non_null(table);
    for (size_t k = 0; k < FRAMES; k++) {
        double *f = table + k * width;
        const double angle = 25 + (k % 2 ? 0.5 : -0.5);
        f[FRAME_TIME] = (double)k * INTERVAL;
        f[FRAME_SURFACE_FIT] = f[FRAME_CENTER_OF_MASS] = f[FRAME_THEIL_SEN] = angle;
        f[FRAME_UPPER_CHORD] = angle + 2;
        f[FRAME_LOWER_CHORD] = angle - 2;
        f[FRAME_SOLID_FRACTION] = 0.58;
        f[FRAME_COORDINATION] = 4.5;
        f[FRAME_WALL_COVERAGE] = 0.5;
        f[FRAME_FLOW_SPEED] = 0.1 + (k % 2 ? 0.01 : -0.01);
    }
    return table;
}

static dem_drum_results results_of(const dem_scene *scene, const double *table, size_t count)
{
    dem_drum_results r;
    assert_int_equal(dem_drum_results_measure(scene, table, count, &r), DEM_OK);
    return r;
}

static dem_scene *any_scene(double rate)
{
    dem_scene_definition d = hand_definition(100);
    d.diameter = 2 * RADIUS;
    d.length = 0.018;
    d.rotation_rate = rate;
    return hand_scene(&d);
}

static void a_steady_table_has_its_mean_error_and_range(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(2);
    double *table = steady_table(scene);
    const dem_drum_results r = results_of(scene, table, FRAMES);
    const dem_angle *a = &r.repose.angle[DEM_SURFACE_FIT];
    CHECK_NEAR(a->mean_deg, 25, 0.01);
    CHECK_NEAR(a->minimum_deg, 24.5, 1e-12);
    CHECK_NEAR(a->maximum_deg, 25.5, 1e-12);
    CHECK_BETWEEN(a->standard_error_deg, 0, 0.5 / sqrt(0.5 * FRAMES)); /* +-0.5, alternating: no more than independent */
    assert_true(r.repose.steady);
    CHECK_NEAR(r.repose.drift_deg_per_revolution, 0, 0.01);
    CHECK_BETWEEN(r.repose.window_start, 0.25 * 2 * M_PI / 2, 0.5 * FRAMES * INTERVAL); /* after a quarter turn */
    CHECK_NEAR(r.repose.window_end, (FRAMES - 1) * INTERVAL, 1e-12);
    CHECK_NEAR(r.regime.curvature_deg, 4, 1e-9);
    CHECK_NEAR(r.packing.solid_fraction, 0.58, 1e-12);
    CHECK_NEAR(r.packing.coordination_number, 4.5, 1e-12);
    assert_int_equal(r.regime.regime, DEM_ROLLING);
    /* Eqns 33, 35 and 36-37 at the measured angle, and Omega^2 R/g at the wall and at R sqrt(1 - 0.5) */
    const double phi = a->mean_deg * M_PI / 180;
    CHECK_NEAR(r.regime.predicted_stationary, 1 / sin(phi), 1e-12);
    CHECK_NEAR(r.regime.predicted_sliding_eq35, (1 + 1 / (tan(phi) + 0.125)) / sqrt(2), 1e-12);
    CHECK_NEAR(r.regime.predicted_sliding_eq36, 1 / sin(atan(0.16 + tan(phi))), 1e-12);
    CHECK_NEAR(r.regime.omega2_outer, 2 * 2 * RADIUS / 9.81, 1e-12);
    CHECK_NEAR(r.regime.omega2_inner, 2 * 2 * RADIUS * sqrt(0.5) / 9.81, 1e-12);
    assert_true(isnan(r.repose.slumps.count) && isnan(r.repose.slumps.period.mean)); /* of a bed that flows: none */
    free(table);
    dem_scene_free(scene);
}

static void a_transient_is_left_out_and_a_drift_is_told(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(2);
    const size_t width = dem_frame_width(scene);
    double *table = steady_table(scene);
    for (size_t k = 0; k < FRAMES; k++) table[k * width + FRAME_SURFACE_FIT] -= 25 * exp(-(double)k * INTERVAL / 1.0);
    dem_drum_results r = results_of(scene, table, FRAMES);
    CHECK_NEAR(r.repose.angle[DEM_SURFACE_FIT].mean_deg, 25, 0.1);
    CHECK_BETWEEN(r.repose.window_start, 2.5, 8); /* 25 exp(-t): 2 degrees left after 2.5 s, 0.01 after 8 s */
    assert_true(r.repose.steady);
    free(table);
    table = steady_table(scene);
    const double rise = 1.2; /* degrees a revolution, 3.14 s */
    for (size_t k = 0; k < FRAMES; k++) table[k * width + FRAME_SURFACE_FIT] += rise * (double)k * INTERVAL / M_PI;
    r = results_of(scene, table, FRAMES);
    CHECK_NEAR(r.repose.drift_deg_per_revolution, rise, 0.02);
    assert_false(r.repose.steady);
    free(table);
    dem_scene_free(scene);
}

static void too_few_frames_are_refused_and_missing_values_left_out(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(2);
    const size_t width = dem_frame_width(scene);
    double *table = steady_table(scene);
    dem_drum_results r;
    assert_int_equal(dem_drum_results_measure(scene, table, 7, &r), DEM_TOO_FEW_FRAMES);
    for (size_t k = 0; k < FRAMES; k++) {
        if (k % 3 == 0) table[k * width + FRAME_SURFACE_FIT] = NAN;
        table[k * width + FRAME_THEIL_SEN] = NAN;
    }
    r = results_of(scene, table, FRAMES);
    CHECK_NEAR(r.repose.angle[DEM_SURFACE_FIT].mean_deg, 25, 0.05);
    assert_true(isnan(r.repose.angle[DEM_THEIL_SEN].mean_deg) && isnan(r.repose.angle[DEM_THEIL_SEN].standard_error_deg));
    free(table);
    dem_scene_free(scene);
}

/* In `missing` of ten frames, spread evenly, the bed has no surface. */
static dem_angle angle_without(const dem_scene *scene, size_t missing)
{
    const size_t width = dem_frame_width(scene);
    double *table = steady_table(scene);
    for (size_t k = 0; k < FRAMES; k++)
        if (7 * k % 10 < missing) table[k * width + FRAME_SURFACE_FIT] = NAN;
    const dem_drum_results r = results_of(scene, table, FRAMES);
    free(table);
    return r.repose.angle[DEM_SURFACE_FIT];
}

static void a_surface_that_is_seen_now_and_then_has_no_angle_and_one_that_is_missed_no_error(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(2);
    assert_true(angle_without(scene, 1).standard_error_deg > 0);
    const dem_angle missed = angle_without(scene, 3), rare = angle_without(scene, 6);
    CHECK_NEAR(missed.mean_deg, 25, 0.5);
    assert_true(isnan(missed.standard_error_deg));
    assert_true(isnan(rare.mean_deg) && isnan(rare.standard_error_deg) && isnan(rare.maximum_deg));
    dem_scene_free(scene);
}

/* Once the bed has no surface, only its moment shows when it has come to rest against the wall. */
static void the_transient_of_a_bed_that_loses_its_surface_is_told_from_its_moment(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(2);
    const size_t width = dem_frame_width(scene);
    double *table = steady_table(scene);
    for (size_t k = 0; k < FRAMES; k++) {
        double *f = table + k * width;
        if (f[FRAME_TIME] > 2) f[FRAME_SURFACE_FIT] = NAN;
        f[FRAME_WEIGHT_TORQUE] = exp(-f[FRAME_TIME]) + (k % 2 ? 0.001 : -0.001);
    }
    const dem_drum_results r = results_of(scene, table, FRAMES);
    assert_true(isnan(r.repose.angle[DEM_SURFACE_FIT].mean_deg));
    CHECK_BETWEEN(r.repose.window_start, 3, 10); /* 0.05 of the moment left after 3 s; half of the run is 10 s */
    free(table);
    dem_scene_free(scene);
}

/* The interface that a GranuDrum would average: its slope between +-D/10, and how much it fluctuates. */
static void the_chord_and_the_fluctuation_are_those_of_the_mean_interface(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(2);
    const size_t width = dem_frame_width(scene), cells = width - DEM_FRAME_SCALARS;
    double *table = steady_table(scene);
    for (size_t k = 0; k < FRAMES; k++)
        for (size_t a = 0; a < cells; a++) {
            const double x = 2 * RADIUS * (((double)a + 0.5) / (double)cells - 0.5);
            table[k * width + DEM_FRAME_SCALARS + a] = tan(0.4) * x + (k % 2 ? 0.001 : -0.001);
        }
    const dem_drum_results r = results_of(scene, table, FRAMES);
    CHECK_NEAR(r.repose.angle[DEM_CHORD].mean_deg, 0.4 * 180 / M_PI, 1e-6);
    CHECK_NEAR(r.repose.interface_fluctuation, 0.001, 1e-5); /* n - 1 for n: 0.2 % */
    dem_profile mean;
    for (size_t k = 0; k < FRAMES / 4; k++) table[k * width + DEM_FRAME_SCALARS] = NAN; /* seen in most of them */
    for (size_t k = 0; k < FRAMES; k++) table[(k + 1) * width - 1] = k % 4 ? NAN : 1.0; /* seen in a quarter */
    assert_int_equal(dem_drum_interface_measure(scene, table, FRAMES, &r, &mean), DEM_OK);
    assert_int_equal(mean.count, (cells < DEM_PROFILE_POINTS ? cells : DEM_PROFILE_POINTS) - 1);
    for (size_t k = 0; k < mean.count; k++) {
        CHECK_NEAR(mean.value[k], tan(0.4) * mean.place[k], 2e-5);
        CHECK_BETWEEN(mean.standard_error[k], 0, 0.001 / sqrt(FRAMES / 2.0)); /* every other frame makes good for the one before */
    }
    CHECK_NEAR(mean.place[0], RADIUS / (double)cells - RADIUS, 1e-9);
    free(table);
    dem_scene_free(scene);
}

/* ---- regimes ---- */

/* A column of the table: mean and alternating swing about it. */
static void set_column(double *table, size_t width, frame_column column, double mean, double swing)
{
    for (size_t k = 0; k < FRAMES; k++) table[k * width + column] = mean + (k / 4 % 2 ? swing : -swing);
}

static void regimes_are_told_from_how_the_bed_moves(void **unused)
{
    (void)unused;
    struct {
        dem_regime regime;
        frame_column column;
        double mean, swing;
        frame_column second;
        double second_mean, second_swing;
    } cases[] = {
        { DEM_SLIPPING, FRAME_WALL_SLIP, 0.8, 0.02, FRAME_TIME, 0, 0 },            /* the bed lies still in a turning drum */
        { DEM_SLUMPING, FRAME_WALL_SLIP, 0.4, 0.6, FRAME_CENTER_OF_MASS, 20, 4 },  /* carried up, slides back, as a whole */
        { DEM_AVALANCHING, FRAME_FLOW_SPEED, 0.1, 0.09, FRAME_TIME, 0, 0 },        /* the surface flows by bursts */
        { DEM_CASCADING, FRAME_UPPER_CHORD, 45, 0.1, FRAME_LOWER_CHORD, 20, 0.1 }, /* S-shaped */
        { DEM_CATARACTING, FRAME_AIRBORNE, 0.3, 0.01, FRAME_TIME, 0, 0 },
    };
    dem_scene *scene = any_scene(2);
    const size_t width = dem_frame_width(scene);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double *table = steady_table(scene);
        set_column(table, width, cases[k].column, cases[k].mean, cases[k].swing);
        if (cases[k].second != FRAME_TIME) set_column(table, width, cases[k].second, cases[k].second_mean, cases[k].second_swing);
        const dem_drum_results r = results_of(scene, table, FRAMES);
        assert_string_equal(dem_regime_name(r.regime.regime), dem_regime_name(cases[k].regime));
        if (cases[k].regime == DEM_SLUMPING) { /* 8 frames from one top to the next, 8 degrees high: every one but the ends' */
            CHECK_NEAR(r.repose.slumps.period.mean, 8 * INTERVAL, 1e-12);
            CHECK_NEAR(r.repose.slumps.size_deg.mean, 8, 1e-12);
            CHECK_BETWEEN(r.repose.slumps.count, (double)r.repose.frames / 8 - 2, (double)r.repose.frames / 8);
            assert_false(r.repose.steady);
        }
        free(table);
    }
    dem_scene_free(scene);
}

/* A slow drum's wall layer is shaken by each avalanche by much of the drum's own pace, and yet follows it in the mean. */
static void avalanches_that_shake_the_wall_are_no_slumps(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(2);
    const size_t width = dem_frame_width(scene);
    double *table = steady_table(scene);
    set_column(table, width, FRAME_FLOW_SPEED, 0.1, 0.09);
    set_column(table, width, FRAME_CENTER_OF_MASS, 25, 3.5);
    set_column(table, width, FRAME_WALL_SLIP, 0.06, 0.28);
    assert_int_equal(results_of(scene, table, FRAMES).regime.regime, DEM_AVALANCHING);
    set_column(table, width, FRAME_WALL_SLIP, 1, 0.28);
    assert_int_equal(results_of(scene, table, FRAMES).regime.regime, DEM_SLUMPING);
    free(table);
    dem_scene_free(scene);
}

/* Eqns 33, 35, 36-37 at phi = 25 degrees, and Omega^2 at the wall and at R_i = R sqrt(1 - fill), by hand. */
static void fast_beds_rain_slide_or_turn_with_the_drum(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(30);
    const size_t width = dem_frame_width(scene), n = dem_scene_particle_count(scene);
    double *table = steady_table(scene);
    set_column(table, width, FRAME_WALL_COVERAGE, 1, 0);
    set_column(table, width, FRAME_SURFACE_LAG, 0.01, 0);
    dem_drum_results r = results_of(scene, table, FRAMES);
    assert_int_equal(r.regime.regime, DEM_CENTRIFUGING);
    CHECK_NEAR(r.regime.omega2_outer, 900 * 0.06 / 9.81, 1e-9);
    CHECK_NEAR(r.regime.omega2_inner, 900 * 0.06 * sqrt(0.5) / 9.81, 1e-9);
    CHECK_NEAR(r.regime.predicted_stationary, 2.366, 0.002);
    CHECK_NEAR(r.regime.predicted_sliding_eq35, 1.903, 0.002); /* 0.7071 (1 + 1/(0.4663 + 0.125)) */
    CHECK_NEAR(r.regime.predicted_sliding_eq36, 1.884, 0.001); /* 1/sin(atan(0.6263)) */
    set_column(table, width, FRAME_SURFACE_LAG, 0.5, 0);
    assert_int_equal(results_of(scene, table, FRAMES).regime.regime, DEM_SLIDING);
    for (size_t i = 0; i < n / 10; i++) scene->spheres.fallen_time[i] = FRAMES * INTERVAL; /* a tenth were seen falling */
    r = results_of(scene, table, FRAMES);
    assert_int_equal(r.regime.regime, DEM_RAINING);
    CHECK_NEAR(r.regime.fallen_fraction, (double)(n / 10) / (double)n, 1e-12);
    free(table);
    dem_scene_free(scene);
}

/* A bed that slid for most of the window and has turned with the drum for its last four revolutions, which are 0.84 s, or
 * the last 17 frames. */
static void a_fast_bed_is_judged_by_its_last_four_revolutions(void **unused)
{
    (void)unused;
    dem_scene *scene = any_scene(30);
    const size_t width = dem_frame_width(scene);
    double *table = steady_table(scene);
    scene->run_start = 0;
    scene->step_count = llround((FRAMES - 1) * INTERVAL / scene->definition.time_step);
    set_column(table, width, FRAME_WALL_COVERAGE, 0.5, 0);
    set_column(table, width, FRAME_SURFACE_LAG, 2, 0);
    for (int turned = 16; turned <= 17; turned++) { /* with one frame too few, what it did before still counts */
        for (int k = FRAMES - turned; k < FRAMES; k++) {
            table[(size_t)k * width + FRAME_WALL_COVERAGE] = 1;
            table[(size_t)k * width + FRAME_SURFACE_LAG] = 0.01;
        }
        const dem_drum_results r = results_of(scene, table, FRAMES);
        CHECK_NEAR(r.regime.surface_lag, turned == 17 ? 0.01 : (2 + 16 * 0.01) / 17, 1e-12);
        CHECK_NEAR(r.regime.wall_coverage, turned == 17 ? 1 : 16.5 / 17, 1e-12);
        assert_int_equal(r.regime.regime, turned == 17 ? DEM_CENTRIFUGING : DEM_SLIDING);
    }
    free(table);
    dem_scene_free(scene);
}

UNIT_TESTS(a_steady_table_has_its_mean_error_and_range, a_transient_is_left_out_and_a_drift_is_told,
           too_few_frames_are_refused_and_missing_values_left_out,
           a_surface_that_is_seen_now_and_then_has_no_angle_and_one_that_is_missed_no_error,
           the_transient_of_a_bed_that_loses_its_surface_is_told_from_its_moment,
           the_chord_and_the_fluctuation_are_those_of_the_mean_interface, regimes_are_told_from_how_the_bed_moves,
           avalanches_that_shake_the_wall_are_no_slumps, fast_beds_rain_slide_or_turn_with_the_drum,
           a_fast_bed_is_judged_by_its_last_four_revolutions)
