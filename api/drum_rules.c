/* From inputs, each within its own range, to a definition of a drum that can be run.
 *
 * Inputs that were refused are NaN. Every check here is a comparison that is false for NaN, so that one mistake
 * is reported once. */
#include <math.h>

#include "dem_cluster.h"
#include "dem_rules.h"
#include "drum_process.h"

/* Results need 8 frames; one frame's angle has an error of a degree or more, so a run of any length gets at least
 * 64 of them, and one revolution at least 40. */
#define SAMPLE_INTERVAL_MOST 0.05 /* s: 20 frames a second */
#define SAMPLES_PER_RUN 64.0
#define SAMPLES_PER_REVOLUTION 40.0

#define MOST_PARTICLES 5e6
#define MOST_STEPS 1e10
#define MOST_SNAPSHOTS 1e5
#define MOST_SNAPSHOT_BYTES 1e12
#define MOST_SAMPLES 2e5
#define MOST_SIZE_RATIO 20.0
#define LEAST_DRUM_DIAMETERS 8.0   /* a bed a few particles deep has no surface to speak of */
#define LEAST_LENGTH_DIAMETERS 3.0 /* below, a particle would feel its own periodic image */
#define MOST_OVERLAP 0.25          /* of the smallest diameter: beyond half a radius a run is stopped */

static double of_species(const dem_drum_definition *drum, double (*number)(const dem_species *), bool largest)
{
    double found = NAN;
    for (size_t s = 0; s < drum->species_count; s++) {
        const double value = number(&drum->species[s]);
        found = largest ? fmax(found, value) : fmin(found, value); /* fmax and fmin pass over NaN */
    }
    return found;
}

/* Of the sphere that holds a particle. */
static double species_width(const dem_species *species) { return 2.0 * dem_species_reach(species); }

static void share_out(drum_inputs *inputs, problem_list *problems)
{
    size_t given = 0;
    double sum = 0.0;
    for (size_t s = 0; s < inputs->species_count; s++) {
        given += !isnan(inputs->species[s].share);
        sum += isnan(inputs->species[s].share) ? 0.0 : inputs->species[s].share;
    }
    if (given == 0) {
        for (size_t s = 0; s < inputs->species_count; s++) inputs->species[s].share = 1.0 / (double)inputs->species_count;
    } else if (given < inputs->species_count) {
        problem_list_add(problems, "/inputs/particles",
                         "have a valid share in %zu of %zu entries; give it in all or "
                         "in none",
                         given, inputs->species_count);
    } else if (fabs(sum - 1.0) > 1e-9) {
        problem_list_add(problems, "/inputs/particles", "have shares that sum to %.12g; must sum to 1", sum);
    }
}

/* Asked for by revolutions, seconds, or by the error wanted. */
static void derive_duration(drum_inputs *inputs, job_spec *spec, problem_list *problems)
{
    enum { USUAL_MOST_REVOLUTIONS = 10 };
    const double revolution = 2.0 * DEM_PI / inputs->rotation_rate;
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

static void set_dependent_defaults(drum_inputs *inputs, double duration, uint64_t seed_if_missing)
{
    if (isnan(inputs->lining_pitch)) inputs->lining_pitch = inputs->lining_diameter;
    if (isnan(inputs->seed)) inputs->seed = (double)(seed_if_missing & ((UINT64_C(1) << 53) - 1));
    if (isnan(inputs->sample_interval)) {
        const double revolution = 2.0 * DEM_PI / inputs->rotation_rate;
        inputs->sample_interval = fmin(SAMPLE_INTERVAL_MOST, fmin(duration / SAMPLES_PER_RUN, revolution / SAMPLES_PER_REVOLUTION));
    }
}

static void check_sizes(const drum_inputs *inputs, const dem_drum_definition *drum, problem_list *problems)
{
    const double largest = of_species(drum, species_width, true);
    const double largest_sphere = of_species(drum, dem_species_largest_sphere, true);
    const double smallest_sphere = of_species(drum, dem_species_smallest_sphere, false);
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
    if (largest_sphere > MOST_SIZE_RATIO * smallest_sphere)
        problem_list_add(problems, "/inputs/particles",
                         "have diameters from %g m to %g m; the largest must be at "
                         "most %g of the smallest",
                         smallest_sphere, largest_sphere, MOST_SIZE_RATIO);
}

static void check_lining(const drum_inputs *inputs, problem_list *problems)
{
    const double most = inputs->drum_diameter / LEAST_DRUM_DIAMETERS;
    if (inputs->lining_diameter > most)
        problem_list_add(problems, "/inputs/wall/lining/diameter",
                         "is %g m; must be at most %g m, 1/%g of the drum's "
                         "diameter",
                         inputs->lining_diameter, most, LEAST_DRUM_DIAMETERS);
    if (inputs->lining_pitch < 0.5 * inputs->lining_diameter)
        problem_list_add(problems, "/inputs/wall/lining/pitch",
                         "is %g m; must be at least %g m, half the diameter of "
                         "the lining's spheres",
                         inputs->lining_pitch, 0.5 * inputs->lining_diameter);
    if (inputs->lining_pitch > inputs->drum_length)
        problem_list_add(problems, "/inputs/wall/lining/pitch", "is %g m; must be at most %g m, the drum's length",
                         inputs->lining_pitch, inputs->drum_length);
    const double spheres = DEM_PI * inputs->drum_diameter * inputs->drum_length / (inputs->lining_pitch * inputs->lining_pitch);
    if (spheres > MOST_PARTICLES)
        problem_list_add(problems, "/inputs/wall/lining/pitch",
                         "is %g m, which needs %.3g spheres; at most %.3g are "
                         "allowed",
                         inputs->lining_pitch, spheres, MOST_PARTICLES);
}

static void derive_species(drum_inputs *inputs, dem_drum_definition *drum, problem_list *problems)
{
    double sum = 0.0;
    for (size_t s = 0; s < inputs->species_count; s++) sum += inputs->species[s].share;
    drum->species_count = inputs->species_count;
    for (size_t s = 0; s < inputs->species_count; s++) {
        species_inputs *species = &inputs->species[s];
        drum->species[s] =
            (dem_species){ .diameter = species->diameter, .density = species->density, .share = species->share / sum };
        if (isnan(species->shape)) drum->species[s].diameter = NAN; /* refused */
        else if (species->shape != DEM_SPHERE) drum_cluster_derive(species, s, &drum->species[s].cluster, problems);
        if (drum->species[s].cluster.sphere_count) drum->species[s].diameter = dem_species_largest_sphere(&drum->species[s]);
    }
    if (drum->species_count == 0) { /* a refused list: not a number, so that nothing is said of what follows from it */
        drum->species_count = 1;
        drum->species[0] = (dem_species){ .diameter = NAN, .density = NAN, .share = NAN };
    }
}

static void derive_particle_count(const drum_inputs *inputs, dem_drum_definition *drum, problem_list *problems)
{
    double count = inputs->particle_count;
    drum->fill_fraction = inputs->fill_fraction;
    if (!isnan(count)) {
        drum->fill_fraction = dem_fill_of_particles(drum->diameter, drum->length, count, drum->species, drum->species_count);
        if (drum->fill_fraction > 0.95)
            problem_list_add(problems, "/inputs/particle_count",
                             "is %.0f, a fill fraction of %.3g; must be at most "
                             "%.0f, a fill fraction of 0.95",
                             count, drum->fill_fraction, floor(count * 0.95 / drum->fill_fraction));
    } else {
        count = dem_particles_of_fill(drum->diameter, drum->length, inputs->fill_fraction, drum->species, drum->species_count);
        if (count < 8.0 || count > MOST_PARTICLES)
            problem_list_add(problems, "/inputs/fill_fraction",
                             "is %g, which makes %.3g particles; must make 8 to "
                             "%.0f",
                             inputs->fill_fraction, count, MOST_PARTICLES);
    }
    const double spheres = count * drum_spheres_a_particle(drum);
    if (count <= MOST_PARTICLES && spheres > MOST_PARTICLES)
        problem_list_add(problems, isnan(inputs->particle_count) ? "/inputs/fill_fraction" : "/inputs/particle_count",
                         "makes %.3g spheres; must make at most %.0f", spheres, MOST_PARTICLES);
    drum->particle_count = count >= 0.0 && count <= MOST_PARTICLES ? (size_t)count : 0;
}

/* What stiffness is chosen for: the heaviest particle at the speed at which it meets the wall. */
typedef struct collision {
    double heaviest, lightest; /* kg; the lightest that a contact can move */
    double smallest, largest;  /* m, diameters of spheres, also those of clusters */
    double speed;              /* m/s */
} collision;

/* Loading stiffness K1, and from it the time step. */
static void derive_linear(const drum_inputs *inputs, const collision *worst, dem_drum_definition *drum, problem_list *problems)
{
    const double least = dem_stiffness_for_overlap(worst->speed, worst->heaviest, MOST_OVERLAP * worst->smallest);
    if (inputs->stiffness < least)
        problem_list_add(problems, "/inputs/contact/stiffness",
                         "is %g N/m, too soft: overlaps would pass %g of the "
                         "smallest diameter; must be at least %.3g N/m here",
                         inputs->stiffness, MOST_OVERLAP, least);
    drum->contact.stiffness = isnan(inputs->maximum_overlap) ? inputs->stiffness
                                                             : dem_stiffness_for_overlap(worst->speed, worst->heaviest,
                                                                                         inputs->maximum_overlap * worst->smallest);
    drum->time_step = dem_time_step(drum->contact.stiffness, worst->lightest, inputs->restitution);
}

/* Young's modulus E, the same for particles and wall, hence E* = E/(2 (1 - nu^2)); and from it the time step. What is
 * reported as stiffness is the chord of the Hertzian curve up to the largest overlap expected. */
static void derive_hertzian(const drum_inputs *inputs, const collision *worst, dem_drum_definition *drum, problem_list *problems)
{
    const double radius = 0.5 * worst->largest, plane_strain = 2 * (1 - inputs->poissons_ratio * inputs->poissons_ratio);
    const double least =
        plane_strain * dem_hertz_modulus_for_overlap(worst->speed, worst->heaviest, radius, MOST_OVERLAP * worst->smallest);
    if (inputs->youngs_modulus < least)
        problem_list_add(problems, "/inputs/contact/youngs_modulus",
                         "is %g Pa, too soft: overlaps would pass %g of the "
                         "smallest diameter; must be at least %.3g Pa here",
                         inputs->youngs_modulus, MOST_OVERLAP, least);
    const double effective =
        isnan(inputs->youngs_modulus)
            ? dem_hertz_modulus_for_overlap(worst->speed, worst->heaviest, radius, inputs->maximum_overlap * worst->smallest)
            : inputs->youngs_modulus / plane_strain;
    const double overlap = worst->smallest * MOST_OVERLAP * pow(least / (effective * plane_strain), 0.4);
    drum->contact.particle = drum->contact.wall = (dem_elasticity){ effective * plane_strain, inputs->poissons_ratio };
    drum->contact.stiffness = 4.0 / 3.0 * effective * sqrt(radius * overlap);
    drum->time_step = dem_hertz_time_step(effective, worst->lightest, 0.25 * worst->smallest, worst->speed);
}

static void derive_contact(const drum_inputs *inputs, dem_drum_definition *drum, problem_list *problems)
{
    const dem_contact_law law = (dem_contact_law)inputs->contact_law;
    collision worst = { of_species(drum, dem_species_mass, true), of_species(drum, dem_species_contact_mass, false),
                        of_species(drum, dem_species_smallest_sphere, false), of_species(drum, dem_species_largest_sphere, true),
                        0.0 };
    worst.speed = dem_impact_speed(drum->diameter, of_species(drum, dem_species_diameter, true), drum->gravity,
                                   dem_bed_friction(inputs->friction, drum->species, drum->species_count), drum->rotation_rate);
    drum->contact = (dem_contact_parameters){
        .law = law,
        .restitution = inputs->restitution,
        .friction = inputs->friction,
        .wall_friction = inputs->wall_friction,
        .tangential_stiffness_ratio = inputs->tangential_stiffness_ratio,
    };
    if (law == DEM_HERTZ_MINDLIN && !isnan(inputs->stiffness))
        problem_list_add(problems, "/inputs/contact/stiffness",
                         "is %g N/m, but hertz-mindlin takes youngs_modulus (Pa) or "
                         "maximum_overlap",
                         inputs->stiffness);
    if (law != DEM_HERTZ_MINDLIN && !isnan(inputs->youngs_modulus))
        problem_list_add(problems, "/inputs/contact/youngs_modulus",
                         "is %g Pa, but this law takes stiffness (N/m) or "
                         "maximum_overlap; youngs_modulus is for hertz-mindlin",
                         inputs->youngs_modulus);
    (law == DEM_HERTZ_MINDLIN ? derive_hertzian : derive_linear)(inputs, &worst, drum, problems);
}

static void derive_drum(drum_inputs *inputs, dem_drum_definition *drum, problem_list *problems)
{
    *drum = (dem_drum_definition){
        .diameter = inputs->drum_diameter,
        .length = inputs->drum_length,
        .rotation_rate = inputs->rotation_rate,
        .gravity = inputs->gravity,
        .seed = isnan(inputs->seed) ? 0 : (uint64_t)inputs->seed,
        .threads = isnan(inputs->threads) ? 1 : (int)inputs->threads,
    };
    if (!isnan(inputs->lining_diameter)) drum->lining = (dem_lining){ inputs->lining_diameter, inputs->lining_pitch };
    derive_species(inputs, drum, problems);
    check_sizes(inputs, drum, problems);
    check_lining(inputs, problems);
    derive_particle_count(inputs, drum, problems);
    derive_contact(inputs, drum, problems);
}

static void check_amounts(const job_spec *spec, problem_list *problems)
{
    const drum_inputs *inputs = &spec->inputs;
    const job_estimate estimate = drum_estimate(spec, 0.0);
    const char *duration = spec->until_standard_error > 0.0 ? "/inputs/duration/at_most_revolutions"
                           : isnan(inputs->revolutions)     ? "/inputs/duration/seconds"
                                                            : "/inputs/duration/revolutions";
    if (estimate.steps > MOST_STEPS)
        problem_list_add(problems, duration,
                         "makes %.3g steps of %.3g s; must make at most %.3g: shorten the "
                         "duration or allow a larger overlap",
                         estimate.steps, spec->drum.time_step, MOST_STEPS);
    if (spec->duration < SAMPLES_PER_RUN * spec->drum.time_step)
        problem_list_add(problems, duration, "is %.3g s; must be at least %.3g s, %g time steps", spec->duration,
                         SAMPLES_PER_RUN * spec->drum.time_step, SAMPLES_PER_RUN);
    else if (spec->sample_interval < spec->drum.time_step)
        problem_list_add(problems, "/inputs/samples/interval", "is %g s; must be at least the time step, %.3g s",
                         spec->sample_interval, spec->drum.time_step);
    const double samples = spec->duration / spec->sample_interval;
    if (samples > MOST_SAMPLES)
        problem_list_add(problems, "/inputs/samples/interval", "is %g s, %.3g samples in all; must make at most %.0f",
                         spec->sample_interval, samples, MOST_SAMPLES);
    if (spec->snapshot_interval > 0.0 && spec->snapshot_interval < spec->drum.time_step)
        problem_list_add(problems, "/inputs/snapshots/interval", "is %g s; must be 0 or at least the time step, %.3g s",
                         spec->snapshot_interval, spec->drum.time_step);
    if (estimate.snapshots > MOST_SNAPSHOTS)
        problem_list_add(problems, "/inputs/snapshots/interval",
                         "is %g s, %.3g snapshots in all; must make at most "
                         "%.0f",
                         spec->snapshot_interval, estimate.snapshots, MOST_SNAPSHOTS);
    if (estimate.snapshot_bytes > MOST_SNAPSHOT_BYTES)
        problem_list_add(problems, "/inputs/snapshots/interval",
                         "is %g s, about %.3g bytes of snapshots; must make at "
                         "most %.0f bytes",
                         spec->snapshot_interval, estimate.snapshot_bytes, MOST_SNAPSHOT_BYTES);
}

void drum_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems)
{
    drum_inputs *inputs = &spec->inputs;
    derive_duration(inputs, spec, problems);
    share_out(inputs, problems);
    set_dependent_defaults(inputs, spec->duration, seed_if_missing);
    derive_drum(inputs, &spec->drum, problems);
    spec->maximum_overlap = isnan(inputs->maximum_overlap) ? 0.0 : inputs->maximum_overlap;
    spec->sample_interval = inputs->sample_interval;
    spec->snapshot_interval = inputs->snapshot_interval;
    spec->threads = spec->drum.threads;
    check_amounts(spec, problems);
}
