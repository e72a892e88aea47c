/* What a drum will cost, from its numbers alone. */
#include <math.h>

#include "dem_rules.h"
#include "drum_process.h"

/* A snapshot: so much for the file's structure, and for each sphere after compression. */
#define SNAPSHOT_FILE_BYTES 30e3
#define SNAPSHOT_PARTICLE_BYTES 60.0
/* A frame of measurement: some 16 numbers and the interface's height at steps of d/4, kept in memory. */
#define FRAME_NUMBERS 16.0
#define FRAME_NUMBERS_PER_DIAMETER 4.0

static double smallest_diameter(const dem_drum_definition *drum)
{
    double diameter = NAN;
    for (size_t s = 0; s < drum->species_count; s++) diameter = fmin(diameter, dem_species_diameter(&drum->species[s]));
    return diameter;
}

static double lining_spheres(const dem_drum_definition *drum)
{
    if (!(drum->lining.diameter > 0.0)) return 0.0;
    return DEM_PI * drum->diameter * drum->length / (drum->lining.pitch * drum->lining.pitch);
}

double drum_spheres_a_particle(const dem_drum_definition *drum)
{
    double mean = 0.0;
    for (size_t s = 0; s < drum->species_count; s++)
        mean += drum->species[s].share * fmax(1.0, (double)drum->species[s].cluster.sphere_count);
    return mean;
}

job_estimate drum_estimate(const job_spec *spec, const calibration *machine)
{
    const dem_drum_definition *drum = &spec->drum;
    const double particles = (double)drum->particle_count, spheres = particles * drum_spheres_a_particle(drum);
    const double frame_bytes =
        sizeof(double) * (FRAME_NUMBERS + FRAME_NUMBERS_PER_DIAMETER * drum->diameter / smallest_diameter(drum));

    job_estimate estimate = {
        .particles = particles,
        .time_step = drum->time_step,
        .stiffness = drum->contact.stiffness,
        .simulated_seconds = spec->duration + (drum->is_placed ? 0.0 : dem_settling_time_estimate(drum->diameter, drum->gravity)),
        .snapshots = spec->snapshot_interval > 0.0 ? floor(spec->duration / spec->snapshot_interval) + 2.0 : 1.0,
    };
    estimate.steps = ceil(estimate.simulated_seconds / drum->time_step);
    estimate.load = (calibration_load){ .spheres = spheres + lining_spheres(drum),
                                        .of_particle = spheres / particles,
                                        .law = drum->contact.law,
                                        .friction = drum->contact.friction,
                                        .rolling_friction = dem_has_rolling_friction(drum),
                                        .in_double = spec->inputs.precision > 0,
                                        .threads = drum->threads };
    estimate.wall_seconds = estimate.steps * calibration_seconds_a_step(machine, &estimate.load);
    const double frames = frame_bytes * spec->duration / spec->sample_interval;
    estimate.memory_bytes = dem_memory_estimate(spheres + lining_spheres(drum)) + frames;
    estimate.checkpoint_bytes = scene_checkpoint_bytes(spheres, frames);
    estimate.snapshot_bytes = estimate.snapshots * (SNAPSHOT_FILE_BYTES + SNAPSHOT_PARTICLE_BYTES * spheres);
    return estimate;
}
