/* From inputs, each within its own range, to a tube on a plate that can be run. Refused inputs are NaN, and no check is
 * true of NaN. */
#include <math.h>

#include "dem_rules.h"
#include "heap_process.h"
#include "scene_warnings.h"
#include "standing_rules.h"

#define LEAST_TUBE_DIAMETERS 5.0 /* of the largest particle: narrower tubes jam */
#define LEAST_PARTICLES 100.0    /* a heap of fewer has flanks of few particles */
#define USUAL_PLATE_DIAMETERS 2.0
#define USUAL_FILL_DIAMETERS 2.0
#define USUAL_LIFT_SHARE 0.02 /* of sqrt(g D) */
#define FAST_LIFT_SHARE 0.3   /* of it, too */
#define USUAL_RIM_SHARE 0.5   /* of the largest particle */
/* Room over the bed for the random start, which is looser; more where the particles make a looser bed. */
#define TUBE_OVER_BED 1.3
#define SECONDS_AFTER_LIFTING 3.0
/* Over that of a drum as wide as the bed is high; from overlaps at frictions from 0 to 1. */
#define FALL_IN_TUBE 1.2
/* For the estimate: slope of the heap, how long (s) the heap takes to come to rest, and what a sphere-step costs beside one in a
 * drum, where neighbors change less: from heaps of 200 to 4000 particles. */
#define SLOPE_EXPECTED 0.45
static const struct {
    double rest, cost;
} OF_SPHERES = { 0.5, 1.75 }, OF_SPHERES_THAT_ROLL_HARD = { 0.3, 1.4 }, OF_CLUSTERS = { 0.7, 1.3 };
/* The last spheres roll to the edge of the plate, at so much of the speed of falling from the top. */
#define ROLLING_SPEED_SHARE 0.06

/* m, of a tube with room for the bed at a share of the height that it has at DEM_BED_SOLID_FRACTION, and for two particles. */
static double height_of_tube(const dem_scene_definition *scene, double over_bed)
{
    return over_bed * standing_bed_height(scene) + 2.0 * scene_of_species(scene, scene_species_width, true);
}

static double height_of_loose_tube(const dem_scene_definition *scene)
{
    return height_of_tube(scene, fmax(TUBE_OVER_BED, DEM_BED_SOLID_FRACTION / dem_poured_solid(scene)));
}

static void derive_tube(scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems)
{
    heap_inputs *heap = &inputs->heap;
    scene->container = DEM_TUBE_ON_PLATE;
    scene->diameter = heap->tube_diameter;
    const double widest = scene_of_species(scene, scene_species_width, true);
    if (scene->diameter < LEAST_TUBE_DIAMETERS * widest * (1.0 - 1e-9))
        problem_list_add(problems, "/inputs/tube/diameter", "is %g m; must be at least %g m, %g of the largest particle diameter",
                         scene->diameter, LEAST_TUBE_DIAMETERS * widest, LEAST_TUBE_DIAMETERS);
    standing_derive_count(inputs, scene, USUAL_FILL_DIAMETERS * scene->diameter, LEAST_PARTICLES, problems);
    const double needed = height_of_tube(scene, TUBE_OVER_BED);
    if (isnan(heap->tube_height)) heap->tube_height = height_of_loose_tube(scene);
    if (heap->tube_height < needed * (1.0 - 1e-9))
        problem_list_add(problems, "/inputs/tube/height",
                         "is %g m, in which the particles don't fit; must be at least %.4g m, or the bed at most %.4g m high",
                         heap->tube_height, needed, fmax(0.0, (heap->tube_height - 2.0 * widest) / TUBE_OVER_BED));
    scene->length = heap->tube_height;
    if (isnan(heap->lift_speed)) heap->lift_speed = USUAL_LIFT_SHARE * sqrt(scene->gravity * scene->diameter);
    scene->lift = (dem_lift){ .speed = heap->lift_speed };
}

static void derive_plate(scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems)
{
    heap_inputs *heap = &inputs->heap;
    const double widest = scene_of_species(scene, scene_species_width, true);
    if (isnan(heap->plate_diameter)) heap->plate_diameter = USUAL_PLATE_DIAMETERS * heap->tube_diameter;
    if (isnan(heap->rim_height)) heap->rim_height = USUAL_RIM_SHARE * widest;
    scene->plate = (dem_plate){ heap->plate_diameter, heap->rim_height, heap->plate_friction, heap->plate_rolling_friction };
    const double least = scene->diameter + 2.0 * widest;
    if (heap->plate_diameter < least)
        problem_list_add(problems, "/inputs/plate/diameter",
                         "is %g m; must be at least %g m, the tube's diameter and two of the largest particle's",
                         heap->plate_diameter, least);
    if (heap->rim_height > 0.25 * heap->plate_diameter)
        problem_list_add(problems, "/inputs/plate/rim_height",
                         "is %g m; must be at most %g m, a quarter of the plate's diameter: what is higher is a vessel",
                         heap->rim_height, 0.25 * heap->plate_diameter);
}

/* What falls down the height of the bed in the tube, as in a rough drum of that size: the tube makes a smooth bed as
 * high as a rough one. */
static double largest_impact(const scene_inputs *inputs, const dem_scene_definition *scene)
{
    const double falling = dem_impact_speed(fmax(standing_bed_height(scene), scene->diameter),
                                            scene_of_species(scene, dem_species_diameter, true), scene->gravity, 1.0, 0.0);
    return fmax(FALL_IN_TUBE * falling, inputs->heap.lift_speed);
}

void heap_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems)
{
    scene_inputs *inputs = &spec->inputs;
    dem_scene_definition *scene = &spec->scene;
    standing_derive_scene(inputs, scene, seed_if_missing, problems);
    derive_tube(inputs, scene, problems);
    derive_plate(inputs, scene, problems);
    spec->expected_overlap = scene_derive_contact(inputs, largest_impact(inputs, scene), scene, problems);
    if (isnan(inputs->heap.seconds)) inputs->heap.seconds = standing_bed_height(scene) / scene->lift.speed + SECONDS_AFTER_LIFTING;
    spec->duration = inputs->heap.seconds;
    standing_complete(spec, "/inputs/duration/at_most_seconds", problems);
}

/* Until the tube is clear of a cone of that volume. */
job_estimate heap_estimate(const job_spec *spec, const calibration *machine)
{
    const dem_scene_definition *scene = &spec->scene;
    const double bed = standing_bed_height(scene), volume = DEM_PI / 4.0 * scene->diameter * scene->diameter * bed;
    const double cone = cbrt(3.0 * volume * SLOPE_EXPECTED * SLOPE_EXPECTED / DEM_PI);
    const double height = fmin(cone, 0.5 * SLOPE_EXPECTED * scene->plate.diameter);
    const bool has_clusters = scene_spheres_a_particle(scene) > 1.0, rolls = !has_clusters && !dem_has_rolling_friction(scene);
    const double rest = has_clusters ? OF_CLUSTERS.rest : rolls ? OF_SPHERES.rest : OF_SPHERES_THAT_ROLL_HARD.rest;
    const double bare = has_clusters ? 0.0 : fmax(0.5 * scene->plate.diameter - cone / SLOPE_EXPECTED, 0.0);
    const double rolling = bare / (ROLLING_SPEED_SHARE * sqrt(2.0 * scene->gravity * height));
    const double seconds = fmin(height / scene->lift.speed + rest + rolling, spec->duration);
    job_estimate heap = standing_estimate(spec, machine, seconds, dem_settling_time(scene), 1.0);
    heap.wall_seconds *= has_clusters ? OF_CLUSTERS.cost : rolls ? OF_SPHERES.cost : OF_SPHERES_THAT_ROLL_HARD.cost;
    return heap;
}

/* A loose bed stands above the height given, where the wall goes on; a tube that is pulled away lets its particles fall. */
void heap_warn(const job_spec *spec, problem_list *warnings)
{
    const double loose = height_of_loose_tube(&spec->scene);
    if (spec->scene.length < loose * (1.0 - 1e-9))
        problem_list_add(warnings, "/inputs/tube/height",
                         "is %g m, over which the bed may stand, where the wall goes on: particles of these shapes with much "
                         "friction make a loose bed, which needs %.4g m",
                         spec->scene.length, loose);
    const double fast = FAST_LIFT_SHARE * sqrt(spec->scene.gravity * spec->scene.diameter);
    if (spec->scene.lift.speed > fast)
        problem_list_add(
            warnings, "/inputs/tube/lift_speed",
            "is %.4g m/s, at which the bed falls rather than flows out; the heap is that of a slow lift up to %.3g m/s here",
            spec->scene.lift.speed, fast);
    scene_warn(spec, "tube", warnings);
}

void heap_understand(const job_spec *spec, json_t *words)
{
    char time[TIME_IN_WORDS_SIZE];
    time_in_words(spec->duration, time);
    scene_understand(spec, words);
    json_object_set_new(words, "duration", json_sprintf("at most %s from when the tube starts to rise", time));
}
