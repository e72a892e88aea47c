/* Claims about the statistics of correlated series, against series whose answers are known beforehand. */
#include "core_claims.h"
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

/* Root mean square of what is claimed, over the standard deviation of the means themselves, whose closed form is
 * sum over k of (n - |k|) a^|k| / n^2. covered: share of the means within one claimed error of the truth, 0. */
static double claimed_over_true(dice *d, double a, size_t count, double *covered)
{
    enum { SERIES = 1000 };
    static double x[4096];
    double squares = 0, truth = (double)count, power = 1;
    for (size_t k = 1; k < count; k++) truth += 2 * (double)(count - k) * (power *= a);
    *covered = 0;
    for (int s = 0; s < SERIES; s++) {
        fill_autoregressive(d, a, x, count);
        const double error = statistics_standard_error(x, count);
        squares += error * error / SERIES;
        *covered += (fabs(statistics_mean(x, count)) < error) / (double)SERIES;
    }
    return sqrt(squares / truth) * (double)count;
}

/* The correlation length is (1+a)/(1-a): 1, 3, 9, 19. Ten of them or more in each series. 1000 series of at least ten
 * independent values: a root mean square known within 1/sqrt(2*10*1000) = 0.7 %, and a share within 1.5 %; what is left
 * is the method's own bias. A normal variable lies within one deviation in 68 of 100 cases; less where the deviation is
 * estimated from ten values (Student: 66). */
static void the_standard_error_of_a_correlated_series_is_the_scatter_of_its_mean(void **unused)
{
    (void)unused;
    static const struct {
        double a;
        size_t count;
    } series[] = { { 0, 100 }, { 0.5, 40 }, { 0.5, 400 }, { 0.8, 100 }, { 0.8, 1000 }, { 0.9, 200 }, { 0.9, 4000 } };
    dice d = { 17 };
    for (size_t c = 0; c < sizeof series / sizeof *series; c++) {
        double covered;
        CHECK_BETWEEN(claimed_over_true(&d, series[c].a, series[c].count, &covered), 0.94, 1.06);
        CHECK_BETWEEN(covered, 0.58, 0.73);
    }
}

/* Five correlation lengths: covariances about the mean of so short a series sum to some 0.6 of theirs, of which a first-order
 * correction puts back too little (0.88). */
static void a_short_series_is_corrected_for_its_own_mean(void **unused)
{
    (void)unused;
    dice d = { 19 };
    double covered;
    CHECK_BETWEEN(claimed_over_true(&d, 0.5, 15, &covered), 0.92, 1.0);
}

/* x_k = x_(k-12)/2 + noise of deviation 1, nothing else: the mean of n has the error 2/sqrt(n), three times the variance of
 * independent values. Two echoes are summed up to lag 24, 2.5 of the 3: 0.91 of the error. A window that ends where the
 * correlation first vanishes sees none, 0.58. 2000 independent means are known to 1.6 %. */
static void an_error_that_remembers_counts_the_echoes_that_a_window_misses(void **unused)
{
    (void)unused;
    enum { ECHO = 12, COUNT = 400, SERIES = 2000 };
    static double x[100 + COUNT];
    dice d = { 23 };
    double with = 0, without = 0, means = 0;
    for (int s = 0; s < SERIES; s++) {
        for (size_t k = 0; k < 100 + COUNT; k++) x[k] = (k < ECHO ? 0 : 0.5 * x[k - ECHO]) + dice_normal(&d);
        const double a = statistics_standard_error_of_memory(x + 100, COUNT, 24), b = statistics_standard_error(x + 100, COUNT);
        const double mean = statistics_mean(x + 100, COUNT);
        with += a * a / SERIES;
        without += b * b / SERIES;
        means += mean * mean / SERIES;
        assert_true(a >= b);
    }
    CHECK_NEAR(sqrt(means) / (2 / sqrt(COUNT)), 1, 0.05); /* the closed form */
    CHECK_BETWEEN(sqrt(with / means), 0.86, 1.0);
    CHECK_BETWEEN(sqrt(without / means), 0.5, 0.72);
}

/* Five correlation lengths hold too little for any method; how much too little is said in statistics.h. */
static void a_series_of_five_correlation_lengths_claims_too_small_an_error(void **unused)
{
    (void)unused;
    dice d = { 23 };
    double covered;
    CHECK_BETWEEN(claimed_over_true(&d, 0.9, 100, &covered), 0.78, 0.90);
}

/* Averaging neighbors leaves the mean alone: a long series has the error that its short form has. */
static void a_series_longer_than_is_summed_over_has_the_same_error(void **unused)
{
    (void)unused;
    enum { COUNT = 40000 };
    static double x[COUNT];
    dice d = { 31 };
    fill_autoregressive(&d, 0.9, x, COUNT);
    /* one series of 2100 correlation lengths: its error is known within 1/sqrt(2*2100), 2 %, and three of them */
    CHECK_NEAR(statistics_standard_error(x, COUNT) / sqrt(19.0 / COUNT), 1, 0.06);
}

static void the_correlation_length_of_an_uncorrelated_series_is_near_one_and_grows_with_memory(void **unused)
{
    (void)unused;
    enum { COUNT = 8192 };
    static double x[COUNT];
    dice d = { 41 };
    fill_autoregressive(&d, 0, x, COUNT);
    CHECK_BETWEEN(statistics_correlation_length(x, COUNT, 0), 1, 1.12); /* three times 2/sqrt(8192), the noise of two lags */
    fill_autoregressive(&d, 0.9, x, COUNT); /* (1+a)/(1-a) = 19; noise of some 60 lags: sqrt(2*61/8192), and three of it */
    CHECK_BETWEEN(statistics_correlation_length(x, COUNT, 0), 12, 26);
}

static void too_few_values_have_no_standard_error(void **unused)
{
    (void)unused;
    const double x[] = { 1, -1, 1, -1, 1, -1, 1, -1, NAN };
    assert_true(isnan(statistics_standard_error(x, 7)));
    /* A series that swings back is claimed no better than independent values: variance 8/7, over 8. */
    CHECK_NEAR(statistics_standard_error(x, 8), sqrt(1.0 / 7), 1e-12);
    CHECK_NEAR(statistics_standard_error(x, 9), sqrt(1.0 / 7), 1e-12);
    const double constant[8] = { 3, 3, 3, 3, 3, 3, 3, 3 };
    CHECK_NEAR(statistics_standard_error(constant, 8), 0, 0);
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

UNIT_TESTS(the_standard_error_of_a_correlated_series_is_the_scatter_of_its_mean, a_short_series_is_corrected_for_its_own_mean,
           a_series_of_five_correlation_lengths_claims_too_small_an_error, a_series_longer_than_is_summed_over_has_the_same_error,
           the_correlation_length_of_an_uncorrelated_series_is_near_one_and_grows_with_memory,
           an_error_that_remembers_counts_the_echoes_that_a_window_misses, too_few_values_have_no_standard_error,
           the_transient_ends_where_the_step_is, a_decaying_start_is_cut_to_below_the_noise,
           a_line_is_found_exactly_and_its_error_is_that_of_least_squares, theil_sen_ignores_outliers,
           missing_values_are_left_out_everywhere)
