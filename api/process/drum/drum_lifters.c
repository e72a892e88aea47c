#include "drum_lifters.h"

#include <math.h>

#include "dem_rules.h"
#include "scene_rules.h"

/* A bar along its own direction: its top, and by how much its middle passes the axis, m. */
typedef struct bar_place {
    double top, aside;
} bar_place;

static bar_place place_of(const scene_inputs *inputs)
{
    const double radius = 0.5 * inputs->drum_diameter, lean = inputs->lifter_angle_deg * DEM_PI / 180.0;
    if (!(fabs(lean) > 0.0)) return (bar_place){ radius - inputs->lifter_height, 0.0 };
    return (bar_place){ radius * cos(lean) - inputs->lifter_height, radius * sin(lean) };
}

/* Widest bars along the radius that neither leave the drum nor meet. */
static double widest_upright(const scene_inputs *inputs, double top)
{
    const double radius = 0.5 * inputs->drum_diameter;
    const double widest = 2.0 * sqrt(fmax(radius * radius - top * top, 0.0));
    return inputs->lifter_count >= 3.0 ? fmin(widest, 1.99 * top * tan(DEM_PI / inputs->lifter_count)) : widest;
}

/* The same of bars that lean. Two neighbors are apart where the side of one has the other on its far side throughout: both ends of
 * the condition are linear in the width, so that a search finds the widest. */
static bool are_apart(bar_place bar, double count, double width)
{
    const double turn = 2.0 * DEM_PI / count, sine = sin(turn), cosine = cos(turn), top = 0.995 * bar.top;
    const double left = bar.aside + 0.5 * width, right = bar.aside - 0.5 * width;
    if (count < 3.0) return true; /* they point away from each other */
    return top * sine - fmax(left * cosine, right * cosine) >= -right || top * sine + fmin(left * cosine, right * cosine) >= left;
}

static double widest_leaning(const scene_inputs *inputs, bar_place bar)
{
    enum { HALVINGS = 50 };
    const double radius = 0.5 * inputs->drum_diameter;
    double low = 0.0, high = 2.0 * (sqrt(fmax(radius * radius - bar.top * bar.top, 0.0)) - fabs(bar.aside));
    if (!(high > 0.0)) return 0.0;
    if (are_apart(bar, inputs->lifter_count, high)) return high;
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (low + high);
        *(are_apart(bar, inputs->lifter_count, middle) ? &low : &high) = middle;
    }
    return low;
}

bool lifters_check(const scene_inputs *inputs, const dem_scene_definition *drum, problem_list *problems)
{
    const size_t before = json_array_size(problems->errors);
    const bar_place bar = place_of(inputs);
    const double room = 1.5 * scene_of_species(drum, scene_species_width, true);
    const double highest = bar.top + inputs->lifter_height - room;
    const bool leans = fabs(inputs->lifter_angle_deg) > 0.0;
    if (!isnan(inputs->lining_diameter) && !isnan(inputs->lifter_count))
        problem_list_add(problems, "/inputs/drum/lifters", "are %.0f bars in a drum with a lining; give one of the two",
                         inputs->lifter_count);
    const double widest = leans ? widest_leaning(inputs, bar) : widest_upright(inputs, bar.top);
    if (inputs->lifter_height > highest && leans)
        problem_list_add(problems, "/inputs/drum/lifters/height",
                         "is %g m; must be at most %g m, the radius times the cosine of angle_deg less 1.5 of the largest particle "
                         "diameters",
                         inputs->lifter_height, fmax(highest, 0.0));
    else if (inputs->lifter_height > highest)
        problem_list_add(problems, "/inputs/drum/lifters/height",
                         "is %g m; must be at most %g m, the drum's radius less 1.5 of the largest particle diameters",
                         inputs->lifter_height, highest);
    else if (inputs->lifter_count >= 1.0 && inputs->lifter_width > widest)
        problem_list_add(problems, "/inputs/drum/lifters/width",
                         "is %g m; must be at most %g m, for that many bars of that height%s to lie within the drum and apart",
                         inputs->lifter_width, widest, leans ? " and angle" : "");
    return json_array_size(problems->errors) == before;
}
