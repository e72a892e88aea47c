#include "result_warnings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "dem_rules.h"
#include "text_copy.h"

#define MUCH_OVERLAP 1.5 /* times what was asked for: stiffness is chosen for the hardest impact, and beds press beside it */

static const json_t *member(const json_t *results, const char *output, const char *name)
{
    return json_object_get(json_object_get(results, output), name);
}

static void warn_of_overlap(const job_spec *spec, const json_t *results, problem_list *warnings)
{
    const bool is_given = spec->maximum_overlap > 0;
    const double wanted = is_given ? spec->maximum_overlap : spec->expected_overlap;
    const double largest = json_number_value(member(results, "run", "maximum_overlap"));
    if (wanted > 0 && largest > MUCH_OVERLAP * wanted)
        problem_list_add(
            warnings, "/run/maximum_overlap",
            "is %.2g of the smallest diameter, where %.2g was %s: particles were pressed into one another, so that angles "
            "and packing are not to be relied on; fewer particles, or a larger stiffness, help",
            largest, wanted, is_given ? "asked for" : "to be expected of the stiffness given");
}

static void warn_of_motion(const char *output, const json_t *results, problem_list *warnings)
{
    char pointer[40];
    snprintf(pointer, sizeof pointer, "/%s/at_rest", output);
    if (json_is_false(member(results, output, "at_rest")))
        problem_list_add(warnings, pointer,
                         "is false: the particles were still moving when the run's time was over, so that the "
                         "angle is not one of repose; give the run a longer time");
}

static void warn_of_missing(const json_t *results, problem_list *warnings)
{
    const json_int_t waiting = json_integer_value(member(results, "fill", "waiting"));
    if (waiting > 0)
        problem_list_add(warnings, "/fill/waiting",
                         "is %lld of %lld particles: these never entered, because there was no room or the run's time was over",
                         (long long)waiting, (long long)json_integer_value(member(results, "run", "particles")));
}

static void warn_of_flow(const json_t *results, problem_list *warnings)
{
    const json_t *rate = member(results, "flow", "mass_rate");
    if (json_is_null(rate))
        problem_list_add(
            warnings, "/flow/mass_rate",
            "is null: the flow had no steady part, from 5 sqrt(D/g) after the orifice was opened until the bed over it "
            "was 2.5 D high; more particles, or a narrower orifice, give it one");
    else if (rate && json_is_null(member(results, "flow", "mass_rate_standard_error")))
        problem_list_add(warnings, "/flow/mass_rate_standard_error",
                         "is null: the steady part is too short for one; more particles make it longer");
    if (json_is_true(member(results, "flow", "clogged")))
        problem_list_add(warnings, "/flow/clogged",
                         "is true: particles lie over the orifice at rest; another seed may flow on for longer");
}

static void warn_of_end(const job_spec *spec, const json_t *results, problem_list *warnings)
{
    const char *ended_by = json_string_value(member(results, "run", "ended_by"));
    if (ended_by && strcmp(ended_by, "at-most-revolutions") == 0)
        problem_list_add(warnings, "/run/ended_by",
                         "is at-most-revolutions: the angle was not steady and known within the %.2g degrees asked for",
                         spec->until_standard_error);
}

static void warn_of_slip(const json_t *results, problem_list *warnings)
{
    const double slip = json_number_value(json_object_get(member(results, "regime", "evidence"), "wall_slip"));
    const char *verdict = json_string_value(member(results, "repose", "verdict"));
    const double revolutions = json_number_value(json_object_get(member(results, "repose", "window"), "revolutions"));
    if (slip > DEM_SLIPS_FROM && revolutions >= DEM_LEAST_REVOLUTIONS && verdict && strcmp(verdict, "too-short") == 0)
        problem_list_add(warnings, "/regime/evidence/wall_slip",
                         "is %.2g: a bed that slips at the wall renews itself so slowly that angle and torque have no error and no "
                         "verdict until it has turned for %d revolutions; give the run that many",
                         slip, DEM_LEAST_SLIPPING_REVOLUTIONS);
}

bool result_warnings_add(const job_spec *spec, json_t *results)
{
    problem_list warnings;
    if (!results || !problem_list_init(&warnings)) return false;
    warn_of_overlap(spec, results, &warnings);
    warn_of_motion("heap", results, &warnings);
    warn_of_motion("fill", results, &warnings);
    warn_of_missing(results, &warnings);
    warn_of_flow(results, &warnings);
    warn_of_end(spec, results, &warnings);
    warn_of_slip(results, &warnings);
    const bool done = json_object_set_new(json_object_get(results, "run"), "warnings", job_warnings_to_json(&warnings)) == 0;
    problem_list_clear(&warnings);
    return done;
}

void result_message(const json_t *results, char *text, size_t size)
{
    const json_t *warnings = member(results, "run", "warnings"), *first = json_array_get(warnings, 0);
    const char *field = json_string_value(json_object_get(first, "field"));
    const char *told = json_string_value(json_object_get(first, "text"));
    const size_t count = json_array_size(warnings);
    json_t *whole = field && told ? json_sprintf("done, with %zu warning%s: %s %s", count, count == 1 ? "" : "s", field, told)
                                  : json_string("done");
    text_copy(text, size, json_string_value(whole));
    json_decref(whole);
}
