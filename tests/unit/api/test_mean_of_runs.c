/* Claims about the mean of several runs and its error. */
#include "claims.h"
#include "mean_of_runs.h"

static json_t *mean_of(const double (*runs)[2], size_t count)
{
    mean_of_runs mean = { 0 };
    for (size_t i = 0; i < count; i++) mean_of_runs_add(&mean, runs[i][0], runs[i][1]);
    return mean_of_runs_to_json(&mean);
}

static double number(const json_t *mean, const char *name) { return json_number_value(json_object_get(mean, name)); }
static const char *from(const json_t *mean) { return json_string_value(json_object_get(mean, "error_from")); }

static void two_runs_that_agree_by_chance_keep_their_own_errors(void **unused)
{
    (void)unused;
    static const double runs[2][2] = { { 1.85, 1.57 }, { 2.00, 1.64 } };
    json_t *mean = mean_of(runs, 2);
    /* sqrt(1.57^2 + 1.64^2)/2 = 1.135, in two digits; 1.925 as far as these reach */
    CHECK_NEAR(number(mean, "standard_error"), 1.1, 1e-12);
    CHECK_NEAR(number(mean, "mean"), 1.9, 1e-12);
    assert_string_equal(from(mean), "runs");
    json_decref(mean);
}

static void scatter_beyond_the_own_errors_counts(void **unused)
{
    (void)unused;
    static const double runs[3][2] = { { 20, 0.1 }, { 22, 0.1 }, { 24, NAN } };
    json_t *mean = mean_of(runs, 3);
    /* s = 2 by hand; 1.32 of table G.2 for two degrees of freedom: 1.32 * 2/sqrt(3) = 1.524 */
    CHECK_NEAR(number(mean, "standard_error"), 1.5, 1e-12);
    CHECK_NEAR(number(mean, "mean"), 22.0, 1e-12);
    assert_string_equal(from(mean), "repeats");
    json_decref(mean);
}

static void one_run_has_its_own_error_or_none(void **unused)
{
    (void)unused;
    static const double with[1][2] = { { 23.456, 0.31 } }, without[1][2] = { { 0.592345678, NAN } };
    json_t *mean = mean_of(with, 1);
    CHECK_NEAR(number(mean, "mean"), 23.46, 1e-12);
    CHECK_NEAR(number(mean, "standard_error"), 0.31, 1e-12);
    assert_string_equal(from(mean), "run");
    json_decref(mean);
    mean = mean_of(without, 1);
    CHECK_NEAR(number(mean, "mean"), 0.592345678, 0);
    assert_true(json_is_null(json_object_get(mean, "standard_error")) && json_is_null(json_object_get(mean, "error_from")));
    json_decref(mean);
}

/* JCGM 100:2008 (GUM), table G.2, p = 68.27 %: two decimals. */
static void few_runs_are_widened_as_students_distribution_asks(void **unused)
{
    (void)unused;
    static const struct {
        int64_t degrees;
        double factor;
    } table[] = { { 1, 1.84 }, { 2, 1.32 }, { 3, 1.20 },  { 4, 1.14 },  { 5, 1.11 },
                  { 6, 1.09 }, { 8, 1.07 }, { 10, 1.05 }, { 20, 1.03 }, { 100, 1.005 } };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        CHECK_NEAR(student_factor(table[i].degrees), table[i].factor, 0.005);
}

/* Sets of n normal numbers, whose mean is 0: within one standard error of it as often as 1 sigma says. */
static void means_lie_within_their_error_as_often_as_claimed(void **unused)
{
    (void)unused;
    enum { SETS = 20000 };
    dice d = { 17 };
    for (int n = 2; n <= 5; n++) {
        int within = 0;
        for (int set = 0; set < SETS; set++) {
            mean_of_runs mean = { 0 };
            for (int i = 0; i < n; i++) {
                const double u = dice_uniform(&d, 1e-12, 1), phi = dice_uniform(&d, 0, 2 * M_PI);
                mean_of_runs_add(&mean, sqrt(-2 * log(u)) * cos(phi), NAN);
            }
            within += fabs(mean.mean) <= student_factor(n - 1) * sqrt(mean.squares / (n - 1) / n);
        }
        /* 4 deviations of a count of SETS with p = 0.6827: 263 */
        CHECK_BETWEEN(within, 0.6827 * SETS - 264, 0.6827 * SETS + 264);
    }
}

static double error_of_beds(const double (*beds)[2], size_t count)
{
    mean_of_runs mean = { 0 };
    for (size_t i = 0; i < count; i++) mean_of_runs_add(&mean, beds[i][0], beds[i][1]);
    return mean_of_beds_error(&mean);
}

/* Errors of 0.3 and 0.4: sqrt(0.09 + 0.16)/2 = 0.25, while the beds are less than 1.96 deviations apart, 0.98 degrees. */
static void beds_have_their_own_errors_unless_they_contradict_them(void **unused)
{
    (void)unused;
    static const double alike[2][2] = { { 20, 0.3 }, { 20.9, 0.4 } }, apart[2][2] = { { 20, 0.3 }, { 22, 0.4 } };
    static const double none[3][2] = { { 20, NAN }, { 22, NAN }, { 24, NAN } },
                        some[3][2] = { { 20, 0.1 }, { 22, 0.1 }, { 24, NAN } };
    CHECK_NEAR(error_of_beds(alike, 2), 0.25, 1e-12);
    CHECK_NEAR(error_of_beds(apart, 2), 1.84, 0.005); /* table G.2, times half of the difference */
    CHECK_NEAR(error_of_beds(none, 3), 1.32 * 2 / sqrt(3), 0.005);
    CHECK_NEAR(error_of_beds(some, 3), 1.32 * 2 / sqrt(3), 0.005);
    CHECK_NEAR(error_of_beds(alike, 1), 0.3, 1e-12);
    assert_true(isnan(error_of_beds(none, 1)));
}

/* Beds that scatter as their errors say keep these, but for one set in twenty. Beds whose errors are a third of their
 * scatter do not, where they are enough to show it. */
static void claims_about_beds_are_as_large_as_their_scatter(void **unused)
{
    (void)unused;
    enum { SETS = 20000 };
    dice d = { 29 };
    for (int n = 2; n <= 8; n += 2)
        for (int honest = 0; honest < 2; honest++) {
            int own = 0;
            for (int set = 0; set < SETS; set++) {
                mean_of_runs mean = { 0 };
                for (int i = 0; i < n; i++) {
                    const double u = dice_uniform(&d, 1e-12, 1), phi = dice_uniform(&d, 0, 2 * M_PI);
                    mean_of_runs_add(&mean, sqrt(-2 * log(u)) * cos(phi), honest ? 1.0 : 1.0 / 3.0);
                }
                own += fabs(mean_of_beds_error(&mean) * sqrt(n) - (honest ? 1.0 : 1.0 / 3.0)) < 1e-12;
            }
            /* 0.95, known to 0.006 at four deviations; the quantile by Wilson and Hilferty is off by less than 0.004 */
            if (honest) CHECK_BETWEEN(own, 0.94 * SETS, 0.96 * SETS);
            else if (n >= 4) CHECK_BETWEEN(own, 0, 0.2 * SETS); /* chi-square of 3 below 7.81/9 in 17 of 100 */
        }
}

static void digits_follow_the_error(void **unused)
{
    (void)unused;
    static const struct {
        double value, error, mean, digits;
    } table[] = { { 1234567, 4321, 1234600, 4300 },
                  { 0.000123456, 0.00000197, 0.0001235, 0.0000020 },
                  { 0.5, 0.0996, 0.5, 0.10 },
                  { -0.0001, 0.9, 0.0, 0.9 },
                  { 23.5, 0.0, 23.5, 0.0 } };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        const double run[1][2] = { { table[i].value, table[i].error } };
        json_t *mean = mean_of(run, 1);
        CHECK_NEAR(number(mean, "mean"), table[i].mean, 1e-12 * fabs(table[i].mean));
        CHECK_NEAR(number(mean, "standard_error"), table[i].digits, 1e-12 * table[i].digits);
        json_decref(mean);
    }
}

UNIT_TESTS(two_runs_that_agree_by_chance_keep_their_own_errors, scatter_beyond_the_own_errors_counts,
           one_run_has_its_own_error_or_none, few_runs_are_widened_as_students_distribution_asks,
           means_lie_within_their_error_as_often_as_claimed, beds_have_their_own_errors_unless_they_contradict_them,
           claims_about_beds_are_as_large_as_their_scatter, digits_follow_the_error)
