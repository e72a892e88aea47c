#include "size_rules.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dem_sizes.h"
#include "process_type.h"
#include "spec_text.h"

#define LEAST_LEFT 0.01            /* of a distribution, once it is cut */
#define MOST_SUM_ERROR 1.000001e-4 /* of shares, which are often given in four digits */
#define HOPELESS 3.2e7             /* s: a year */

/* A member that a law may take; at: of a double in size_inputs, or of the count of a list's numbers. */
typedef struct size_member {
    const char *name;
    size_t at;
    bool is_list;
    unsigned laws; /* bits by dem_size_law: that need it */
} size_member;

#define LAW(law) (1U << DEM_##law)
static const size_member members[] = {
    { "median", offsetof(size_inputs, median), false, LAW(LOGNORMAL) },
    { "geometric_deviation", offsetof(size_inputs, geometric_deviation), false, LAW(LOGNORMAL) },
    { "mean", offsetof(size_inputs, mean), false, LAW(NORMAL) },
    { "deviation", offsetof(size_inputs, deviation), false, LAW(NORMAL) },
    { "size", offsetof(size_inputs, size), false, LAW(ROSIN_RAMMLER) },
    { "spread", offsetof(size_inputs, spread), false, LAW(ROSIN_RAMMLER) },
    { "sizes", offsetof(size_inputs, size_count), true, LAW(SIEVES) },
};
static const char *const taken[] = { "a diameter",          "median and geometric_deviation",
                                     "mean and deviation",  "size and spread",
                                     "minimum and maximum", "sizes, and cumulative or shares" };
static const char *const names[] = { "", "lognormal", "normal", "rosin-rammler", "uniform", "table" };

enum { POINTER_SIZE = 100 };

static void point_at(char pointer[POINTER_SIZE], size_t s, const char *name)
{
    snprintf(pointer, POINTER_SIZE, "/inputs/particles/%zu/size_distribution%s%s", s, *name ? "/" : "", name);
}

/* Adds that the member is missing, or that the law has no use for it. False: it did. */
static bool check_member(size_t s, dem_size_law law, const char *name, bool is_given, bool is_needed, problem_list *problems)
{
    char pointer[POINTER_SIZE];
    if (is_given == is_needed) return true;
    point_at(pointer, s, name);
    problem_list_add(problems, pointer, "is %s; %s takes %s", is_given ? "given" : "missing", names[law], taken[law]);
    return false;
}

/* is_refused: something of it was, so that what is missing can't be told. */
static bool check_members(const size_inputs *in, size_t s, dem_size_law law, bool is_refused, problem_list *problems)
{
    bool good = true;
    for (size_t k = 0; k < sizeof members / sizeof *members; k++) {
        const char *at = (const char *)in + members[k].at;
        const bool is_given = members[k].is_list ? *(const size_t *)at > 0 : !isnan(*(const double *)at);
        const bool is_needed = (members[k].laws & 1U << law) != 0;
        if (is_needed && !is_given && is_refused) good = false;
        else good = check_member(s, law, members[k].name, is_given, is_needed, problems) && good;
    }
    if (law == DEM_UNIFORM && !is_refused) {
        good = check_member(s, law, "minimum", !isnan(in->minimum), true, problems) && good;
        good = check_member(s, law, "maximum", !isnan(in->maximum), true, problems) && good;
    }
    if (law != DEM_SIEVES) {
        good = check_member(s, law, "cumulative", in->cumulative_count > 0, false, problems) && good;
        good = check_member(s, law, "shares", in->share_count > 0, false, problems) && good;
    }
    return good;
}

/* Whether anything at the pointer, or below it, is wrong already. */
static bool is_refused_at(const char *pointer, const problem_list *problems)
{
    size_t index;
    json_t *error;
    json_array_foreach(problems->errors, index, error)
    {
        const char *at = json_string_value(json_object_get(error, "pointer"));
        if (at && strncmp(at, pointer, strlen(pointer)) == 0) return true;
    }
    return false;
}

static bool check_ascending(const double *numbers, size_t count, bool may_stay, size_t s, const char *name, problem_list *problems)
{
    char path[POINTER_SIZE], pointer[POINTER_SIZE + 30];
    for (size_t k = 1; k < count; k++) {
        if (may_stay ? numbers[k] >= numbers[k - 1] : numbers[k] > numbers[k - 1]) continue;
        point_at(path, s, name);
        snprintf(pointer, sizeof pointer, "%s/%zu", path, k);
        problem_list_add(problems, pointer, "is %.12g, after %.12g; must %s", numbers[k], numbers[k - 1],
                         may_stay ? "not fall: it is the share of all that is smaller" : "be more: sizes ascend");
        return false;
    }
    return true;
}

/* The table's shares below each size. */
static bool take_sieves(const size_inputs *in, size_t s, dem_sizes *sizes, problem_list *problems)
{
    char pointer[POINTER_SIZE];
    const bool by_share = in->share_count > 0;
    const size_t given = by_share ? in->share_count : in->cumulative_count, needed = in->size_count - by_share;
    if ((in->share_count > 0) == (in->cumulative_count > 0)) {
        point_at(pointer, s, "");
        problem_list_add(problems, pointer, "has %s cumulative %s shares; give one of the two",
                         in->share_count ? "both" : "neither", in->share_count ? "and" : "nor");
        return false;
    }
    const char *name = by_share ? "shares" : "cumulative";
    if (given != needed) {
        point_at(pointer, s, name);
        problem_list_add(problems, pointer, "has %zu numbers; must have %zu: %s", given, needed,
                         by_share ? "one less than sizes, between which they are" : "as many as sizes");
        return false;
    }
    sizes->sieve_count = in->size_count;
    memcpy(sizes->sieve, in->sizes, in->size_count * sizeof *in->sizes);
    bool good = check_ascending(in->sizes, in->size_count, false, s, "sizes", problems);
    double sum = 0.0;
    for (size_t k = 0; k < in->size_count; k++) {
        sizes->below[k] = by_share ? sum : in->cumulative[k];
        if (by_share && k < in->share_count) sum += in->shares[k];
    }
    if (!by_share) return check_ascending(in->cumulative, in->size_count, true, s, "cumulative", problems) && good;
    if (fabs(sum - 1.0) > MOST_SUM_ERROR) {
        point_at(pointer, s, "shares");
        problem_list_add(problems, pointer, "sum to %.12g; must sum to 1", sum);
        return false;
    }
    for (size_t k = 0; k < in->size_count; k++) sizes->below[k] = fmin(sizes->below[k] / sum, 1.0);
    return good;
}

static bool take_law(const size_inputs *in, size_t s, dem_sizes *sizes, problem_list *problems)
{
    switch (sizes->law) {
    case DEM_LOGNORMAL: sizes->center = in->median, sizes->width = in->geometric_deviation; break;
    case DEM_NORMAL: sizes->center = in->mean, sizes->width = in->deviation; break;
    case DEM_ROSIN_RAMMLER: sizes->center = in->size, sizes->width = in->spread; break;
    case DEM_SIEVES: return take_sieves(in, s, sizes, problems);
    default: break;
    }
    return true;
}

/* Where it is cut: as given, or where little is left. */
static bool take_ends(size_inputs *in, size_t s, dem_sizes *sizes, problem_list *problems)
{
    char pointer[POINTER_SIZE];
    const size_t last = sizes->law == DEM_SIEVES ? sizes->sieve_count - 1 : 0;
    sizes->minimum = in->minimum, sizes->maximum = in->maximum;
    if (isnan(in->minimum)) sizes->minimum = last ? sizes->sieve[0] : dem_sizes_at(sizes, DEM_SIZES_LOW_END);
    if (isnan(in->maximum)) sizes->maximum = last ? sizes->sieve[last] : dem_sizes_at(sizes, DEM_SIZES_HIGH_END);
    const double low = last ? sizes->sieve[0] : 1e-5, high = last ? sizes->sieve[last] : 1.0; /* as minimum's and maximum's range */
    const bool is_low = sizes->minimum<low, is_high = sizes->maximum> high;
    if (is_low || is_high) {
        point_at(pointer, s, is_low ? "minimum" : "maximum");
        problem_list_add(problems, pointer, "is %.6g m%s; must be in [%g, %g] m", is_low ? sizes->minimum : sizes->maximum,
                         isnan(is_low ? in->minimum : in->maximum) ? ", as nothing else was given" : "", low, high);
        return false;
    }
    if (!(sizes->minimum < sizes->maximum)) {
        point_at(pointer, s, isnan(in->maximum) ? "minimum" : "maximum");
        problem_list_add(problems, pointer, "leaves sizes from %g m to %g m; the minimum must be below the maximum", sizes->minimum,
                         sizes->maximum);
        return false;
    }
    const double left = dem_sizes_below(sizes, sizes->maximum) - dem_sizes_below(sizes, sizes->minimum);
    if (!(left >= LEAST_LEFT)) {
        point_at(pointer, s, "");
        problem_list_add(problems, pointer, "has %.3g of it between %g m and %g m, where it is cut; must have at least %g", left,
                         sizes->minimum, sizes->maximum, LEAST_LEFT);
        return false;
    }
    in->minimum = sizes->minimum, in->maximum = sizes->maximum;
    return true;
}

void sizes_derive(species_inputs *species, size_t s, dem_species *derived, problem_list *problems)
{
    char pointer[POINTER_SIZE];
    size_inputs *in = &species->sizes;
    point_at(pointer, s, "");
    const bool is_refused = is_refused_at(pointer, problems);
    if (isnan(in->type)) {
        if (is_refused) derived->diameter = NAN;
        return;
    }
    dem_sizes sizes = { .law = (dem_size_law)(in->type + 1.0), .by_volume = in->by != SIZES_BY_NUMBER };
    bool good = check_members(in, s, sizes.law, is_refused, problems) && !is_refused;
    if (species->shape > 0.0) {
        problem_list_add(problems, pointer, "is given beside a shape; sizes are distributed of spheres alone");
        good = false;
    }
    if (*in->file && !is_refused) {
        problem_list_add(problems, pointer, "has a file, which is for `repose run` alone; give sizes, and cumulative or shares");
        good = false;
    }
    good = good && take_law(in, s, &sizes, problems) && take_ends(in, s, &sizes, problems);
    derived->diameter = NAN;
    if (!good) return;
    derived->sizes = sizes;
    dem_sizes_complete(derived);
}

double sizes_cut_below(const dem_sizes *sizes) { return sizes->law == DEM_UNIFORM ? 0.0 : dem_sizes_below(sizes, sizes->minimum); }

double sizes_cut_above(const dem_sizes *sizes)
{
    return sizes->law == DEM_UNIFORM ? 0.0 : 1.0 - dem_sizes_below(sizes, sizes->maximum);
}

void sizes_check_cost(const job_spec *spec, problem_list *problems)
{
    const dem_scene_definition *scene = &spec->scene;
    const job_estimate estimate = job_spec_estimate(spec, NULL);
    if (!dem_have_sizes(scene->species, scene->species_count) || !(estimate.wall_seconds > HOPELESS)) return;
    char pointer[POINTER_SIZE], words[TIME_IN_WORDS_SIZE];
    size_t s = 0;
    for (size_t k = 0; k < scene->species_count; k++)
        if (scene->species[k].sizes.law
            && (!scene->species[s].sizes.law || scene->species[k].sizes.minimum < scene->species[s].sizes.minimum))
            s = k;
    point_at(pointer, s, "");
    time_in_words(estimate.wall_seconds, words);
    problem_list_add(
        problems, pointer,
        "has sizes from %g m to %g m, of which the smallest make a time step of %.3g s and all %.3g particles: the run "
        "takes about %s; must take at most a year: cut it at a larger minimum",
        scene->species[s].sizes.minimum, scene->species[s].sizes.maximum, scene->time_step, estimate.particles, words);
}

void sizes_understand(const job_spec *spec, json_t *words)
{
    const dem_scene_definition *scene = &spec->scene;
    if (!dem_have_sizes(scene->species, scene->species_count)) return;
    json_t *list = json_array();
    dem_size_table *table = malloc(sizeof *table);
    for (size_t k = 0; table && k < scene->species_count; k++) {
        const dem_sizes *sizes = &scene->species[k].sizes;
        if (!sizes->law) continue;
        dem_size_table_set(table, sizes);
        const bool by_volume = sizes->by_volume;
        json_array_append_new(
            list, json_pack("{s:i, s:s, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "species", (int)k, "by",
                            by_volume ? "mass" : "number", "minimum", sizes->minimum, "d10",
                            dem_size_table_at(table, by_volume, 0.1), "d50", dem_size_table_at(table, by_volume, 0.5), "d90",
                            dem_size_table_at(table, by_volume, 0.9), "maximum", sizes->maximum, "sauter_mean", table->sauter_mean,
                            "cut_off_below", sizes_cut_below(sizes), "cut_off_above", sizes_cut_above(sizes)));
    }
    free(table);
    json_object_set_new(words, "sizes", list);
}
