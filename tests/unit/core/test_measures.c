/* Claims about the measures, on beds laid out by hand so that the answer is known before. */
#include "density_grid.h"
#include "measure.h"
#include "scene_by_hand.h"

/* ---- beds laid out by hand ---- */

static const double D = 0.003, RADIUS = 0.06, LENGTH = 0.018;
enum { SPHERES = 8000 };

typedef struct bed {
    double x[3 * SPHERES], v[3 * SPHERES];
    size_t count;
} bed;

/* A definition for so many spheres in the hand-made drum; shares for two species of the same size or not. */
static dem_scene_definition bed_definition(size_t count, double second_diameter, double second_share)
{
    dem_scene_definition d = hand_definition(count - PARKED);
    d.diameter = 2 * RADIUS;
    d.length = LENGTH;
    d.rotation_rate = 2;
    d.species[0].diameter = D;
    if (second_share > 0) {
        d.species_count = 2;
        d.species[0].share = 1 - second_share;
        d.species[1] = (dem_species){ .diameter = second_diameter, .density = 2500, .share = second_share };
    }
    return d;
}

/* A close-packed lattice cut at a plane that is tilted by phi and `offset` above the axis; its layers lie at `skew` to the
 * plane, 0: level with it. A little denser than touching, so that neighbors count as contacts; moved along by `phase`
 * of a lattice length. */
static void fill_below_plane(bed *b, double phi, double offset, double skew, double phase)
{
    const double a = 0.995 * D, row = a * sqrt(3) / 2, layer = a * sqrt(2.0 / 3), c = cos(phi + skew), sine = sin(phi + skew);
    const int across = (int)(LENGTH / a), reach = (int)(2 * RADIUS / layer) + 2;
    const double pitch = LENGTH / across; /* along the axis: a whole number in a period */
    b->count = 0;
    for (int k = -reach; k <= reach; k++)
        for (int j = -reach; j <= reach; j++)
            for (int i = 0; i < across; i++) {
                /* with no skew, the layer k = 0 ends at the plane */
                const double h = offset - D / 2 - k * layer, s = (j + phase + (k & 1) / 3.0) * row;
                const double x = s * c - h * sine, y = s * sine + h * c, z = (i + 0.5 * (j & 1) + 0.5 * (k & 1)) * pitch;
                if (hypot(x, y) > RADIUS - D / 2 || y * cos(phi) - x * sin(phi) > offset - D / 2 + 1e-9) continue;
                assert_true(b->count < SPHERES);
                double *p = b->x + 3 * b->count++;
                p[0] = x;
                p[1] = y;
                p[2] = remainder(z, LENGTH);
            }
}

/* The scene with all spheres, parked ones as well, where the bed says. */
static dem_scene *scene_of_bed(const bed *b, const dem_scene_definition *d)
{
    dem_scene *scene = hand_scene(d);
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    int64_t *counters = state_array(&state, "counters")->data;
    counters[0] = DEM_PHASE_RUNNING;
    counters[1] = counters[2] = counters[3] = 0;
    assert_int_equal(state_array(&state, "position")->rows, b->count);
    memcpy(state_array(&state, "position")->data, b->x, 3 * b->count * sizeof(double));
    memcpy(state_array(&state, "velocity")->data, b->v, 3 * b->count * sizeof(double));
    assert_int_equal(dem_scene_restore(scene, &state), DEM_OK);
    dem_state_clear(&state);
    return scene;
}

static double *frame_of(dem_scene *scene)
{
    double *frame = calloc(dem_frame_width(scene), sizeof *frame);
    assert_non_null(frame);
    assert_int_equal(dem_frame_measure(scene, frame), DEM_OK);
    return frame;
}

/* ---- angles ---- */

typedef struct expected_angle {
    frame_column column;
    double level;       /* degrees that it may be off on a bed whose layers are level with the plane */
    double rough, mean; /* on one bed whose lattice ends anyhow at the plane, and in the mean over such beds */
} expected_angle;

/* A rough surface has steps of up to a layer. A line through 60 % of the chord, 25 columns, feels 0.5 degrees of them;
 * half chords twice that; a chord between two points 24 mm apart, each at the mercy of one step, 4 degrees, which is
 * why instruments average it over 50 images. The centre of mass of a segment lies at right angles to its chord, but
 * for the unevenness with which a lattice fills the rounding of the wall. */
static const expected_angle expected_angles[] = {
    { FRAME_SURFACE_FIT, 0.05, 1.0, 0.3 }, { FRAME_THEIL_SEN, 0.05, 1.5, 0.4 },     { FRAME_UPPER_CHORD, 0.1, 2.5, 1.0 },
    { FRAME_LOWER_CHORD, 0.1, 2.5, 1.0 },  { FRAME_CENTER_OF_MASS, 0.7, 0.7, 0.3 }, { FRAME_CHORD, 0.3, 6.0, 2.0 },
};
enum { ANGLES = sizeof expected_angles / sizeof *expected_angles };

/* Frame of a bed cut at a plane, less the plane's angle; freed by the caller. */
static double *frame_of_plane(double phi_deg, double offset, double skew, double phase)
{
    static bed b;
    fill_below_plane(&b, phi_deg * M_PI / 180, offset, skew, phase);
    const dem_scene_definition d = bed_definition(b.count, 0, 0);
    dem_scene *scene = scene_of_bed(&b, &d);
    double *frame = frame_of(scene);
    dem_scene_free(scene);
    for (int k = 0; k < ANGLES; k++) frame[expected_angles[k].column] -= phi_deg;
    return frame;
}

static void every_angle_of_a_bed_cut_level_at_a_plane_is_that_of_the_plane(void **unused)
{
    (void)unused;
    static const double phis[] = { -35, 0, 10, 22.5, 45 }, offsets[] = { -0.015, 0.012, 0, 0.005, -0.008 };
    for (int p = 0; p < 5; p++) {
        double *frame = frame_of_plane(phis[p], offsets[p], 0, 0.37 * p);
        for (int k = 0; k < ANGLES; k++) CHECK_NEAR(frame[expected_angles[k].column], 0, expected_angles[k].level);
        CHECK_BETWEEN(frame[FRAME_SOLID_FRACTION], 0.68, 0.78); /* close packing: 0.7405 over 0.995^3 */
        free(frame);
    }
}

static void every_angle_of_a_rough_bed_is_that_of_the_plane_in_the_mean(void **unused)
{
    (void)unused;
    static const double phis[] = { -20, 5, 18, 26, 33, 40 }, skews[] = { 0.2, 0.35, 0.6 };
    enum { BEDS = 18 };
    double sum[ANGLES] = { 0 };
    for (int p = 0; p < BEDS; p++) {
        double *frame = frame_of_plane(phis[p % 6], 0.012 - 0.0013 * p, skews[p / 6], 0.37 * p);
        for (int k = 0; k < ANGLES; k++) {
            CHECK_NEAR(frame[expected_angles[k].column], 0, expected_angles[k].rough);
            sum[k] += frame[expected_angles[k].column] / BEDS;
        }
        free(frame);
    }
    for (int k = 0; k < ANGLES; k++) CHECK_NEAR(sum[k], 0, expected_angles[k].mean);
}

/* ---- flow of the surface ---- */

/* Velocities of a bed cut at a plane tilted by phi: `speed` downslope in its two topmost layers, and as much upslope below;
 * ten times that beyond the middle of the chord, which is not looked at. Returns the flow: downslope speed, none of what moves
 * upslope, over all in the middle. */
static double set_flow(bed *b, double phi, double offset, double speed)
{
    const double c = cos(phi), sine = sin(phi), down = phi > 0 ? -1 : 1, reach = RADIUS / 4;
    double flowing = 0, all = 0;
    for (size_t i = 0; i < b->count; i++) {
        const double *x = b->x + 3 * i, along = c * x[0] + sine * x[1], depth = offset - (c * x[1] - sine * x[0]);
        const bool is_middle = fabs(along) < reach, is_top = depth < 0.5 * D + 1.5 * D * sqrt(2.0 / 3);
        assert_true(fabs(fabs(along) - reach) > 1e-4); /* none in doubt */
        const double v = (is_middle ? speed : 10 * speed) * (is_top ? down : -down);
        b->v[3 * i] = c * v - 0.3 * speed * sine; /* and some of it at right angles to the surface */
        b->v[3 * i + 1] = sine * v + 0.3 * speed * c;
        all += is_middle;
        flowing += is_middle && is_top;
    }
    assert_true(flowing > 0.05 * all && flowing < 0.5 * all);
    return speed * flowing / all;
}

/* A surface that flows in n of N frames and rests in the others has a flow of f n/N in the mean, with a deviation of
 * f sqrt(n (N - n)/(N (N - 1))): their ratio is sqrt(N (N - n)/(n (N - 1))), above a half where 4 of 5 frames flow or fewer. */
static void flow_fluctuation_is_that_of_the_speed_downslope_over_all_frames_and_particles(void **unused)
{
    (void)unused;
    enum { FRAMES = 40 };
    static const int flowing[] = { 4, 10, 20, 30, 36, 40 };
    for (int sense = -1; sense <= 1; sense += 2) {
        static bed b;
        const double phi = sense * 25 * M_PI / 180, offset = -0.008, speed = 0.2;
        fill_below_plane(&b, phi, offset, 0, 0.37);
        const double flow = set_flow(&b, phi, offset, speed);
        dem_scene_definition d = bed_definition(b.count, 0, 0);
        d.rotation_rate = 2 * sense;
        dem_scene *scene = scene_of_bed(&b, &d);
        double *flows = frame_of(scene);
        CHECK_NEAR(flows[FRAME_FLOW_SPEED], flow, 1e-5 * flow); /* the surface's angle is known to 0.05 degrees */
        dem_scene_free(scene);
        memset(b.v, 0, sizeof b.v);
        scene = scene_of_bed(&b, &d);
        double *rests = frame_of(scene);
        CHECK_NEAR(rests[FRAME_FLOW_SPEED], 0, 1e-15);
        const size_t width = dem_frame_width(scene);
        double *table = calloc(FRAMES * width, sizeof *table);
        for (size_t t = 0; t < sizeof flowing / sizeof *flowing; t++) {
            const int n = flowing[t];
            for (int k = 0; k < FRAMES; k++)
                memcpy(table + (size_t)k * width, k * n / FRAMES != (k + 1) * n / FRAMES ? flows : rests, width * sizeof *table);
            dem_repose_result repose = { 0 };
            dem_regime_result regime = { 0 };
            measure_regime_results(scene, &(frame_window){ table, FRAMES, width }, &repose, &regime);
            CHECK_NEAR(regime.flow_fluctuation, sqrt(FRAMES * (double)(FRAMES - n) / (n * (FRAMES - 1.0))), 1e-6);
            assert_int_equal(regime.regime == DEM_AVALANCHING, 5 * n <= 4 * FRAMES);
        }
        free(table);
        free(flows);
        free(rests);
        dem_scene_free(scene);
    }
}

/* ---- a bed all round the wall ---- */

/* Rings of spheres against the wall, three deep, turning with the drum. */
static void fill_ring(bed *b, double rate)
{
    const int along = (int)(LENGTH / D);
    b->count = 0;
    for (int ring = 0; ring < 3; ring++) {
        const double r = RADIUS - 0.495 * D - ring * 0.6 * D;
        const int around = (int)(2 * M_PI * r / D);
        for (int k = 0; k < around * along; k++) {
            const double phi = 2 * M_PI * (k / along + 0.5 * (ring & 1)) / around;
            double *p = b->x + 3 * b->count, *v = b->v + 3 * b->count++;
            p[0] = r * cos(phi);
            p[1] = r * sin(phi);
            p[2] = LENGTH * ((k % along + 0.25 + 0.5 * (ring & 1)) / along - 0.5);
            v[0] = -rate * p[1];
            v[1] = rate * p[0];
        }
    }
}

static void a_ring_that_turns_with_the_drum_covers_the_wall_and_does_not_slip(void **unused)
{
    (void)unused;
    static bed b;
    fill_ring(&b, 20);
    dem_scene_definition d = bed_definition(b.count, 0, 0);
    d.rotation_rate = 20;
    dem_scene *scene = scene_of_bed(&b, &d);
    double *frame = frame_of(scene);
    CHECK_NEAR(frame[FRAME_WALL_COVERAGE], 1, 0);
    CHECK_NEAR(frame[FRAME_WALL_SLIP], 0, 1e-9);
    CHECK_BETWEEN(frame[FRAME_AIRBORNE], 0, 0.01);
    /* level in every frame, so at no angle */
    assert_true(isnan(frame[FRAME_SURFACE_FIT]) && isnan(frame[FRAME_CENTER_OF_MASS]) && isnan(frame[FRAME_CHORD])
                && isnan(frame[FRAME_THEIL_SEN]));
    free(frame);
    dem_scene_free(scene);
}

enum { AT_SURFACE = 200, FRAMES_A_TURN = 40 };

/* Sphere i of AT_SURFACE at the bed's inner surface (all others lie at the wall) after so many turns of the drum: every
 * fourth falls behind by a quarter; every tenth sinks to the wall in the second revolution, and lags by half meanwhile. */
static double lag_in_turns(size_t i, double turns)
{
    const double second = fmax(0, fmin(turns - 1, 1));
    return i % 10 == 9 ? 0.5 * second : i % 4 == 0 ? 0.25 * turns : 0;
}

static void put_at_surface(dem_scene *scene, double inner, double turns)
{
    for (size_t i = 0; i < AT_SURFACE; i++) {
        const double radius = i % 10 == 9 && turns > 1.5 ? RADIUS - D / 2 : inner;
        const double angle = 2 * M_PI * ((double)i / AT_SURFACE + turns - lag_in_turns(i, turns));
        sphere_set_place(&scene->spheres, i, (double[]){ radius * cos(angle), radius * sin(angle), 0 });
    }
}

/* Forty frames a revolution: the lag of the last whole one, of those that were there when it began. */
static void the_surface_lags_by_what_its_spheres_fall_behind_in_a_revolution(void **unused)
{
    (void)unused;
    dem_scene_definition d = bed_definition(AT_SURFACE + 200, 0, 0);
    d.rotation_rate = 20;
    dem_scene *scene = hand_scene(&d);
    scene->phase = DEM_PHASE_RUNNING;
    scene->run_start = 0;
    scene->container.rotation_rate = d.rotation_rate;
    const double inner = scene->container.radius * sqrt(1 - d.fill_fraction), turn = 2 * M_PI / d.rotation_rate;
    for (size_t i = AT_SURFACE; i < scene->spheres.mobile_count; i++)
        sphere_set_place(&scene->spheres, i, (double[]){ RADIUS - D / 2, 0, 0 });
    int32_t *contacts = calloc(scene->spheres.mobile_count, sizeof *contacts);
    double *frame = calloc(dem_frame_width(scene), sizeof *frame), seen[3 * FRAMES_A_TURN + 1];
    for (int k = 0; k <= 3 * FRAMES_A_TURN; k++) {
        scene->step_count = llround(k * turn / FRAMES_A_TURN / d.time_step);
        put_at_surface(scene, inner, dem_scene_time(scene) / turn);
        measure_regime_frame(scene, contacts, frame);
        seen[k] = frame[FRAME_SURFACE_LAG];
    }
    /* 50 by a quarter; 20 by half, which are no longer there in the third */
    const double first = 50 * 0.25 / 200 * 2 * M_PI, second = (50 * 0.25 + 20 * 0.5) / 200 * 2 * M_PI,
                 third = 50 * 0.25 / 180 * 2 * M_PI;
    const double step = 2 * M_PI * d.time_step / turn; /* a frame is at a whole step */
    assert_true(isnan(seen[0]));
    CHECK_NEAR(seen[FRAMES_A_TURN / 2], first, 1e-5 + step); /* so far */
    CHECK_NEAR(seen[FRAMES_A_TURN + 1], first, 1e-5 + step);
    CHECK_NEAR(seen[2 * FRAMES_A_TURN - 1], first, 1e-5 + step);
    CHECK_NEAR(seen[2 * FRAMES_A_TURN + 1], second, 1e-5 + 3 * step * 40);
    CHECK_NEAR(seen[3 * FRAMES_A_TURN], third, 1e-5 + 3 * step * 40);
    free(contacts);
    free(frame);
    dem_scene_free(scene);
}

/* ---- segregation ---- */

enum { MIXED = 2000 };

/* A bed of two species of one size, half and half: ids below MIXED/2 are of the first. */
static dem_segregation_result segregation_of(const bed *b, double second_diameter)
{
    dem_scene_definition d = bed_definition(MIXED, second_diameter, 0.5);
    dem_scene *scene = scene_of_bed(b, &d);
    dem_segregation_result result;
    assert_int_equal(measure_segregation_results(scene, &result), DEM_OK);
    dem_scene_free(scene);
    return result;
}

static void place_anywhere(dice *d, double p[3])
{
    do {
        p[0] = dice_uniform(d, -RADIUS, RADIUS);
        p[1] = dice_uniform(d, -RADIUS, 0);
    } while (hypot(p[0], p[1]) > RADIUS);
    p[2] = dice_uniform(d, -LENGTH / 2, LENGTH / 2);
}

/* At random: indices of 0, 1 and 0. 2000 spheres in some 80 cells: Lacey's variance ratio scatters by sqrt(2/80), of
 * which 80/2000 counts; the axial index is a root of a difference, 1/sqrt(2000) of 2 slices. */
static void species_placed_at_random_are_mixed(void **unused)
{
    (void)unused;
    static bed b = { .count = MIXED };
    dice d = { 61 };
    for (int i = 0; i < MIXED; i++) place_anywhere(&d, b.x + 3 * i);
    const dem_segregation_result r = segregation_of(&b, D);
    CHECK_NEAR(r.radial_index, 0, 0.04); /* spread of the radius 0.24 R, 1000 of each: 4 deviations */
    CHECK_NEAR(r.lacey_index, 1, 0.015);
    CHECK_BETWEEN(r.axial_index, 0, 0.09);
}

/* The first species left of the plane x = 0, which is a border of cells; the second right of it. */
static void species_side_by_side_are_segregated_across_and_not_along(void **unused)
{
    (void)unused;
    static bed b = { .count = MIXED };
    dice d = { 62 };
    for (int i = 0; i < MIXED; i++) {
        place_anywhere(&d, b.x + 3 * i);
        b.x[3 * i] = i < MIXED / 2 ? -fabs(b.x[3 * i]) : fabs(b.x[3 * i]);
    }
    const dem_segregation_result r = segregation_of(&b, D);
    CHECK_NEAR(r.lacey_index, 0, 1e-12);
    CHECK_BETWEEN(r.axial_index, 0, 0.09);
    CHECK_NEAR(r.radial_index, 0, 0.04);
}

static void species_in_bands_along_the_axis_have_an_axial_index_of_one(void **unused)
{
    (void)unused;
    static bed b = { .count = MIXED };
    dice d = { 63 };
    for (int i = 0; i < MIXED; i++) {
        place_anywhere(&d, b.x + 3 * i);
        b.x[3 * i + 2] = i < MIXED / 2 ? -fabs(b.x[3 * i + 2]) : fabs(b.x[3 * i + 2]);
    }
    const dem_segregation_result r = segregation_of(&b, D);
    CHECK_NEAR(r.axial_index, 1, 1e-12);
    CHECK_NEAR(r.lacey_index, 1, 0.03); /* across the section they are mixed */
}

/* Small ones on a ring of radius R/3, large ones at 2R/3: (2/3 - 1/3). Swapped, the sign turns. */
static void the_radial_index_is_the_difference_of_mean_radii_over_the_drums(void **unused)
{
    (void)unused;
    static bed b = { .count = MIXED };
    for (int swap = 0; swap < 2; swap++) {
        for (int i = 0; i < MIXED; i++) {
            const bool outer = (i >= MIXED / 2) != swap;
            const double r = RADIUS * (outer ? 2 : 1) / 3, phi = -M_PI * (i % 997) / 997;
            b.x[3 * i] = r * cos(phi);
            b.x[3 * i + 1] = r * sin(phi);
            b.x[3 * i + 2] = LENGTH * ((i % 31) / 31.0 - 0.5);
        }
        CHECK_NEAR(segregation_of(&b, 1.2 * D).radial_index, swap ? -1.0 / 3 : 1.0 / 3, 1e-12);
    }
}

static void one_species_has_no_segregation(void **unused)
{
    (void)unused;
    static bed b;
    fill_below_plane(&b, 0, 0, 0, 0);
    const dem_scene_definition d = bed_definition(b.count, 0, 0);
    dem_scene *scene = scene_of_bed(&b, &d);
    dem_segregation_result r;
    assert_int_equal(measure_segregation_results(scene, &r), DEM_OK);
    assert_true(isnan(r.radial_index) && isnan(r.axial_index) && isnan(r.lacey_index));
    dem_scene_free(scene);
}

/* ---- contacts ---- */

/* Rows of three spheres along z far from all others; within each row the gaps overlap by what is asked for. */
static void overlaps_and_contacts_are_those_of_the_pairs_that_touch(void **unused)
{
    (void)unused;
    enum { ROWS = 100 };
    dem_scene_definition d = hand_definition(3 * ROWS);
    const double diameter = 2 * (double)(real)0.002; /* radii are kept as real */
    double x[9 * ROWS] = { 0 }, sum = 0;
    for (int row = 0; row < ROWS; row++) {
        const double overlap = 0.004 * 1e-4 * (row + 1); /* 0.01 % to 1 % */
        double *p = x + 9 * row;
        for (int k = 0; k < 3; k++) {
            p[3 * k] = -0.06 + 0.008 * (row % 10);
            p[3 * k + 1] = -0.07 + 0.006 * (row / 10);
        }
        p[2] = 0.045; /* the third of them is beyond the period's end */
        p[5] = p[2] + diameter - overlap;
        p[8] = row % 2 ? p[5] + diameter + 1e-6 : p[5] + diameter - overlap; /* every second row: it does not touch */
        p[8] = remainder(p[8], d.length);
        sum += overlap * (row % 2 ? 1 : 2);
    }
    dem_scene *scene = hand_scene(&d);
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = x });
    double frame[DEM_FRAME_SCALARS];
    assert_int_equal(measure_overlap_frame(scene, frame), DEM_OK);
    enum { CONTACTS = ROWS * 3 / 2 };
    CHECK_NEAR(frame[FRAME_MEAN_OVERLAP], sum / CONTACTS / 0.004, 1e-9);
    CHECK_NEAR(frame[FRAME_OVERLAP_99], 99e-4, 1e-9); /* of 150: one is above, 1 %; the two rows of 99 parts come next */
    double *whole = frame_of(scene);
    CHECK_NEAR(whole[FRAME_COORDINATION], 2.0 * CONTACTS / (3 * ROWS + PARKED), 1e-12);
    free(whole);
    dem_scene_free(scene);
}

/* ---- a wide drum ---- */

/* A sphere at the middle of a cell, in a drum of 20 m and in one of 20 mm: its density is the same, and so is what it costs,
 * which for all cells of the wide drum would be terabytes. */
static void a_small_sphere_in_a_wide_drum_is_measured_as_in_a_narrow_one(void **unused)
{
    (void)unused;
    double fraction[2];
    for (int k = 0; k < 2; k++) {
        dem_scene_definition d = hand_definition(1);
        d.species[0].diameter = 1e-4;
        d.diameter = k ? 20 : 0.02;
        d.length = 0.01;
        dem_scene *scene = hand_scene(&d);
        const double cell = d.diameter / density_grid_cells(scene), offset = cell * (double)(density_grid_cells(scene) / 4);
        for (size_t i = 0; i < scene->spheres.mobile_count; i++)
            sphere_set_place(&scene->spheres, i, (double[]){ 0.5 * cell, 0.5 * cell - offset, 0 });
        density_grid grid;
        assert_int_equal(density_grid_init(&grid, scene), DEM_OK);
        density_grid_deposit(&grid, scene, 0.0);
        density_grid_find_surface(&grid);
        assert_false(grid.lacks_memory);
        /* nine columns and rows of cells, which are in four tiles at most */
        CHECK_BETWEEN((double)grid.tile_count, 1, 4);
        CHECK_BETWEEN((double)grid.surface.count, 3, 9);
        const double height = grid.surface.height[grid.surface.count / 2];
        CHECK_BETWEEN(height - (0.5 * cell - offset), 0.3e-4, 1e-4);
        fraction[k] = grid.core;
        density_grid_clear(&grid);
        dem_scene_free(scene);
    }
    CHECK_NEAR(fraction[1] / fraction[0], 1, 1e-3); /* the bins of the median */
}

UNIT_TESTS(every_angle_of_a_bed_cut_level_at_a_plane_is_that_of_the_plane,
           every_angle_of_a_rough_bed_is_that_of_the_plane_in_the_mean,
           flow_fluctuation_is_that_of_the_speed_downslope_over_all_frames_and_particles,
           a_ring_that_turns_with_the_drum_covers_the_wall_and_does_not_slip,
           the_surface_lags_by_what_its_spheres_fall_behind_in_a_revolution, species_placed_at_random_are_mixed,
           species_side_by_side_are_segregated_across_and_not_along, species_in_bands_along_the_axis_have_an_axial_index_of_one,
           the_radial_index_is_the_difference_of_mean_radii_over_the_drums, one_species_has_no_segregation,
           overlaps_and_contacts_are_those_of_the_pairs_that_touch, a_small_sphere_in_a_wide_drum_is_measured_as_in_a_narrow_one)
