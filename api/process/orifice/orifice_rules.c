/* From inputs, each within its own range, to a vessel with an orifice that can be run. Refused inputs are NaN, and no check is
 * true of NaN. */
#include <math.h>

#include "dem_rules.h"
#include "orifice_process.h"
#include "scene_warnings.h"
#include "standing_rules.h"

#define LEAST_VESSEL_DIAMETERS 5.0 /* of the largest particle: narrower vessels jam */
#define LEAST_DEPTH_DIAMETERS 3.0
#define USUAL_DEPTH_DIAMETERS 8.0
#define LEAST_PARTICLES 100.0 /* fewer are gone before the flow is steady */
#define USUAL_FILL_DIAMETERS 2.0
#define USUAL_FILL_ORIFICES 8.0
/* Below, orifices clog within a few hundred particles: of spheres (Zuriguel et al. 2005: in earnest up to some 4). */
#define CLOGS_BELOW 4.0
#define STEADY_ABOVE 2.5 /* orifices: measure_flow.c */
/* Room over the bed for the random start, as for a heap's tube. */
#define VESSEL_OVER_BED 1.3
#define FALL_IN_VESSEL 1.2 /* as in a heap's tube */
#define SECONDS_OF_END 2.0
#define TIMES_EXPECTED 3.0
#define SAMPLES_A_FALL 4.0 /* of sqrt(D/g) */
#define MOST_SAMPLES 10000.0
/* Beverloo, Leniger & van de Velde (1961): W = C rho sqrt(g) (D - k d)^(5/2), of a slot 1.03 C' rho sqrt(g) (W - k d)^(3/2) L. */
#define BEVERLOO_C 0.58
#define BEVERLOO_C_OF_SLOT 1.03
#define BEVERLOO_K 1.4
#define LEAST_FREE_SHARE 0.35 /* of the orifice, for what to expect of narrow ones */

static double radians_of(double degrees) { return degrees * DEM_PI / 180.0; }

static double hopper_height(const dem_scene_definition *scene)
{
    const dem_orifice *o = &scene->orifice;
    return o->half_angle > 0.0 ? 0.5 * (scene->diameter - o->opening) / tan(o->half_angle) : 0.0;
}

/* m3 that a hopper takes from the room above the orifice's level. */
static double lost_to_hopper(const dem_scene_definition *scene)
{
    const dem_orifice *o = &scene->orifice;
    const double h = hopper_height(scene), wide = scene->diameter, narrow = o->opening;
    const double inside =
        o->depth > 0.0 ? 0.5 * (wide + narrow) * o->depth * h : DEM_PI / 12.0 * h * (wide * wide + wide * narrow + narrow * narrow);
    return standing_area(scene) * h - inside;
}

/* m over the orifice, of the bed at a share of the room that it takes at DEM_BED_SOLID_FRACTION; it reaches over the hopper. */
static double bed_top(const dem_scene_definition *scene, double share)
{
    return fmax(share * standing_bed_height(scene) + lost_to_hopper(scene) / standing_area(scene), hopper_height(scene));
}

static double height_of_vessel(const dem_scene_definition *scene, double over_bed)
{
    return bed_top(scene, over_bed) + 2.0 * scene_of_species(scene, scene_species_width, true);
}

static double height_of_loose_vessel(const dem_scene_definition *scene)
{
    return height_of_vessel(scene, fmax(VESSEL_OVER_BED, DEM_BED_SOLID_FRACTION / dem_poured_solid(scene)));
}

/* Which of the inputs are given, and that they are of one kind. */
static void derive_section(scene_inputs *inputs, dem_scene_definition *scene, double widest, problem_list *problems)
{
    orifice_inputs *o = &inputs->orifice;
    const bool is_flat = !isnan(o->width);
    if (!is_flat && !isnan(o->vessel_width))
        problem_list_add(problems, "/inputs/orifice", "has no width; must have one below a flat vessel, whose orifice is a slot");
    if (!is_flat && !isnan(o->vessel_depth) && isnan(o->vessel_width))
        problem_list_add(problems, "/inputs/vessel/depth", "is %g m; must be left out where the orifice is a round hole",
                         o->vessel_depth);
    if (is_flat && isnan(o->vessel_depth)) o->vessel_depth = USUAL_DEPTH_DIAMETERS * widest;
    scene->diameter = isnan(o->vessel_width) ? o->vessel_diameter : o->vessel_width;
    scene->orifice = (dem_orifice){ .opening = is_flat ? o->width : o->diameter,
                                    .depth = is_flat ? o->vessel_depth : 0.0,
                                    .half_angle = isnan(o->half_angle_deg) ? 0.0 : radians_of(o->half_angle_deg) };
    if (scene->orifice.depth < LEAST_DEPTH_DIAMETERS * widest * (1.0 - 1e-9) && is_flat)
        problem_list_add(problems, "/inputs/vessel/depth", "is %g m; must be at least %g m, %g of the largest particle diameter",
                         o->vessel_depth, LEAST_DEPTH_DIAMETERS * widest, LEAST_DEPTH_DIAMETERS);
}

static void check_opening(const orifice_inputs *o, const dem_scene_definition *scene, double widest, problem_list *problems)
{
    const char *across = isnan(o->vessel_width) ? "/inputs/vessel/diameter" : "/inputs/vessel/width";
    const char *opening = isnan(o->width) ? "/inputs/orifice/diameter" : "/inputs/orifice/width";
    if (scene->diameter < LEAST_VESSEL_DIAMETERS * widest * (1.0 - 1e-9))
        problem_list_add(problems, across, "is %g m; must be at least %g m, %g of the largest particle diameter", scene->diameter,
                         LEAST_VESSEL_DIAMETERS * widest, LEAST_VESSEL_DIAMETERS);
    if (scene->orifice.opening < widest * (1.0 - 1e-9))
        problem_list_add(problems, opening, "is %g m; must be at least %g m, the largest particle diameter, or nothing passes",
                         scene->orifice.opening, widest);
    const double most = scene->diameter - 2.0 * widest;
    if (scene->orifice.opening > most * (1.0 + 1e-9) && most > 0.0)
        problem_list_add(problems, opening,
                         "is %g m; must be at most %g m here: the vessel less two of the largest particle diameters",
                         scene->orifice.opening, most);
}

static void derive_vessel(scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems)
{
    orifice_inputs *o = &inputs->orifice;
    const double widest = scene_of_species(scene, scene_species_width, true);
    scene->container = DEM_VESSEL;
    scene->ends.friction = inputs->wall_friction;
    scene->ends.rolling_friction = inputs->wall_rolling_friction;
    derive_section(inputs, scene, widest, problems);
    check_opening(o, scene, widest, problems);
    const double usual = fmax(USUAL_FILL_DIAMETERS * scene->diameter, USUAL_FILL_ORIFICES * scene->orifice.opening);
    standing_derive_count(inputs, scene, usual, LEAST_PARTICLES, problems);
    const double needed = height_of_vessel(scene, VESSEL_OVER_BED);
    if (isnan(o->vessel_height)) o->vessel_height = height_of_loose_vessel(scene);
    if (o->vessel_height < needed * (1.0 - 1e-9))
        problem_list_add(problems, "/inputs/vessel/height",
                         "is %g m, in which the particles don't fit; must be at least %.4g m, or the particles at most %.0f",
                         o->vessel_height, needed,
                         fmax(0.0, floor((o->vessel_height - 2.0 * widest - lost_to_hopper(scene) / standing_area(scene))
                                         / VESSEL_OVER_BED / standing_bed_height(scene) * (double)scene->particle_count)));
    scene->length = o->vessel_height;
}

/* kg/s by Beverloo's law, at a solid fraction of 0.6. */
static double expected_rate(const dem_scene_definition *scene)
{
    const dem_orifice *o = &scene->orifice;
    double mass = 0.0, volume = 0.0;
    for (size_t s = 0; s < scene->species_count; s++) {
        mass += scene->species[s].share * dem_species_mass(&scene->species[s]);
        volume += scene->species[s].share * dem_species_volume(&scene->species[s]);
    }
    const double grain = cbrt(6.0 / DEM_PI * volume), bulk = DEM_BED_SOLID_FRACTION * mass / volume;
    const double free = fmax(o->opening - BEVERLOO_K * grain, LEAST_FREE_SHARE * fmax(o->opening, grain));
    return o->depth > 0.0 ? BEVERLOO_C_OF_SLOT * bulk * sqrt(scene->gravity) * pow(free, 1.5) * o->depth
                          : BEVERLOO_C * bulk * sqrt(scene->gravity) * pow(free, 2.5);
}

static double expected_seconds(const dem_scene_definition *scene)
{
    double mass = 0.0;
    for (size_t s = 0; s < scene->species_count; s++) mass += scene->species[s].share * dem_species_mass(&scene->species[s]);
    return (double)scene->particle_count * mass / expected_rate(scene);
}

/* What falls down the height of the bed, as in the tube of a heap. */
static double largest_impact(const dem_scene_definition *scene)
{
    return FALL_IN_VESSEL
           * dem_impact_speed(fmax(standing_bed_height(scene), scene->diameter),
                              scene_of_species(scene, dem_species_diameter, true), scene->gravity, 1.0, 0.0);
}

void orifice_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems)
{
    scene_inputs *inputs = &spec->inputs;
    dem_scene_definition *scene = &spec->scene;
    standing_derive_scene(inputs, scene, seed_if_missing, problems);
    derive_vessel(inputs, scene, problems);
    spec->expected_overlap = scene_derive_contact(inputs, largest_impact(scene), scene, problems);
    if (isnan(inputs->orifice.seconds)) inputs->orifice.seconds = TIMES_EXPECTED * expected_seconds(scene) + SECONDS_OF_END;
    spec->duration = inputs->orifice.seconds;
    /* as often as the flow changes, but no more often than can be kept of a run that lasts for long */
    const double often = fmax(sqrt(scene->orifice.opening / scene->gravity) / SAMPLES_A_FALL, spec->duration / MOST_SAMPLES);
    if (isnan(inputs->sample_interval))
        inputs->sample_interval = fmin(fmin(SCENE_SAMPLE_INTERVAL_MOST, spec->duration / SCENE_SAMPLES_PER_RUN), often);
    standing_complete(spec, "/inputs/duration/at_most_seconds", problems);
}

/* While it flows, half of the particles are inside on average, and those that are out cost a little. */
job_estimate orifice_estimate(const job_spec *spec, const calibration *machine)
{
    const dem_scene_definition *scene = &spec->scene;
    const double flowing = fmin(1.5 * expected_seconds(scene) + 0.5, spec->duration), before = dem_settling_time(scene);
    return standing_estimate(spec, machine, flowing, before, (0.6 * flowing + before) / (flowing + before));
}

void orifice_warn(const job_spec *spec, problem_list *warnings)
{
    const dem_scene_definition *scene = &spec->scene;
    const bool is_flat = scene->orifice.depth > 0.0;
    const double widest = scene_of_species(scene, scene_species_width, true), opening = scene->orifice.opening;
    const double loose = height_of_loose_vessel(scene);
    if (scene->length < loose * (1.0 - 1e-9))
        problem_list_add(warnings, "/inputs/vessel/height",
                         "is %g m, over which the bed may stand, where the wall goes on: particles of these shapes with much "
                         "friction make a loose bed, which needs %.4g m",
                         scene->length, loose);
    if (opening < CLOGS_BELOW * widest)
        problem_list_add(warnings, is_flat ? "/inputs/orifice/width" : "/inputs/orifice/diameter",
                         "is %.3g of the largest particle's diameters: below %g the flow is likely to clog", opening / widest,
                         CLOGS_BELOW);
    if (bed_top(scene, 1.0) < 2.0 * STEADY_ABOVE * opening)
        problem_list_add(
            warnings, isnan(spec->inputs.fill_height) ? "/inputs/particle_count" : "/inputs/fill_height",
            "makes a bed %.3g m high over an orifice of %.3g m: the flow is steady down to %g openings, so that little "
            "or nothing is left to measure",
            bed_top(scene, 1.0), opening, STEADY_ABOVE);
    scene_warn(spec, "vessel", warnings);
}

void orifice_understand(const job_spec *spec, json_t *words)
{
    char time[TIME_IN_WORDS_SIZE];
    time_in_words(spec->duration, time);
    scene_understand(spec, words);
    json_object_set_new(words, "duration", json_sprintf("at most %s from when the orifice is opened", time));
    json_object_set_new(words, "beverloo_mass_rate", json_real(expected_rate(&spec->scene)));
}
