/* Claims about spheres of one species that are not all alike: that so many have the sizes asked for, and that each moves as
 * one of its size. */
#include "dem_sizes.h"
#include "measure.h"
#include "scene.h"
#include "small_drum.h"

enum { MANY = 1000 };

/* Deviations from the mean that 10 and 90 % of a normal distribution are below. */
#define DEVIATIONS_OF_TENTH 1.2815515655446004

static dem_size_table table;

/* The size that a share of the drawn particles, by number or by volume, is below: half of each counts as below itself. */
static double drawn(const double *d, size_t count, bool by_volume, double share)
{
    double all = 0, below = 0, before = 0;
    for (size_t k = 0; k < count; k++) all += by_volume ? d[k] * d[k] * d[k] : 1;
    for (size_t k = 0; k < count; k++) {
        const double weight = (by_volume ? d[k] * d[k] * d[k] : 1) / all, at = below + weight / 2;
        if (at >= share) return d[k] + (d[k] - d[k > 0 ? k - 1 : 0]) * (share - at) / (at - before);
        before = at;
        below += weight;
    }
    return d[count - 1];
}

/* D10, D50 and D90 of so many particles, and of the table, as they should be. */
static void check_percentiles(const dem_sizes *sizes, bool by_volume, const double expected[3], double tolerance)
{
    static double d[MANY];
    assert_true(dem_sizes_are_good(sizes));
    dem_size_table_set(&table, sizes);
    dem_size_table_draw(&table, MANY, d);
    for (size_t k = 1; k < MANY; k++) assert_true(d[k] >= d[k - 1]);
    assert_true(d[0] >= sizes->minimum && d[MANY - 1] <= sizes->maximum);
    for (int k = 0; k < 3; k++) {
        const double share = k == 0 ? 0.1 : k == 1 ? 0.5 : 0.9;
        CHECK_NEAR(drawn(d, MANY, by_volume, share), expected[k], tolerance * expected[k]);
        CHECK_NEAR(dem_size_table_at(&table, by_volume, share), expected[k], 1e-4 * expected[k]);
    }
}

static void a_thousand_lognormal_by_mass_have_the_percentiles_asked_for_and_hatch_and_choates(void **unused)
{
    (void)unused;
    const double s = log(1.2), median = 0.004, far = exp(8 * s);
    const dem_sizes sizes = { DEM_LOGNORMAL, true, median, 1.2, median / far, median * far, 0, { 0 }, { 0 } };
    const double tenth = exp(DEVIATIONS_OF_TENTH * s), by_number = median * exp(-3 * s * s);
    check_percentiles(&sizes, true, (double[]){ median / tenth, median, median * tenth }, 0.003);
    check_percentiles(&sizes, false, (double[]){ by_number / tenth, by_number, by_number * tenth }, 0.002);
    CHECK_NEAR(table.sauter_mean, median * exp(-s * s / 2), 1e-6 * median);
    CHECK_NEAR(table.mean_diameter, median * exp(-1.5 * s * s), 1e-6 * median); /* of the mean volume by number */
}

/* Each closed form between its ends: the share p of what is left is below F^-1(F_min + p (F_max - F_min)). */
static void other_laws_have_theirs_cut_at_their_ends(void **unused)
{
    (void)unused;
    const dem_sizes even = { DEM_UNIFORM, true, 0, 0, 0.002, 0.006, 0, { 0 }, { 0 } };
    check_percentiles(&even, true, (double[]){ 0.0024, 0.004, 0.0056 }, 0.003);
    const dem_sizes normal = { DEM_NORMAL, false, 0.004, 0.0004, 0.004 - 0.0004, 0.004 + 0.0004, 0, { 0 }, { 0 } };
    /* Phi(1) - Phi(-1) = 0.682689; Phi^-1(0.158655 + 0.0682689) = -0.748922 */
    check_percentiles(&normal, false, (double[]){ 0.004 - 0.748922 * 0.0004, 0.004, 0.004 + 0.748922 * 0.0004 }, 0.001);
    const double n = 3, size = 0.005, low = 0.003, high = 0.007, f_low = 1 - exp(-pow(low / size, n)),
                 f_high = 1 - exp(-pow(high / size, n));
    double expected[3];
    for (int k = 0; k < 3; k++)
        expected[k] = size * pow(-log(1 - (f_low + (k == 0 ? 0.1 : k == 1 ? 0.5 : 0.9) * (f_high - f_low))), 1 / n);
    const dem_sizes rosin = { DEM_ROSIN_RAMMLER, true, size, n, low, high, 0, { 0 }, { 0 } };
    check_percentiles(&rosin, true, expected, 0.003);
    /* straight lines between 0.1 below 2 mm, 0.6 below 4 mm and 1 below 8 mm; cut at 2 and at 8: 0.9 is left */
    const dem_sizes sieves = { DEM_SIEVES, true, 0, 0, 0.002, 0.008, 3, { 0.002, 0.004, 0.008 }, { 0.1, 0.6, 1.0 } };
    check_percentiles(&sieves, true,
                      (double[]){ 0.002 + 0.09 / 0.5 * 0.002, 0.002 + 0.45 / 0.5 * 0.002, 0.004 + 0.31 / 0.4 * 0.004 }, 0.004);
    CHECK_NEAR(dem_sizes_at(&rosin, 1 - exp(-1)), size, 1e-12);
    CHECK_NEAR(dem_sizes_at(&normal, 0.841344746068543), 0.0044, 1e-12);
}

static void what_is_no_distribution_is_refused(void **unused)
{
    (void)unused;
    const dem_sizes good = { DEM_LOGNORMAL, true, 0.004, 1.2, 0.003, 0.005, 0, { 0 }, { 0 } };
    dem_sizes bad[6];
    for (int k = 0; k < 6; k++) bad[k] = good;
    bad[0].width = 1;
    bad[1].minimum = 0.005;
    bad[2].center = NAN;
    bad[3].minimum = 0;
    bad[4] = (dem_sizes){ DEM_SIEVES, true, 0, 0, 0.002, 0.004, 2, { 0.004, 0.002 }, { 0, 1 } };
    bad[5] = (dem_sizes){ DEM_SIEVES, true, 0, 0, 0.001, 0.004, 2, { 0.002, 0.004 }, { 0, 1 } };
    assert_true(dem_sizes_are_good(&good));
    for (int k = 0; k < 6; k++) {
        assert_false(dem_sizes_are_good(&bad[k]));
        dem_scene_definition d = small_drum();
        dem_scene *scene;
        follow_rules(&d, 0.03);
        d.species[0].sizes = bad[k];
        assert_int_equal(dem_scene_create(&d, &scene), DEM_BAD_PARAMETER);
    }
}

/* ---- in a scene ---- */

static dem_scene_definition drum_of_sizes(void)
{
    dem_scene_definition d = small_drum();
    d.length = 0.0151;
    d.species[0].sizes = (dem_sizes){ DEM_LOGNORMAL, true, 0.003, 1.3, 0.002, 0.005, 0, { 0 }, { 0 } };
    dem_sizes_complete(&d.species[0]);
    d.particle_count = 150;
    d.fill_fraction = 0.3;
    follow_rules(&d, 0.03);
    return d;
}

enum { ROOM = 200 };
typedef struct motion {
    double x[3 * ROOM], v[3 * ROOM], w[3 * ROOM], radius[ROOM];
} motion;

static void look(const dem_scene *scene, motion *m)
{
    assert_true(dem_scene_sphere_count(scene) <= ROOM);
    memset(m, 0, sizeof *m);
    dem_scene_particles(
        scene, &(dem_particle_arrays){ .position = m->x, .velocity = m->v, .angular_velocity = m->w, .radius = m->radius });
}

static void each_has_the_mass_and_inertia_of_its_size(void **unused)
{
    (void)unused;
    const dem_scene_definition d = drum_of_sizes();
    dem_scene *scene = drum_scene(&d);
    double volume = 0;
    for (size_t i = 0; i < d.particle_count; i++) {
        const double r = (double)scene->spheres.full_radius[i], mass = 4.0 / 3 * M_PI * r * r * r * 2500;
        CHECK_NEAR(sphere_inverse_mass(&scene->spheres, i) * mass, 1, 1e-12);
        CHECK_NEAR(scene->spheres.inverse_inertia[scene->spheres.kind[i]] * 0.4 * mass * r * r, 1, 1e-12);
        volume += mass / 2500;
    }
    CHECK_NEAR(volume / (double)d.particle_count / dem_mean_volume(d.species, 1), 1, 1e-6);
    dem_scene_free(scene);
}

/* Diameters that binary has exactly: half of the spheres small, half large. */
#define SMALL (10.0 / 4096)
#define LARGE (16.0 / 4096)

/* The same bed twice: of one species, whose spheres are of two sizes, and of two species. */
static dem_scene *bed_of_two_sizes(bool as_species)
{
    enum { ROWS = 6, COUNT = ROWS * ROWS };
    dem_scene_definition d = small_drum();
    d.length = 0.02;
    d.is_placed = true;
    d.particle_count = COUNT;
    d.species[0].diameter = SMALL;
    d.species_count = 2;
    d.species[1] = (dem_species){ .diameter = LARGE, .density = 2500, .share = 0.5 };
    d.species[0].share = 0.5;
    follow_rules(&d, 0.03);
    if (!as_species) {
        d.species_count = 1;
        d.species[0].share = 1;
        d.species[0].sizes = (dem_sizes){ DEM_UNIFORM, false, 0, 0, SMALL, LARGE, 0, { 0 }, { 0 } };
    }
    dem_placed_particle bed[COUNT];
    for (int k = 0; k < COUNT; k++) {
        const bool is_large = k >= COUNT / 2;
        bed[k] = (dem_placed_particle){ .position = { (k % ROWS - 2.5) * 0.0041, (k / ROWS - 3.5) * 0.0041, 0.0002 * (k % 5) },
                                        .species = as_species && is_large,
                                        .diameter = as_species ? 0
                                                    : is_large ? LARGE
                                                               : SMALL };
    }
    dem_scene *scene = drum_scene(&d);
    assert_int_equal(dem_scene_place(scene, bed, COUNT, 0), DEM_OK);
    return scene;
}

static void spheres_of_one_species_move_as_those_of_species_of_their_sizes(void **unused)
{
    (void)unused;
    static motion of_sizes, of_species;
    dem_scene *sizes = bed_of_two_sizes(false), *species = bed_of_two_sizes(true);
    for (int k = 0; k < 4; k++) {
        run(sizes, 800);
        run(species, 800);
        look(sizes, &of_sizes);
        look(species, &of_species);
        assert_memory_equal(&of_sizes, &of_species, sizeof of_sizes);
    }
    assert_true(dem_scene_maximum_overlap(sizes) > 0);
    dem_scene_free(sizes);
    dem_scene_free(species);
}

static void a_bed_of_sizes_goes_on_with_the_same_bits_from_its_state_and_with_threads(void **unused)
{
    (void)unused;
    static motion of_first, of_second;
    dem_scene_definition d = drum_of_sizes();
    dem_scene *first = drum_scene(&d);
    run_to_phase(first, DEM_PHASE_RUNNING);
    dem_state state;
    assert_int_equal(dem_scene_save(first, &state), DEM_OK);
    d.seed = 6; /* which would draw the sizes in another order */
    d.threads = 3;
    d.is_placed = true;
    dem_scene *second = drum_scene(&d);
    assert_int_equal(dem_scene_continue(second, &state), DEM_OK);
    dem_state_clear(&state);
    for (int k = 0; k < 3; k++) {
        run(first, 500);
        run(second, 500);
        look(first, &of_first);
        look(second, &of_second);
        assert_memory_equal(&of_first, &of_second, sizeof of_first);
    }
    dem_scene_free(first);
    dem_scene_free(second);
}

static void a_size_that_the_species_has_not_is_no_state_of_it(void **unused)
{
    (void)unused;
    dem_scene_definition d = drum_of_sizes();
    d.particle_count = 1;
    d.is_placed = true;
    dem_scene *scene = drum_scene(&d);
    dem_placed_particle one = { .position = { 0 }, .diameter = 0.0051 };
    assert_int_equal(dem_scene_place(scene, &one, 1, 0), DEM_STATE_MISMATCH);
    one.diameter = 0.0049;
    assert_int_equal(dem_scene_place(scene, &one, 1, 0), DEM_OK);
    dem_scene_free(scene);
}

/* Nine spheres in a row, ascending in size outwards: the third of the large is 6 spacings farther out than that of the small. */
static void thirds_by_size_are_what_is_compared(void **unused)
{
    (void)unused;
    enum { COUNT = 9 };
    const double spacing = 0.005;
    dem_scene_definition d = drum_of_sizes();
    d.diameter = 0.12;
    d.length = 0.02;
    d.particle_count = COUNT;
    d.is_placed = true;
    dem_placed_particle row[COUNT];
    for (int k = 0; k < COUNT; k++)
        row[k] = (dem_placed_particle){ .position = { (k + 1) * spacing }, .diameter = 0.0021 + 0.0003 * k };
    dem_scene *scene = drum_scene(&d);
    assert_int_equal(dem_scene_place(scene, row, COUNT, 0), DEM_OK);
    CHECK_NEAR(measure_radial_index(scene), 6 * spacing / 0.06, 1e-12);
    dem_segregation_result r;
    assert_int_equal(measure_segregation_results(scene, &r), DEM_OK);
    assert_true(r.lacey_index < 0.5 && r.radial_index == measure_radial_index(scene));
    dem_scene_free(scene);
}

UNIT_TESTS(a_thousand_lognormal_by_mass_have_the_percentiles_asked_for_and_hatch_and_choates,
           other_laws_have_theirs_cut_at_their_ends, what_is_no_distribution_is_refused, each_has_the_mass_and_inertia_of_its_size,
           spheres_of_one_species_move_as_those_of_species_of_their_sizes,
           a_bed_of_sizes_goes_on_with_the_same_bits_from_its_state_and_with_threads,
           a_size_that_the_species_has_not_is_no_state_of_it, thirds_by_size_are_what_is_compared)
