/* Everything that a scene is after so many steps, as one number: the hash of its saved state (FNV-1a). Prints as JSON the
 * number, the instruction set and the precision.
 *
 * All builds of the core must come to the same one, with any number of threads (test_same_bits.py). */
#include <inttypes.h>

#include "../unit/core/small_drum.h"
#include "dem_cluster.h"
#include "named_numbers.h"

enum { CASE, STEPS, THREADS, SETTLING };

static named_number asked[] = {
    { "case", 0 }, /* 0: spheres, 1: two sizes, 2: tetrahedra, 3: spring-dashpot with lifters, 4: Hertz-Mindlin, end walls,
                      5: rolling friction, two sizes, 6: two materials and a third of the walls,
                      7: jkr, two sizes, 8: liquid bridges of latching springs,
                      9: damped rolling of two materials, 10: constant rolling torque, Hertz-Mindlin, two sizes,
                      11: a vessel whose orifice opens */
    { "steps", 2000 }, { "threads", 1 }, { "settling", 1 }, /* 0: the steps begin with the growing, 1: with the rotation */
    { NULL, 0 },
};

static double of(int which) { return asked[which].value; }

static void set_materials(dem_scene_definition *d)
{
    d->species_count = 2;
    d->species[0].share = 0.5;
    d->species[1] = (dem_species){ .diameter = 0.003, .density = 1500, .share = 0.5 };
    d->has_pairs = true;
}

/* Each pair a little different. */
static void set_pairs(dem_scene_definition *d)
{
    for (size_t a = 0; d->has_pairs && a < d->species_count; a++)
        for (size_t b = 0; b < DEM_MAXIMUM_SPECIES + DEM_SURFACES; b++)
            d->pair[a][b] = (dem_pair){ .friction = 0.2 + 0.01 * (double)(a + b),
                                        .rolling_friction = of(CASE) == 9 ? 0.05 + 0.01 * (double)(a + b) : 0,
                                        .restitution = 0.8 - 0.02 * (double)(a + b % DEM_MAXIMUM_SPECIES),
                                        .stiffness = d->contact.stiffness * (1 - 0.05 * (double)(a * b % 3)) };
}

static void set_cohesion(dem_scene_definition *d, bool is_jkr)
{
    if (is_jkr) {
        d->contact.law = DEM_HERTZ_MINDLIN;
        d->contact.particle = d->contact.wall = (dem_elasticity){ 2e6, 0.3 };
    }
    d->contact.cohesion_law = is_jkr ? DEM_JKR : DEM_LIQUID_BRIDGE;
    d->contact.cohesion = is_jkr ? (dem_cohesion){ .strength = 0.05 }
                                 : (dem_cohesion){ .strength = 0.03, .liquid_volume = 1e-11, .contact_angle = 0.3 };
    d->contact.wall_cohesion = d->contact.cohesion;
}

static dem_scene_definition drum_asked(void)
{
    const int number = (int)of(CASE);
    dem_scene_definition d = small_drum();
    if (number == 1 || number == 5 || number == 7 || number == 10) {
        d.species_count = 2;
        d.species[0].share = 0.7;
        d.species[1] = (dem_species){ .diameter = 0.004, .density = 2500, .share = 0.3 };
        d.particle_count = 160;
    }
    if (number == 2) {
        dem_species *species = &d.species[0];
        species->diameter = 0.002;
        dem_cluster_of_shape(&species->cluster, DEM_TETRAHEDRON, species->diameter);
        dem_cluster_complete(&species->cluster);
        d.particle_count = 80;
    }
    if (number == 3) {
        d.contact.law = DEM_SPRING_DASHPOT;
        d.lifters = (dem_lifters){ .count = 4, .height = 0.005, .width = 0.003, .friction = 0.4 };
        d.particle_count = 200;
    }
    if (number == 4 || number == 10) {
        d.contact.law = DEM_HERTZ_MINDLIN;
        d.contact.particle = d.contact.wall = (dem_elasticity){ 1e6, 0.3 };
        d.ends = (dem_drum_ends){ .are_walls = true, .friction = 0.3 };
    }
    if (number == 6 || number == 9) set_materials(&d);
    if (number == 7 || number == 8) set_cohesion(&d, number == 7);
    if (number == 5 || number == 10) d.contact.rolling_friction = d.contact.wall_rolling_friction = 0.05;
    if (number == 9 || number == 10) d.contact.rolling_law = number == 9 ? DEM_EPSD_DAMPED : DEM_CONSTANT_TORQUE;
    d.contact.rolling_damping = 0.3;
    if (number == 11) {
        d.container = DEM_VESSEL;
        d.diameter = 0.025;
        d.length = 0.08;
        d.orifice = (dem_orifice){ .opening = 0.012, .half_angle = 0.6 };
        d.ends.friction = 0.4;
        d.rotation_rate = 0;
    }
    d.contact.latch_damping = 0.3;
    d.threads = (int)of(THREADS);
    follow_rules(&d, 0.03);
    set_pairs(&d);
    return d;
}

static uint64_t hash(uint64_t so_far, const void *data, size_t bytes)
{
    const unsigned char *byte = data;
    for (size_t k = 0; k < bytes; k++) so_far = (so_far ^ byte[k]) * 0x100000001b3;
    return so_far;
}

static uint64_t state_hash(const dem_scene *scene)
{
    static const size_t size[] = { [DEM_FLOAT64] = 8, [DEM_INT64] = 8, [DEM_INT32] = 4 };
    dem_state state;
    if (dem_scene_save(scene, &state) != DEM_OK) fail_msg("no memory");
    uint64_t h = 0xcbf29ce484222325;
    for (size_t k = 0; k < state.array_count; k++) {
        const dem_state_array *a = &state.array[k];
        h = hash(h, a->name, strlen(a->name));
        h = hash(h, a->data, a->rows * a->columns * size[a->element]);
    }
    dem_state_clear(&state);
    return h;
}

int main(int argc, char **argv)
{
    read_named_numbers(argc, argv, asked);
    const dem_scene_definition d = drum_asked();
    dem_scene *scene = drum_scene(&d);
    if (of(SETTLING) > 0) run_to_phase(scene, DEM_PHASE_RUNNING);
    const int64_t settled = dem_scene_step_count(scene);
    run(scene, (int64_t)of(STEPS));
    printf("{\"hash\": \"%016" PRIx64 "\", \"isa\": \"%s\", \"precision\": \"%s\", \"particles\": %zu, \"settled\": %" PRId64
           ", \"overlap\": %.17g}\n",
           state_hash(scene), dem_build_isa(), dem_build_precision(), dem_scene_particle_count(scene), settled,
           dem_scene_maximum_overlap(scene));
    dem_scene_free(scene);
    return 0;
}
