#include "mean_of_runs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Of a normal distribution, within one standard deviation. */
#define WITHIN_ONE_SIGMA 0.682689492137086
#define PI 3.14159265358979323846

/* Welford's recurrence: no difference of large sums. */
void mean_of_runs_add(mean_of_runs *mean, double value, double run_error)
{
    mean->count++;
    const double off = value - mean->mean;
    mean->mean += off / (double)mean->count;
    mean->squares += off * (value - mean->mean);
    if (!isfinite(run_error)) return;
    mean->errors++;
    mean->squares_of_errors += run_error * run_error;
}

/* One and two degrees of freedom have closed forms. Beyond, the expansion in 1/degrees for a quantile of 1 sigma
 * (Abramowitz and Stegun 26.7.5), off by less than 1e-3. */
double student_factor(int64_t degrees)
{
    const double n = (double)degrees, a = WITHIN_ONE_SIGMA;
    if (degrees <= 1) return tan(0.5 * PI * a);
    if (degrees == 2) return a * sqrt(2.0 / (1.0 - a * a));
    return 1.0 + 1.0 / (2.0 * n) + 1.0 / (4.0 * n * n) + 1.0 / (16.0 * n * n * n);
}

static double error_of_scatter(const mean_of_runs *mean)
{
    const double n = (double)mean->count;
    return mean->count > 1 ? student_factor(mean->count - 1) * sqrt(mean->squares / (n - 1.0) / n) : NAN;
}

static double error_of_own(const mean_of_runs *mean)
{
    return mean->errors > 0 ? sqrt(mean->squares_of_errors / (double)mean->errors / (double)mean->count) : NAN;
}

static double error_of(const mean_of_runs *mean, const char **from)
{
    const double scatter = error_of_scatter(mean), own = error_of_own(mean);
    *from = isnan(scatter) && isnan(own) ? NULL : mean->count == 1 ? "run" : own > scatter ? "runs" : "repeats";
    return fmax(scatter, own); /* fmax passes over NaN */
}

/* What chi-square exceeds in one of twenty cases (Abramowitz and Stegun 26.4.17). */
static double chi_square_95(double degrees)
{
    static const double ABOVE_ONE_OF_TWENTY = 1.6448536269514722;
    const double width = 2.0 / (9.0 * degrees), cube_root = 1.0 - width + ABOVE_ONE_OF_TWENTY * sqrt(width);
    return degrees * cube_root * cube_root * cube_root;
}

double mean_of_beds_error(const mean_of_runs *mean)
{
    const double scatter = error_of_scatter(mean), own = error_of_own(mean);
    if (isnan(scatter) || mean->errors < mean->count) return fmax(scatter, own); /* which passes over NaN */
    const double own_square = mean->squares_of_errors / (double)mean->errors;
    return mean->squares > chi_square_95((double)mean->count - 1.0) * own_square ? fmax(scatter, own) : own;
}

static double two_digits(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.1e", value);
    return strtod(text, NULL);
}

/* As far as two digits of the error reach: 23.456 +- 0.123 is 23.46. */
static double rounded_to(double value, double error)
{
    enum { MOST_DECIMALS = 300 };
    char text[700];
    const int decimals = 1 - (int)floor(log10(error));
    if (decimals > MOST_DECIMALS) return value;
    if (decimals < 0) {
        const double unit = pow(10.0, -decimals);
        return unit * round(value / unit);
    }
    snprintf(text, sizeof text, "%.*f", decimals, value);
    return strtod(text, NULL) + 0.0; /* no -0 */
}

json_t *mean_of_runs_to_json(const mean_of_runs *mean)
{
    const char *from;
    const double error = two_digits(error_of(mean, &from));
    const double value = error > 0.0 && isfinite(error) ? rounded_to(mean->mean, error) : mean->mean;
    return json_pack("{s:f, s:o, s:s?, s:I}", "mean", value, "standard_error", isfinite(error) ? json_real(error) : json_null(),
                     "error_from", from, "count", (json_int_t)mean->count);
}
