/* Claims about several steps in one pass: they are the same steps, to the last bit, also where they have to stop on the
 * way. The oracle: the same run, told to take one step at a time. */
#include "dem_cluster.h"
#include "dem_sizes.h"
#include "scene.h"
#include "small_drum.h"
#include "wave.h"

enum { MOST_STEPS = 3 * HORIZON, BEFORE_SORT = 8192 - 500, DEFINITION_BYTES = 1512 /* species and pairs apart */ };

/* Eight diameters across and fifty long: some 1500 spheres, so that steps follow each other along it. */
static dem_scene_definition slender_drum(void)
{
    dem_scene_definition d = small_drum();
    d.diameter = 0.024;
    d.length = 0.15;
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, d.species_count);
    return d;
}

/* Sizes, moments of both ends, rolling: whatever a contact may have. */
static dem_scene_definition slender_mixture(void)
{
    dem_scene_definition d = slender_drum();
    d.species_count = 2;
    d.species[0].share = 0.7;
    d.species[1] = (dem_species){ .diameter = 0.004, .density = 2500, .share = 0.3 };
    d.contact.rolling_friction = d.contact.wall_rolling_friction = 0.1;
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, d.species_count);
    return d;
}

static dem_scene *scene_in_waves(const dem_scene_definition *d, double margin)
{
    dem_scene *scene = drum_scene(d);
    scene->spheres.in_waves = true;
    if (margin > 0) scene->neighbors.least_margin = scene->neighbors.most_margin = scene->neighbors.margin = margin;
    return scene;
}

static void check_same_bits(const dem_scene *a, const dem_scene *b)
{
    const spheres *s = &a->spheres, *t = &b->spheres;
    const size_t n = s->mobile_count;
    assert_int_equal(a->step_count, b->step_count);
    assert_memory_equal(s->id, t->id, n * sizeof *s->id);
    assert_memory_equal(s->place, t->place, n * sizeof *s->place);
    assert_memory_equal(s->velocity, t->velocity, n * sizeof *s->velocity);
    assert_memory_equal(s->angular_velocity, t->angular_velocity, n * sizeof *s->angular_velocity);
    assert_memory_equal(&a->maximum_overlap, &b->maximum_overlap, sizeof a->maximum_overlap);
    assert_memory_equal(&a->torque, &b->torque, sizeof a->torque);
    assert_memory_equal(&a->container.angle, &b->container.angle, sizeof a->container.angle);
}

typedef struct tally {
    int64_t steps, in_waves; /* of these, in waves */
    int64_t stopped;         /* waves that had to be picked for again on their way */
} tally;

/* `calls` times up to MOST_STEPS steps, of another number each time. */
static tally compare(dem_scene *waves, dem_scene *single, int calls)
{
    tally t = { 0 };
    for (int call = 0; call < calls; call++) {
        for (int left = 1 + call * 7 % MOST_STEPS; left > 0;) {
            const int steps = wave_length(waves, left);
            const int64_t picks = waves->neighbors.inner_picks;
            run(waves, steps);
            for (int k = 0; k < steps; k++) run(single, 1);
            t.steps += steps;
            if (steps > 1) t.in_waves += steps;
            t.stopped += waves->neighbors.inner_picks - picks > 1;
            left -= steps;
        }
        if (call % 20 == 0) check_same_bits(waves, single);
    }
    check_same_bits(waves, single);
    return t;
}

/* While it falls, through the change of phase, and as it turns, across a sort. threads: that share the stages of the waves. */
static tally check_drum(dem_scene_definition *d, double margin, int threads)
{
    follow_rules(d, 0.04);
    dem_scene *single = scene_in_waves(d, margin);
    d->threads = threads;
    dem_scene *waves = scene_in_waves(d, margin);
    run_to_phase(waves, DEM_PHASE_SETTLING);
    run_to_phase(single, DEM_PHASE_SETTLING);
    tally sum = compare(waves, single, 100);
    run_to_phase(waves, DEM_PHASE_RUNNING);
    run(waves, BEFORE_SORT - (dem_scene_step_count(waves) - dem_scene_run_start(waves)));
    while (dem_scene_step_count(single) < dem_scene_step_count(waves)) run(single, 1);
    const tally t = compare(waves, single, 100);
    assert_true(dem_scene_step_count(waves) - dem_scene_run_start(waves) > 8192);
    sum.steps += t.steps;
    sum.in_waves += t.in_waves;
    sum.stopped += t.stopped;
    dem_scene_free(waves);
    dem_scene_free(single);
    return sum;
}

static void waves_have_the_same_bits_as_single_steps(void **unused)
{
    (void)unused;
    dem_scene_definition d = slender_drum();
    const tally t = check_drum(&d, 0, 1);
    assert_true(t.in_waves > t.steps / 2);
}

static void of_a_rolling_mixture_between_end_walls_too(void **unused)
{
    (void)unused;
    dem_scene_definition d = slender_mixture();
    d.ends.are_walls = true;
    d.ends.friction = 0.3;
    const tally t = check_drum(&d, 0, 2);
    assert_true(t.in_waves > t.steps / 2);
}

static void by_every_law(void **unused)
{
    (void)unused;
    const dem_contact_law laws[] = { DEM_SPRING_DASHPOT, DEM_HERTZ_MINDLIN };
    for (int k = 0; k < 2; k++) {
        dem_scene_definition d = slender_drum();
        follow_rules(&d, 0.04);
        d.contact.law = laws[k];
        if (laws[k] == DEM_HERTZ_MINDLIN) d.contact.particle = d.contact.wall = (dem_elasticity){ 1e7, 0.3 };
        dem_scene *waves = scene_in_waves(&d, 2e-6), *single = scene_in_waves(&d, 2e-6);
        run_to_phase(waves, DEM_PHASE_SETTLING);
        run_to_phase(single, DEM_PHASE_SETTLING);
        const tally t = compare(waves, single, 200);
        assert_true(t.stopped > t.steps / 100);
        dem_scene_free(waves);
        dem_scene_free(single);
    }
}

/* A margin so narrow that the first collision on the way, or the first step, uses it up. */
static void waves_that_stop_on_their_way_have_the_same_bits(void **unused)
{
    (void)unused;
    const double margins[] = { 1e-9, 2e-7, 2e-6, 1e-6 };
    const int threads[] = { 2, 1, 1, 3 };
    for (int k = 0; k < 4; k++) {
        dem_scene_definition d = k % 2 ? slender_mixture() : slender_drum();
        const tally t = check_drum(&d, margins[k], threads[k]);
        assert_true(t.stopped > t.steps / 100);
    }
}

/* The same failure at the same step, as no step behind it counts. */
static void a_drum_that_is_too_soft_stops_as_in_single_steps(void **unused)
{
    (void)unused;
    dem_scene_definition d = slender_drum();
    follow_rules(&d, 0.04);
    dem_scene *waves = scene_in_waves(&d, 0), *single = scene_in_waves(&d, 0);
    run_to_phase(waves, DEM_PHASE_RUNNING);
    run_to_phase(single, DEM_PHASE_RUNNING);
    waves->contact.stiffness /= 3000;
    single->contact.stiffness /= 3000;
    dem_status status = DEM_OK;
    while (status == DEM_OK) status = dem_scene_advance(waves, 1000);
    assert_int_equal(status, DEM_OVERLAP_TOO_LARGE);
    for (status = DEM_OK; status == DEM_OK;) status = dem_scene_advance(single, 1);
    const dem_failure *a = dem_scene_failure(waves), *b = dem_scene_failure(single);
    assert_int_equal(a->status, b->status);
    assert_int_equal(a->step, b->step);
    assert_int_equal(a->particle, b->particle);
    assert_int_equal(a->other, b->other);
    CHECK_NEAR(a->value, b->value, 1e-12);
    dem_scene_free(waves);
    dem_scene_free(single);
}

/* ---- everything that can change from one step to the next ---- */

static void nothing(dem_scene_definition *d) { (void)d; }
static void end_walls(dem_scene_definition *d) { d->ends = (dem_drum_ends){ true, 0.3, 0.05 }; }
static void rolling(dem_scene_definition *d) { d->contact.rolling_friction = d->contact.wall_rolling_friction = 0.1; }
static void rolling_by(dem_scene_definition *d, dem_rolling_law law)
{
    rolling(d);
    d->contact.rolling_law = law;
    d->contact.rolling_damping = 0.3;
}
static void damped_rolling(dem_scene_definition *d) { rolling_by(d, DEM_EPSD_DAMPED); }
static void constant_torque(dem_scene_definition *d) { rolling_by(d, DEM_CONSTANT_TORQUE); }
static void on_a_slope(dem_scene_definition *d)
{
    end_walls(d);
    d->tilt = 0.2;
}
static void sizes(dem_scene_definition *d)
{
    const double size = d->species[0].diameter;
    d->species[0].sizes = (dem_sizes){ .law = DEM_UNIFORM, .by_volume = true, .minimum = 0.8 * size, .maximum = 1.2 * size };
    dem_sizes_complete(&d->species[0]);
}
static void stages(dem_scene_definition *d)
{
    d->stage_count = 2;
    d->stage[0] = (dem_rotation_stage){ d->rotation_rate, 0.005 };
    d->stage[1] = (dem_rotation_stage){ -d->rotation_rate, 1 };
}
static void variable_unloading(dem_scene_definition *d) { d->contact.unloading_slope = 1e3; }
static void latch_damping(dem_scene_definition *d) { d->contact.latch_damping = 0.3; }
static void materials(dem_scene_definition *d)
{
    d->species_count = 2;
    d->species[0].share = 0.6;
    d->species[1] = (dem_species){ .diameter = 0.003, .density = 1500, .share = 0.4 };
    d->has_pairs = true;
    for (size_t a = 0; a < 2; a++)
        for (size_t b = 0; b < DEM_MAXIMUM_SPECIES + DEM_SURFACES; b++)
            d->pair[a][b] = (dem_pair){ .friction = 0.2 + 0.1 * (double)(a + b % 3),
                                        .restitution = 0.8 - 0.1 * (double)a,
                                        .stiffness = 3000 + 300 * (double)a };
    for (size_t a = 0; a < 2; a++)
        for (size_t b = 0; b < 2; b++) d->pair[a][b].friction = 0.2 + 0.1 * (double)(a + b);
}
static void liquid_bridges(dem_scene_definition *d)
{
    d->contact.cohesion_law = DEM_LIQUID_BRIDGE;
    d->contact.cohesion = d->contact.wall_cohesion =
        (dem_cohesion){ .strength = 0.02, .liquid_volume = 1e-11, .contact_angle = 0.3 };
}
static void other_sense(dem_scene_definition *d) { d->rotation_rate = -d->rotation_rate; }
static void standing_still(dem_scene_definition *d) { d->rotation_rate = 0; }
static void threads(dem_scene_definition *d) { d->threads = 2; }
static void lining(dem_scene_definition *d) { d->lining = (dem_lining){ .diameter = 0.003, .pitch = 0.004 }; }
static void lifters(dem_scene_definition *d)
{
    d->lifters = (dem_lifters){ .count = 4, .height = 0.004, .width = 0.003, .friction = 0.5 };
}

static void clusters_beside_spheres(dem_scene_definition *d)
{
    d->length = 0.02;
    d->species_count = 2;
    d->species[0].share = 0.8;
    d->species[1] = (dem_species){ .diameter = 0.003, .density = 2500, .share = 0.2 };
    dem_cluster_of_shape(&d->species[1].cluster, DEM_DUMBBELL, 0.003);
    dem_cluster_complete(&d->species[1].cluster);
    d->corrector_passes = 2;
}

static void standing_cylinder(dem_scene_definition *d)
{
    d->container = DEM_CYLINDER;
    d->length = 0.1;
    d->rotation_rate = 0;
    d->particle_count = 100;
}

static void fed_by_a_stream(dem_scene_definition *d)
{
    standing_cylinder(d);
    d->stream = (dem_stream){ .rate = 500, .diameter = 0.012, .impact_speed = 1.0 };
}

static void raised_tube(dem_scene_definition *d)
{
    standing_cylinder(d);
    d->container = DEM_TUBE_ON_PLATE;
    d->lift = (dem_lift){ .speed = 0.2, .start = 0.001 };
    d->plate = (dem_plate){ .diameter = 0.06, .friction = 0.4 };
}

static void flowing_out(dem_scene_definition *d)
{
    standing_cylinder(d);
    d->container = DEM_VESSEL;
    d->orifice = (dem_orifice){ .opening = 0.015 };
}

static void audit(dem_scene *scene) { scene->audit.is_on = true; }
static double no_time(void) { return 0; }
static void profile(dem_scene *scene)
{
    static dem_step_profile unused = { .clock = no_time };
    dem_scene_set_profile(scene, &unused);
}

typedef struct effect {
    const char *name;
    void (*define)(dem_scene_definition *); /* what of the definition switches it on */
    void (*begin)(dem_scene *);             /* or what else, once the drum turns; NULL: nothing */
    bool allows_waves;
} effect;

/* Everything that a scene can be made to do in its steps. */
static const effect effects[] = {
    { "nothing else", nothing, NULL, true },
    { "end walls", end_walls, NULL, true },
    { "rolling friction", rolling, NULL, true },
    { "damped rolling", damped_rolling, NULL, true },
    { "the constant torque of rolling", constant_torque, NULL, true },
    { "variable unloading", variable_unloading, NULL, true },
    { "latch damping", latch_damping, NULL, true },
    { "materials", materials, NULL, true },
    { "cohesion beyond touch", liquid_bridges, NULL, true },
    { "sizes", sizes, NULL, true },
    { "a tilted axis", on_a_slope, NULL, true },
    { "the other sense", other_sense, NULL, true },
    { "standing still", standing_still, NULL, true },
    { "stages", stages, NULL, false },
    { "threads", threads, NULL, true },
    { "a lining", lining, NULL, false },
    { "lifters", lifters, NULL, false },
    { "clusters", clusters_beside_spheres, NULL, false },
    { "a cylinder", standing_cylinder, NULL, false },
    { "a stream", fed_by_a_stream, NULL, false },
    { "a tube on a plate", raised_tube, NULL, false },
    { "a vessel with an orifice", flowing_out, NULL, false },
    { "the audit of energy", nothing, audit, false },
    { "the profile", nothing, profile, false },
};

/* A definition with a new member does not have this size: say in `effects` what the member switches on in a step, and
 * whether waves foresee it (wave_is_possible in wave.c). */
_Static_assert(sizeof(dem_scene_definition) - sizeof(((dem_scene_definition *)NULL)->species)
                       - sizeof(((dem_scene_definition *)NULL)->pair)
                   == DEFINITION_BYTES,
               "each member that acts in a step has a row in effects");
_Static_assert(sizeof(energy_audit) == 3 * sizeof(double), "what the audit counts is compared below");

static void check_effect(const effect *e)
{
    dem_scene_definition d = small_drum();
    e->define(&d);
    follow_rules(&d, 0.04);
    dem_scene *waves = scene_in_waves(&d, 0), *single = scene_in_waves(&d, 0);
    tally sum = { 0 };
    for (int phase = DEM_PHASE_SETTLING; phase <= DEM_PHASE_RUNNING; phase++) {
        run_to_phase(waves, (dem_phase)phase);
        run_to_phase(single, (dem_phase)phase);
        if (e->begin && phase == DEM_PHASE_RUNNING) {
            e->begin(waves);
            e->begin(single);
            sum = (tally){ 0 };
        }
        const tally t = compare(waves, single, 60);
        assert_memory_equal(&waves->audit, &single->audit, sizeof waves->audit);
        sum.steps += t.steps;
        sum.in_waves += t.in_waves;
    }
    if (e->allows_waves ? sum.in_waves < sum.steps / 2 : sum.in_waves > 0)
        fail_msg("%s: %lld of %lld steps were in waves", e->name, (long long)sum.in_waves, (long long)sum.steps);
    dem_scene_free(waves);
    dem_scene_free(single);
}

static void every_effect_of_a_step_has_the_same_bits_where_waves_are_allowed(void **unused)
{
    (void)unused;
    for (size_t k = 0; k < sizeof effects / sizeof *effects; k++) check_effect(&effects[k]);
}

/* What a wave would not foresee keeps to single steps. */
static void what_moves_otherwise_takes_single_steps(void **unused)
{
    (void)unused;
    dem_scene_definition d = slender_drum();
    follow_rules(&d, 0.04);
    dem_scene *scene = scene_in_waves(&d, 0);
    assert_int_equal(wave_length(scene, 1000), 1); /* it grows */
    run_to_phase(scene, DEM_PHASE_RUNNING);
    run(scene, 10);
    int longest = 0;
    for (int k = 0; k < 20; k++) {
        run(scene, 1);
        const int length = wave_length(scene, 1000);
        longest = length > longest ? length : longest;
        scene->definition.rotation_rate *= 2; /* the wall's velocity is another from the next step on */
        assert_int_equal(wave_length(scene, 1000), 1);
        scene->definition.rotation_rate /= 2;
    }
    assert_true(longest > 3);
    dem_scene_free(scene);
}

UNIT_TESTS(waves_have_the_same_bits_as_single_steps, of_a_rolling_mixture_between_end_walls_too, by_every_law,
           waves_that_stop_on_their_way_have_the_same_bits, a_drum_that_is_too_soft_stops_as_in_single_steps,
           every_effect_of_a_step_has_the_same_bits_where_waves_are_allowed, what_moves_otherwise_takes_single_steps)
