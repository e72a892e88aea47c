/* Claims about what a run says of itself, against tables of frames whose truth is known: noise that remembers, ramps, steps,
 * saw-teeth; and about beds of one or a handful of spheres. */
#include "measure.h"
#include "scene_by_hand.h"

enum { FRAMES = 800 };
static const double INTERVAL = 0.05, RADIUS = 0.06; /* s, m */

static double dice_normal(dice *d)
{
    double sum = -6;
    for (int k = 0; k < 12; k++) sum += dice_uniform(d, 0, 1);
    return sum;
}

static dem_scene *scene_of(size_t particles, double rate)
{
    dem_scene_definition d = hand_definition(particles - PARKED);
    d.diameter = 2 * RADIUS;
    d.length = 0.018;
    d.rotation_rate = rate;
    return hand_scene(&d);
}

/* Angles over time of a bed whose surface flows evenly. */
static dem_drum_results results_of(const dem_scene *scene, const double *angle, size_t count)
{
    const size_t width = dem_frame_width(scene);
    double *table = calloc(count * width, sizeof *table);
    assert_non_null(table);
    for (size_t k = 0; k < count; k++) {
        double *f = table + k * width;
        f[FRAME_TIME] = (double)k * INTERVAL;
        f[FRAME_SURFACE_FIT] = f[FRAME_CENTER_OF_MASS] = f[FRAME_THEIL_SEN] = angle[k];
        f[FRAME_UPPER_CHORD] = f[FRAME_LOWER_CHORD] = angle[k];
        f[FRAME_WALL_COVERAGE] = 0.5;
        f[FRAME_FLOW_SPEED] = 0.1;
    }
    dem_drum_results r;
    assert_int_equal(dem_drum_results_measure(scene, table, count, &r), DEM_OK);
    free(table);
    return r;
}

/* x_k = a x_(k-1) + noise, of the deviation given. */
static void add_noise(dice *d, double a, double deviation, double *x, size_t count)
{
    double value = dice_normal(d);
    for (size_t k = 0; k < count; k++) {
        value = a * value + sqrt(1 - a * a) * dice_normal(d);
        x[k] += deviation * value;
    }
}

static void fill_with(double *x, size_t count, double value)
{
    for (size_t k = 0; k < count; k++) x[k] = value;
}

/* The drum turns by 2 rad/s: 800 frames are 12.7 revolutions, of which some half at least are in the window. 400 tables of
 * each: a share is known to 2.5 %. */
static void a_series_without_trend_is_hardly_ever_said_to_drift_and_the_bound_holds(void **unused)
{
    (void)unused;
    enum { TABLES = 400 };
    dem_scene *scene = scene_of(200, 2);
    dice d = { 3 };
    for (int a = 0; a < 3; a++) {
        int said[5] = { 0 }, outside = 0, bounds = 0;
        for (int t = 0; t < TABLES; t++) {
            double angle[FRAMES];
            fill_with(angle, FRAMES, 25);
            add_noise(&d, (const double[]){ 0, 0.6, 0.9 }[a], 0.8, angle, FRAMES);
            const dem_drum_results r = results_of(scene, angle, FRAMES);
            said[r.repose.verdict]++;
            bounds += !isnan(r.repose.drift_bound_deg_per_revolution);
            outside += r.repose.drift_bound_deg_per_revolution < fabs(r.repose.drift_deg_per_revolution);
            assert_int_equal(r.repose.steady, r.repose.verdict == DEM_STEADY);
        }
        assert_int_equal(outside, 0);
        CHECK_BETWEEN(bounds, 0.95 * TABLES, TABLES);
        CHECK_BETWEEN(said[DEM_DRIFTING], 0, 0.08 * TABLES); /* 5 of 100, by what 95 % means */
        CHECK_BETWEEN(said[DEM_STEADY], 0.85 * TABLES, TABLES);
        assert_int_equal(said[DEM_TOO_FEW] + said[DEM_NO_VERDICT], 0);
    }
    dem_scene_free(scene);
}

/* The true slope lies below the bound; ramps of 3 degrees or more over the window are seen. */
static void a_ramp_drifts_and_its_slope_is_below_the_bound(void **unused)
{
    (void)unused;
    enum { TABLES = 200 };
    static const double slopes[] = { 0.7, -0.7, 3 }; /* degrees a revolution */
    dem_scene *scene = scene_of(200, 2);
    dice d = { 8 };
    for (size_t s = 0; s < sizeof slopes / sizeof *slopes; s++) {
        int drifting = 0, steady = 0, below = 0;
        for (int t = 0; t < TABLES; t++) {
            double angle[FRAMES];
            for (size_t k = 0; k < FRAMES; k++) angle[k] = 20 + slopes[s] * (double)k * INTERVAL / M_PI;
            add_noise(&d, 0.6, 0.8, angle, FRAMES);
            const dem_drum_results r = results_of(scene, angle, FRAMES);
            drifting += r.repose.verdict == DEM_DRIFTING;
            steady += r.repose.steady;
            below += fabs(slopes[s]) < r.repose.drift_bound_deg_per_revolution;
        }
        CHECK_BETWEEN(drifting, 0.97 * TABLES, TABLES);
        assert_int_equal(steady, 0);
        CHECK_BETWEEN(below, 0.94 * TABLES, TABLES); /* 97 of 100, known to 1.2 */
    }
    dem_scene_free(scene);
}

/* A step of five deviations after two thirds to five sixths of the run is no steady angle, whatever else is said of it. */
static void a_step_is_not_steady(void **unused)
{
    (void)unused;
    dem_scene *scene = scene_of(200, 2);
    dice d = { 21 };
    for (int t = 0; t < 100; t++) {
        double angle[FRAMES];
        for (size_t k = 0; k < FRAMES; k++) angle[k] = 3 * k < 2 * FRAMES + 4 * (size_t)t ? 24 : 28;
        add_noise(&d, 0.6, 0.8, angle, FRAMES);
        const dem_drum_results r = results_of(scene, angle, FRAMES);
        assert_false(r.repose.steady);
    }
    dem_scene_free(scene);
}

/* The same series, cut after fewer and fewer revolutions: below half of one nobody can know, be it ever so flat, or ever so
 * steep. */
static void a_run_that_is_too_short_says_so(void **unused)
{
    (void)unused;
    dem_scene *scene = scene_of(200, 2);
    dice d = { 34 };
    for (int steep = 0; steep < 2; steep++)
        for (size_t count = 8; count <= 31; count++) { /* 0.5 revolutions are 31.4 frames */
            double angle[FRAMES];
            for (size_t k = 0; k < count; k++) angle[k] = 25 + steep * 0.5 * (double)k;
            add_noise(&d, 0.3, 0.1, angle, count);
            const dem_drum_results r = results_of(scene, angle, count);
            assert_int_equal(r.repose.verdict, DEM_TOO_SHORT);
            assert_true(isnan(r.repose.drift_deg_per_revolution));
            assert_false(r.regime.is_certain);
        }
    dem_scene *slow = scene_of(200, 0.1); /* enough frames, 0.48 revolutions in all */
    double angle[FRAMES];
    fill_with(angle, FRAMES, 25);
    add_noise(&d, 0, 0.5, angle, FRAMES);
    const size_t count = (size_t)(0.48 * 2 * M_PI / 0.1 / INTERVAL);
    assert_true(count < FRAMES);
    assert_int_equal(results_of(slow, angle, count).repose.verdict, DEM_TOO_SHORT);
    dem_scene_free(slow);
    dem_scene_free(scene);
}

/* Revolutions enough, but the angle wanders so slowly that the window has one or two correlation times, or four, and no
 * trend: too short is the word for nearly all, and steady for no more than 2 of 100. Shares are known to 1 of 100. */
static void correlation_times_are_counted(void **unused)
{
    (void)unused;
    enum { TABLES = 400 };
    dem_scene *scene = scene_of(200, 2);
    dice d = { 55 };
    for (int a = 0; a < 3; a++) {
        int said[5] = { 0 };
        for (int t = 0; t < TABLES; t++) {
            double angle[FRAMES];
            fill_with(angle, FRAMES, 25);
            /* 1000, 400 and 200 frames a correlation length */
            add_noise(&d, (const double[]){ 0.998, 0.995, 0.99 }[a], 2, angle, FRAMES);
            said[results_of(scene, angle, FRAMES).repose.verdict]++;
        }
        CHECK_BETWEEN(said[DEM_STEADY], 0, (a < 2 ? 0.02 : 0.04) * TABLES);
        CHECK_BETWEEN(said[DEM_TOO_SHORT], (a < 2 ? 0.95 : 0.93) * TABLES, TABLES);
    }
    dem_scene_free(scene);
}

/* So many beds of such series, told together. */
static dem_repose_result together(const dem_scene *scene, dice *d, size_t beds, double a, double deviation, double slope,
                                  size_t frames)
{
    dem_drum_results bed[8];
    for (size_t b = 0; b < beds; b++) {
        double angle[FRAMES];
        for (size_t k = 0; k < frames; k++) angle[k] = 25 + slope * (double)k * INTERVAL / M_PI;
        add_noise(d, a, deviation, angle, frames);
        bed[b] = results_of(scene, angle, frames);
    }
    dem_repose_result all = bed[0].repose;
    dem_drum_results_of_beds(bed, beds, &all);
    assert_int_equal(all.steady, all.verdict == DEM_STEADY);
    return all;
}

/* Windows of one or two correlation times are too short also where two or four beds have such; windows of some fifteen each
 * suffice; and a ramp that each bed has is seen by all together. */
static void beds_are_steady_together(void **unused)
{
    (void)unused;
    enum { TABLES = 200 };
    dem_scene *scene = scene_of(200, 2);
    dice d = { 89 };
    for (size_t beds = 1; beds <= 4; beds *= 2) {
        int of_short[5] = { 0 }, of_long[5] = { 0 }, of_ramp[5] = { 0 }, below = 0;
        for (int t = 0; t < TABLES; t++) {
            of_short[together(scene, &d, beds, 0.995, 2, 0, FRAMES).verdict]++;
            of_long[together(scene, &d, beds, 0.9, 0.8, 0, 400).verdict]++; /* 19 frames a correlation length */
            const dem_repose_result ramp = together(scene, &d, beds, 0.6, 0.8, 0.7, FRAMES);
            of_ramp[ramp.verdict]++;
            below += ramp.drift_bound_deg_per_revolution > 0.7;
        }
        CHECK_BETWEEN(of_short[DEM_STEADY], 0, 0.03 * TABLES);
        if (beds > 1) CHECK_BETWEEN(of_long[DEM_STEADY], 0.7 * TABLES, TABLES);
        CHECK_BETWEEN(of_ramp[DEM_DRIFTING], 0.97 * TABLES, TABLES);
        assert_int_equal(of_ramp[DEM_STEADY], 0);
        CHECK_BETWEEN(below, 0.93 * TABLES, TABLES); /* as of one bed: 97 of 100, known to 1.2 */
    }
    dem_scene_free(scene);
}

/* Half of the beds that fall, or have no angle, are no steady bed together; nor is one among them too short for its verdict. */
static void one_bed_in_two_decides_what_the_drift_does_not(void **unused)
{
    (void)unused;
    dem_scene *scene = scene_of(200, 2);
    dice d = { 144 };
    double angle[FRAMES];
    fill_with(angle, FRAMES, 25);
    add_noise(&d, 0.6, 0.8, angle, FRAMES);
    const dem_drum_results steady = results_of(scene, angle, FRAMES);
    assert_int_equal(steady.repose.verdict, DEM_STEADY);
    for (int which = 0; which < 4; which++) {
        dem_drum_results bed[3] = { steady, steady, steady };
        dem_repose_result all = steady.repose;
        if (which == 0) bed[1].regime.regime = DEM_SLUMPING;
        if (which == 1) bed[1].repose.is_long_enough = false;
        if (which == 2) bed[1].repose.verdict = DEM_NO_VERDICT, bed[1].repose.trend = (dem_trend){ NAN, NAN, NAN, NAN };
        if (which == 3) bed[1].repose.verdict = DEM_TOO_FEW;
        const dem_verdict of_two[] = { DEM_DRIFTING, DEM_TOO_SHORT, DEM_NO_VERDICT, DEM_TOO_FEW };
        const dem_verdict of_three[] = { DEM_STEADY, DEM_TOO_SHORT, DEM_STEADY, DEM_TOO_FEW };
        dem_drum_results_of_beds(bed, 2, &all);
        assert_int_equal(all.verdict, of_two[which]);
        dem_drum_results_of_beds(bed, 3, &all);
        assert_int_equal(all.verdict, of_three[which]);
    }
    dem_scene_free(scene);
}

/* Climbs from 0 to a first fall and falls again and again, the first fall the deepest. rate in rad/s, of either sense. */
static void falls_are_all_kept_however_the_transient_is_judged(double rate)
{
    dem_scene *scene = scene_of(200, rate);
    const size_t width = dem_frame_width(scene);
    const double sense = rate < 0 ? -1 : 1;
    /* frame and angle of turning points: the falls begin at 32.3, 27 and 26.5 degrees */
    static const struct {
        size_t frame;
        double angle;
    } turns[] = { { 0, 0 }, { 152, 32.3 }, { 158, 22.4 }, { 250, 27 }, { 256, 23 }, { 340, 26.5 }, { 346, 22.8 }, { 400, 25.5 } };
    double *table = calloc(401 * width, sizeof *table);
    for (size_t k = 0, next = 1; k <= 400; k++) {
        if (k > turns[next].frame) next++;
        const double share = (double)(k - turns[next - 1].frame) / (double)(turns[next].frame - turns[next - 1].frame);
        double *f = table + k * width;
        f[FRAME_TIME] = (double)k * INTERVAL;
        f[FRAME_SURFACE_FIT] = sense * (turns[next - 1].angle + share * (turns[next].angle - turns[next - 1].angle));
        f[FRAME_CENTER_OF_MASS] = f[FRAME_UPPER_CHORD] = f[FRAME_LOWER_CHORD] = f[FRAME_THEIL_SEN] = f[FRAME_SURFACE_FIT];
        f[FRAME_WALL_COVERAGE] = 0.5;
        f[FRAME_FLOW_SPEED] = turns[next].angle < turns[next - 1].angle ? 0.1 : 0;
    }
    dem_drum_results r;
    assert_int_equal(dem_drum_results_measure(scene, table, 401, &r), DEM_OK);
    assert_int_equal(r.regime.regime, DEM_AVALANCHING);
    CHECK_NEAR(r.repose.slumps.count, 3, 0);
    CHECK_NEAR(r.repose.slumps.start_deg.mean, (32.3 + 27 + 26.5) / 3, 1e-9);
    CHECK_NEAR(r.repose.slumps.stop_deg.mean, (22.4 + 23 + 22.8) / 3, 1e-9);
    CHECK_NEAR(sense > 0 ? r.repose.angle[DEM_SURFACE_FIT].maximum_deg : -r.repose.angle[DEM_SURFACE_FIT].minimum_deg, 32.3, 1e-9);
    CHECK_NEAR(sense > 0 ? r.repose.angle[DEM_SURFACE_FIT].minimum_deg : -r.repose.angle[DEM_SURFACE_FIT].maximum_deg, 22.4, 1e-9);
    CHECK_NEAR(r.repose.window_start, 152 * INTERVAL, 1e-9);
    assert_int_equal(r.repose.verdict, DEM_DRIFTING); /* three falls tell, though the drum turned by less than a tenth */
    free(table);
    dem_scene_free(scene);
}

static void beds_that_fall_keep_their_falls(void **unused)
{
    (void)unused;
    falls_are_all_kept_however_the_transient_is_judged(M_PI / 128);
    falls_are_all_kept_however_the_transient_is_judged(-M_PI / 128);
}

/* A first fall from 28 to 23 degrees is the transient of a bed that flows after it: no avalanches, and not in the window. */
static void the_first_fall_of_a_bed_that_flows_is_its_transient(void **unused)
{
    (void)unused;
    dem_scene *scene = scene_of(200, 2);
    dice d = { 89 };
    double angle[FRAMES];
    for (size_t k = 0; k < FRAMES; k++) angle[k] = k < 6 ? 28.0 / 6 * (double)k : k < 10 ? 28 - 1.25 * (double)(k - 6) : 23;
    add_noise(&d, 0.6, 0.5, angle, FRAMES);
    const dem_drum_results r = results_of(scene, angle, FRAMES);
    assert_int_equal(r.regime.regime, DEM_ROLLING);
    assert_true(r.repose.window_start >= 10 * INTERVAL && isnan(r.repose.slumps.count));
    assert_int_equal(r.repose.verdict, DEM_STEADY);
    assert_true(r.regime.is_certain);
    dem_scene_free(scene);
}

/* Frames of beds of so many particles: an angle is none where there is no bed. */
static void one_sphere_or_a_handful_have_no_angle_and_few_no_verdict(void **unused)
{
    (void)unused;
    static const struct {
        size_t particles;
        double fill;
        bool has_angle;
        dem_verdict verdict;
    } beds[] = {
        { PARKED + 1, 0.5, false, DEM_TOO_FEW }, { DEM_LEAST_BED_PARTICLES - 1, 0.5, false, DEM_TOO_FEW },
        { 99, 0.5, true, DEM_TOO_FEW },          { 200, 0.004, false, DEM_TOO_FEW },
        { 200, 0.05, true, DEM_TOO_FEW },        { 200, 0.5, true, DEM_STEADY },
    };
    for (size_t b = 0; b < sizeof beds / sizeof *beds; b++) {
        dem_scene *scene = scene_of(beds[b].particles, 2);
        scene->definition.fill_fraction = beds[b].fill;
        double *frame = calloc(dem_frame_width(scene), sizeof *frame), angle[FRAMES];
        assert_int_equal(dem_frame_measure(scene, frame), DEM_OK);
        if (!beds[b].has_angle)
            for (int column = FRAME_SURFACE_FIT; column <= FRAME_CHORD; column++) assert_true(isnan(frame[column]));
        free(frame);
        dice d = { 144 };
        fill_with(angle, FRAMES, beds[b].has_angle ? 25 : NAN);
        add_noise(&d, 0.6, 0.5, angle, FRAMES);
        const dem_drum_results r = results_of(scene, angle, FRAMES);
        assert_int_equal(r.repose.verdict, beds[b].verdict);
        assert_int_equal(r.regime.is_told, beds[b].has_angle);
        assert_int_equal(r.regime.is_certain, beds[b].verdict == DEM_STEADY);
        if (!beds[b].has_angle) assert_true(isnan(r.repose.angle[DEM_SURFACE_FIT].mean_deg) && isnan(r.repose.slumps.count));
        dem_scene_free(scene);
    }
}

UNIT_TESTS(a_series_without_trend_is_hardly_ever_said_to_drift_and_the_bound_holds, a_ramp_drifts_and_its_slope_is_below_the_bound,
           a_step_is_not_steady, a_run_that_is_too_short_says_so, correlation_times_are_counted, beds_that_fall_keep_their_falls,
           beds_are_steady_together, one_bed_in_two_decides_what_the_drift_does_not,
           the_first_fall_of_a_bed_that_flows_is_its_transient, one_sphere_or_a_handful_have_no_angle_and_few_no_verdict)
