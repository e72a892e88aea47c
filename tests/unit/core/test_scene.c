/* Claims about a whole scene: the same bits however it is run, saved or restored; rest stays rest; the axis has no
 * beginning. */
#include <unistd.h>

#include "scene_by_hand.h"
#include "small_drum.h"

static dem_state state_of(const dem_scene *scene)
{
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    return state;
}

static bool are_equal(const dem_scene *a, const dem_scene *b)
{
    dem_state x = state_of(a), y = state_of(b);
    const bool equal = states_are_equal(&x, &y);
    dem_state_clear(&x);
    dem_state_clear(&y);
    return equal;
}

static dem_scene_definition quick_drum(void)
{
    dem_scene_definition d = small_drum();
    d.lining = (dem_lining){ .diameter = 0.002, .pitch = 0.004 };
    d.particle_count = 220;
    d.rotation_rate = 12;
    follow_rules(&d, 0.03);
    return d;
}

/* Growing, settling and a good part of a turn, in calls of `stride` steps. */
static int64_t whole_run(const dem_scene_definition *d)
{
    dem_scene *scene = drum_scene(d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    const int64_t steps = dem_scene_step_count(scene) + 1500;
    dem_scene_free(scene);
    return steps;
}

static dem_scene *run_in_calls(const dem_scene_definition *d, int64_t steps, int64_t stride)
{
    dem_scene *scene = drum_scene(d);
    for (int64_t done = 0; done < steps; done += stride) run(scene, done + stride < steps ? stride : steps - done);
    assert_int_equal(dem_scene_step_count(scene), steps);
    assert_int_equal(dem_scene_phase(scene), DEM_PHASE_RUNNING);
    return scene;
}

static void advancing_to_rotation_ends_at_its_first_step(void **unused)
{
    (void)unused;
    dem_scene_definition d = quick_drum();
    for (d.threads = 1; d.threads <= 2; d.threads++) {
        dem_scene *once = drum_scene(&d), *stepwise = drum_scene(&d);
        assert_int_equal(dem_scene_advance_to_run(once, 7), DEM_OK);
        assert_int_equal(dem_scene_step_count(once), 7);
        assert_int_equal(dem_scene_advance_to_run(once, 1000000), DEM_OK);
        while (dem_scene_phase(stepwise) != DEM_PHASE_RUNNING) run(stepwise, 1);
        assert_int_equal(dem_scene_run_start(once), dem_scene_step_count(once));
        assert_true(are_equal(once, stepwise));
        assert_int_equal(dem_scene_advance_to_run(once, 5), DEM_OK);
        assert_true(are_equal(once, stepwise));
        dem_scene_free(once);
        dem_scene_free(stepwise);
    }
}

static void a_run_gives_the_same_bits_for_any_division_into_calls(void **unused)
{
    (void)unused;
    dem_scene_definition d = quick_drum();
    const int64_t steps = whole_run(&d);
    dem_scene *once = run_in_calls(&d, steps, steps);
    static const int64_t strides[] = { 1000000, 1, 7, 100 /* steps a call */ };
    for (int k = 0; k < 4; k++) {
        dem_scene *again = run_in_calls(&d, steps, strides[k]);
        assert_true(are_equal(once, again));
        dem_scene_free(again);
    }
    /* the comparison can tell: one step more is another state */
    dem_scene *again = run_in_calls(&d, steps, steps);
    run(once, 1);
    assert_false(are_equal(once, again));
    dem_scene_free(again);
    dem_scene_free(once);
}

/* From the start, and in a bed that turns; in growing the lists change the most, in the bed they are the longest. */
static void a_run_gives_the_same_bits_for_any_number_of_threads(void **unused)
{
    (void)unused;
    dem_scene_definition d = quick_drum();
    dem_scene *start = drum_scene(&d), *bed = drum_scene(&d);
    run_to_phase(bed, DEM_PHASE_RUNNING);
    dem_state turning = state_of(bed);
    run(start, 150);
    run(bed, 150);
    for (d.threads = 2; d.threads <= 3; d.threads++) {
        dem_scene *threaded = drum_scene(&d);
        run(threaded, 150);
        assert_true(are_equal(start, threaded));
        assert_int_equal(dem_scene_restore(threaded, &turning), DEM_OK);
        run(threaded, 150);
        assert_true(are_equal(bed, threaded));
        dem_scene_free(threaded);
    }
    dem_state_clear(&turning);
    dem_scene_free(start);
    dem_scene_free(bed);
}

/* A large sphere, first in memory, among small ones that press on it from all sides, more than a block of contacts has: where
 * parts are many, some begin and end within these and have contacts but no sphere. */
static dem_scene *besieged_sphere(int threads)
{
    enum { SMALL = 300, ALL = 1 + SMALL };
    dem_scene_definition d = hand_definition(ALL);
    d.species[0].diameter = 0.04;
    first_sphere_differs(&d, (dem_species){ .diameter = 0.004, .density = 2500 });
    d.threads = threads;
    double position[ALL][3] = { { 0.05 } }, velocity[ALL][3] = { { 0 } }, spin[ALL][3] = { { 0, 0, 3 } };
    for (int k = 1; k < ALL; k++) {
        const double z = (2 * k - 1.0) / SMALL - 1, turn = 2.399963229728653 * k, rho = sqrt(1 - z * z); /* golden angle */
        const double n[3] = { rho * cos(turn), rho * sin(turn), z };
        for (int c = 0; c < 3; c++) {
            position[k][c] = position[0][c] + 0.02199 * n[c];
            velocity[k][c] = -0.02 * n[c];
        }
        spin[k][k % 3] = 5;
    }
    dem_scene *scene = weightless_scene(&d);
    place_by_hand(
        scene,
        &(placement){ .phase = DEM_PHASE_RUNNING, .position = &position[0][0], .velocity = &velocity[0][0], .spin = &spin[0][0] });
    return scene;
}

static void parts_smaller_than_one_spheres_contacts_give_the_same_bits(void **unused)
{
    (void)unused;
    dem_scene *one = besieged_sphere(1);
    size_t of_the_large = 0;
    for (size_t k = 0; k < one->neighbors.pairs.count; k++) of_the_large += one->neighbors.pairs.first[k] == 0;
    assert_true(of_the_large > 2 * BLOCK);
    run(one, 200);
    for (int threads = 2; threads <= 64; threads *= 2) {
        dem_scene *several = besieged_sphere(threads);
        run(several, 200);
        if (!are_equal(one, several)) fail_msg("%d threads differ from one", threads);
        dem_scene_free(several);
    }
    dem_scene_free(one);
}

/* ---- save and restore ---- */

/* A new scene that goes on from where `scene` is. */
static dem_scene *continued(const dem_scene *scene, const dem_scene_definition *d)
{
    dem_state state = state_of(scene);
    dem_scene *copy = drum_scene(d);
    assert_int_equal(dem_scene_restore(copy, &state), DEM_OK);
    dem_state_clear(&state);
    return copy;
}

static void a_run_saved_and_restored_in_any_phase_goes_on_bit_for_bit(void **unused)
{
    (void)unused;
    dem_scene_definition d = quick_drum();
    const int64_t steps = whole_run(&d);
    dem_scene *straight = run_in_calls(&d, steps, steps);
    for (dem_phase phase = DEM_PHASE_GROWING; phase <= DEM_PHASE_RUNNING; phase++) {
        dem_scene *scene = drum_scene(&d);
        run_to_phase(scene, phase);
        run(scene, 333); /* in the middle of a list's life */
        assert_int_equal(dem_scene_phase(scene), phase);
        dem_scene *copy = continued(scene, &d);
        assert_true(are_equal(scene, copy));
        run(copy, steps - dem_scene_step_count(copy));
        assert_true(are_equal(straight, copy));
        CHECK_NEAR(dem_scene_time(copy), dem_scene_time(straight), 0);
        assert_int_equal(dem_scene_run_start(copy), dem_scene_run_start(straight));
        dem_scene_free(copy);
        dem_scene_free(scene);
    }
    dem_scene_free(straight);
}

/* Frames note when a particle was last seen falling: a restart must not forget it. */
static void what_measuring_noted_of_the_particles_is_saved_too(void **unused)
{
    (void)unused;
    dem_scene_definition d = quick_drum();
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    dem_scene *before = continued(scene, &d);
    double *frame = calloc(dem_frame_width(scene), sizeof *frame);
    assert_non_null(frame);
    assert_int_equal(dem_frame_measure(scene, frame), DEM_OK);
    free(frame);
    assert_false(are_equal(scene, before)); /* some were seen falling */
    dem_scene *copy = continued(scene, &d);
    assert_true(are_equal(scene, copy));
    dem_scene_free(before);
    dem_scene_free(copy);
    dem_scene_free(scene);
}

/* The first and the last step of a phase, where one forgets most easily what belongs to which. */
static void a_run_saved_at_the_very_change_of_phase_goes_on_bit_for_bit(void **unused)
{
    (void)unused;
    dem_scene_definition d = quick_drum();
    dem_scene *scene = drum_scene(&d);
    for (dem_phase phase = DEM_PHASE_SETTLING; phase <= DEM_PHASE_RUNNING; phase++) {
        while (dem_scene_phase(scene) < phase) {
            dem_state before = state_of(scene);
            run(scene, 1);
            if (dem_scene_phase(scene) == phase) {
                dem_scene *at_end = drum_scene(&d), *at_start = continued(scene, &d);
                assert_int_equal(dem_scene_restore(at_end, &before), DEM_OK);
                run(at_end, 201);
                run(at_start, 200);
                run(scene, 200);
                assert_true(are_equal(at_end, scene));
                assert_true(are_equal(at_start, scene));
                dem_scene_free(at_end);
                dem_scene_free(at_start);
            }
            dem_state_clear(&before);
        }
    }
    dem_scene_free(scene);
}

static void check_refused(dem_scene *scene, const dem_state *good, void (*spoil)(dem_state *))
{
    dem_state bad = *good; /* arrays shared: a spoiler changes their descriptions alone, or puts back what it changed */
    spoil(&bad);
    assert_int_equal(dem_scene_restore(scene, &bad), DEM_STATE_MISMATCH);
}

static void leave_out_velocity(dem_state *s) { state_array(s, "velocity")->name = "speed"; }
static void shorten_positions(dem_state *s) { state_array(s, "position")->rows--; }
static void flatten_positions(dem_state *s)
{
    state_array(s, "position")->columns = 1;
    state_array(s, "position")->rows *= 3;
}
static void mistype_counters(dem_state *s) { state_array(s, "counters")->element = DEM_FLOAT64; }
static void lose_a_history(dem_state *s) { state_array(s, "pair_history")->rows--; }
static void leave_out_walls(dem_state *s) { state_array(s, "wall_contact")->name = "floor"; }

static void a_state_of_another_shape_is_refused(void **unused)
{
    (void)unused;
    dem_scene_definition d = quick_drum();
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    dem_state good = state_of(scene);
    void (*const spoilers[])(dem_state *) = { leave_out_velocity, shorten_positions, flatten_positions,
                                              mistype_counters,   lose_a_history,    leave_out_walls };
    for (size_t k = 0; k < sizeof spoilers / sizeof *spoilers; k++) check_refused(scene, &good, spoilers[k]);

    int64_t *counters = state_array(&good, "counters")->data, phase = counters[0];
    counters[0] = 3;
    assert_int_equal(dem_scene_restore(scene, &good), DEM_STATE_MISMATCH);
    counters[0] = phase;
    int32_t *pair = state_array(&good, "pair")->data, kept = pair[0];
    pair[0] = (int32_t)d.particle_count; /* no mobile sphere */
    assert_int_equal(dem_scene_restore(scene, &good), DEM_STATE_MISMATCH);
    pair[0] = -1;
    assert_int_equal(dem_scene_restore(scene, &good), DEM_STATE_MISMATCH);
    pair[0] = kept;
    assert_int_equal(dem_scene_restore(scene, &good), DEM_OK); /* and the good one is taken after all */

    d.particle_count--;
    dem_scene *other = drum_scene(&d);
    assert_int_equal(dem_scene_restore(other, &good), DEM_STATE_MISMATCH);
    dem_scene_free(other);
    dem_state_clear(&good);
    dem_scene_free(scene);
}

/* ---- rest ---- */

/* Settled, left alone for 0.2 s, then watched for as long. What still moves is the last ringing of contacts, which
 * nothing damps but their hysteresis: 1e-4 of a diameter here, and a bound of ten times that. */
static void a_settled_bed_in_a_standing_drum_keeps_still(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    follow_rules(&d, 0.03);
    d.rotation_rate = 0;
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    const int64_t watch = (int64_t)(0.2 / d.time_step);
    run(scene, watch);
    const size_t n = d.particle_count;
    double *before = calloc(6 * n, sizeof *before), *after = before + 3 * n;
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = before });
    run(scene, watch);
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = after });
    double furthest = 0;
    for (size_t i = 0; i < n; i++) {
        const double dx = after[3 * i] - before[3 * i], dy = after[3 * i + 1] - before[3 * i + 1];
        const double dz = remainder(after[3 * i + 2] - before[3 * i + 2], d.length);
        furthest = fmax(furthest, sqrt(dx * dx + dy * dy + dz * dz));
    }
    free(before);
    CHECK_BETWEEN(furthest / 0.003, 0, 1e-3);
    dem_scene_free(scene);
}

/* Without weight nothing moves a block whose spheres just touch. */
static void a_block_of_touching_spheres_without_weight_stays_where_it_is(void **unused)
{
    (void)unused;
    enum { SIDE = 4, N = SIDE * SIDE * SIDE };
    dem_scene_definition d = hand_definition(N);
    dem_scene *scene = weightless_scene(&d);
    const double apart = 2 * scene->spheres.full_radius[0];
    double x[3 * N], after[3 * N];
    for (int i = 0; i < N; i++) {
        x[3 * i] = 0.03 + apart * (i % SIDE);
        x[3 * i + 1] = apart * (i / SIDE % SIDE);
        x[3 * i + 2] = apart * (i / SIDE / SIDE);
        for (int c = 0; c < 3; c++) x[3 * i + c] = nextafter(x[3 * i + c], 1);
    }
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = x });
    advance(scene, 2000);
    look_at(scene, after, NULL, NULL);
    /* Contacts see places in units u of 2^-32 of 8 diameters, so some pairs overlap by one: their springs push them apart
     * at u sqrt(K1/m) or so, here 5e-8 m/s. In double precision by a rounding of the place. */
    const double unit = sizeof(real) == sizeof(float) ? 8 * 0.004 / 4294967296.0 : 0.03 * DBL_EPSILON;
    const double speed = unit * sqrt(d.contact.stiffness / species_mass(&d.species[0]));
    for (int k = 0; k < 3 * N; k++) CHECK_NEAR(after[k], x[k], 3 * speed * 2000 * d.time_step);
    dem_scene_free(scene);
}

/* One sphere under its weight at the lowest line, at the overlap that carries it, stays there and does not turn. */
static void a_sphere_at_rest_on_the_wall_stays_at_rest(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(1);
    dem_scene *scene = hand_scene(&d);
    const double alpha = species_mass(&d.species[0]) * 9.81 / d.contact.stiffness;
    const double x[3] = { 0, -(0.1 - scene->spheres.full_radius[0] + alpha), 0.001 };
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = x });
    double now[3], v[3], w[3];
    for (int k = 0; k < 20; k++) {
        advance(scene, 100); /* 0.02 s: the parked spheres have fallen 2 mm */
        look_at(scene, now, v, w);
        for (int c = 0; c < 3; c++) {
            CHECK_NEAR(now[c], x[c], 10 * alpha * ROUNDING + 1e-15); /* the balance is as exact as the force */
            CHECK_NEAR(w[c], 0, 1e-9);
        }
    }
    dem_scene_free(scene);
}

/* ---- the axis ---- */

/* All z shifted by any amount: the same run but for rounding, which collisions magnify; over 300 steps of a bed, some
 * fifteen contact times, by less than a thousand. */
static void a_bed_shifted_along_the_axis_moves_as_before(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    follow_rules(&d, 0.03);
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    dem_state state = state_of(scene);
    const size_t n = d.particle_count;
    run(scene, 300);
    double *straight = calloc(6 * n, sizeof *straight), *shifted = straight + 3 * n;
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = straight });
    static const double shifts[] = { 0.0001, 0.003, 0.006, 0.0113 };
    double *z = state_array(&state, "position")->data;
    const double tolerance = 1000 * ROUNDING * 0.003 + 1e-14;
    for (int k = 0; k < 4; k++) {
        const double shift = shifts[k] - (k ? shifts[k - 1] : 0);
        for (size_t i = 0; i < n; i++) z[3 * i + 2] = remainder(z[3 * i + 2] + shift, d.length);
        assert_int_equal(dem_scene_restore(scene, &state), DEM_OK);
        run(scene, 300);
        dem_scene_particles(scene, &(dem_particle_arrays){ .position = shifted });
        for (size_t i = 0; i < n; i++) {
            CHECK_NEAR(shifted[3 * i], straight[3 * i], tolerance);
            CHECK_NEAR(shifted[3 * i + 1], straight[3 * i + 1], tolerance);
            CHECK_NEAR(remainder(shifted[3 * i + 2] - straight[3 * i + 2] - shifts[k], d.length), 0, tolerance);
        }
    }
    free(straight);
    dem_state_clear(&state);
    dem_scene_free(scene);
}

/* ---- the turning drum ---- */

/* A sphere pressed against a turning wall without weight is dragged along until it moves with it. */
static void a_turning_wall_drags_a_sphere_that_it_presses_on(void **unused)
{
    (void)unused;
    dem_scene_definition d = hand_definition(1);
    d.rotation_rate = 10;
    dem_scene *scene = weightless_scene(&d);
    scene_enter_phase(scene, DEM_PHASE_RUNNING);
    const double speed = d.rotation_rate * 0.1;
    place_by_hand(
        scene,
        &(placement){ .phase = DEM_PHASE_RUNNING, .position = (double[]){ 0, -0.0979, 0 }, .velocity = (double[]){ 0, -0.4, 0 } });
    advance(scene, 400);
    double v[3], w[3];
    look_at(scene, NULL, v, w);
    /* counter-clockwise, the lowest line moves towards +x; friction gives mu_w (1+e) v_n there, torque turns it */
    CHECK_NEAR(v[0], 0.5 * 1.8 * 0.4, 0.36 * 0.3);
    CHECK_BETWEEN(v[0], 0.05, speed);
    CHECK_BETWEEN(w[2], 1, INFINITY);
    dem_scene_free(scene);
}

/* The whole drum turned the other way round is its mirror image: the bed leans to the other side. */
static void a_drum_turned_backwards_leans_the_other_way(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    double angle[2];
    for (int k = 0; k < 2; k++) {
        d.rotation_rate = k ? -8 : 8;
        follow_rules(&d, 0.03);
        dem_scene *scene = drum_scene(&d);
        run_to_phase(scene, DEM_PHASE_RUNNING);
        run(scene, (int64_t)(0.15 / d.time_step));
        double *frame = calloc(dem_frame_width(scene), sizeof *frame);
        assert_int_equal(dem_frame_measure(scene, frame), DEM_OK);
        angle[k] = frame[2]; /* center_of_mass_deg */
        free(frame);
        dem_scene_free(scene);
    }
    assert_string_equal(dem_frame_scalar_name(2), "center_of_mass_deg");
    CHECK_BETWEEN(angle[0], 10, 60);
    CHECK_NEAR(angle[1], -angle[0], 6); /* one instant of one start each: the spread from frame to frame is 1 to 2 */
}

/* Threads that wait by spinning take ages where cores are busy; how they wait is read before main. */
static void wait_without_spinning(char **arguments)
{
    if (getenv("OMP_WAIT_POLICY")) return;
    setenv("OMP_WAIT_POLICY", "passive", 1);
    execv("/proc/self/exe", arguments);
}

int main(int count, char **arguments)
{
    (void)count;
    wait_without_spinning(arguments);
    return RUN_UNIT_TESTS(
        NULL, NULL, advancing_to_rotation_ends_at_its_first_step, a_run_gives_the_same_bits_for_any_division_into_calls,
        a_run_gives_the_same_bits_for_any_number_of_threads, parts_smaller_than_one_spheres_contacts_give_the_same_bits,
        a_run_saved_and_restored_in_any_phase_goes_on_bit_for_bit, what_measuring_noted_of_the_particles_is_saved_too,
        a_run_saved_at_the_very_change_of_phase_goes_on_bit_for_bit, a_state_of_another_shape_is_refused,
        a_settled_bed_in_a_standing_drum_keeps_still, a_block_of_touching_spheres_without_weight_stays_where_it_is,
        a_sphere_at_rest_on_the_wall_stays_at_rest, a_bed_shifted_along_the_axis_moves_as_before,
        a_turning_wall_drags_a_sphere_that_it_presses_on, a_drum_turned_backwards_leans_the_other_way);
}
