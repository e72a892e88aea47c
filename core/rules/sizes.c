/* Distributions of size. */
#include "dem_sizes.h"

#include <math.h>

static bool is_positive(double x) { return isfinite(x) && x > 0; }

static bool are_sieves(const dem_sizes *s)
{
    bool good = s->sieve_count >= 2 && s->sieve_count <= DEM_MAXIMUM_SIEVES && s->below[0] >= 0 && is_positive(s->sieve[0]);
    for (size_t k = 1; good && k < s->sieve_count; k++) good = s->sieve[k] > s->sieve[k - 1] && s->below[k] >= s->below[k - 1];
    return good && s->below[s->sieve_count - 1] <= 1 && isfinite(s->sieve[s->sieve_count - 1]);
}

bool dem_sizes_are_good(const dem_sizes *s)
{
    const bool ends = is_positive(s->minimum) && is_positive(s->maximum) && s->minimum < s->maximum;
    bool good = false;
    switch (s->law) {
    case DEM_ONE_SIZE: break;
    case DEM_LOGNORMAL: good = is_positive(s->center) && isfinite(s->width) && s->width > 1; break;
    case DEM_NORMAL:
    case DEM_ROSIN_RAMMLER: good = is_positive(s->center) && is_positive(s->width); break;
    case DEM_UNIFORM: good = true; break;
    case DEM_SIEVES: good = are_sieves(s) && s->minimum >= s->sieve[0] && s->maximum <= s->sieve[s->sieve_count - 1];
    }
    return good && ends && dem_sizes_below(s, s->maximum) > dem_sizes_below(s, s->minimum);
}

/* Of the standard normal distribution. */
static double normal_below(double x) { return 0.5 * erfc(-x / sqrt(2.0)); }

static double sieves_below(const dem_sizes *s, double diameter)
{
    if (diameter <= s->sieve[0]) return s->below[0];
    for (size_t k = 1; k < s->sieve_count; k++) {
        if (diameter > s->sieve[k]) continue;
        const double share = (diameter - s->sieve[k - 1]) / (s->sieve[k] - s->sieve[k - 1]);
        return s->below[k - 1] + share * (s->below[k] - s->below[k - 1]);
    }
    return s->below[s->sieve_count - 1];
}

double dem_sizes_below(const dem_sizes *s, double diameter)
{
    switch (s->law) {
    case DEM_LOGNORMAL: return diameter > 0 ? normal_below(log(diameter / s->center) / log(s->width)) : 0;
    case DEM_NORMAL: return normal_below((diameter - s->center) / s->width);
    case DEM_ROSIN_RAMMLER: return diameter > 0 ? -expm1(-pow(diameter / s->center, s->width)) : 0;
    case DEM_UNIFORM: return fmin(fmax((diameter - s->minimum) / (s->maximum - s->minimum), 0), 1);
    case DEM_SIEVES: return sieves_below(s, diameter);
    case DEM_ONE_SIZE: break;
    }
    return diameter > s->center;
}

/* A range that has all but nothing outside it. */
static dem_range widest(const dem_sizes *s)
{
    enum { DEVIATIONS = 9 };
    switch (s->law) {
    case DEM_LOGNORMAL: return (dem_range){ s->center * pow(s->width, -DEVIATIONS), s->center * pow(s->width, DEVIATIONS) };
    case DEM_NORMAL: return (dem_range){ s->center - DEVIATIONS * s->width, s->center + DEVIATIONS * s->width };
    case DEM_ROSIN_RAMMLER: return (dem_range){ 0, s->center * pow(40, 1 / s->width) };
    case DEM_SIEVES: return (dem_range){ s->sieve[0], s->sieve[s->sieve_count - 1] };
    default: return (dem_range){ s->minimum, s->maximum };
    }
}

double dem_sizes_at(const dem_sizes *s, double share)
{
    enum { HALVINGS = 200 };
    dem_range range = widest(s);
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (range.low + range.high);
        *(dem_sizes_below(s, middle) < share ? &range.low : &range.high) = middle;
    }
    return range.high;
}

/* Mean of x^power over a..b. */
static double mean_power(double a, double b, int power)
{
    return power == -1 ? log(b / a) / (b - a) : (pow(b, power + 1) - pow(a, power + 1)) / ((power + 1) * (b - a));
}

void dem_size_table_set(dem_size_table *t, const dem_sizes *s)
{
    double area = 0, number = 0, volume = 0, below = dem_sizes_below(s, s->minimum);
    const double unit = s->maximum, span = log(s->maximum / s->minimum); /* sums in a unit in which they are near 1 */
    t->edge[0] = s->minimum;
    t->number[0] = t->volume[0] = 0;
    for (int k = 1; k <= DEM_SIZE_CELLS; k++) {
        t->edge[k] = k < DEM_SIZE_CELLS ? s->minimum * exp(span * k / DEM_SIZE_CELLS) : s->maximum;
        const double a = t->edge[k - 1] / unit, b = t->edge[k] / unit, below_b = dem_sizes_below(s, t->edge[k]);
        const double share = fmax(below_b - below, 0), cube = mean_power(a, b, 3);
        const double in_cell = s->by_volume ? share / cube : share;
        below = below_b;
        number += in_cell;
        area += in_cell * mean_power(a, b, 2);
        volume += in_cell * cube;
        t->number[k] = number;
        t->volume[k] = volume;
    }
    for (int k = 0; k <= DEM_SIZE_CELLS; k++) {
        t->number[k] /= number;
        t->volume[k] /= volume;
    }
    t->mean_diameter = unit * cbrt(volume / number);
    t->sauter_mean = unit * volume / area;
}

/* The last cell that begins below the share. */
static int cell_of(const double *shares, double share)
{
    int low = 0, high = DEM_SIZE_CELLS;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        *(shares[middle] < share ? &low : &high) = middle;
    }
    return low;
}

static double fourth(double x) { return x * x * x * x; }

/* m: within cell k, where the number is spread evenly. share: of what the cell has. */
static double place_in_cell(const dem_size_table *t, int k, bool by_volume, double share)
{
    const double a = t->edge[k], b = t->edge[k + 1];
    if (!by_volume) return a + share * (b - a);
    return sqrt(sqrt(fourth(a) + share * (fourth(b) - fourth(a))));
}

double dem_size_table_at(const dem_size_table *t, bool by_volume, double share)
{
    const double *shares = by_volume ? t->volume : t->number;
    const int k = cell_of(shares, share);
    const double in_cell = shares[k + 1] - shares[k];
    return place_in_cell(t, k, by_volume, in_cell > 0 ? fmin(fmax((share - shares[k]) / in_cell, 0), 1) : 1);
}

/* Share of the volume that the smallest `share` of all particles has. *diameter: the largest of these. */
static double volume_below(const dem_size_table *t, double share, double *diameter)
{
    const int k = cell_of(t->number, share);
    const double a = fourth(t->edge[k]), b = fourth(t->edge[k + 1]);
    *diameter = dem_size_table_at(t, false, share);
    return t->volume[k] + (fourth(*diameter) - a) / (b - a) * (t->volume[k + 1] - t->volume[k]);
}

void dem_size_table_draw(const dem_size_table *t, size_t count, double *diameter)
{
    double from = t->edge[0], volume = 0;
    for (size_t p = 0; p < count; p++) {
        double to = t->edge[DEM_SIZE_CELLS], below = 1;
        if (p + 1 < count) below = volume_below(t, (double)(p + 1) / (double)count, &to);
        const double mean = t->mean_diameter * cbrt(fmax(below - volume, 0) * (double)count);
        diameter[p] = fmin(fmax(mean, from), to);
        from = to;
        volume = below;
    }
}

void dem_sizes_complete(dem_species *species)
{
    if (species->sizes.law == DEM_ONE_SIZE) return;
    dem_size_table table;
    dem_size_table_set(&table, &species->sizes);
    species->diameter = table.mean_diameter;
}
