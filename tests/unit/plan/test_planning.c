/* Even points, the simplex, chi square, and draws of a posterior against sums over a fine grid. */
#include "agreement.h"
#include "claims.h"
#include "even_points.h"
#include "linear_algebra.h"
#include "posterior.h"
#include "simplex.h"

static void even_points_fill_every_interval_once(void **state)
{
    (void)state;
    static const struct {
        unsigned dimension;
        size_t count;
    } cases[] = { { 0, 64 }, { 1, 81 }, { 2, 125 }, { 3, 49 } }; /* powers of 2, 3, 5, 7 */
    for (uint64_t seed = 0; seed < 3; seed++)
        for (size_t c = 0; c < 4; c++) {
            bool seen[125] = { false };
            for (size_t i = 0; i < cases[c].count; i++) {
                const double x = even_point(seed, i, cases[c].dimension);
                CHECK_BETWEEN(x, 0.0, 1.0 - 1e-16);
                bool *here = &seen[(size_t)(x * (double)cases[c].count + 1e-9)];
                assert_false(*here);
                *here = true;
            }
        }
    assert_true(even_point(1, 0, 0) != even_point(2, 0, 0));
}

static void random_numbers_have_their_moments(void **state)
{
    (void)state;
    random_source source = { 3 };
    double sum = 0, squares = 0, fourth = 0;
    for (int i = 0; i < 100000; i++) {
        const double x = random_normal(&source);
        sum += x / 1e5;
        squares += x * x / 1e5;
        fourth += x * x * x * x / 1e5;
    }
    CHECK_NEAR(sum, 0, 4 / sqrt(1e5));
    CHECK_NEAR(squares, 1, 4 * sqrt(2 / 1e5));
    CHECK_NEAR(fourth, 3, 4 * sqrt(96 / 1e5));
}

static double rosenbrock(void *context, const double *x)
{
    (void)context;
    return 100 * pow(x[1] - x[0] * x[0], 2) + pow(1 - x[0], 2);
}

static void the_simplex_finds_the_end_of_rosenbrocks_valley(void **state)
{
    (void)state;
    double x[2] = { -1.2, 1 };
    CHECK_BETWEEN(simplex_minimize(rosenbrock, NULL, 2, x, 0.5, 1e-12, 2000), 0, 1e-8);
    CHECK_NEAR(x[0], 1, 1e-3);
    CHECK_NEAR(x[1], 1, 1e-3);
}

/* Tables of the distribution: what 5, 1 and 0.1 of 100 exceed. */
static void chi_square_is_that_of_tables(void **state)
{
    (void)state;
    static const double table[][3] = { { 3.841459, 1, 0.05 },   { 6.634897, 1, 0.01 },  { 5.991465, 2, 0.05 },
                                       { 13.815511, 2, 0.001 }, { 7.814728, 3, 0.05 },  { 11.070498, 5, 0.05 },
                                       { 18.307038, 10, 0.05 }, { 30.143527, 19, 0.05 } };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        CHECK_NEAR(chi_square_beyond(table[i][0], (int)table[i][1]), table[i][2], 2e-8 + 1e-5 * table[i][2]);
    CHECK_NEAR(chi_square_beyond(0, 1), 1, 1e-12);
    CHECK_NEAR(chi_square_beyond(0, 4), 1, 1e-12);
}

static void eigenvectors_are_those_of_a_matrix_made_of_them(void **state)
{
    (void)state;
    const double c = cos(0.6), s = sin(0.6);
    double a[4] = { 2 * c * c + 5 * s * s, (2 - 5) * c * s, (2 - 5) * c * s, 2 * s * s + 5 * c * c }, values[2];
    assert_true(symmetric_eigen(2, a, values));
    CHECK_NEAR(values[0], 2, 1e-12);
    CHECK_NEAR(values[1], 5, 1e-12);
    CHECK_NEAR(a[0], c, 1e-12);
    CHECK_NEAR(a[1], s, 1e-12);
    CHECK_NEAR(a[2], -s, 1e-12); /* of each the largest component is positive */
    CHECK_NEAR(a[3], c, 1e-12);
}

/* An emulator of a wave, and what was measured: up to three places of it fit. */
static emulator wave(void)
{
    double x[30], y[30], error[30];
    for (size_t i = 0; i < 30; i++) {
        x[i] = ((double)i + 0.5) / 30;
        y[i] = sin(7 * x[i]) + 0.5 * x[i];
        error[i] = 0.01;
    }
    emulator e;
    assert_true(emulator_fit(&e, 1, 30, x, y, error));
    return e;
}

static void draws_lie_as_a_sum_over_a_grid_says(void **state)
{
    (void)state;
    enum { CELLS = 2000, DRAWS = 3000, BINS = 10 };
    emulator e = wave();
    const measured_value measured = { &e, 0.9, 0.15 };
    double share[BINS] = { 0 }, found[BINS] = { 0 }, sum = 0;
    for (size_t i = 0; i < CELLS; i++) {
        const double x = (i + 0.5) / CELLS;
        double mean, variance;
        assert_true(emulator_predict(&e, 1, &x, &mean, &variance));
        const double all = 0.15 * 0.15 + variance, likelihood = exp(-0.5 * pow(mean - 0.9, 2) / all) / sqrt(all);
        share[i * BINS / CELLS] += likelihood;
        sum += likelihood;
    }
    posterior p;
    assert_true(posterior_draw(&p, 1, &measured, 1, DRAWS, 5));
    for (size_t i = 0; i < DRAWS; i++) found[(size_t)(p.x[i] * BINS)] += 1.0 / DRAWS;
    for (size_t b = 0; b < BINS; b++) CHECK_NEAR(found[b], share[b] / sum, 0.04); /* four times sqrt(0.25 / 3000) */
    CHECK_NEAR(sin(7 * p.best[0]) + 0.5 * p.best[0], 0.9, 0.02);
    posterior_clear(&p);
    emulator_clear(&e);
}

/* A target far more exact than the start of the draws: tempering must find its way. */
static void a_narrow_posterior_in_four_dimensions_is_found(void **state)
{
    (void)state;
    enum { N = 60 };
    static double x[4 * N], y[4][N], error[N];
    static const double truth[4] = { 0.3, 0.8, 0.55, 0.12 };
    emulator e[4];
    measured_value measured[4];
    for (size_t i = 0; i < N; i++)
        for (size_t k = 0; k < 4; k++) x[4 * i + k] = even_point(2, i, (unsigned)k);
    for (size_t v = 0; v < 4; v++) {
        double value = 0;
        for (size_t k = 0; k < 4; k++) value += (k == v ? 3 : 1) * truth[k];
        for (size_t i = 0; i < N; i++) {
            y[v][i] = 0;
            for (size_t k = 0; k < 4; k++) y[v][i] += (k == v ? 3 : 1) * x[4 * i + k];
            error[i] = 0.001;
        }
        assert_true(emulator_fit(&e[v], 4, N, x, y[v], error));
        measured[v] = (measured_value){ &e[v], value, 0.01 };
    }
    posterior p;
    assert_true(posterior_draw(&p, 4, measured, 4, 1000, 5));
    /* (2 I + J)^-1 has 5/12 on its diagonal and -1/12 beside it: rows of length sqrt(28) / 12. */
    const double expected = 0.01 * sqrt(28) / 12;
    for (size_t k = 0; k < 4; k++) {
        double mean = 0, squares = 0;
        for (size_t i = 0; i < 1000; i++) mean += p.x[4 * i + k] / 1000;
        for (size_t i = 0; i < 1000; i++) squares += pow(p.x[4 * i + k] - mean, 2) / 1000;
        CHECK_NEAR(mean, truth[k], 0.25 * expected + 1e-3 / 3);
        CHECK_BETWEEN(sqrt(squares), 0.85 * expected, 1.25 * expected);
    }
    posterior_clear(&p);
    for (size_t v = 0; v < 4; v++) emulator_clear(&e[v]);
}

UNIT_TESTS(even_points_fill_every_interval_once, random_numbers_have_their_moments, the_simplex_finds_the_end_of_rosenbrocks_valley,
           chi_square_is_that_of_tables, eigenvectors_are_those_of_a_matrix_made_of_them, draws_lie_as_a_sum_over_a_grid_says,
           a_narrow_posterior_in_four_dimensions_is_found)
