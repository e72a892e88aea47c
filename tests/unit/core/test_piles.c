/* A pile of four equal spheres at the step that runs take. Closed form: the upper sphere's weight spreads the three below it;
 * floor and upper sphere press each of them, and the pile stands where the friction between spheres is above
 * tan(half the angle between the upward vertical and a line of centres) = sqrt(3) - sqrt(2) = 0.318, and that of the floor too. */
#include "core_claims.h"
#include "dem.h"
#include "dem_rules.h"

static const double D = 0.002; /* m, of a sphere */

/* What the daemon would make of such a drum, for an overlap of 1 % of the diameter. */
static dem_scene_definition drum_of_a_pile(double restitution, bool variable, double friction, double latch_damping)
{
    dem_scene_definition d = {
        .diameter = 0.16,
        .length = 0.06,
        .gravity = 9.81,
        .particle_count = 4,
        .species_count = 1,
        .species = { { .diameter = D, .density = 2500, .share = 1 } },
        .contact = { .restitution = restitution,
                     .friction = friction,
                     .wall_friction = friction,
                     .tangential_stiffness_ratio = 0.8,
                     .latch_damping = latch_damping },
        .is_placed = true,
        .seed = 1,
        .threads = 1,
    };
    const double mass = dem_species_mass(&d.species[0]), speed = dem_impact_speed(d.diameter, D, d.gravity, friction, 0);
    d.contact.stiffness = dem_stiffness_for_overlap(speed, mass, 0.01 * D);
    if (variable) d.contact.unloading_slope = (1 / (restitution * restitution) - 1) / (0.01 * D);
    d.time_step = dem_latching_time_step(d.contact.stiffness, mass, restitution);
    return d;
}

/* Height of the upper sphere over the others, in diameters, after so many seconds; sqrt(2/3) at first. */
static double height_after(double seconds, const dem_scene_definition *d)
{
    /* three that touch each other and the drum, two of them side by side: a triangle that is tilted a little */
    const double floor = -0.5 * (d->diameter - D), side = D / 2, low = -sqrt(floor * floor - side * side), up = low - floor;
    const double away = sqrt(0.75 * D * D - up * up), tall = sqrt(2.0 / 3) * D, length = hypot(away, up);
    const dem_placed_particle pile[4] = { { .position = { -side, low, 0 } },
                                          { .position = { side, low, 0 } },
                                          { .position = { 0, floor, away } },
                                          { .position = { 0, (2 * low + floor) / 3 + tall * away / length,
                                                          away / 3 + tall * up / length } } };
    dem_scene *scene = NULL;
    assert_int_equal(dem_scene_create(d, &scene), DEM_OK);
    assert_int_equal(dem_scene_place(scene, pile, 4, 0), DEM_OK);
    assert_int_equal(dem_scene_advance(scene, (int64_t)(seconds / d->time_step)), DEM_OK);
    double x[12];
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = x });
    dem_scene_free(scene);
    int top = 0;
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        sum += x[3 * k + 1];
        if (x[3 * k + 1] > x[3 * top + 1]) top = k;
    }
    return (x[3 * top + 1] - (sum - x[3 * top + 1]) / 3) / D;
}

static const double RESTITUTIONS[] = { 0.1, 0.3, 0.5, 0.8, 0.95 };

/* It may sink by its own weight's overlaps and by what slips while it finds its rest: a thousandth of a diameter. */
static void four_spheres_stand_where_friction_holds_them(void **unused)
{
    (void)unused;
    for (int k = 0; k < 5; k++)
        for (int variable = 0; variable < 2; variable++)
            for (double friction = 0.34; friction < 0.6; friction += 0.16) {
                const dem_scene_definition d = drum_of_a_pile(RESTITUTIONS[k], variable, friction, 0.3);
                CHECK_NEAR(height_after(0.4, &d), sqrt(2.0 / 3), 1e-3);
            }
}

static void four_spheres_fall_where_it_does_not(void **unused)
{
    (void)unused;
    const dem_scene_definition d = drum_of_a_pile(0.8, false, 0.30, 0.3);
    CHECK_BETWEEN(height_after(0.4, &d), -0.1, 0.5);
}

/* As the paper has it: nothing takes the swinging below the latch away. */
static void without_damping_below_the_latch_they_sink(void **unused)
{
    (void)unused;
    const dem_scene_definition constant = drum_of_a_pile(0.5, false, 0.5, 0), variable = drum_of_a_pile(0.8, true, 0.5, 0);
    CHECK_BETWEEN(height_after(0.4, &constant), 0, sqrt(2.0 / 3) - 3e-3);
    CHECK_BETWEEN(height_after(0.4, &variable), -0.1, 0.75);
}

UNIT_TESTS(four_spheres_stand_where_friction_holds_them, four_spheres_fall_where_it_does_not,
           without_damping_below_the_latch_they_sink)
