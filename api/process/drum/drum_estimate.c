/* What a drum will cost, from its numbers alone. */
#include <math.h>

#include "dem_rules.h"
#include "drum_process.h"
#include "scene_rules.h"

/* A snapshot: so much for the file's structure, and for each sphere after compression. */
#define SNAPSHOT_FILE_BYTES 30e3
#define SNAPSHOT_PARTICLE_BYTES 70.0 /* and of its frame */
/* A frame of measurement, kept in memory: so many numbers and the interface's height at steps of d/4, or pairs of column and
 * height where those that the spheres reach are fewer. */
#define FRAME_NUMBERS 20.0
#define FRAME_NUMBERS_PER_DIAMETER 4.0
/* A cell of the fields: its sums, what is told from them, and both on their way to the disk. */
#define FIELD_CELL_BYTES 272.0
/* The sums alone, in a checkpoint. */
#define CHECKPOINT_CELL_BYTES 136.0
/* s: it counts where spheres are few. */
#define FIELD_CELL_SECONDS 2.5e-6

/* diameter: m, of the mean volume. */
static double interface_numbers(const dem_scene_definition *drum, double spheres, double diameter)
{
    const double columns = FRAME_NUMBERS_PER_DIAMETER * drum->diameter / diameter;
    const double of_sphere = FRAME_NUMBERS_PER_DIAMETER * (dem_largest_sphere(drum) + diameter) / diameter + 2.0;
    return fmin(columns, 2.0 * spheres * of_sphere);
}

static double lining_spheres(const dem_scene_definition *drum)
{
    if (!(drum->lining.diameter > 0.0)) return 0.0;
    return DEM_PI * drum->diameter * drum->length / (drum->lining.pitch * drum->lining.pitch);
}

job_estimate drum_estimate(const job_spec *spec, const calibration *machine)
{
    const dem_scene_definition *drum = &spec->scene;
    const double particles = (double)drum->particle_count, spheres = particles * scene_spheres_a_particle(drum);
    const double diameter = cbrt(6.0 / DEM_PI * dem_mean_volume(drum->species, drum->species_count));
    const double side = dem_field_cells(drum->diameter, diameter, particles), field_cells = side * side;
    const double beds = (double)spec->bed_count;
    const double frame_bytes = sizeof(double) * (FRAME_NUMBERS + interface_numbers(drum, spheres, diameter));

    const double settling = dem_settling_time(drum);
    const dem_range range = dem_settling_range(drum);
    job_estimate estimate = {
        .particles = beds * particles,
        .time_step = drum->time_step,
        .stiffness = drum->contact.stiffness,
        .simulated_seconds = spec->duration + settling,
        .settling_seconds = settling,
        .settling_seconds_low = range.low * settling,
        .settling_seconds_high = range.high * settling,
        .snapshots = spec->snapshot_interval > 0.0 ? floor(spec->duration / spec->snapshot_interval) + 2.0 : 1.0,
    };
    const double steps = ceil(estimate.simulated_seconds / drum->time_step);
    estimate.steps = beds * steps;
    estimate.load = (calibration_load){ .spheres = spheres + lining_spheres(drum),
                                        .of_particle = spheres / particles,
                                        .law = drum->contact.law,
                                        .friction = drum->contact.friction,
                                        .rolling_friction = dem_has_rolling_friction(drum),
                                        .in_double = spec->inputs.precision > 0,
                                        .threads = drum->threads };
    estimate.wall_seconds = beds / calibration_at_once(machine, job_beds_at_once(spec))
                            * (calibration_pace(machine) * FIELD_CELL_SECONDS * field_cells
                               + calibration_seconds_a_run(machine, &estimate.load, steps));
    const double frames = frame_bytes * spec->duration / spec->sample_interval;
    estimate.memory_bytes = beds * (dem_memory_estimate(spheres + lining_spheres(drum)) + FIELD_CELL_BYTES * field_cells + frames);
    estimate.checkpoint_bytes = beds * (scene_checkpoint_bytes(spheres, frames) + CHECKPOINT_CELL_BYTES * field_cells);
    estimate.snapshot_bytes = estimate.snapshots * (SNAPSHOT_FILE_BYTES + SNAPSHOT_PARTICLE_BYTES * spheres);
    return estimate;
}
