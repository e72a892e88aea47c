/* From inputs, each within its own range, to a cylinder and a stream that can be run. Refused inputs are NaN, and no check
 * is true of NaN. */
#include <math.h>

#include "dem_rules.h"
#include "dem_stream.h"
#include "fill_process.h"
#include "scene_warnings.h"
#include "standing_rules.h"

#define LEAST_CYLINDER_DIAMETERS 6.0 /* of the largest particle: a surface needs some width */
#define LEAST_BED_DIAMETERS 2.0
#define USUAL_SOLID 0.05 /* of the stream */
#define USUAL_STREAM_SHARE 0.25
#define USUAL_STREAM_DIAMETERS 3.0
#define SETTLING_EXPECTED 0.4 /* s, for the estimate */
/* A bed of some height presses and slides, however gently it was poured: its own weight is a speed, too. */
#define SPEED_OF_WEIGHT 0.6
/* A particle that is hit on the bed by the next one is pressed by more than a single impact on the floor. */
#define IMPACT_ON_OTHERS 1.25

static void derive_stream(scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems)
{
    fill_inputs *fill = &inputs->fill;
    const double widest = dem_stream_widest(scene), least_speed = dem_stream_least_impact_speed(scene);
    if (isnan(fill->stream_diameter))
        fill->stream_diameter = fmin(fmax(USUAL_STREAM_SHARE * scene->diameter, USUAL_STREAM_DIAMETERS * widest), scene->diameter);
    scene->stream = (dem_stream){ .diameter = fill->stream_diameter, .impact_speed = fill->impact_speed };
    if (fill->stream_diameter > scene->diameter)
        problem_list_add(problems, "/inputs/stream/diameter", "is %g m; must be at most %g m, the cylinder's diameter",
                         fill->stream_diameter, scene->diameter);
    if (fill->stream_diameter < widest)
        problem_list_add(problems, "/inputs/stream/diameter", "is %g m; must be at least %g m, the largest particle diameter",
                         fill->stream_diameter, widest);
    if (fill->impact_speed < least_speed)
        problem_list_add(problems, "/inputs/stream/impact_speed",
                         "is %g m/s; must be at least %.4g m/s here, the speed of falling the %.3g m from the inlet to the bed",
                         fill->impact_speed, least_speed, dem_stream_clearance(scene));
}

/* rate or mass_rate as given; a few per cent of the stream where neither is. */
static void derive_rate(scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems)
{
    fill_inputs *fill = &inputs->fill;
    double mass = 0.0;
    for (size_t s = 0; s < scene->species_count; s++) mass += scene->species[s].share * dem_species_mass(&scene->species[s]);
    const double most = dem_stream_most_rate(scene);
    if (isnan(fill->rate) && isnan(fill->mass_rate))
        fill->rate = fmin(dem_stream_rate(scene, USUAL_SOLID, fill->impact_speed), most);
    const bool by_mass = !isnan(fill->mass_rate);
    scene->stream.rate = by_mass ? fill->mass_rate / mass : fill->rate;
    if (scene->stream.rate <= most) return;
    if (by_mass)
        problem_list_add(problems, "/inputs/stream/mass_rate",
                         "is %g kg/s, at which the inlet clogs; must be at most %.4g kg/s for this inlet and speed",
                         fill->mass_rate, most * mass);
    else if (scene->stream.rate > most)
        problem_list_add(problems, "/inputs/stream/rate",
                         "is %g particles a second, at which the inlet clogs; must be at most %.4g 1/s for this inlet and speed",
                         fill->rate, most);
}

/* As dense as beds in a wide cylinder are, at the least. */
static void check_bed(const scene_inputs *inputs, const dem_scene_definition *scene, problem_list *problems)
{
    const double solid = dem_stream_usual_fraction(scene), height = inputs->fill.cylinder_height;
    const double needed = dem_stream_height(scene, (double)scene->particle_count, solid);
    if (needed > height)
        problem_list_add(problems, "/inputs/cylinder/height",
                         "is %g m, but the particles need %.4g m; must be at least that, or the particles at most %.0f", height,
                         needed, floor(height / dem_stream_height(scene, 1.0, solid)));
}

/* A bed of much friction is looser, and its top may stand over the cylinder's. */
void fill_warn(const job_spec *spec, problem_list *warnings)
{
    const dem_scene_definition *scene = &spec->scene;
    const double solid = dem_poured_solid(scene), needed = dem_stream_height(scene, (double)scene->particle_count, solid);
    if (needed > spec->inputs.fill.cylinder_height)
        problem_list_add(warnings, "/inputs/cylinder/height",
                         "is %g m, above which the bed may end: particles of these shapes with much friction fill %.2g of so "
                         "narrow a cylinder, and need %.3g m",
                         spec->inputs.fill.cylinder_height, solid, needed);
    scene_warn(spec, "cylinder", warnings);
}

static void derive_cylinder(scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems)
{
    scene->container = DEM_CYLINDER;
    scene->diameter = inputs->fill.cylinder_diameter;
    scene->ends.friction = inputs->wall_friction;
    scene->ends.rolling_friction = inputs->wall_rolling_friction;
    const double widest = scene_of_species(scene, scene_species_width, true);
    if (scene->diameter < LEAST_CYLINDER_DIAMETERS * widest * (1.0 - 1e-9))
        problem_list_add(problems, "/inputs/cylinder/diameter",
                         "is %g m; must be at least %g m, %g of the largest particle diameter", scene->diameter,
                         LEAST_CYLINDER_DIAMETERS * widest, LEAST_CYLINDER_DIAMETERS);
    const double least_bed = LEAST_BED_DIAMETERS * widest / dem_stream_level(scene, 1.0);
    standing_derive_count(inputs, scene, 0.5 * scene->diameter, fmax(8.0, ceil(least_bed)), problems);
    check_bed(inputs, scene, problems);
    derive_stream(inputs, scene, problems);
    derive_rate(inputs, scene, problems);
    scene->length = dem_stream_inlet_height(scene, (double)scene->particle_count) + widest;
}

/* The input to be named where there is too much to simulate. */
static const char *what_makes_it_long(const scene_inputs *inputs, const dem_scene_definition *scene)
{
    if ((double)scene->particle_count / scene->stream.rate < inputs->fill.settling_seconds)
        return "/inputs/duration/settling_seconds";
    return isnan(inputs->fill.mass_rate) ? "/inputs/stream/rate" : "/inputs/stream/mass_rate";
}

void fill_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems)
{
    scene_inputs *inputs = &spec->inputs;
    dem_scene_definition *scene = &spec->scene;
    standing_derive_scene(inputs, scene, seed_if_missing, problems);
    derive_cylinder(inputs, scene, problems);
    if (dem_have_sizes(scene->species, scene->species_count) && scene_spheres_a_particle(scene) > 1.0)
        problem_list_add(problems, "/inputs/particles",
                         "are clusters and spheres with a size distribution; must be one or the other where a stream lets them in");
    const double weight = SPEED_OF_WEIGHT * sqrt(scene->gravity * dem_stream_level(scene, (double)scene->particle_count));
    spec->expected_overlap =
        scene_derive_contact(inputs, fmax(IMPACT_ON_OTHERS * inputs->fill.impact_speed, weight), scene, problems);
    spec->duration = (double)scene->particle_count / scene->stream.rate + inputs->fill.settling_seconds;
    standing_complete(spec, what_makes_it_long(inputs, scene), problems);
}

job_estimate fill_estimate(const job_spec *spec, const calibration *machine)
{
    const double filling = (double)spec->scene.particle_count / spec->scene.stream.rate;
    const double settling = fmin(SETTLING_EXPECTED, spec->inputs.fill.settling_seconds);
    /* While it fills, half of the particles are inside on average. */
    return standing_estimate(spec, machine, filling + settling, 0.0, (0.5 * filling + settling) / (filling + settling));
}

void fill_understand(const job_spec *spec, json_t *words)
{
    char filling[TIME_IN_WORDS_SIZE], settling[TIME_IN_WORDS_SIZE];
    time_in_words((double)spec->scene.particle_count / spec->scene.stream.rate, filling);
    time_in_words(spec->inputs.fill.settling_seconds, settling);
    scene_understand(spec, words);
    json_object_set_new(words, "duration", json_sprintf("%s of filling, then at most %s to come to rest", filling, settling));
}
