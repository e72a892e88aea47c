/* Emulators against a system that is solved by elimination here, by formulas written anew. */
#include "claims.h"
#include "emulator.h"
#include "even_points.h"
#include "sensitivity.h"

enum { RUNS = 20, PARAMETERS = 2 };

typedef struct runs {
    double x[RUNS * PARAMETERS], y[RUNS], error[RUNS];
} runs;

static runs some_runs(void)
{
    runs r;
    dice d = { 11 };
    for (size_t i = 0; i < RUNS; i++) {
        const double a = r.x[2 * i] = dice_uniform(&d, 0, 1), b = r.x[2 * i + 1] = dice_uniform(&d, 0, 1);
        r.error[i] = dice_uniform(&d, 0.1, 0.3);
        r.y[i] = 30 + 8 * sin(3 * a) + 4 * a * b + dice_uniform(&d, -0.4, 0.4);
    }
    return r;
}

/* Matern 5/2 and the plane, in units of the values. */
static double kernel(const emulator *e, const double *a, const double *b)
{
    const double u = (a[0] - b[0]) / e->length[0], v = (a[1] - b[1]) / e->length[1], h2 = u * u + v * v, h = sqrt(h2);
    const double matern = (1 + sqrt(5.0) * h + 5.0 / 3.0 * h2) * exp(-sqrt(5.0) * h);
    const double plane = 1 + (1 - 2 * a[0]) * (1 - 2 * b[0]) + (1 - 2 * a[1]) * (1 - 2 * b[1]);
    return e->spread * e->spread * (e->variance * matern + 100 * plane);
}

/* m (n,n+1) with the right side as its last column; Gauss with pivots. The logarithm of the determinant. */
static double eliminate(size_t n, double m[RUNS][RUNS + 1], double *solution)
{
    double logarithm = 0;
    for (size_t c = 0; c < n; c++) {
        size_t pivot = c;
        for (size_t r = c + 1; r < n; r++)
            if (fabs(m[r][c]) > fabs(m[pivot][c])) pivot = r;
        for (size_t k = 0; k <= n; k++) {
            const double kept = m[c][k];
            m[c][k] = m[pivot][k];
            m[pivot][k] = kept;
        }
        logarithm += log(fabs(m[c][c]));
        for (size_t r = c + 1; r < n; r++) {
            const double share = m[r][c] / m[c][c];
            for (size_t k = c; k <= n; k++) m[r][k] -= share * m[c][k];
        }
    }
    for (size_t r = n; r-- > 0;) {
        solution[r] = m[r][n];
        for (size_t k = r + 1; k < n; k++) solution[r] -= m[r][k] * solution[k];
        solution[r] /= m[r][r];
    }
    return logarithm;
}

/* Solves with all runs but `left_out` for the right side; the jitter of 1e-8 is the emulator's. */
static double solve(const emulator *e, const runs *r, size_t left_out, const double *right, double *solution)
{
    double m[RUNS][RUNS + 1];
    size_t row = 0;
    for (size_t i = 0; i < RUNS; i++) {
        if (i == left_out) continue;
        size_t column = 0;
        for (size_t j = 0; j < RUNS; j++) {
            if (j == left_out) continue;
            m[row][column] = kernel(e, &r->x[2 * i], &r->x[2 * j]);
            if (i == j) m[row][column] += e->own * r->error[i] * r->error[i] + e->spread * e->spread * (e->scatter + 1e-8);
            column++;
        }
        m[row++][column] = right[i];
    }
    return eliminate(row, m, solution);
}

static void mean_and_variance(const emulator *e, const runs *r, size_t left_out, const double *x, double *mean, double *variance)
{
    double right[RUNS], known[RUNS], weight[RUNS];
    for (size_t i = 0; i < RUNS; i++) right[i] = r->y[i] - e->middle;
    solve(e, r, left_out, right, weight);
    for (size_t i = 0; i < RUNS; i++) right[i] = kernel(e, &r->x[2 * i], x);
    solve(e, r, left_out, right, known);
    *mean = e->middle;
    *variance = kernel(e, x, x);
    for (size_t i = 0, row = 0; i < RUNS; i++) {
        if (i == left_out) continue;
        *mean += right[i] * weight[row];
        *variance -= right[i] * known[row++];
    }
}

static emulator fitted(const runs *r)
{
    emulator e;
    assert_true(emulator_fit(&e, PARAMETERS, RUNS, r->x, r->y, r->error));
    return e;
}

static void predictions_are_those_of_the_equations(void **state)
{
    (void)state;
    const runs r = some_runs();
    emulator e = fitted(&r);
    dice d = { 5 };
    for (int k = 0; k < 20; k++) {
        const double x[2] = { dice_uniform(&d, 0, 1), dice_uniform(&d, 0, 1) };
        double mean, variance, expected_mean, expected_variance;
        assert_true(emulator_predict(&e, 1, x, &mean, &variance));
        mean_and_variance(&e, &r, RUNS, x, &expected_mean, &expected_variance);
        CHECK_NEAR(mean, expected_mean, 1e-6);
        CHECK_NEAR(variance, expected_variance, 1e-5);
        /* The function itself, within the errors: what was fitted is what was asked. */
        CHECK_NEAR(mean, 30 + 8 * sin(3 * x[0]) + 4 * x[0] * x[1], 4 * sqrt(variance) + 0.4);
    }
    emulator_clear(&e);
}

static void covariances_have_the_variances_on_their_diagonal(void **state)
{
    (void)state;
    const runs r = some_runs();
    emulator e = fitted(&r);
    const double x[6] = { 0.1, 0.2, 0.9, 0.4, 0.5, 0.95 };
    double mean[3], variance[3], covariance[9];
    assert_true(emulator_predict(&e, 3, x, mean, variance) && emulator_covariance(&e, 3, x, covariance));
    for (size_t i = 0; i < 3; i++) CHECK_NEAR(covariance[4 * i], variance[i], 1e-9);
    CHECK_NEAR(covariance[1], covariance[3], 0);
    assert_true(fabs(covariance[1]) < sqrt(variance[0] * variance[1]));
    emulator_clear(&e);
}

static void leaving_one_out_is_as_if_it_had_not_been(void **state)
{
    (void)state;
    const runs r = some_runs();
    emulator e = fitted(&r);
    double deviation[RUNS];
    assert_true(emulator_leave_one_out(&e, deviation));
    for (size_t i = 0; i < RUNS; i++) {
        double mean, variance;
        mean_and_variance(&e, &r, i, &r.x[2 * i], &mean, &variance);
        const double all = variance + e.own * r.error[i] * r.error[i] + emulator_scatter(&e) * emulator_scatter(&e);
        CHECK_NEAR(deviation[i], (r.y[i] - mean) / sqrt(all), 1e-4);
    }
    emulator_clear(&e);
}

/* Less the logarithm of likelihood and priors, those of the emulator's description: normal in the logarithms. */
static double misfit(const emulator *e, const runs *r)
{
    double right[RUNS], weight[RUNS];
    for (size_t i = 0; i < RUNS; i++) right[i] = r->y[i] - e->middle;
    double sum = 0.5 * solve(e, r, RUNS, right, weight);
    for (size_t i = 0; i < RUNS; i++) sum += 0.5 * right[i] * weight[i];
    for (size_t k = 0; k < 2; k++) sum += 0.5 * pow(log(e->length[k]) + 0.22, 2);
    sum += 0.5 * pow(log(e->own), 2);
    return sum + 0.5 * pow((log(e->variance) + 0.7) / 2, 2) + 0.5 * pow((log(e->scatter) + 5) / 3, 2);
}

static void no_other_lengths_or_variances_are_likelier(void **state)
{
    (void)state;
    const runs r = some_runs();
    emulator e = fitted(&r);
    const double least = misfit(&e, &r);
    double *const numbers[] = { &e.length[0], &e.length[1], &e.variance, &e.scatter, &e.own };
    for (size_t k = 0; k < 5; k++)
        for (int side = -1; side <= 1; side += 2) {
            const double kept = *numbers[k];
            *numbers[k] *= exp(0.3 * side);
            CHECK_BETWEEN(misfit(&e, &r), least - 0.01, INFINITY); /* the search ends within 1e-4 of values */
            *numbers[k] = kept;
        }
    emulator_clear(&e);
}

static void repeats_tell_the_scatter_from_bed_to_bed(void **state)
{
    (void)state;
    double x[60], y[60], error[60] = { 0 };
    dice d = { 21 };
    for (size_t i = 0; i < 60; i++) {
        x[i] = (double)(i / 2) / 30;
        double normal = 0;
        for (int k = 0; k < 12; k++) normal += dice_uniform(&d, -0.5, 0.5);
        y[i] = 5 * x[i] + 0.7 * normal;
    }
    emulator e;
    assert_true(emulator_fit(&e, 1, 60, x, y, error));
    CHECK_BETWEEN(emulator_scatter(&e), 0.7 * 0.75, 0.7 * 1.25); /* of 60 numbers, a tenth is one standard deviation */
    emulator_clear(&e);
}

/* The runs scatter by 0.2 and claim 0.5. */
static void errors_that_are_told_too_large_are_found_out(void **state)
{
    (void)state;
    double x[80], y[80], error[80];
    dice d = { 8 };
    for (size_t i = 0; i < 80; i++) {
        x[i] = (double)(i / 2) / 40;
        double normal = 0;
        for (int k = 0; k < 12; k++) normal += dice_uniform(&d, -0.5, 0.5);
        error[i] = dice_uniform(&d, 0.4, 0.6);
        y[i] = 5 * x[i] + 0.4 * error[i] * normal;
    }
    emulator e;
    assert_true(emulator_fit(&e, 1, 80, x, y, error));
    CHECK_BETWEEN(emulator_run_deviation(&e, 0.5), 0.2 * 0.75, 0.2 * 1.25);
    emulator_clear(&e);
}

static void too_few_points_make_no_emulator(void **state)
{
    (void)state;
    const double x[1] = { 0.5 }, y[1] = { 3 }, error[1] = { 0.1 };
    emulator e;
    assert_false(emulator_fit(&e, 1, 1, x, y, error));
    assert_int_equal(e.points, 0);
    const double same[3] = { 2, 2, 2 }, places[3] = { 0.1, 0.5, 0.9 }, none[3] = { 0 };
    double mean, variance;
    assert_true(emulator_fit(&e, 1, 3, places, same, none)); /* values that do not differ are values */
    assert_true(emulator_predict(&e, 1, x, &mean, &variance));
    CHECK_NEAR(mean, 2, 1e-6);
    emulator_clear(&e);
}

/* Ishigami & Homma (1990): sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1, each in [-pi, pi], whose indices are known. */
static void sensitivities_are_those_of_ishigamis_function(void **state)
{
    (void)state;
    enum { N = 260 };
    static double x[3 * N], y[N], error[N];
    for (size_t i = 0; i < N; i++) {
        double z[3];
        for (size_t k = 0; k < 3; k++) z[k] = M_PI * (2 * (x[3 * i + k] = even_point(4, i, (unsigned)k)) - 1);
        y[i] = sin(z[0]) + 7 * pow(sin(z[1]), 2) + 0.1 * pow(z[2], 4) * sin(z[0]);
    }
    emulator e;
    sensitivity s;
    assert_true(emulator_fit(&e, 3, N, x, y, error));
    assert_true(sensitivity_measure(&e, 9, &s));
    /* The emulator's own error is a twentieth of the variance. */
    CHECK_NEAR(s.first[0], 0.3139, 0.05);
    CHECK_NEAR(s.first[1], 0.4424, 0.05);
    CHECK_NEAR(s.first[2], 0.0, 0.05);
    CHECK_NEAR(s.total[0], 0.5576, 0.05);
    CHECK_NEAR(s.total[1], 0.4424, 0.05);
    CHECK_NEAR(s.total[2], 0.2437, 0.05);
    CHECK_NEAR(s.spread, 3.7208, 0.2);
    emulator_clear(&e);
}

UNIT_TESTS(predictions_are_those_of_the_equations, covariances_have_the_variances_on_their_diagonal,
           leaving_one_out_is_as_if_it_had_not_been, no_other_lengths_or_variances_are_likelier,
           repeats_tell_the_scatter_from_bed_to_bed, errors_that_are_told_too_large_are_found_out, too_few_points_make_no_emulator,
           sensitivities_are_those_of_ishigamis_function)
