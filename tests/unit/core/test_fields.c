/* Claims about the fields over the cross-section, on beds whose fields are known. */
#include "measure.h"
#include "scene_by_hand.h"

static const double RADIUS = 0.03, LENGTH = 0.016; /* m */
enum { MOST = 3000 };

typedef struct bed {
    double x[3 * MOST], v[3 * MOST];
    size_t count;
} bed;

static dem_scene_definition bed_definition(size_t count)
{
    dem_scene_definition d = hand_definition(count - PARKED);
    d.diameter = 2 * RADIUS;
    d.length = LENGTH;
    return d;
}

/* A square lattice over the whole section, four layers along the axis, moved by (dx, dy). */
static void fill_lattice(bed *b, double pitch, double dx, double dy)
{
    const int reach = (int)(RADIUS / pitch) + 2;
    b->count = 0;
    for (int i = -reach; i <= reach; i++)
        for (int j = -reach; j <= reach; j++)
            for (int k = 0; k < 4; k++) {
                const double x = i * pitch + dx, y = j * pitch + dy;
                if (hypot(x, y) > RADIUS - 0.0021) continue;
                assert_true(b->count < MOST);
                double *p = b->x + 3 * b->count++;
                p[0] = x;
                p[1] = y;
                p[2] = LENGTH * ((k + 0.5) / 4 - 0.5);
            }
}

/* The scene's own spheres and the parked ones alike take places of the bed. */
static dem_scene *scene_of(const bed *b)
{
    const dem_scene_definition d = bed_definition(b->count);
    dem_scene *scene = hand_scene(&d);
    dem_state state;
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    int64_t *counters = state_array(&state, "counters")->data;
    counters[0] = DEM_PHASE_RUNNING;
    counters[1] = counters[2] = counters[3] = 0;
    memcpy(state_array(&state, "position")->data, b->x, 3 * b->count * sizeof(double));
    memcpy(state_array(&state, "velocity")->data, b->v, 3 * b->count * sizeof(double));
    assert_int_equal(dem_scene_restore(scene, &state), DEM_OK);
    dem_state_clear(&state);
    return scene;
}

typedef struct fields {
    size_t cells;
    double *sums, *solid, *velocity, *temperature, *samples;
} fields;

static void fields_begin(fields *f, const dem_scene *scene)
{
    f->cells = dem_fields_cells(scene);
    const size_t n = f->cells * f->cells;
    f->sums = calloc(dem_fields_size(scene) + 6 * n, sizeof *f->sums);
    assert_non_null(f->sums);
    f->solid = f->sums + dem_fields_size(scene);
    f->velocity = f->solid + n;
    f->temperature = f->velocity + 3 * n;
    f->samples = f->temperature + n;
}

static void fields_end(fields *f, const dem_scene *scene)
{
    dem_fields_measure(
        scene, f->sums,
        &(dem_field_arrays){
            .solid_fraction = f->solid, .velocity = f->velocity, .temperature = f->temperature, .samples = f->samples });
}

static double place(const fields *f, size_t cell) { return 2 * RADIUS * (((double)cell + 0.5) / (double)f->cells - 0.5); }

static bool is_well_inside(const fields *f, size_t k) /* every sphere that reaches the cell has its like on all sides */
{
    return hypot(place(f, k % f->cells), place(f, k / f->cells)) < RADIUS - 0.0105;
}

/* v = omega x r plus a drift of all: to the rounding of sums of squares, at any place of the lattice. */
static void a_bed_that_turns_rigidly_has_omega_cross_r_and_no_fluctuation(void **unused)
{
    (void)unused;
    static bed b;
    const double omega = 7, drift[3] = { 0.1, -0.03, 0.02 };
    fields f = { 0 };
    dem_scene *scene = NULL;
    for (int frame = 0; frame < 6; frame++) {
        fill_lattice(&b, 0.004, 0.0007 * frame, -0.0005 * frame);
        for (size_t i = 0; i < b.count; i++) {
            b.v[3 * i] = drift[0] - omega * b.x[3 * i + 1];
            b.v[3 * i + 1] = drift[1] + omega * b.x[3 * i];
            b.v[3 * i + 2] = drift[2];
        }
        dem_scene_free(scene);
        scene = scene_of(&b);
        if (frame == 0) fields_begin(&f, scene);
        assert_int_equal(dem_fields_add(scene, f.sums), DEM_OK);
    }
    fields_end(&f, scene);
    size_t seen = 0;
    for (size_t k = 0; k < f.cells * f.cells; k++) {
        if (isnan(f.temperature[k])) continue; /* too few spheres, or all on a line */
        seen++;
        CHECK_NEAR(f.velocity[3 * k], drift[0] - omega * place(&f, k / f.cells), 1e-12);
        CHECK_NEAR(f.velocity[3 * k + 1], drift[1] + omega * place(&f, k % f.cells), 1e-12);
        CHECK_NEAR(f.velocity[3 * k + 2], drift[2], 1e-12);
        CHECK_NEAR(f.temperature[k], 0, 1e-13);
    }
    CHECK_BETWEEN(seen, 0.65 * (double)(f.cells * f.cells),
                  (double)(f.cells * f.cells)); /* a circle has 0.785 of its square, less its rim */
    free(f.sums);
    dem_scene_free(scene);
}

/* One sphere to each pitch^2 of the section and LENGTH/4: (pi/6 d^3)/(pitch^2 LENGTH/4), once the lattice has passed over
 * every place of a cell: 8 x 8 places of a pitch. The whole volume is there, whatever the cells. */
static void a_uniform_lattice_has_its_solid_fraction_everywhere(void **unused)
{
    (void)unused;
    static bed b;
    enum { PLACES = 8 };
    const double pitch = 0.0045, d = 2 * (double)(real)0.002, sphere = M_PI / 6 * d * d * d;
    fields f = { 0 };
    dem_scene *scene = NULL;
    double volume = 0;
    for (int place_of = 0; place_of < PLACES * PLACES; place_of++) {
        fill_lattice(&b, pitch, pitch * (place_of % PLACES) / PLACES, pitch * (place_of / PLACES) / PLACES);
        volume += sphere * (double)b.count;
        dem_scene_free(scene);
        scene = scene_of(&b);
        if (place_of == 0) fields_begin(&f, scene);
        assert_int_equal(dem_fields_add(scene, f.sums), DEM_OK);
    }
    fields_end(&f, scene);
    const double expected = sphere / (pitch * pitch * LENGTH / 4), cell = pow(2 * RADIUS / (double)f.cells, 2) * LENGTH;
    double sum = 0, inside = 0, n = 0;
    for (size_t k = 0; k < f.cells * f.cells; k++) {
        sum += f.solid[k] * cell * PLACES * PLACES;
        if (!is_well_inside(&f, k)) continue;
        /* Places 0.56 mm apart stand for all, on a grid of points 0.48 mm apart: they beat, but not in the mean. */
        CHECK_NEAR(f.solid[k] / expected, 1, 0.03);
        inside += f.solid[k] / expected;
        n += 1;
    }
    CHECK_NEAR(inside / n, 1, 0.003);
    CHECK_NEAR(sum / volume, 1, 1e-12);
    free(f.sums);
    dem_scene_free(scene);
}

/* Each sphere at omega x r and a random velocity of deviation s a component: T = s^2. Of some 500 spheres of which each
 * counts in many cells, over 20 frames: the mean over the section is known within sqrt(2/(3*10^4)), 0.8 %, and three of
 * them. */
static void random_velocities_have_their_temperature(void **unused)
{
    (void)unused;
    static bed b;
    const double omega = 5, s = 0.04;
    dice dice_of = { 77 };
    fields f = { 0 };
    dem_scene *scene = NULL;
    for (int frame = 0; frame < 20; frame++) {
        fill_lattice(&b, 0.0042, dice_uniform(&dice_of, 0, 0.004), dice_uniform(&dice_of, 0, 0.004));
        for (size_t i = 0; i < b.count; i++)
            for (int c = 0; c < 3; c++) {
                const double rigid = c == 0 ? -omega * b.x[3 * i + 1] : c == 1 ? omega * b.x[3 * i] : 0;
                b.v[3 * i + (size_t)c] = rigid + s * sqrt(12) * dice_uniform(&dice_of, -0.5, 0.5);
            }
        dem_scene_free(scene);
        scene = scene_of(&b);
        if (frame == 0) fields_begin(&f, scene);
        assert_int_equal(dem_fields_add(scene, f.sums), DEM_OK);
    }
    fields_end(&f, scene);
    double sum = 0, n = 0;
    for (size_t k = 0; k < f.cells * f.cells; k++)
        if (is_well_inside(&f, k)) {
            sum += f.temperature[k];
            n += 1;
        }
    CHECK_NEAR(sum / n / (s * s), 1, 0.025);
    free(f.sums);
    dem_scene_free(scene);
}

static void an_empty_place_has_no_velocity(void **unused)
{
    (void)unused;
    static bed b;
    fill_lattice(&b, 0.0045, 0, 0);
    size_t kept = 0;
    for (size_t i = 0; i < b.count; i++)
        if (b.x[3 * i + 1] < -0.005) memmove(b.x + 3 * kept++, b.x + 3 * i, 3 * sizeof(double));
    b.count = kept;
    memset(b.v, 0, sizeof b.v);
    dem_scene *scene = scene_of(&b);
    fields f;
    fields_begin(&f, scene);
    fields_end(&f, scene);
    assert_true(isnan(f.solid[0])); /* no frame at all */
    assert_int_equal(dem_fields_add(scene, f.sums), DEM_OK);
    fields_end(&f, scene);
    const size_t above = (f.cells * 3 / 4) * f.cells + f.cells / 2;
    CHECK_NEAR(f.solid[above], 0, 0);
    CHECK_NEAR(f.samples[above], 0, 0);
    assert_true(isnan(f.velocity[3 * above]) && isnan(f.temperature[above]));
    free(f.sums);
    dem_scene_free(scene);
}

UNIT_TESTS(a_bed_that_turns_rigidly_has_omega_cross_r_and_no_fluctuation, a_uniform_lattice_has_its_solid_fraction_everywhere,
           random_velocities_have_their_temperature, an_empty_place_has_no_velocity)
