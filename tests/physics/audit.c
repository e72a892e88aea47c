/* A small drum over some revolutions with its energy audited at every step. Prints as JSON, in J: what the particles
 * gained in motion and height, from places and velocities alone; the contacts' work on them; the drum's work on the bed. */
#include "../unit/core/small_drum.h"
#include "dem_cluster.h"
#include "measure.h"
#include "named_numbers.h"

enum { RATE, REVOLUTIONS, MU, CLUSTERS, SEED, COHESION };

static named_number asked[] = {
    { "rate", 4 }, { "revolutions", 1 }, { "friction", 0.3 }, { "clusters", 0 }, /* 1: dumbbells */
    { "seed", 5 }, { "cohesion", 0 }, /* of Hertz-Mindlin: 1: constant, 2: sjkr, 4: jkr, 5: liquid bridges (dem_cohesion_law) */
    { NULL, 0 },
};

static double of(int which) { return asked[which].value; }

/* Pull-offs of some weights. */
static void set_cohesion(dem_scene_definition *d, dem_cohesion_law law)
{
    static const dem_cohesion strength[] = { [DEM_CONSTANT_PULL] = { .strength = 2e-3 },
                                             [DEM_SJKR] = { .strength = 3e4 },
                                             [DEM_JKR] = { .strength = 0.5 },
                                             [DEM_LIQUID_BRIDGE] = { 0.07, 1e-11, 0.3 } };
    if (!law) return;
    d->contact.law = DEM_HERTZ_MINDLIN;
    d->contact.particle = d->contact.wall = (dem_elasticity){ 2e6, 0.3 };
    d->contact.cohesion_law = law;
    d->contact.cohesion = d->contact.wall_cohesion = strength[law];
}

/* Half a step ago, where velocities are known: kinetic energy, and the height of each sphere then. A dumbbell's spheres
 * are equal, so its height is the mean of theirs. */
static double motion_and_height(const dem_scene *scene, double mass)
{
    const size_t n = dem_scene_sphere_count(scene);
    const double share = mass * (double)dem_scene_particle_count(scene) / (double)n, half = 0.5 * scene->definition.time_step;
    double *x = calloc(6 * n, sizeof *x), *v = x + 3 * n, height = 0;
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = x, .velocity = v });
    for (size_t i = 0; i < n; i++) height += x[3 * i + 1] - half * v[3 * i + 1];
    free(x);
    return dem_scene_kinetic_energy(scene) + share * scene->definition.gravity * height;
}

int main(int argc, char **argv)
{
    read_named_numbers(argc, argv, asked);
    dem_scene_definition d = small_drum();
    d.rotation_rate = of(RATE);
    d.contact.friction = of(MU);
    d.seed = (uint64_t)of(SEED);
    if (of(CLUSTERS) > 0) {
        dem_cluster_of_shape(&d.species[0].cluster, DEM_DUMBBELL, d.species[0].diameter);
        dem_cluster_complete(&d.species[0].cluster);
        d.length = 0.02;
        d.particle_count /= 2;
    }
    follow_rules(&d, 0.03);
    set_cohesion(&d, (dem_cohesion_law)of(COHESION));
    dem_scene *scene = drum_scene(&d);
    const double mass = dem_species_mass(&d.species[0]);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    const double before = motion_and_height(scene, mass);
    scene->audit.is_on = true;
    run(scene, (int64_t)(of(REVOLUTIONS) * 2 * M_PI / fabs(d.rotation_rate) / d.time_step));
    printf("{\"gained\": %.17g, \"contact_work\": %.17g, \"wall_work\": %.17g, \"tension_share\": %.17g}\n",
           motion_and_height(scene, mass) - before, scene->audit.contact_work, scene->audit.wall_work,
           of(COHESION) > 0 ? measure_tension_share(scene) : 0);
    dem_scene_free(scene);
    return 0;
}
