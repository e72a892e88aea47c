/* Claims about the statistics of correlated series, against series whose answers are known beforehand. */
#include "claims.h"
#include "statistics.h"

/* Sum of twelve uniforms less six: mean 0, deviation 1, near enough to normal. */
static double dice_normal(dice *d)
{
    double sum = -6;
    for (int k = 0; k < 12; k++) sum += dice_uniform(d, 0, 1);
    return sum;
}

/* x_k = a x_(k-1) + noise, of deviation 1: the mean of n of them has the standard error sqrt((1+a)/(1-a)/n). */
static void fill_autoregressive(dice *d, double a, double *x, size_t count)
{
    double value = dice_normal(d);
    for (size_t k = 0; k < count; k++) x[k] = value = a * value + sqrt(1 - a * a) * dice_normal(d);
}

/* The estimate is the largest of a few block lengths of which the longest leaves 8 blocks (relative error
 * 1/sqrt(2*7) = 27 %): above the truth in the mean by some of that, and never far below it. */
static void block_averages_find_the_standard_error_of_a_correlated_series(void **unused)
{
    (void)unused;
    static const double a[] = { 0, 0.5, 0.8, 0.9 };
    enum { COUNT = 4096, SERIES = 200 };
    static double x[COUNT];
    dice d = { 17 };
    for (int c = 0; c < 4; c++) {
        const double truth = sqrt((1 + a[c]) / (1 - a[c]) / COUNT);
        double sum = 0, lowest = INFINITY;
        for (int s = 0; s < SERIES; s++) {
            fill_autoregressive(&d, a[c], x, COUNT);
            const double error = statistics_standard_error(x, COUNT);
            sum += error;
            lowest = fmin(lowest, error);
        }
        CHECK_BETWEEN(sum / SERIES / truth, 0.95, 1.35);
        CHECK_BETWEEN(lowest / truth, 0.7, 1.1);
    }
}

/* It is what it says: of many means, two thirds lie within one standard error (more, since it errs upwards). */
static void the_standard_error_covers_the_scatter_of_the_mean(void **unused)
{
    (void)unused;
    enum { COUNT = 1024, SERIES = 400 };
    static double x[COUNT];
    dice d = { 29 };
    int within = 0;
    for (int s = 0; s < SERIES; s++) {
        fill_autoregressive(&d, 0.8, x, COUNT);
        within += fabs(statistics_mean(x, COUNT)) < statistics_standard_error(x, COUNT);
    }
    CHECK_BETWEEN(within / (double)SERIES, 0.65, 0.85);
}

static void the_correlation_length_of_an_uncorrelated_series_is_near_one_and_grows_with_memory(void **unused)
{
    (void)unused;
    enum { COUNT = 8192 };
    static double x[COUNT];
    dice d = { 41 }; /* the square of an error that is 0.8 to 1.6 times the truth, as above */
    fill_autoregressive(&d, 0, x, COUNT);
    CHECK_BETWEEN(statistics_correlation_length(x, COUNT), 1, 2.5);
    fill_autoregressive(&d, 0.9, x, COUNT); /* (1+a)/(1-a) = 19 */
    CHECK_BETWEEN(statistics_correlation_length(x, COUNT), 12, 48);
}

static void too_few_values_have_no_standard_error(void **unused)
{
    (void)unused;
    const double x[] = { 1, 2, 3, 4, 5, 6, 7, 8 };
    assert_true(isnan(statistics_standard_error(x, 7)));
    /* 8 values, one block length: deviation 2.449 over sqrt(8) */
    CHECK_NEAR(statistics_standard_error(x, 8), sqrt(6.0 / 8), 1e-12);
}

/* A step of ten deviations after 300 of 1000 values: the cut lies within a batch of it, and a series without a
 * transient loses little. */
static void the_transient_ends_where_the_step_is(void **unused)
{
    (void)unused;
    enum { COUNT = 1000 };
    static double x[COUNT];
    dice d = { 53 };
    for (int trial = 0; trial < 20; trial++) {
        for (int k = 0; k < COUNT; k++) x[k] = dice_normal(&d) + (k < 300 ? 10 : 0);
        CHECK_BETWEEN(statistics_transient(x, COUNT), 300, 310);
    }
    double kept = 0;
    for (int trial = 0; trial < 20; trial++) {
        for (int k = 0; k < COUNT; k++) x[k] = dice_normal(&d);
        const size_t cut = statistics_transient(x, COUNT);
        CHECK_BETWEEN(cut, 0, COUNT / 2);
        kept += (double)(COUNT - cut) / COUNT / 20;
    }
    CHECK_BETWEEN(kept, 0.75, 1);
}

static void a_decaying_start_is_cut_to_below_the_noise(void **unused)
{
    (void)unused;
    enum { COUNT = 1000 };
    static double x[COUNT];
    dice d = { 67 };
    for (int trial = 0; trial < 20; trial++) {
        for (int k = 0; k < COUNT; k++) x[k] = dice_normal(&d) + 20 * exp(-k / 50.0);
        const size_t cut = statistics_transient(x, COUNT);
        CHECK_BETWEEN(20 * exp(-(double)cut / 50), 0, 2); /* what is left of the transient, in deviations */
        CHECK_NEAR(statistics_mean(x + cut, COUNT - cut), 0, 0.2);
    }
}

static void a_line_is_found_exactly_and_its_error_is_that_of_least_squares(void **unused)
{
    (void)unused;
    enum { COUNT = 200, TRIALS = 400 };
    double x[COUNT], y[COUNT], squares = 0, claimed = 0;
    for (int k = 0; k < COUNT; k++) {
        x[k] = 0.1 * k - 3;
        y[k] = 2.5 - 0.7 * x[k];
    }
    const line_fit exact = statistics_line(x, y, COUNT, 1);
    CHECK_NEAR(exact.slope, -0.7, 1e-13);
    CHECK_NEAR(exact.intercept, 2.5, 1e-12);
    CHECK_NEAR(exact.slope_error, 0, 1e-13);
    dice d = { 71 };
    for (int trial = 0; trial < TRIALS; trial++) {
        for (int k = 0; k < COUNT; k++) y[k] = 2.5 - 0.7 * x[k] + dice_normal(&d);
        const line_fit fit = statistics_line(x, y, COUNT, 1);
        squares += (fit.slope + 0.7) * (fit.slope + 0.7) / TRIALS;
        claimed += fit.slope_error / TRIALS;
    }
    CHECK_NEAR(claimed / sqrt(squares), 1, 0.15); /* 400 trials: 4 deviations of 1/sqrt(800) */
    const line_fit wider = statistics_line(x, y, COUNT, 9), narrow = statistics_line(x, y, COUNT, 1);
    CHECK_NEAR(wider.slope_error / narrow.slope_error, 3, 1e-12); /* correlated over 9 samples: sqrt(9) */
}

/* A quarter of the points thrown far off: least squares follows them, the median of slopes does not. */
static void theil_sen_ignores_outliers(void **unused)
{
    (void)unused;
    enum { COUNT = 40 };
    double x[COUNT], y[COUNT];
    dice d = { 83 };
    for (int k = 0; k < COUNT; k++) {
        x[k] = k;
        y[k] = 3 + 0.5 * k + 0.01 * dice_normal(&d) + (k >= 30 ? 100 : 0);
    }
    CHECK_NEAR(statistics_theil_sen(x, y, COUNT), 0.5, 0.02);
    CHECK_BETWEEN(statistics_line(x, y, COUNT, 1).slope, 2, 10);
    for (int k = 0; k < COUNT; k++) y[k] = 1 - 2 * x[k];
    CHECK_NEAR(statistics_theil_sen(x, y, COUNT), -2, 1e-14);
    assert_true(isnan(statistics_theil_sen(x, y, 1)));
}

static void missing_values_are_left_out_everywhere(void **unused)
{
    (void)unused;
    double x[] = { 1, NAN, 2, 3, NAN, 4 };
    const double t[] = { 0, 1, 2, 3, 4, 5 };
    CHECK_NEAR(statistics_mean(x, 6), 2.5, 1e-15);
    CHECK_NEAR(statistics_deviation(x, 6), sqrt(5.0 / 3), 1e-15);
    const line_fit fit = statistics_line(t, x, 6, 1);
    assert_int_equal(fit.points, 4);
    CHECK_NEAR(fit.slope, 8.0 / 13, 1e-13); /* 0, 2, 3, 5 about 2.5 and 1, 2, 3, 4 about 2.5: squares 13, products 8 */
    CHECK_NEAR(statistics_median(x, 6), 2.5, 1e-15);
    double none[] = { NAN, NAN };
    assert_true(isnan(statistics_mean(none, 2)) && isnan(statistics_median(none, 2)) && isnan(statistics_mean(none, 0)));
    assert_true(isnan(statistics_line(none, none, 2, 1).slope));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(block_averages_find_the_standard_error_of_a_correlated_series),
        cmocka_unit_test(the_standard_error_covers_the_scatter_of_the_mean),
        cmocka_unit_test(the_correlation_length_of_an_uncorrelated_series_is_near_one_and_grows_with_memory),
        cmocka_unit_test(too_few_values_have_no_standard_error),
        cmocka_unit_test(the_transient_ends_where_the_step_is),
        cmocka_unit_test(a_decaying_start_is_cut_to_below_the_noise),
        cmocka_unit_test(a_line_is_found_exactly_and_its_error_is_that_of_least_squares),
        cmocka_unit_test(theil_sen_ignores_outliers),
        cmocka_unit_test(missing_values_are_left_out_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
