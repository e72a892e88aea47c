/* From inputs, each within its own range, to a definition of a drum that can be run.
 *
 * Inputs that were refused are NaN. Every check here is a comparison that is false for NaN, so that one mistake
 * is reported once. */
#include <math.h>

#include "dem_cluster.h"
#include "dem_rules.h"
#include "drum_lifters.h"
#include "drum_process.h"
#include "drum_stages.h"
#include "scene_rules.h"
#include "start_rules.h"

#define SAMPLES_PER_REVOLUTION 40.0
/* Of a run that ends by what its frames tell: the least window then has the least number of frames. */
#define SAMPLES_PER_REVOLUTION_TO_END (DEM_LEAST_WINDOW_FRAMES / DEM_LEAST_WINDOW_REVOLUTIONS)
#define LEAST_DRUM_DIAMETERS 8.0 /* a bed a few particles deep has no surface to speak of */
/* Of spheres within a lining of their own size 0.65 can be packed, but not 0.7, a tenth of the drum's diameter each. */
#define MOST_FILL 0.95
#define LINING_DEPTH 0.85          /* of its diameter, that it takes off the radius */
#define LEAST_PARTICLES 8.0        /* fewer make no bed; they may be placed one by one */
#define LEAST_LENGTH_DIAMETERS 3.0 /* below, a particle would feel its own periodic image */

/* Asked for by revolutions, seconds, or by the error wanted. */
static void derive_duration(scene_inputs *inputs, job_spec *spec, problem_list *problems)
{
    enum { USUAL_MOST_REVOLUTIONS = 10 };
    const double revolution = 2.0 * DEM_PI / fabs(inputs->rotation_rate);
    spec->until_standard_error = isnan(inputs->until_standard_error) ? 0.0 : inputs->until_standard_error;
    if (spec->until_standard_error > 0.0) {
        if (isnan(inputs->at_most_revolutions)) inputs->at_most_revolutions = USUAL_MOST_REVOLUTIONS;
        spec->duration = inputs->at_most_revolutions * revolution;
        return;
    }
    if (!isnan(inputs->at_most_revolutions))
        problem_list_add(problems, "/inputs/duration/at_most_revolutions",
                         "is %g revolutions, but bounds nothing without "
                         "until_standard_error_deg; give that too, or revolutions",
                         inputs->at_most_revolutions);
    spec->duration = isnan(inputs->revolutions) ? inputs->seconds : inputs->revolutions * revolution;
}

static void derive_rate(scene_inputs *inputs)
{
    if (!isnan(inputs->rotation_rate_rpm)) inputs->rotation_rate = rotation_of_rpm(inputs->rotation_rate_rpm);
    inputs->rate_was_rpm = inputs->rotation_rate_rpm;
    inputs->rotation_rate_rpm = NAN; /* one spelling in the canonical specification */
}

/* Where there are stages, they say how long the drum turns, and at which rates. */
static void derive_rotation(job_spec *spec, problem_list *problems)
{
    derive_rate(&spec->inputs);
    spec->rotation_rate = spec->inputs.stage_count > 0 ? stages_fastest(&spec->inputs) : spec->inputs.rotation_rate;
    if (spec->inputs.stage_count > 0) stages_derive(spec, problems);
    else derive_duration(&spec->inputs, spec, problems);
}

/* A drum that turns the other way is the mirror image of one that turns this way, and that is what runs: so all that is
 * measured is the same to the last bit. What is read and written is mirrored. A cluster is, too, in its own frame: z for
 * -z, which is what turns its orientation w, x, y, z of the one into y, z, w, x of the other. */
static void mirror(job_spec *spec)
{
    spec->is_mirrored = turns_back(&spec->inputs);
    for (size_t s = 0; spec->is_mirrored && s < spec->scene.species_count; s++) {
        dem_cluster *cluster = &spec->scene.species[s].cluster;
        for (size_t k = 0; k < cluster->sphere_count; k++) cluster->sphere[k].position[2] = -cluster->sphere[k].position[2];
    }
}

static bool has_end_walls(const scene_inputs *inputs) { return inputs->drum_ends == 1.0; }

static void set_dependent_defaults(scene_inputs *inputs, double duration, uint64_t seed_if_missing)
{
    if (isnan(inputs->end_friction) && has_end_walls(inputs)) inputs->end_friction = inputs->wall_friction;
    if (isnan(inputs->end_rolling_friction) && has_end_walls(inputs)) inputs->end_rolling_friction = inputs->wall_rolling_friction;
    if (isnan(inputs->lifter_friction) && inputs->lifter_count > 0.0) inputs->lifter_friction = inputs->wall_friction;
    if (isnan(inputs->lining_pitch)) inputs->lining_pitch = inputs->lining_diameter;
    if (isnan(inputs->seed)) inputs->seed = (double)(seed_if_missing & LARGEST_WHOLE_NUMBER);
    if (isnan(inputs->sample_interval)) {
        const double per_revolution = inputs->until_standard_error > 0.0 ? SAMPLES_PER_REVOLUTION_TO_END : SAMPLES_PER_REVOLUTION;
        const double revolution = 2.0 * DEM_PI / fabs(inputs->rotation_rate);
        const double enough = inputs->stage_count > 0 ? stages_sample_interval(inputs, per_revolution)
                                                      : fmin(duration / SCENE_SAMPLES_PER_RUN, revolution / per_revolution);
        inputs->sample_interval = fmin(SCENE_SAMPLE_INTERVAL_MOST, enough);
    }
}

static void check_sizes(const scene_inputs *inputs, const dem_scene_definition *drum, problem_list *problems)
{
    const double largest = scene_of_species(drum, scene_species_width, true);
    if (inputs->drum_diameter < LEAST_DRUM_DIAMETERS * largest)
        problem_list_add(problems, "/inputs/drum/diameter",
                         "is %g m; must be at least %g m, %g of the largest "
                         "particle diameter",
                         inputs->drum_diameter, LEAST_DRUM_DIAMETERS * largest, LEAST_DRUM_DIAMETERS);
    /* A little less is let through: 3 * 0.0063 is not quite 0.0189 in binary. */
    if (inputs->drum_length < LEAST_LENGTH_DIAMETERS * largest * (1.0 - 1e-9))
        problem_list_add(problems, "/inputs/drum/length",
                         "is %g m; must be at least %g m, %g of the largest "
                         "particle diameter",
                         inputs->drum_length, LEAST_LENGTH_DIAMETERS * largest, LEAST_LENGTH_DIAMETERS);
    scene_check_size_ratio(drum, problems);
}

static void check_lining(const scene_inputs *inputs, problem_list *problems)
{
    const double most = inputs->drum_diameter / LEAST_DRUM_DIAMETERS;
    if (inputs->lining_diameter > most)
        problem_list_add(problems, "/inputs/wall/lining/diameter",
                         "is %g m; must be at most %g m, 1/%g of the drum's "
                         "diameter",
                         inputs->lining_diameter, most, LEAST_DRUM_DIAMETERS);
    if (!has_end_walls(inputs) && inputs->lining_diameter * LEAST_LENGTH_DIAMETERS > inputs->drum_length * (1.0 + 1e-9))
        problem_list_add(problems, "/inputs/wall/lining/diameter", "is %g m; must be at most %g m, 1/%g of the periodic axis",
                         inputs->lining_diameter, inputs->drum_length / LEAST_LENGTH_DIAMETERS, LEAST_LENGTH_DIAMETERS);
    if (inputs->lining_pitch < 0.5 * inputs->lining_diameter)
        problem_list_add(problems, "/inputs/wall/lining/pitch",
                         "is %g m; must be at least %g m, half the diameter of "
                         "the lining's spheres",
                         inputs->lining_pitch, 0.5 * inputs->lining_diameter);
    if (inputs->lining_pitch > inputs->drum_length)
        problem_list_add(problems, "/inputs/wall/lining/pitch", "is %g m; must be at most %g m, the drum's length",
                         inputs->lining_pitch, inputs->drum_length);
    const double spheres = DEM_PI * inputs->drum_diameter * inputs->drum_length / (inputs->lining_pitch * inputs->lining_pitch);
    if (spheres > SCENE_MOST_PARTICLES)
        problem_list_add(problems, "/inputs/wall/lining/pitch",
                         "is %g m, which needs %.3g spheres; at most %.3g are "
                         "allowed",
                         inputs->lining_pitch, spheres, SCENE_MOST_PARTICLES);
}

static void check_ends(const scene_inputs *inputs, problem_list *problems)
{
    const struct {
        const char *pointer;
        double value;
    } given[] = { { "/inputs/wall/end_friction", inputs->end_friction },
                  { "/inputs/wall/end_rolling_friction", inputs->end_rolling_friction } };
    for (size_t k = 0; k < sizeof given / sizeof *given; k++)
        if (!isnan(given[k].value) && inputs->drum_ends == 0.0)
            problem_list_add(problems, given[k].pointer,
                             "is %g, but the drum's ends are periodic; give /inputs/drum/ends as \"walls\", too", given[k].value);
}

/* Share of the drum that bars take up. */
static double share_of_lifters(const dem_scene_definition *drum)
{
    const dem_lifters *l = &drum->lifters;
    return (double)l->count * l->height * l->width / (0.25 * DEM_PI * drum->diameter * drum->diameter);
}

/* Share of the drum that is not behind a lining of touching spheres, whose hollows take up little. */
static double share_within_lining(const dem_scene_definition *drum)
{
    if (!(drum->lining.diameter > 0.0)) return 1.0;
    const double covered = fmin(1.0, drum->lining.diameter / drum->lining.pitch);
    const double within = 1.0 - LINING_DEPTH * drum->lining.diameter * covered * covered / (0.5 * drum->diameter);
    return within * within;
}

/* Fill up to which all particles find a place at the start. A lining takes its whole layer from it, however wide its pitch; the
 * numbers of each species are rounded, so that one particle may come on top. */
static double most_placed(const dem_scene_definition *drum)
{
    const double within = 1.0 - drum->lining.diameter / (0.5 * drum->diameter);
    const double room = within * within - share_of_lifters(drum);
    return dem_most_placed(drum) / DEM_BED_SOLID_FRACTION * room * (1.0 - 1.0 / fmax(2.0, (double)drum->particle_count));
}

static double most_fill(const dem_scene_definition *drum)
{
    const double filled = dem_most_solid(drum->species, drum->species_count) / DEM_BED_SOLID_FRACTION;
    return fmin(filled * (1.0 - share_of_lifters(drum)) * share_within_lining(drum), most_placed(drum));
}

static void check_room(const scene_inputs *inputs, const dem_scene_definition *drum, problem_list *problems)
{
    const double fill = drum->fill_fraction, most = most_fill(drum);
    if (fill <= MOST_FILL && fill > most * (1.0 + 1e-9))
        problem_list_add(problems, isnan(inputs->particle_count) ? "/inputs/fill_fraction" : "/inputs/particle_count",
                         "makes a fill of %g; must be at most %.3g, what particles of these shapes can be packed to%s%s", fill,
                         most, drum->lifters.count ? " beside these lifters" : "",
                         drum->lining.diameter > 0.0 ? " within this lining" : "");
}

static void check_beds(const scene_inputs *inputs, const dem_scene_definition *drum, problem_list *problems)
{
    const double spheres = inputs->beds * (double)drum->particle_count * scene_spheres_a_particle(drum);
    if (!(inputs->beds > 1.0)) return;
    if (!isnan(inputs->start.given))
        problem_list_add(problems, "/inputs/beds", "is %.0f, but all would be the bed that start names; leave one of the two out",
                         inputs->beds);
    if (inputs->stage_count > 0)
        problem_list_add(problems, "/inputs/beds", "is %.0f, but the results of stages are of one bed; leave one of the two out",
                         inputs->beds);
    if (spheres > SCENE_MOST_PARTICLES)
        problem_list_add(problems, "/inputs/beds", "is %.0f, which makes %.3g spheres in all; must make at most %.0f", inputs->beds,
                         spheres, SCENE_MOST_PARTICLES);
}

static void check_least(const scene_inputs *inputs, double count, problem_list *problems)
{
    const bool starts = !isnan(inputs->start.given);
    if (starts && isnan(count) && isnan(inputs->fill_fraction) && problem_list_is_empty(problems))
        problem_list_add(problems, "/inputs/particle_count",
                         "is missing; must be given where the bed that start names is not at hand to be counted");
    if (!starts && count < LEAST_PARTICLES)
        problem_list_add(problems, "/inputs/particle_count", "is %.0f; must be in [%g, %.0f]", count, LEAST_PARTICLES,
                         SCENE_MOST_PARTICLES);
}

static void derive_particle_count(scene_inputs *inputs, dem_scene_definition *drum, problem_list *problems)
{
    if (start_count_particles(inputs, drum, problems)) return;
    double count = inputs->particle_count;
    drum->fill_fraction = inputs->fill_fraction;
    check_least(inputs, count, problems);
    if (!isnan(count)) {
        drum->fill_fraction = dem_fill_of_particles(drum->diameter, drum->length, count, drum->species, drum->species_count);
        if (drum->fill_fraction > 0.95)
            problem_list_add(problems, "/inputs/particle_count",
                             "is %.0f, a fill fraction of %.3g; must be at most "
                             "%.0f, a fill fraction of 0.95",
                             count, drum->fill_fraction, floor(count * 0.95 / drum->fill_fraction));
    } else {
        count = dem_particles_of_fill(drum->diameter, drum->length, inputs->fill_fraction, drum->species, drum->species_count);
        if (count < 8.0 || count > SCENE_MOST_PARTICLES)
            problem_list_add(problems, "/inputs/fill_fraction",
                             "is %g, which makes %.3g particles; must make 8 to "
                             "%.0f",
                             inputs->fill_fraction, count, SCENE_MOST_PARTICLES);
    }
    scene_check_every_species(inputs, drum, count, problems);
    const double spheres = count * scene_spheres_a_particle(drum);
    if (count <= SCENE_MOST_PARTICLES && spheres > SCENE_MOST_PARTICLES)
        problem_list_add(problems, isnan(inputs->particle_count) ? "/inputs/fill_fraction" : "/inputs/particle_count",
                         "makes %.3g spheres; must make at most %.0f", spheres, SCENE_MOST_PARTICLES);
    drum->particle_count = count >= 0.0 && count <= SCENE_MOST_PARTICLES ? (size_t)count : 0;
}

static void check_tilt(const scene_inputs *inputs, problem_list *problems)
{
    if (inputs->tilt_deg > 0.0 && inputs->drum_ends == 0.0)
        problem_list_add(problems, "/inputs/drum/tilt_deg",
                         "is %g degrees, but the drum's ends are periodic, so that nothing holds the bed along the axis; give "
                         "/inputs/drum/ends as \"walls\", too",
                         inputs->tilt_deg);
}

/* NaN stays NaN. Along a tilted axis a particle may slide for all its length. */
static double largest_impact(const scene_inputs *inputs, const dem_scene_definition *drum)
{
    double speed = dem_impact_speed(drum->diameter, scene_of_species(drum, dem_species_diameter, true), drum->gravity,
                                    dem_bed_friction(inputs->friction, drum->species, drum->species_count), drum->rotation_rate);
    if (drum->tilt > 0.0 && speed > 0.0) speed = fmax(speed, sqrt(2.0 * drum->gravity * sin(drum->tilt) * drum->length));
    if (drum->lifters.count == 0) return speed;
    return fmax(speed, dem_lifted_speed(drum->diameter, drum->gravity, drum->fill_fraction, drum->rotation_rate));
}

/* rate: rad/s, the fastest. Returns what scene_derive_contact does. */
static double derive_drum(scene_inputs *inputs, double rate, dem_scene_definition *drum, problem_list *problems)
{
    *drum = (dem_scene_definition){
        .diameter = inputs->drum_diameter,
        .length = inputs->drum_length,
        .rotation_rate = fabs(rate),
        .tilt = inputs->tilt_deg > 0.0 ? inputs->tilt_deg * DEM_PI / 180.0 : 0.0, /* not of NaN */
        .gravity = inputs->gravity,
        .is_placed = !isnan(inputs->start.given),
        .seed = isnan(inputs->seed) ? 0 : (uint64_t)inputs->seed,
        .threads = isnan(inputs->threads) ? 1 : (int)inputs->threads,
    };
    if (!isnan(inputs->lining_diameter)) drum->lining = (dem_lining){ inputs->lining_diameter, inputs->lining_pitch };
    if (has_end_walls(inputs)) drum->ends = (dem_drum_ends){ true, inputs->end_friction, inputs->end_rolling_friction };
    const double lean = isnan(inputs->lifter_angle_deg) ? 0.0 : inputs->lifter_angle_deg * DEM_PI / 180.0;
    if (inputs->lifter_count > 0.0)
        drum->lifters = (dem_lifters){ .count = (size_t)inputs->lifter_count,
                                       .height = inputs->lifter_height,
                                       .width = inputs->lifter_width,
                                       .friction = inputs->lifter_friction,
                                       .angle = turns_back(inputs) ? -lean : lean };
    stages_define(inputs, drum);
    scene_derive_species(inputs, drum, problems);
    check_sizes(inputs, drum, problems);
    check_lining(inputs, problems);
    check_ends(inputs, problems);
    check_tilt(inputs, problems);
    const bool good_lifters = lifters_check(inputs, drum, problems);
    derive_particle_count(inputs, drum, problems);
    if (good_lifters && !drum->is_placed) check_room(inputs, drum, problems);
    return scene_derive_contact(inputs, largest_impact(inputs, drum), drum, problems);
}

void drum_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems)
{
    scene_inputs *inputs = &spec->inputs;
    json_t *origin = start_find(spec, problems);
    derive_rotation(spec, problems);
    if (inputs->start.particle_count == 0) scene_share_out(inputs, problems);
    set_dependent_defaults(inputs, spec->duration, seed_if_missing);
    spec->expected_overlap = derive_drum(inputs, spec->rotation_rate, &spec->scene, problems);
    scene_set_common(spec);
    scene_check_amounts(spec,
                        inputs->stage_count > 0            ? "/inputs/drum/rotation"
                        : spec->until_standard_error > 0.0 ? "/inputs/duration/at_most_revolutions"
                        : isnan(inputs->revolutions)       ? "/inputs/duration/seconds"
                                                           : "/inputs/duration/revolutions",
                        problems);
    check_beds(inputs, &spec->scene, problems);
    start_check_particles(inputs, &spec->scene, problems);
    start_compare(spec, origin, problems);
    json_decref(origin);
    mirror(spec);
}
