/* A small drum at rest, run for long, in the scene's own step. Prints as JSON:
 * weight = 0: an elastic gas without friction, and its whole energy (motion and springs) at the start and after;
 * weight = 1: a settled bed, how far its spheres have moved (half of them no farther than the median; together, as their
 * centre has), in diameters, and their kinetic energy over what they would lose by falling a diameter. */
#include "../unit/core/small_drum.h"
#include "named_numbers.h"

enum { WEIGHT, PARTICLES, STEPS, PER_CONTACT, SEED };

static named_number asked[] = {
    { "weight", 0 }, { "particles", 60 }, { "steps", 100000 }, { "steps_per_contact", 20 }, { "seed", 5 }, { NULL, 0 },
};

static double of(int which) { return asked[which].value; }

/* J: sum of K1 alpha^2/2 over pairs, nearest image, and the wall. */
static double spring_energy(const dem_scene *scene, const double *x, const double *radius, size_t n)
{
    const double length = scene->container.length, k_1 = scene->definition.contact.stiffness;
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const double alpha = hypot(x[3 * i], x[3 * i + 1]) + radius[i] - scene->container.radius;
        if (alpha > 0) sum += 0.5 * k_1 * alpha * alpha;
        for (size_t j = i + 1; j < n; j++) {
            const double dx = x[3 * i] - x[3 * j], dy = x[3 * i + 1] - x[3 * j + 1],
                         dz = remainder(x[3 * i + 2] - x[3 * j + 2], length);
            const double gap = sqrt(dx * dx + dy * dy + dz * dz) - radius[i] - radius[j];
            if (gap < 0) sum += 0.5 * k_1 * gap * gap;
        }
    }
    return sum;
}

/* Velocities are half a step behind the positions: the mean of the kinetic energies on both sides goes with these. */
static double whole_energy(dem_scene *scene, double *x, double *radius, size_t n)
{
    const double before = dem_scene_kinetic_energy(scene);
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = x, .radius = radius });
    const double springs = spring_energy(scene, x, radius, n);
    run(scene, 1);
    return 0.5 * (before + dem_scene_kinetic_energy(scene)) + springs;
}

/* Every sphere gets a velocity of its own, m/s each component uniform within +-0.3, and the phase in which only the law acts. */
static void stir(dem_scene *scene, size_t n)
{
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    int64_t *counters = state_array(&state, "counters")->data;
    counters[0] = DEM_PHASE_RUNNING;
    counters[3] = counters[1]; /* rotation begins now, in a drum that does not turn */
    double *v = state_array(&state, "velocity")->data;
    dice own = { (uint64_t)of(SEED) };
    for (size_t k = 0; k < 3 * n; k++) v[k] = dice_uniform(&own, -0.3, 0.3);
    assert_int_equal(dem_scene_restore(scene, &state), DEM_OK);
    dem_state_clear(&state);
    scene->definition.gravity = 0;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* From the places a to the places b. */
static void print_moves(const double *a, const double *b, size_t n, const dem_scene_definition *d)
{
    double *move = calloc(n, sizeof *move), centre[3] = { 0 };
    for (size_t i = 0; i < n; i++) {
        const double by[3] = { b[3 * i] - a[3 * i], b[3 * i + 1] - a[3 * i + 1],
                               remainder(b[3 * i + 2] - a[3 * i + 2], d->length) };
        for (int c = 0; c < 3; c++) {
            centre[c] += by[c] / (double)n;
            move[i] += by[c] * by[c];
        }
    }
    qsort(move, n, sizeof *move, ascending);
    const double diameter = d->species[0].diameter;
    printf("\"median\": %.17g, \"furthest\": %.17g, \"centre\": %.17g", sqrt(move[n / 2]) / diameter, sqrt(move[n - 1]) / diameter,
           sqrt(centre[0] * centre[0] + centre[1] * centre[1] + centre[2] * centre[2]) / diameter);
    free(move);
}

int main(int argc, char **argv)
{
    read_named_numbers(argc, argv, asked);
    const bool bed = of(WEIGHT) > 0;
    dem_scene_definition d = small_drum();
    d.rotation_rate = 0;
    d.seed = (uint64_t)of(SEED);
    d.particle_count = (size_t)of(PARTICLES);
    follow_rules(&d, 0.03);
    if (!bed) {
        d.contact.restitution = 1;
        d.contact.friction = d.contact.wall_friction = 0;
    }
    d.time_step = dem_time_step(d.contact.stiffness, dem_species_mass(&d.species[0]), d.contact.restitution) * DEM_STEPS_PER_CONTACT
                  / of(PER_CONTACT);
    dem_scene *scene = drum_scene(&d);
    const size_t n = d.particle_count;
    double *x = calloc(7 * n, sizeof *x), *y = x + 3 * n, *radius = x + 6 * n;
    const int64_t steps = (int64_t)of(STEPS);
    if (bed) {
        run_to_phase(scene, DEM_PHASE_RUNNING);
        run(scene, (int64_t)(0.2 / d.time_step)); /* contacts ring until then */
        dem_scene_particles(scene, &(dem_particle_arrays){ .position = x });
        run(scene, steps);
        dem_scene_particles(scene, &(dem_particle_arrays){ .position = y });
        const double fall = dem_species_mass(&d.species[0]) * d.gravity * d.species[0].diameter * (double)n;
        printf("{");
        print_moves(x, y, n, &d);
        printf(", \"kinetic\": %.17g, \"seconds\": %.17g}\n", dem_scene_kinetic_energy(scene) / fall, (double)steps * d.time_step);
    } else {
        while (dem_scene_phase(scene) == DEM_PHASE_GROWING) run(scene, 1);
        stir(scene, n);
        run(scene, 1000); /* those that overlapped have parted */
        const double before = whole_energy(scene, x, radius, n);
        run(scene, steps);
        const double after = whole_energy(scene, x, radius, n);
        printf("{\"before\": %.17g, \"after\": %.17g, \"seconds\": %.17g}\n", before, after, (double)steps * d.time_step);
    }
    free(x);
    dem_scene_free(scene);
    return 0;
}
