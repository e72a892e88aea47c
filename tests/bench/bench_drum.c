/* How fast the core is: the paper's drum in steady flow, in particle-steps per second.
 *
 *   bench_drum [particles] [diameter_mm] [threads] [friction] [rate_rad_s] [windows] [steps_a_window]
 *
 * The drum's axis is made as long as the particles need at half filling. Prints one JSON line with minimum,
 * median and maximum over the windows, and the share of the whole run's steps spent before rotation. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "dem.h"
#include "dem_rules.h"

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double argument(int argc, char **argv, int k, double otherwise) { return argc > k ? atof(argv[k]) : otherwise; }

static dem_scene_definition paper_drum(int argc, char **argv)
{
    dem_scene_definition d = { .diameter = 0.126, .gravity = 9.81, .fill_fraction = 0.5, .species_count = 1, .seed = 1 };
    d.particle_count = (size_t)argument(argc, argv, 1, 2500);
    d.species[0] = (dem_species){ .diameter = argument(argc, argv, 2, 3.78) * 1e-3, .density = 2500, .share = 1.0 };
    d.threads = (int)argument(argc, argv, 3, 1);
    d.rotation_rate = argument(argc, argv, 5, DEM_PI / 2);
    const double one = dem_particles_of_fill(d.diameter, 1.0, d.fill_fraction, d.species, 1);
    d.length = (double)d.particle_count / one;
    d.contact = (dem_contact_parameters){
        .restitution = 0.8, .friction = argument(argc, argv, 4, 0.1), .wall_friction = 0.5, .tangential_stiffness_ratio = 0.8
    };
    const double mass = dem_sphere_mass(d.species[0].diameter, d.species[0].density);
    const double speed = dem_impact_speed(d.diameter, d.species[0].diameter, d.gravity, d.contact.friction, d.rotation_rate);
    d.contact.stiffness = dem_stiffness_for_overlap(speed, mass, 0.01 * d.species[0].diameter);
    d.time_step = dem_time_step(d.contact.stiffness, mass, d.contact.restitution);
    return d;
}

static int report_failure(const dem_scene *scene, dem_status status)
{
    const dem_failure *f = dem_scene_failure(scene);
    fprintf(stderr, "failed at step %lld: %s (particle %lld, %lld, %s %g %s, limit %g)\n", (long long)f->step,
            dem_status_text(status), (long long)f->particle, (long long)f->other, f->quantity, f->value, f->unit, f->limit);
    return 1;
}

int main(int argc, char **argv)
{
    const dem_scene_definition d = paper_drum(argc, argv);
    const int windows = (int)argument(argc, argv, 6, 7);
    dem_scene *scene;
    dem_status status = dem_scene_create(&d, &scene);
    if (status != DEM_OK) {
        fprintf(stderr, "%s\n", dem_status_text(status));
        return 1;
    }
    const double start = now();
    while (dem_scene_phase(scene) != DEM_PHASE_RUNNING)
        if ((status = dem_scene_advance(scene, 100)) != DEM_OK) return report_failure(scene, status);
    const double settled = now();
    const int64_t settling_steps = dem_scene_step_count(scene);
    /* the transient: the bed turns to its angle of repose */
    const int64_t transient = (int64_t)(0.6 / d.time_step);
    if ((status = dem_scene_advance(scene, transient)) != DEM_OK) return report_failure(scene, status);

    const int64_t steps = (int64_t)argument(argc, argv, 7, 2.5e7 / (double)d.particle_count);
    double speed[64];
    for (int w = 0; w < windows && w < 64; w++) {
        const double begin = now();
        if ((status = dem_scene_advance(scene, steps)) != DEM_OK) return report_failure(scene, status);
        speed[w] = (double)d.particle_count * (double)steps / (now() - begin);
    }
    qsort(speed, (size_t)windows, sizeof *speed, ascending);
    printf("{\"particles\": %zu, \"diameter\": %g, \"threads\": %d, \"friction\": %g, \"rotation_rate\": %g, \"time_step\": %.4g, "
           "\"settling_steps\": %lld, \"settling_seconds\": %.3g, \"maximum_overlap\": %.4f, "
           "\"particle_steps_per_second\": {\"minimum\": %.4g, \"median\": %.4g, \"maximum\": %.4g}}\n",
           d.particle_count, d.species[0].diameter, d.threads, d.contact.friction, d.rotation_rate, d.time_step,
           (long long)settling_steps, settled - start, dem_scene_maximum_overlap(scene), speed[0], speed[windows / 2],
           speed[windows - 1]);
    dem_scene_free(scene);
    return 0;
}
