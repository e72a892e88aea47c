/* From particles and contacts as asked for to what a scene is made of: the same for every container.
 *
 * Inputs that were refused are NaN. Every check here is a comparison that is false for NaN, so that one mistake
 * is reported once. */
#include "scene_rules.h"

#include <math.h>
#include <stdio.h>

#include "cohesion_rules.h"
#include "dem_cluster.h"
#include "dem_rules.h"
#include "pair_rules.h"
#include "size_rules.h"

#define MOST_STEPS 1e10
#define MOST_SNAPSHOTS 1e5
#define MOST_SNAPSHOT_BYTES 1e12
#define MOST_SAMPLES 2e5
#define MOST_TRACED 1e6
#define MOST_SHARE_ERROR 1.000001e-4 /* of the sum of shares, which are often given in four digits */
#define LEAST_RESTITUTION 0.1        /* as restitution's own range has it */

double scene_spheres_a_particle(const dem_scene_definition *scene)
{
    double mean = 0.0;
    for (size_t s = 0; s < scene->species_count; s++)
        mean += scene->species[s].share * fmax(1.0, (double)scene->species[s].cluster.sphere_count);
    return mean;
}

double scene_of_species(const dem_scene_definition *scene, double (*number)(const dem_species *), bool largest)
{
    double found = NAN;
    for (size_t s = 0; s < scene->species_count; s++) {
        const double value = number(&scene->species[s]);
        found = largest ? fmax(found, value) : fmin(found, value); /* fmax and fmin pass over NaN */
    }
    return found;
}

double scene_species_width(const dem_species *species) { return 2.0 * dem_species_reach(species); }

void scene_share_out(scene_inputs *inputs, problem_list *problems)
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
    } else if (fabs(sum - 1.0) > MOST_SHARE_ERROR) {
        problem_list_add(problems, "/inputs/particles", "have shares that sum to %.12g; must sum to 1", sum);
    }
}

/* Shares by volume or mass into shares by number: a species of large particles has few of them. */
static void shares_to_numbers(const scene_inputs *inputs, dem_scene_definition *scene)
{
    double sum = 0.0;
    for (size_t s = 0; s < scene->species_count; s++) {
        dem_species *species = &scene->species[s];
        if (inputs->share_by > SHARE_BY_NUMBER) species->share /= dem_species_volume(species);
        if (inputs->share_by == SHARE_BY_MASS) species->share /= species->density;
        sum += species->share;
    }
    for (size_t s = 0; s < scene->species_count; s++) scene->species[s].share /= sum;
}

void scene_check_every_species(const scene_inputs *inputs, const dem_scene_definition *scene, double count, problem_list *problems)
{
    if (count < 8.0 || inputs->species_count == 1) return; /* that is then what is wrong, or nothing can be */
    for (size_t s = 0; s < inputs->species_count; s++) {
        if (!(count * scene->species[s].share < 0.5)) continue;
        char pointer[60];
        snprintf(pointer, sizeof pointer, "/inputs/particles/%zu/share", s);
        problem_list_add(problems, pointer,
                         "is %g, which makes %.3g of %.0f particles; must make at least one: give a larger share or more particles",
                         inputs->species[s].share, count * scene->species[s].share, count);
    }
}

void scene_derive_species(scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems)
{
    materials_complete(inputs, problems);
    scene->species_count = inputs->species_count;
    for (size_t s = 0; s < inputs->species_count; s++) {
        species_inputs *species = &inputs->species[s];
        scene->species[s] =
            (dem_species){ .diameter = species->diameter, .density = material_density(inputs, species), .share = species->share };
        const bool is_cluster = species->shape > DEM_SPHERE, has_left = is_cluster && client_has_left(inputs->client);
        if (has_left) problem_list_add(problems, "/inputs/particles", "was not read to its end: who asked has left");
        if (isnan(species->shape) || has_left) scene->species[s].diameter = NAN; /* refused */
        else if (is_cluster) scene_cluster_derive(inputs->memory, species, s, &scene->species[s].cluster, problems);
        if (scene->species[s].cluster.sphere_count) scene->species[s].diameter = dem_species_largest_sphere(&scene->species[s]);
        sizes_derive(species, s, &scene->species[s], problems);
    }
    if (scene->species_count == 0) { /* a refused list: not a number, so that nothing is said of what follows from it */
        scene->species_count = 1;
        scene->species[0] = (dem_species){ .diameter = NAN, .density = NAN, .share = NAN };
    }
    shares_to_numbers(inputs, scene);
}

void scene_check_size_ratio(const dem_scene_definition *scene, problem_list *problems)
{
    const double largest_sphere = scene_of_species(scene, dem_species_largest_sphere, true);
    const double smallest_sphere = scene_of_species(scene, dem_species_smallest_sphere, false);
    const double beyond = largest_sphere / (SCENE_MOST_SIZE_RATIO * smallest_sphere);
    if (beyond > 1.0 && dem_have_sizes(scene->species, scene->species_count))
        problem_list_add(
            problems, "/inputs/particles",
            "have diameters from %g m to %g m; the largest must be at most %g of the smallest: at this ratio a run takes "
            "%.3g times as many steps as at that",
            smallest_sphere, largest_sphere, SCENE_MOST_SIZE_RATIO, pow(beyond, 2.5));
    else if (beyond > 1.0)
        problem_list_add(problems, "/inputs/particles",
                         "have diameters from %g m to %g m; the largest must be at "
                         "most %g of the smallest",
                         smallest_sphere, largest_sphere, SCENE_MOST_SIZE_RATIO);
}

static void check_unloading(const scene_inputs *inputs, problem_list *problems)
{
    if (!isnan(inputs->unloading_slope) && inputs->unloading == 0.0)
        problem_list_add(problems, "/inputs/contact/unloading_slope",
                         "is %g 1/m, but unloading is \"constant\"; give restitution, or unloading \"variable\"",
                         inputs->unloading_slope);
    if (inputs->unloading == 1.0 && inputs->contact_law > DEM_WALTON_BRAUN)
        problem_list_add(
            problems, "/inputs/contact/unloading",
            "is \"variable\", but this law has no unloading branch; must be \"constant\", or the law \"walton-braun\"");
}

static void check_rolling(const scene_inputs *inputs, problem_list *problems)
{
    if (isnan(inputs->rolling_damping) || isnan(inputs->rolling_law) || inputs->rolling_law == (double)DEM_EPSD_DAMPED) return;
    problem_list_add(
        problems, "/inputs/contact/rolling_damping",
        "is %g, but rolling_law is \"%s\", which has no share of damping to choose; give rolling_law as \"epsd-damped\", "
        "too",
        inputs->rolling_damping, inputs->rolling_law > 0.0 ? "constant" : "epsd");
}

/* S of variable unloading and the restitution of the hardest impact, one from the other: e^2 = K1/K2 = 1/(1 + S alpha_max). */
static void derive_unloading(const scene_inputs *inputs, const collision *worst, dem_scene_definition *scene,
                             problem_list *problems)
{
    const double overlap = worst->speed * sqrt(worst->heaviest / scene->contact.stiffness);
    if (isnan(inputs->unloading_slope)) {
        scene->contact.unloading_slope = (1.0 / (inputs->restitution * inputs->restitution) - 1.0) / overlap;
        return;
    }
    scene->contact.unloading_slope = inputs->unloading_slope;
    scene->contact.restitution = 1.0 / sqrt(1.0 + inputs->unloading_slope * overlap);
    const double most = (1.0 / (LEAST_RESTITUTION * LEAST_RESTITUTION) - 1.0) / overlap;
    if (inputs->unloading_slope > most)
        problem_list_add(
            problems, "/inputs/contact/unloading_slope",
            "is %g 1/m, which leaves the hardest impact expected a restitution of %.3g; must be at most %.4g 1/m here, "
            "for %g",
            inputs->unloading_slope, scene->contact.restitution, most, LEAST_RESTITUTION);
}

/* Of the fastest impact; with variable unloading that may be another than the one that restitution is of. */
static double least_restitution(const dem_contact_parameters *contact, const collision *worst)
{
    if (contact->unloading_slope == 0.0 || !(worst->fastest > worst->speed)) return contact->restitution;
    const double overlap = worst->fastest * sqrt(worst->heaviest / contact->stiffness);
    return 1.0 / sqrt(1.0 + contact->unloading_slope * overlap);
}

/* Loading stiffness K1, and from it the time step. Returns the largest overlap expected, as a share of the smallest diameter. */
static double derive_linear(const scene_inputs *inputs, const collision *worst, dem_scene_definition *scene, problem_list *problems)
{
    const double least = dem_stiffness_for_overlap(worst->speed, worst->heaviest, MOST_OVERLAP * worst->smallest);
    if (inputs->stiffness < least)
        problem_list_add(problems, "/inputs/contact/stiffness",
                         "is %g N/m, too soft: overlaps would pass %g of the "
                         "smallest diameter; must be at least %.3g N/m here",
                         inputs->stiffness, MOST_OVERLAP, least);
    scene->contact.stiffness =
        isnan(inputs->maximum_overlap)
            ? inputs->stiffness
            : larger_of(dem_stiffness_for_overlap(worst->speed, worst->heaviest, inputs->maximum_overlap * worst->smallest),
                        cohesion_stiffness(worst, inputs->maximum_overlap));
    if (inputs->unloading == 1.0 && scene->contact.law == DEM_WALTON_BRAUN) derive_unloading(inputs, worst, scene, problems);
    if (scene->contact.law == DEM_SPRING_DASHPOT)
        scene->time_step = dem_time_step(scene->contact.stiffness, worst->lightest, scene->contact.restitution);
    else
        scene->time_step =
            dem_latching_time_step(scene->contact.stiffness, worst->lightest, least_restitution(&scene->contact, worst));
    return worst->speed * sqrt(worst->heaviest / scene->contact.stiffness) / worst->smallest;
}

/* Young's modulus E, the same for particles and wall, hence E* = E/(2 (1 - nu^2)); and from it the time step. What is
 * reported as stiffness is the chord of the Hertzian curve up to the largest overlap expected. */
static double derive_hertzian(const scene_inputs *inputs, const collision *worst, dem_scene_definition *scene,
                              problem_list *problems)
{
    const double radius = 0.5 * worst->largest, plane_strain = 2 * (1 - inputs->poissons_ratio * inputs->poissons_ratio);
    const double least =
        plane_strain * dem_hertz_modulus_for_overlap(worst->speed, worst->heaviest, radius, MOST_OVERLAP * worst->smallest);
    if (inputs->youngs_modulus < least)
        problem_list_add(problems, "/inputs/contact/youngs_modulus",
                         "is %g Pa, too soft: overlaps would pass %g of the "
                         "smallest diameter; must be at least %.3g Pa here",
                         inputs->youngs_modulus, MOST_OVERLAP, least);
    const double effective = isnan(inputs->youngs_modulus)
                                 ? larger_of(dem_hertz_modulus_for_overlap(worst->speed, worst->heaviest, radius,
                                                                           inputs->maximum_overlap * worst->smallest),
                                             cohesion_modulus(worst, inputs->maximum_overlap))
                                 : inputs->youngs_modulus / plane_strain;
    const double overlap = worst->smallest * MOST_OVERLAP * pow(least / (effective * plane_strain), 0.4);
    scene->contact.particle = scene->contact.wall = (dem_elasticity){ effective * plane_strain, inputs->poissons_ratio };
    scene->contact.stiffness = 4.0 / 3.0 * effective * sqrt(radius * overlap);
    scene->time_step = dem_hertz_time_step(effective, worst->lightest, 0.25 * worst->smallest, worst->fastest);
    return overlap / worst->smallest;
}

/* Sum of the two largest speeds, m/s. */
static double fastest_meeting(const start_inputs *start)
{
    double first = 0.0, second = 0.0;
    for (size_t k = 0; k < start->particle_count; k++) {
        const double *v = start->particles[k].velocity, speed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        if (!(speed > second)) continue;
        second = fmin(speed, first);
        first = fmax(speed, first);
    }
    return first + second;
}

double scene_derive_contact(scene_inputs *inputs, double impact_speed, dem_scene_definition *scene, problem_list *problems)
{
    const dem_contact_law law =
        inputs->contact_law > 0.0 ? (dem_contact_law)inputs->contact_law : DEM_WALTON_BRAUN; /* not of NaN */
    collision worst = { scene_of_species(scene, dem_species_heaviest, true),
                        scene_of_species(scene, dem_species_contact_mass, false),
                        scene_of_species(scene, dem_species_smallest_sphere, false),
                        scene_of_species(scene, dem_species_largest_sphere, true),
                        impact_speed,
                        fmax(impact_speed, fastest_meeting(&inputs->start)),
                        0.0 };
    scene->contact = (dem_contact_parameters){
        .law = law,
        .restitution = inputs->restitution,
        .latch_damping = inputs->latch_damping,
        .friction = inputs->friction,
        .wall_friction = inputs->wall_friction,
        .tangential_stiffness_ratio = inputs->tangential_stiffness_ratio,
        .rolling_friction = inputs->rolling_friction,
        .wall_rolling_friction = inputs->wall_rolling_friction,
        .rolling_law = inputs->rolling_law > 0.0 ? (dem_rolling_law)inputs->rolling_law : DEM_EPSD, /* not of NaN */
        .rolling_damping = isnan(inputs->rolling_damping) ? 0.3 : inputs->rolling_damping,
    };
    check_unloading(inputs, problems);
    check_rolling(inputs, problems);
    worst.pull = cohesion_derive(inputs, scene, problems);
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
    double overlap = (law == DEM_HERTZ_MINDLIN ? derive_hertzian : derive_linear)(inputs, &worst, scene, problems);
    const double usual_steps = pairs_derive(inputs, &worst, &overlap, scene, problems);
    const double largest = cohesion_complete(inputs, &worst, overlap, scene, problems);
    if (isnan(inputs->steps_per_contact)) inputs->steps_per_contact = usual_steps;
    scene->time_step *= DEM_STEPS_PER_CONTACT / inputs->steps_per_contact;
    return largest;
}

static void check_tracers(const job_spec *spec, double samples, problem_list *problems)
{
    const scene_inputs *inputs = &spec->inputs;
    for (size_t k = 0; k < inputs->tracer_count; k++) {
        char pointer[40];
        const double id = inputs->tracer[k];
        size_t before = 0;
        snprintf(pointer, sizeof pointer, "/inputs/tracers/%zu", k);
        while (inputs->tracer[before] != id) before++;
        if (id != floor(id)) problem_list_add(problems, pointer, "is %g; must be a whole number", id);
        else if (before < k) problem_list_add(problems, pointer, "is %g, as is tracers/%zu; give each particle once", id, before);
        else if (id >= (double)spec->scene.particle_count)
            problem_list_add(problems, pointer, "is %.0f; must be at most %zu: there are %zu particles, counted from 0", id,
                             spec->scene.particle_count - 1, spec->scene.particle_count);
    }
    if (samples * (double)inputs->tracer_count > MOST_TRACED)
        problem_list_add(
            problems, "/inputs/tracers",
            "are %zu, of %.3g samples each; must make at most %.0f places in all: follow fewer, or give a longer samples/interval",
            inputs->tracer_count, samples, MOST_TRACED);
}

void scene_check_amounts(const job_spec *spec, const char *duration, problem_list *problems)
{
    if (problem_list_is_empty(problems)) sizes_check_cost(spec, problems);
    const job_estimate estimate = job_spec_estimate(spec, 0);
    if (estimate.steps > MOST_STEPS)
        problem_list_add(problems, duration,
                         "makes %.3g steps of %.3g s; must make at most %.3g: shorten the "
                         "duration or allow a larger overlap",
                         estimate.steps, spec->scene.time_step, MOST_STEPS);
    if (spec->duration < SCENE_SAMPLES_PER_RUN * spec->scene.time_step)
        problem_list_add(problems, duration, "is %.3g s; must be at least %.3g s, %g time steps", spec->duration,
                         SCENE_SAMPLES_PER_RUN * spec->scene.time_step, SCENE_SAMPLES_PER_RUN);
    else if (spec->sample_interval < spec->scene.time_step)
        problem_list_add(problems, "/inputs/samples/interval", "is %g s; must be at least the time step, %.3g s",
                         spec->sample_interval, spec->scene.time_step);
    const double samples = spec->duration / spec->sample_interval;
    if (samples > MOST_SAMPLES)
        problem_list_add(problems, "/inputs/samples/interval", "is %g s, %.3g samples in all; must make at most %.0f",
                         spec->sample_interval, samples, MOST_SAMPLES);
    check_tracers(spec, samples, problems);
    if (spec->snapshot_interval > 0.0 && spec->snapshot_interval < spec->scene.time_step)
        problem_list_add(problems, "/inputs/snapshots/interval", "is %g s; must be 0 or at least the time step, %.3g s",
                         spec->snapshot_interval, spec->scene.time_step);
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

void scene_set_common(job_spec *spec)
{
    const scene_inputs *inputs = &spec->inputs;
    spec->maximum_overlap = isnan(inputs->maximum_overlap) ? 0.0 : inputs->maximum_overlap;
    spec->sample_interval = inputs->sample_interval;
    spec->snapshot_interval = inputs->snapshot_interval;
    spec->bed_count = inputs->beds >= 1.0 ? (size_t)inputs->beds : 1;
    job_spec_set_threads(spec, spec->scene.threads);
    spec->bond_number = spec->scene.contact.cohesion_law ? cohesion_bond_number(&spec->scene) : NAN;
    spec->scene.corrector_passes = isnan(inputs->corrector_passes) ? 1 : (int)inputs->corrector_passes;
}
