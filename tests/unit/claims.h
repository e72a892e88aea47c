/* What unit tests start from: cmocka, checks that say what they saw, and the main program. */
#ifndef CLAIMS_H
#define CLAIMS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka.h needs the four above. */
#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK_BETWEEN(value, low, high) check_between(#value, value, low, high, __FILE__, __LINE__)
#define CHECK_NEAR(value, expected, tolerance) check_near(#value, value, expected, tolerance, __FILE__, __LINE__)

/* The main program of the tests that are named. */
#define UNIT_TESTS(...)                                                                                                            \
    int main(void) { return RUN_UNIT_TESTS(NULL, NULL, __VA_ARGS__); }
/* How many of them fail, with what is done before the first of them and after the last, or NULL. */
#define RUN_UNIT_TESTS(before, after, ...)                                                                                         \
    run_unit_tests((const CMUnitTestFunction[]){ __VA_ARGS__ }, (char[]){ #__VA_ARGS__ }, before, after)

#define MOST_UNIT_TESTS 100

/* names: of the tests, in their order, with commas between them. */
static inline int run_unit_tests(const CMUnitTestFunction tests[], char *names, CMFixtureFunction before, CMFixtureFunction after)
{
    struct CMUnitTest named[MOST_UNIT_TESTS] = { { NULL } };
    size_t count = 0;
    for (char *name = strtok(names, ", "); name; name = strtok(NULL, ", "), count++) {
        assert_true(count < MOST_UNIT_TESTS);
        named[count] = (struct CMUnitTest){ .name = name, .test_func = tests[count] };
    }
    return _cmocka_run_group_tests("tests", named, count, before, after);
}

/* Written so that a NaN fails. */
static inline void check_between(const char *what, double value, double low, double high, const char *file, int line)
{
    if (value >= low && value <= high) return;
    print_error("%s is %.17g; claimed to lie in [%.10g, %.10g]\n", what, value, low, high);
    _fail(file, line);
}

static inline void check_near(const char *what, double value, double expected, double tolerance, const char *file, int line)
{
    if (fabs(value - expected) <= tolerance) return;
    print_error("%s is %.17g; claimed %.17g within %.3g, off by %.3g\n", what, value, expected, tolerance, value - expected);
    _fail(file, line);
}

/* A test's own random numbers (a linear congruence), so that nothing under test makes its own questions. */
typedef struct dice {
    uint64_t state;
} dice;

static inline double dice_uniform(dice *d, double low, double high)
{
    d->state = d->state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * ((double)(d->state >> 11) * 0x1p-53);
}

/* A direction, uniform over the sphere. */
static inline void dice_direction(dice *d, double n[3])
{
    const double z = dice_uniform(d, -1, 1), phi = dice_uniform(d, -M_PI, M_PI), rho = sqrt(1 - z * z);
    n[0] = rho * cos(phi);
    n[1] = rho * sin(phi);
    n[2] = z;
}

#endif
