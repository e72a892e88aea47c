/* The test that is proposed where none is. Friction and rolling friction can often be traded for each other in slopes, of heaps and
 * drums alike; a flow through an orifice is held back by the first much more than by the second. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dem_rules.h"
#include "plan_request.h"
#include "process_type.h"

#define SHARE_OF_RATE 0.03 /* to which a flow is easily measured */
/* Of a flat vessel over a slot, in diameters of the largest particles. */
#define WIDTH 15.0
#define DEPTH 6.0
#define SLOT 4.5

enum { GRAINS = 1600 };

static bool seeks(const plan_request *request, const char *pointer)
{
    for (size_t p = 0; p < request->parameters; p++)
        if (strcmp(request->parameter[p].pointer, pointer) == 0) return true;
    return false;
}

static bool has_process(const plan_request *request, const char *name)
{
    for (size_t t = 0; t < request->tests; t++)
        if (strcmp(json_string_value(json_object_get(request->test[t].request, "process")), name) == 0) return true;
    return false;
}

/* Of the largest particles of the first test: m, kg/m3, and its gravity. False: it has no bed of them. */
static bool find_grain(const plan_request *request, double *diameter, double *density, double *gravity)
{
    problem_list problems;
    job_spec spec;
    *diameter = *density = *gravity = 0.0;
    if (!problem_list_init(&problems)) return false;
    if (plan_middle_spec(request, 0, &spec, &problems)) {
        for (size_t s = 0; strcmp(spec.process, "granule") != 0 && s < spec.scene.species_count; s++) {
            const dem_species *species = &spec.scene.species[s];
            if (!(dem_species_diameter(species) > *diameter)) continue;
            *diameter = dem_species_diameter(species);
            *density = species->density;
        }
        *gravity = spec.scene.gravity;
        job_spec_clear(&spec);
    }
    problem_list_clear(&problems);
    return *diameter > 0.0;
}

static double rounded(double value, int digits)
{
    char text[40];
    snprintf(text, sizeof text, "%.*g", digits, value);
    return strtod(text, NULL);
}

/* Its rate by the law of Beverloo, Leniger & van de Velde (1961) for a slot, to know what error would be small. */
static json_t *flow_of(double diameter, double density, double gravity)
{
    const double slot = SLOT * diameter, depth = DEPTH * diameter;
    const double rate = 1.03 * 0.6 * density * sqrt(gravity) * depth * pow(slot - 1.4 * diameter, 1.5);
    return json_pack("{s:s, s:s, s:{s:{s:f, s:f}, s:{s:f}, s:i}, s:s, s:f}", "name", "flow through an orifice, proposed", "process",
                     "orifice", "inputs", "vessel", "width", rounded(WIDTH * diameter, 4), "depth", rounded(depth, 4), "orifice",
                     "width", rounded(slot, 4), "particle_count", GRAINS, "result", "/flow/mass_rate", "standard_error",
                     rounded(SHARE_OF_RATE * rate, 2));
}

/* The last test and its measure, whatever of it is there. */
static void take_back(plan_request *request, size_t tests, size_t measures)
{
    while (request->tests > tests) json_decref(request->test[--request->tests].request);
    request->measures = measures;
}

void plan_propose(plan_request *request, const json_t *base)
{
    const size_t tests = request->tests, measures = request->measures;
    double diameter, density, gravity;
    size_t test;
    problem_list problems;
    if (!seeks(request, "/inputs/contact/friction") || !seeks(request, "/inputs/contact/rolling_friction")
        || has_process(request, "orifice") || tests == PLAN_MOST_TESTS || measures == PLAN_MOST_MEASURES
        || !find_grain(request, &diameter, &density, &gravity) || !problem_list_init(&problems))
        return;
    json_t *target = flow_of(diameter, density, gravity);
    bool good = target && plan_test_add(request, base, target, "/next_tests/0", PLAN_PROPOSED, 0, &test, &problems);
    if (good) {
        plan_measures_add(request, target, "/next_tests/0", PLAN_PROPOSED, test, &problems);
        plan_test_check(request, test, &problems);
        request->test[test].is_own = true;
    }
    /* The base may have what an orifice can't. */
    if (!good || !problem_list_is_empty(&problems)) take_back(request, tests, measures);
    problem_list_clear(&problems);
    json_decref(target);
}
