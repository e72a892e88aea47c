#include "standing_rules.h"

#include <math.h>

#include "dem_rules.h"

/* A snapshot: so much for the file's structure, and for each sphere after compression. */
#define SNAPSHOT_FILE_BYTES 30e3
#define SNAPSHOT_PARTICLE_BYTES 70.0 /* and of its frame */
#define FRAME_BYTES 100.0

void standing_derive_scene(scene_inputs *inputs, dem_scene_definition *scene, uint64_t seed_if_missing, problem_list *problems)
{
    if (isnan(inputs->seed)) inputs->seed = (double)(seed_if_missing & LARGEST_WHOLE_NUMBER);
    *scene = (dem_scene_definition){
        .gravity = inputs->gravity,
        .corrector_passes = isnan(inputs->corrector_passes) ? 1 : (int)inputs->corrector_passes,
        .seed = isnan(inputs->seed) ? 0 : (uint64_t)inputs->seed,
        .threads = isnan(inputs->threads) ? 1 : (int)inputs->threads,
    };
    scene_share_out(inputs, problems);
    scene_derive_species(inputs, scene, problems);
    scene_check_size_ratio(scene, problems);
}

double standing_area(const dem_scene_definition *scene)
{
    return scene->orifice.depth > 0.0 ? scene->diameter * scene->orifice.depth : DEM_PI / 4.0 * scene->diameter * scene->diameter;
}

static double particles_a_meter(const dem_scene_definition *scene)
{
    const double area = standing_area(scene);
    return DEM_BED_SOLID_FRACTION * area / dem_mean_volume(scene->species, scene->species_count);
}

double standing_bed_height(const dem_scene_definition *scene) { return (double)scene->particle_count / particles_a_meter(scene); }

void standing_derive_count(scene_inputs *inputs, dem_scene_definition *scene, double usual_height, double least,
                           problem_list *problems)
{
    if (isnan(inputs->particle_count) && isnan(inputs->fill_height)) inputs->fill_height = usual_height;
    const bool is_counted = !isnan(inputs->particle_count);
    const double count = is_counted ? inputs->particle_count : floor(inputs->fill_height * particles_a_meter(scene) + 0.5);
    if (is_counted && count < least)
        problem_list_add(problems, "/inputs/particle_count",
                         "is %.0f; must be at least %.0f here: fewer have no surface to measure", count, least);
    if (!is_counted && (count < least || count > SCENE_MOST_PARTICLES))
        problem_list_add(problems, "/inputs/fill_height",
                         "is %g m, which makes %.3g particles; must make %.0f to %.0f, fill_height in [%.3g, %.3g] m here",
                         inputs->fill_height, count, least, SCENE_MOST_PARTICLES, least / particles_a_meter(scene),
                         SCENE_MOST_PARTICLES / particles_a_meter(scene));
    scene_check_every_species(inputs, scene, count, problems);
    const double spheres = count * scene_spheres_a_particle(scene);
    if (count <= SCENE_MOST_PARTICLES && spheres > SCENE_MOST_PARTICLES)
        problem_list_add(problems, is_counted ? "/inputs/particle_count" : "/inputs/fill_height",
                         "makes %.3g spheres; must make at most %.0f", spheres, SCENE_MOST_PARTICLES);
    scene->particle_count = count >= 0.0 && count <= SCENE_MOST_PARTICLES ? (size_t)count : 0;
}

void standing_complete(job_spec *spec, const char *duration, problem_list *problems)
{
    scene_inputs *inputs = &spec->inputs;
    if (isnan(inputs->sample_interval))
        inputs->sample_interval = fmin(SCENE_SAMPLE_INTERVAL_MOST, spec->duration / SCENE_SAMPLES_PER_RUN);
    scene_set_common(spec);
    scene_check_amounts(spec, duration, problems);
}

job_estimate standing_estimate(const job_spec *spec, const calibration *machine, double seconds, double before, double share_inside)
{
    const dem_scene_definition *scene = &spec->scene;
    const double particles = (double)scene->particle_count, spheres = particles * scene_spheres_a_particle(scene);
    job_estimate estimate = {
        .particles = particles,
        .time_step = scene->time_step,
        .stiffness = scene->contact.stiffness,
        .simulated_seconds = seconds + before,
        .settling_seconds = NAN,
        .settling_seconds_low = NAN,
        .settling_seconds_high = NAN,
        .snapshots = spec->snapshot_interval > 0.0 ? floor(seconds / spec->snapshot_interval) + 2.0 : 1.0,
    };
    estimate.steps = ceil(estimate.simulated_seconds / scene->time_step);
    estimate.load = (calibration_load){ .spheres = share_inside * spheres,
                                        .of_particle = spheres / particles,
                                        .law = scene->contact.law,
                                        .friction = scene->contact.friction,
                                        .rolling_friction = dem_has_rolling_friction(scene),
                                        .in_double = spec->inputs.precision > 0,
                                        .threads = scene->threads };
    estimate.wall_seconds = calibration_seconds_a_run(machine, &estimate.load, estimate.steps);
    const double frames = FRAME_BYTES * spec->duration / spec->sample_interval;
    estimate.memory_bytes = dem_memory_estimate(spheres) + frames;
    estimate.checkpoint_bytes = scene_checkpoint_bytes(spheres, frames);
    estimate.snapshot_bytes = estimate.snapshots * (SNAPSHOT_FILE_BYTES + SNAPSHOT_PARTICLE_BYTES * spheres);
    return estimate;
}
