#include "scene_warnings.h"

#include <math.h>
#include <stdio.h>

#include "dem_rules.h"
#include "scene_rules.h"
#include "size_rules.h"

#define SOFT_OVERLAP 0.05 /* of the smallest diameter: the most that maximum_overlap can ask for */

#define LEAST_ACROSS 10.0

double froude_number(double rotation_rate, double radius, double gravity)
{
    return rotation_rate * rotation_rate * radius / gravity;
}

double revolutions_a_minute(double rotation_rate) { return rotation_rate * 60.0 / (2.0 * DEM_PI); }

void rotation_understand(double rotation_rate, double froude, json_t *words)
{
    json_object_set_new(words, "rotation_rate_rpm", json_real(revolutions_a_minute(rotation_rate)));
    json_object_set_new(words, "froude_number", json_real(froude));
}

static double diameter_ratio(const job_spec *spec)
{
    return spec->scene.diameter / scene_of_species(&spec->scene, scene_species_width, true);
}

void scene_understand(const job_spec *spec, json_t *words)
{
    json_object_set_new(words, "diameter_ratio", json_real(diameter_ratio(spec)));
    json_object_set_new(words, "expected_overlap", json_real(spec->expected_overlap));
    sizes_understand(spec, words);
    if (!isnan(spec->bond_number)) json_object_set_new(words, "bond_number", json_real(spec->bond_number));
}

void scene_warn(const job_spec *spec, const char *container, problem_list *warnings)
{
    char pointer[60];
    const double ratio = diameter_ratio(spec);
    if (ratio < LEAST_ACROSS * (1.0 - 1e-9)) {
        snprintf(pointer, sizeof pointer, "/inputs/%s/diameter", container);
        problem_list_add(
            warnings, pointer,
            "is %.3g of the largest particle's diameters: with fewer than %g across, the wall and the places of single "
            "particles decide the angle",
            ratio, LEAST_ACROSS);
    }
    const scene_inputs *inputs = &spec->inputs;
    const double overlap = spec->expected_overlap;
    if (isnan(inputs->maximum_overlap) && overlap > SOFT_OVERLAP)
        problem_list_add(warnings, isnan(inputs->stiffness) ? "/inputs/contact/youngs_modulus" : "/inputs/contact/stiffness",
                         "is so soft that overlaps of %.2g of the smallest diameter are to be expected; angles are good up to %g",
                         overlap, SOFT_OVERLAP);
}
