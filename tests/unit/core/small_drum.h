/* Drums small enough to run in a test: a few hundred spheres, few diameters long. */
#ifndef SMALL_DRUM_H
#define SMALL_DRUM_H

#include "core_claims.h"
#include "dem.h"
#include "dem_rules.h"

/* 40 mm across, 12 mm long, 3 mm spheres, half full: 320 of them. Soft (an overlap of 3 %), to be quick. */
static inline dem_scene_definition small_drum(void)
{
    dem_scene_definition d = {
        .diameter = 0.04,
        .length = 0.012,
        .rotation_rate = 4,
        .gravity = 9.81,
        .fill_fraction = 0.5,
        .species_count = 1,
        .species = { { .diameter = 0.003, .density = 2500, .share = 1 } },
        .contact = { .restitution = 0.7, .friction = 0.3, .wall_friction = 0.5, .tangential_stiffness_ratio = 0.8 },
        .seed = 5,
        .threads = 1,
    };
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, 1);
    return d;
}

/* Stiffness and time step from the rules (clusters complete), for this overlap as a share of the smallest diameter. */
static inline void follow_rules(dem_scene_definition *d, double overlap)
{
    double smallest = INFINITY, largest = 0, lightest = INFINITY, heaviest = 0;
    for (size_t k = 0; k < d->species_count; k++) {
        smallest = fmin(smallest, dem_species_smallest_sphere(&d->species[k]));
        largest = fmax(largest, dem_species_diameter(&d->species[k]));
        lightest = fmin(lightest, dem_species_contact_mass(&d->species[k]));
        heaviest = fmax(heaviest, dem_species_mass(&d->species[k]));
    }
    const double friction = dem_bed_friction(d->contact.friction, d->species, d->species_count);
    const double speed = dem_impact_speed(d->diameter, largest, d->gravity, friction, d->rotation_rate);
    d->contact.stiffness = dem_stiffness_for_overlap(speed, heaviest, overlap * smallest);
    d->time_step = dem_time_step(d->contact.stiffness, lightest, d->contact.restitution);
}

/* Two sizes, 1 to 3, one in ten large. */
static inline dem_scene_definition two_sizes_drum(void)
{
    dem_scene_definition d = small_drum();
    d.diameter = 0.05;
    d.length = 0.018;
    d.species_count = 2;
    d.species[0] = (dem_species){ .diameter = 0.002, .density = 2500, .share = 0.93 };
    d.species[1] = (dem_species){ .diameter = 0.006, .density = 2500, .share = 0.07 };
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, 0.4, d.species, 2);
    d.fill_fraction = 0.4;
    return d;
}

static inline dem_scene *drum_scene(const dem_scene_definition *d)
{
    dem_scene *scene = NULL;
    const dem_status status = dem_scene_create(d, &scene);
    if (status != DEM_OK) fail_msg("the test's own drum of %zu: %s", d->particle_count, dem_status_text(status));
    return scene;
}

static inline void run(dem_scene *scene, int64_t steps)
{
    const dem_status status = dem_scene_advance(scene, steps);
    if (status == DEM_OK) return;
    const dem_failure *f = dem_scene_failure(scene);
    fail_msg("the drum stopped at step %lld: %s (particle %lld, %lld: %s %g %s, limit %g)", (long long)f->step,
             dem_status_text(status), (long long)f->particle, (long long)f->other, f->quantity, f->value, f->unit, f->limit);
}

static inline void run_to_phase(dem_scene *scene, dem_phase phase)
{
    while (dem_scene_phase(scene) < phase) run(scene, 50);
}

#endif
