/* Claims about slumps as events, against saw-teeth whose period and height are known. */
#include "measure.h"

#include "core_claims.h"

enum { COUNT = 1200 };
static const double INTERVAL = 0.05; /* s */

/* Sum of twelve uniforms less six: deviation 1. */
static double dice_normal(dice *d)
{
    double sum = -6;
    for (int k = 0; k < 12; k++) sum += dice_uniform(d, 0, 1);
    return sum;
}

/* Rises from `low` to `high` over `rise` s and falls back over `fall` s; begins `phase` s after a low. */
static double saw_tooth(double t, double phase, double low, double high, double rise, double fall)
{
    const double at = fmod(t + phase, rise + fall);
    return at < rise ? low + (high - low) * at / rise : high - (high - low) * (at - rise) / fall;
}

static dem_slumps slumps_of(const double *time, const double *angle, size_t count)
{
    dem_slumps s;
    assert_int_equal(measure_slumps(time, angle, count, &s), DEM_OK);
    return s;
}

/* Turning points on frames: exact. Of 60 s in periods of 1.2 s, begun 0.3 s after a low: tops at 0.7, 1.9, ...: 50 of
 * them, of which the first has no rise by more than the threshold before it (0.7 of 1.0 s), and the last bottom is at
 * 60.9 s, beyond the end. */
static void a_saw_tooth_is_found_tooth_by_tooth(void **unused)
{
    (void)unused;
    static double time[COUNT], angle[COUNT];
    for (int k = 0; k < COUNT; k++) {
        time[k] = 7 + INTERVAL * k;
        angle[k] = saw_tooth(INTERVAL * k, 0.3, 4, 10, 1.0, 0.2);
    }
    const dem_slumps s = slumps_of(time, angle, COUNT);
    CHECK_BETWEEN(s.count, 48, 50);
    CHECK_NEAR(s.period.mean, 1.2, 1e-12);
    CHECK_NEAR(s.period.standard_error, 0, 1e-12);
    CHECK_NEAR(s.start_deg.mean, 10, 1e-12);
    CHECK_NEAR(s.stop_deg.mean, 4, 1e-12);
    CHECK_NEAR(s.size_deg.mean, 6, 1e-12);
    CHECK_NEAR(s.size_deg.standard_error, 0, 1e-12);
    dem_slump one[COUNT];
    size_t found;
    assert_int_equal(measure_slumps_list(time, angle, COUNT, one, 10, &found), DEM_OK);
    assert_true((double)found == s.count);
    const double first = one[0].start_time;
    CHECK_NEAR(fmod(first - 7 + 0.3, 1.2), 1.0, 1e-9);
    for (int k = 0; k < 10; k++) { /* those that there is room for */
        CHECK_NEAR(one[k].start_time, first + 1.2 * k, 1e-9);
        CHECK_NEAR(one[k].stop_time, one[k].start_time + 0.2, 1e-9);
        CHECK_NEAR(one[k].start_deg, 10, 1e-12);
        CHECK_NEAR(one[k].stop_deg, 4, 1e-12);
    }
}

/* Noise of 1/15 of a tooth's height: no tooth is missed and none is made up. A turning point is the extreme of a few
 * frames' noise, so it lies further out by up to two deviations; of 40 teeth the mean scatters by less than that. */
static void noise_neither_hides_nor_makes_slumps(void **unused)
{
    (void)unused;
    static double time[COUNT], angle[COUNT];
    const double noise = 0.4, period = 1.37;
    dice d = { 5 };
    for (int trial = 0; trial < 50; trial++) {
        const double phase = dice_uniform(&d, 0, period);
        for (int k = 0; k < COUNT; k++) {
            time[k] = INTERVAL * k;
            angle[k] = saw_tooth(time[k], phase, 12, 18, 1.1, period - 1.1) + noise * dice_normal(&d);
        }
        const dem_slumps s = slumps_of(time, angle, COUNT);
        CHECK_BETWEEN(s.count, floor(COUNT * INTERVAL / period) - 1, ceil(COUNT * INTERVAL / period));
        /* the first and the last top are known to a frame or two of 42 periods */
        CHECK_NEAR(s.period.mean, period, 2 * 2 * INTERVAL / (s.count - 1));
        CHECK_BETWEEN(s.start_deg.mean, 18 - noise, 18 + 2 * noise);
        CHECK_BETWEEN(s.stop_deg.mean, 12 - 2 * noise, 12 + noise);
        CHECK_NEAR(s.size_deg.mean, s.start_deg.mean - s.stop_deg.mean, 1e-12);
        CHECK_BETWEEN(s.start_deg.standard_error, 0, 1.5 * noise / sqrt(s.count));
    }
}

/* Eight frames a swing, as of a small drum that slides as a block: all swings are seen, the first after the climb too. */
static void swings_of_few_frames_are_no_noise(void **unused)
{
    (void)unused;
    static double time[COUNT], angle[COUNT];
    enum { SWINGS = 12, A_SWING = 8 };
    for (int k = 0; k < SWINGS * A_SWING + 5; k++) {
        time[k] = INTERVAL * k;
        angle[k] = (k < 12 ? 5 : 6) * (1 - cos(2 * 3.14159265358979 * k / A_SWING)); /* the first is less high */
    }
    const dem_slumps s = slumps_of(time, angle, SWINGS * A_SWING + 5);
    CHECK_NEAR(s.count, SWINGS, 0);
    CHECK_NEAR(s.first_start, 4 * INTERVAL, 1e-12);
    CHECK_NEAR(s.period.mean, A_SWING * INTERVAL, 1e-12);
}

/* Teeth of 4 degrees in a climb of 0.5 degrees a second, 30 in all: each of 30 tops at 1.6 + 2 k s is 4 degrees above the
 * climb, and the fall of 0.4 s ends 3.8 degrees lower. The end of the last is at 60 s, beyond the end of the series. */
static void a_climb_does_not_hide_the_falls_in_it(void **unused)
{
    (void)unused;
    static double time[COUNT], angle[COUNT];
    for (int k = 0; k < COUNT; k++) {
        time[k] = INTERVAL * k;
        angle[k] = 0.5 * time[k] + saw_tooth(INTERVAL * (k % 40), 0, 0, 4, 1.6, 0.4);
    }
    const dem_slumps s = slumps_of(time, angle, COUNT);
    CHECK_NEAR(s.count, 29, 0);
    CHECK_NEAR(s.period.mean, 2, 1e-12);
    CHECK_NEAR(s.first_start, 1.6, 1e-12);
    CHECK_NEAR(s.start_deg.mean, 4 + 0.5 * (1.6 + 2 * 14), 1e-9);
    CHECK_NEAR(s.size_deg.mean, 3.8, 1e-9);
    CHECK_NEAR(s.size_deg.standard_error, 0, 1e-9);
}

static void noise_alone_has_no_slumps(void **unused)
{
    (void)unused;
    static double time[COUNT], angle[COUNT];
    dice d = { 9 };
    for (int trial = 0; trial < 50; trial++) {
        for (int k = 0; k < COUNT; k++) {
            time[k] = INTERVAL * k;
            angle[k] = 23 + 0.3 * dice_normal(&d);
        }
        CHECK_NEAR(slumps_of(time, angle, COUNT).count, 0, 0); /* 1200 values span 6.5 deviations */
    }
}

/* Teeth of random height between 60 and 140 % of the mean: all seen, and the error of the mean size is their own scatter,
 * 0.8/sqrt(12) = 0.23 of it, over the root of their number. */
static void uneven_slumps_are_all_seen(void **unused)
{
    (void)unused;
    static double time[COUNT], angle[COUNT];
    enum { RISE = 16, FALL = 4 };
    dice d = { 13 };
    double low = 5, high = 0, sum = 0;
    int teeth = 0;
    for (int k = 0; k < COUNT; k++) {
        const int at = k % (RISE + FALL);
        if (at == 0) {
            high = 11 + dice_uniform(&d, -1.2, 1.2);
            low = k ? low : 5;
        }
        time[k] = INTERVAL * k;
        static double next_low;
        if (at == RISE) next_low = 5 + dice_uniform(&d, -1.2, 1.2);
        angle[k] = at <= RISE ? low + (high - low) * at / RISE : high + (next_low - high) * (at - RISE) / FALL;
        if (at == RISE + FALL - 1) {
            low = next_low;
            sum += high - low;
            teeth++;
        }
    }
    const dem_slumps s = slumps_of(time, angle, COUNT);
    CHECK_BETWEEN(s.count, teeth - 1, teeth);
    CHECK_NEAR(s.size_deg.mean, sum / teeth, 2 * 2.4 / teeth); /* but for one tooth at an end */
    CHECK_NEAR(s.size_deg.standard_error, sqrt(2) * 2.4 / sqrt(12) / sqrt(teeth), 0.25 * s.size_deg.standard_error);
    CHECK_NEAR(s.period.mean, (RISE + FALL) * INTERVAL, 1e-12);
}

/* Falls of 10 degrees with one of `share` of that between every two. Below 0.43 a fall is not counted: it is left out of the
 * count and of the means, and all others are as they would be without it. Above, it is counted like any other. The last fall
 * has no end. */
static void falls_well_below_the_usual_are_left_out_and_nothing_else_is(void **unused)
{
    (void)unused;
    static double time[COUNT], angle[COUNT];
    enum { RISE = 16, FALL = 4, TOOTH = RISE + FALL, CYCLES = COUNT / (3 * TOOTH) };
    static const double shares[] = { 0.05, 0.2, 0.35, 0.5, 0.7, 0.9 };
    for (size_t q = 0; q < sizeof shares / sizeof *shares; q++) {
        for (int k = 0; k < COUNT; k++) {
            const int tooth = k / TOOTH % 3, at = k % TOOTH;
            const double from = tooth == 2 ? 15 - 10 * shares[q] : 5, to = tooth == 1 ? 15 - 10 * shares[q] : 5;
            time[k] = INTERVAL * k;
            angle[k] = at < RISE ? from + (15 - from) * at / RISE : 15 - (15 - to) * (at - RISE) / FALL;
        }
        const dem_slumps s = slumps_of(time, angle, COUNT);
        const double counted = shares[q] > 0.43 ? CYCLES : 0, large = 2 * CYCLES - 1; /* falls of either kind */
        CHECK_NEAR(s.count, counted + large, 0);
        CHECK_NEAR(s.start_deg.mean, 15, 1e-12);
        CHECK_NEAR(s.size_deg.mean, (10 * shares[q] * counted + 10 * large) / (counted + large), 1e-9);
        /* from the first beginning to the last: where the small fall is left out, the fall after it begins at either top */
        CHECK_BETWEEN(s.period.mean * (counted + large - 1), (3 * CYCLES - 3) * TOOTH * INTERVAL - 1e-9,
                      (3 * CYCLES - 2) * TOOTH * INTERVAL);
    }
}

static void missing_frames_are_left_out_and_too_few_have_no_slumps(void **unused)
{
    (void)unused;
    static double time[COUNT], angle[COUNT];
    for (int k = 0; k < COUNT; k++) {
        time[k] = INTERVAL * k;
        angle[k] = k % 7 == 3 ? NAN : saw_tooth(time[k], 0.3, 4, 10, 1.0, 0.2);
    }
    CHECK_NEAR(slumps_of(time, angle, COUNT).period.mean, 1.2, 0.01);
    const double none[] = { NAN, NAN, 3, NAN, 4 }, when[] = { 0, 1, 2, 3, 4 };
    const dem_slumps s = slumps_of(when, none, 5);
    assert_true(isnan(s.count) && isnan(s.period.mean) && isnan(s.size_deg.mean) && isnan(s.hysteresis_deg));
}

/* Teeth of three heights: between the highest start and the lowest stop, which are not of one slump. The last fall has no end. */
static void hysteresis_reaches_from_the_highest_start_to_the_lowest_stop(void **unused)
{
    (void)unused;
    enum { A_SIDE = 20, SIDES = 8 };
    static const double turn[SIDES + 1] = { 5, 10, 4, 14, 6, 12, 2, 20, 1 };
    double time[SIDES * A_SIDE + 1], angle[SIDES * A_SIDE + 1];
    for (int k = 0; k <= SIDES * A_SIDE; k++) {
        const int side = k / A_SIDE;
        const double share = (double)(k % A_SIDE) / A_SIDE;
        time[k] = INTERVAL * k;
        angle[k] = share > 0 ? turn[side] + (turn[side + 1] - turn[side]) * share : turn[side];
    }
    const dem_slumps s = slumps_of(time, angle, SIDES * A_SIDE + 1);
    CHECK_NEAR(s.count, 3, 0);
    CHECK_NEAR(s.start_deg.mean, 12, 1e-12); /* 10, 14, 12 */
    CHECK_NEAR(s.stop_deg.mean, 4, 1e-12);   /* 4, 6, 2 */
    CHECK_NEAR(s.hysteresis_deg, 14 - 2, 1e-12);
    /* the sides up to the top of the first tooth: a rise, and no fall that is seen to its end */
    assert_true(isnan(slumps_of(time, angle, A_SIDE + A_SIDE / 2).hysteresis_deg));
}

UNIT_TESTS(a_saw_tooth_is_found_tooth_by_tooth, noise_neither_hides_nor_makes_slumps, swings_of_few_frames_are_no_noise,
           a_climb_does_not_hide_the_falls_in_it, noise_alone_has_no_slumps, uneven_slumps_are_all_seen,
           hysteresis_reaches_from_the_highest_start_to_the_lowest_stop,
           falls_well_below_the_usual_are_left_out_and_nothing_else_is, missing_frames_are_left_out_and_too_few_have_no_slumps)
