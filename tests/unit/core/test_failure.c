/* Claims about numerical failure: a run that can't be right stops, and says which particle, where and why. */
#include "failure.h"
#include "neighbor_list.h"
#include "scene_by_hand.h"
#include "small_drum.h"

static void check_description(const dem_scene *scene, dem_status status)
{
    const dem_failure *f = dem_scene_failure(scene);
    assert_int_equal(f->status, status);
    CHECK_BETWEEN(f->particle, 0, (double)dem_scene_particle_count(scene) - 1);
    CHECK_BETWEEN(f->other, -1, (double)dem_scene_particle_count(scene) - 1);
    assert_int_equal(f->step, dem_scene_step_count(scene));
    CHECK_NEAR(f->time, dem_scene_time(scene), 0);
    assert_non_null(f->quantity);
    assert_non_null(f->unit);
    assert_true(strlen(f->likely_cause) > 20);
}

/* A drum whose contacts are 300 times too soft. */
static void a_drum_that_is_too_soft_stops_and_says_so(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    d.rotation_rate = 15;
    follow_rules(&d, 0.03);
    d.contact.stiffness /= 300;
    dem_scene *scene = drum_scene(&d);
    dem_status status = DEM_OK;
    for (int k = 0; k < 600 && status == DEM_OK; k++) status = dem_scene_advance(scene, 50);
    assert_true(status == DEM_OVERLAP_TOO_LARGE || status == DEM_PARTICLE_ESCAPED);
    check_description(scene, status);
    const dem_failure *f = dem_scene_failure(scene);
    CHECK_BETWEEN(f->value, f->limit, INFINITY);
    assert_string_equal(f->unit, "m");
    CHECK_BETWEEN(hypot(f->position[0], f->position[1]), 0, 1.5 * d.diameter);
    assert_non_null(strstr(f->likely_cause, "stiffness"));
    dem_scene_free(scene);
}

/* A collision at a speed that must end with an overlap of v sqrt(m_eff/K1) = 0.6 radii stops on the way there. */
static void an_overlap_beyond_half_a_radius_is_a_failure_of_those_two(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(3);
    const double r = 0.002, m_eff = species_mass(&d.species[0]) / 2, v = 0.6 * r / sqrt(m_eff / d.contact.stiffness);
    dem_scene *scene = weightless_scene(&d);
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0, 0.05, 0.01, 0.02, 0, 0.012, 0.0241, 0, 0.012 },
                                       .velocity = (double[]){ 0, 0, 0, v, 0, 0, 0, 0, 0 } });
    assert_int_equal(dem_scene_advance(scene, 1000), DEM_OVERLAP_TOO_LARGE);
    check_description(scene, DEM_OVERLAP_TOO_LARGE);
    const dem_failure *f = dem_scene_failure(scene);
    assert_int_equal(f->particle, 1);
    assert_int_equal(f->other, 2);
    CHECK_NEAR(f->limit, 0.5 * r, 1e-6 * r);
    CHECK_BETWEEN(f->value, 0.5 * r, 0.5 * r + 2 * v * d.time_step); /* found at once */
    dem_scene_free(scene);
    /* and nine tenths of that speed is none */
    scene = weightless_scene(&d);
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0, 0.05, 0.01, 0.02, 0, 0.012, 0.0241, 0, 0.012 },
                                       .velocity = (double[]){ 0, 0, 0, 0.75 * v, 0, 0, 0, 0, 0 } });
    advance(scene, 300);
    CHECK_NEAR(dem_scene_maximum_overlap(scene), 0.75 * 0.6 * r / 0.004, 1e-3);
    dem_scene_free(scene);
}

/* A particle thrown at the wall so fast that it is through before a force acts. */
static void a_particle_beyond_the_wall_has_escaped(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(2);
    dem_scene *scene = weightless_scene(&d);
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ 0.02, 0, 0, 0.09, 0, 0.01 },
                                       .velocity = (double[]){ 0, 0, 0, 3000, 0, 0 } });
    assert_int_equal(dem_scene_advance(scene, 100), DEM_PARTICLE_ESCAPED);
    check_description(scene, DEM_PARTICLE_ESCAPED);
    const dem_failure *f = dem_scene_failure(scene);
    assert_int_equal(f->particle, 1);
    CHECK_NEAR(f->limit, 0.1, 1e-12);
    CHECK_BETWEEN(f->value, 0.1, 0.2);
    assert_string_equal(f->quantity, "distance from the axis");
    dem_scene_free(scene);
}

enum { STEPS_BETWEEN_LOOKS = HORIZON * PICKS_BETWEEN_LOOKS };

/* A NaN from wherever is found when places are looked at next, wherever it sits. */
static void a_place_or_velocity_that_is_not_a_number_is_found_at_the_next_look(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    follow_rules(&d, 0.03);
    const size_t where[] = { 0, 17, d.particle_count - 1 };
    for (int k = 0; k < 3 * 6; k++) {
        dem_scene *scene = drum_scene(&d);
        run(scene, 107);
        (k % 6 < 3 ? scene->spheres.velocity : scene->spheres.place)[where[k / 6]][k % 3] = NAN;
        assert_int_equal(dem_scene_advance(scene, STEPS_BETWEEN_LOOKS + 1), DEM_NOT_A_NUMBER);
        check_description(scene, DEM_NOT_A_NUMBER);
        CHECK_BETWEEN(dem_scene_step_count(scene), 107, 107 + STEPS_BETWEEN_LOOKS);
        dem_scene_free(scene);
    }
}

/* The same of a sphere that touches nothing, among others at rest, where no bound is ever passed. */
static void what_is_not_a_number_is_found_among_spheres_at_rest(void **unused)
{
    (void)unused;
    const dem_scene_definition d = hand_definition(2);
    for (int k = 0; k < 6; k++) {
        dem_scene *scene = weightless_scene(&d);
        place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = (double[]){ 0.02, 0, 0, 0.05, 0, 0.01 } });
        run(scene, 10);
        (k < 3 ? scene->spheres.velocity : scene->spheres.place)[1][k % 3] = NAN;
        assert_int_equal(dem_scene_advance(scene, STEPS_BETWEEN_LOOKS + 1), DEM_NOT_A_NUMBER);
        dem_scene_free(scene);
    }
}

/* However near the centres are: forces and speeds stay finite, and the pair is told. */
static void spheres_nearly_one_in_another_overlap_too_much(void **unused)
{
    (void)unused;
    const dem_scene_definition d = hand_definition(2);
    for (double apart = 1e-8; apart < 0.3; apart *= 3) {
        dem_scene *scene = weightless_scene(&d);
        place_by_hand(scene,
                      &(placement){ .phase = DEM_PHASE_RUNNING, .position = (double[]){ 0.02, 0, 0, 0.02, apart * 0.004, 0 } });
        assert_int_equal(dem_scene_advance(scene, 1), DEM_OVERLAP_TOO_LARGE);
        CHECK_NEAR(dem_scene_failure(scene)->value, (1 - apart) * 0.004, 1e-3 * 0.004);
        dem_scene_free(scene);
    }
}

/* What a failed scene does next is fail again, not go on. */
static void a_failed_scene_stays_failed(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(1);
    dem_scene *scene = weightless_scene(&d);
    place_by_hand(
        scene,
        &(placement){ .phase = DEM_PHASE_RUNNING, .position = (double[]){ 0.09, 0, 0 }, .velocity = (double[]){ 3000, 0, 0 } });
    assert_int_equal(dem_scene_advance(scene, 100), DEM_PARTICLE_ESCAPED);
    assert_int_not_equal(dem_scene_advance(scene, 100), DEM_OK);
    dem_scene_free(scene);
}

static void a_definition_out_of_range_is_refused(void **unused)
{
    (void)unused;
    dem_scene_definition good = small_drum();
    follow_rules(&good, 0.03);
    dem_scene *scene = NULL;
    assert_int_equal(dem_scene_create(&good, &scene), DEM_OK);
    dem_scene_free(scene);
    struct {
        size_t offset;
        double bad;
    } cases[] = {
        { offsetof(dem_scene_definition, diameter), -0.1 },
        { offsetof(dem_scene_definition, diameter), NAN },
        { offsetof(dem_scene_definition, diameter), 0.005 },
        { offsetof(dem_scene_definition, length), 0.005 },
        { offsetof(dem_scene_definition, rotation_rate), INFINITY },
        { offsetof(dem_scene_definition, gravity), 0 },
        { offsetof(dem_scene_definition, time_step), 0 },
        { offsetof(dem_scene_definition, species[0].diameter), 0 },
        { offsetof(dem_scene_definition, species[0].density), -1 },
        { offsetof(dem_scene_definition, species[0].share), 0.9 },
        { offsetof(dem_scene_definition, contact.stiffness), 0 },
        { offsetof(dem_scene_definition, contact.restitution), 0 },
        { offsetof(dem_scene_definition, contact.restitution), 1.01 },
        { offsetof(dem_scene_definition, contact.friction), -0.1 },
        { offsetof(dem_scene_definition, contact.wall_friction), NAN },
        { offsetof(dem_scene_definition, lining.diameter), 0.02 },
        { offsetof(dem_scene_definition, contact.tangential_stiffness_ratio), 0 },
        { offsetof(dem_scene_definition, lining.diameter), NAN },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        dem_scene_definition bad = good;
        memcpy((char *)&bad + cases[k].offset, &cases[k].bad, sizeof(double));
        if (dem_scene_create(&bad, &scene) != DEM_BAD_PARAMETER) fail_msg("case %zu was not refused", k);
        assert_null(scene);
    }
}

UNIT_TESTS(a_drum_that_is_too_soft_stops_and_says_so, an_overlap_beyond_half_a_radius_is_a_failure_of_those_two,
           a_particle_beyond_the_wall_has_escaped, a_place_or_velocity_that_is_not_a_number_is_found_at_the_next_look,
           what_is_not_a_number_is_found_among_spheres_at_rest, spheres_nearly_one_in_another_overlap_too_much,
           a_failed_scene_stays_failed, a_definition_out_of_range_is_refused)
