/* Claims about rigid clusters: volume and inertia of the union, Euler's equations and quaternions, and clusters in a
 * drum: the same as spheres where they are spheres, at rest where they rest, conserved where nothing is lost. */
#include "cluster.h"
#include "dem_cluster.h"
#include "scene.h"
#include "small_drum.h"

/* ---- volume and inertia ---- */

static dem_cluster completed(dem_shape shape, double diameter, double spacing)
{
    dem_cluster c;
    dem_cluster_of_shape(&c, shape, diameter);
    for (size_t k = 0; k < c.sphere_count; k++)
        for (int a = 0; a < 3; a++) c.sphere[k].position[a] *= spacing;
    dem_cluster_complete(&c);
    return c;
}

/* In units of one sphere's mass m and radius a: sums by the theorem of parallel axes, done by hand. */
static void touching_spheres_have_the_sums_of_their_moments(void **unused)
{
    (void)unused;
    static const struct {
        dem_shape shape;
        double mass, moment[3], reach;
    } by_hand[] = {
        { DEM_DUMBBELL, 2, { 0.8, 2.8, 2.8 }, 2 },
        { DEM_TETRAHEDRON, 4, { 5.6, 5.6, 5.6 }, 1 + 1.2247448713915890 }, /* sqrt(3/2) */
        { DEM_CUBE, 8, { 19.2, 19.2, 19.2 }, 1 + 1.7320508075688772 },
    };
    for (int k = 0; k < 3; k++) {
        const double a = 0.0015, m = dem_sphere_mass(2 * a, 1.0);
        const dem_cluster c = completed(by_hand[k].shape, 2 * a, 1);
        CHECK_NEAR(c.volume / m, by_hand[k].mass, 1e-12);
        CHECK_NEAR(c.reach / a, by_hand[k].reach, 1e-12);
        for (int i = 0; i < 3; i++) CHECK_NEAR(c.inertia[i] / (m * a * a), by_hand[k].moment[i], 1e-12);
    }
}

/* Centres 0.8 diameters apart: numbers found by another program, to the digits given. */
static void nothing_is_counted_twice_where_spheres_overlap(void **unused)
{
    (void)unused;
    static const struct {
        dem_shape shape;
        double mass, moment;
    } known[] = { { DEM_TETRAHEDRON, 3.675, 4.06 }, { DEM_CUBE, 7.33, 12.81 } };
    for (int k = 0; k < 2; k++) {
        const double a = 0.002, m = dem_sphere_mass(2 * a, 1.0);
        const dem_cluster c = completed(known[k].shape, 2 * a, 0.8);
        CHECK_NEAR(c.volume / m, known[k].mass, k ? 0.005 : 0.0005);
        for (int i = 0; i < 3; i++) CHECK_NEAR(c.inertia[i] / (m * a * a), known[k].moment, 0.005);
    }
}

static int later_start(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Columns along z in any order, whose common parts are what the lengths of the spheres in it exceed that of their union by:
 * the volume of many spheres that nearly coincide, two of them in one place along z. */
static void many_spheres_in_one_place_have_the_volume_of_their_union(void **unused)
{
    (void)unused;
    dem_cluster c = { .sphere_count = DEM_MAXIMUM_CLUSTER };
    for (size_t k = 0; k < c.sphere_count; k++) {
        c.sphere[k] = (dem_cluster_sphere){ { 0.03 * (double)(k * 37 % 64) / 64, 0.05 * (double)(k * 11 % 64) / 64, 0 }, 1 };
        c.sphere[k].position[2] = 0.04 * (double)(k * 23 % 32) / 32;
    }
    const dem_cluster given = c;
    enum { ROWS = 300 };
    const double low = -0.5, step = 1.06 / ROWS;
    double volume = 0;
    for (int b = 0; b < ROWS; b++)
        for (int a = 0; a < ROWS; a++) {
            double part[DEM_MAXIMUM_CLUSTER][2], covered = -1;
            size_t count = 0;
            for (size_t k = 0; k < given.sphere_count; k++) {
                const double *p = given.sphere[k].position, x = low + (a + 0.5) * step - p[0], y = low + (b + 0.5) * step - p[1];
                if (x * x + y * y >= 0.25) continue;
                part[count][0] = p[2] - sqrt(0.25 - x * x - y * y);
                part[count++][1] = p[2] + sqrt(0.25 - x * x - y * y);
            }
            qsort(part, count, sizeof part[0], later_start);
            for (size_t k = 0; k < count; k++) {
                volume += fmax(part[k][1] - fmax(part[k][0], covered), 0) * step * step;
                covered = fmax(covered, part[k][1]);
            }
        }
    dem_cluster_complete(&c);
    CHECK_NEAR(c.volume / volume, 1, 1e-4); /* what both miss at the rim */
}

/* Two spheres, radii 1 and 0.7, centres 1.1 apart, as a body of revolution: the integral over discs along its axis. */
static void two_overlapping_spheres_are_the_body_of_revolution(void **unused)
{
    (void)unused;
    const double big = 1, small = 0.7, apart = 1.1;
    double volume = 0, first = 0, along = 0, across = 0;
    enum { DISCS = 200000 };
    for (int k = 0; k < DISCS; k++) { /* midpoints of 2e5 discs: good to 1e-9 */
        const double h = (big + apart + small) / DISCS, x = -big + (k + 0.5) * h;
        const double r2 = fmax(fmax(big * big - x * x, small * small - (x - apart) * (x - apart)), 0);
        volume += M_PI * r2 * h;
        first += M_PI * r2 * h * x;
        along += 0.5 * M_PI * r2 * r2 * h;
        across += (0.25 * r2 + x * x) * M_PI * r2 * h;
    }
    const double centre = first / volume;
    across -= volume * centre * centre;
    /* along each axis in turn: columns of the integration run along z alone */
    for (int axis = 0; axis < 3; axis++) {
        dem_cluster c = { .sphere_count = 2, .sphere = { { { 0.3, 0.2, -0.1 }, 2 * big }, { { 0.3, 0.2, -0.1 }, 2 * small } } };
        c.sphere[1].position[axis] += apart;
        dem_cluster_complete(&c);
        /* what 400 columns miss at the rim of the overlap */
        CHECK_NEAR(c.volume / volume, 1, 1e-5);
        int turned = 0; /* the axis of revolution has the least moment */
        for (int i = 1; i < 3; i++)
            if (c.inertia[i] < c.inertia[turned]) turned = i;
        for (int i = 0; i < 3; i++) CHECK_NEAR(c.inertia[i] / (i == turned ? along : across), 1, 2e-5);
        CHECK_NEAR(fabs(c.sphere[0].position[turned]), centre, 1e-5);
    }
}

/* Any three touching spheres, in any frame: the products of inertia vanish in the frame that comes out, and the
 * moments in it are those of the sums. */
static void the_frame_is_the_principal_one(void **unused)
{
    (void)unused;
    dice d = { 5 };
    for (int round = 0; round < 200; round++) {
        dem_cluster c = { .sphere_count = 3 };
        for (int k = 0; k < 3; k++) {
            double n[3];
            dice_direction(&d, n);
            c.sphere[k].diameter = dice_uniform(&d, 0.5, 2);
            const double reach = k ? 0.5 * (c.sphere[k - 1].diameter + c.sphere[k].diameter) : 3;
            for (int a = 0; a < 3; a++) c.sphere[k].position[a] = (k ? c.sphere[k - 1].position[a] : 0) + reach * n[a];
        }
        if (dem_cluster_distance(&c.sphere[0], &c.sphere[2]) < 0.5 * (c.sphere[0].diameter + c.sphere[2].diameter)) continue;
        dem_cluster_complete(&c);
        double sum[3][3] = { { 0 } }, centre[3] = { 0 };
        for (int k = 0; k < 3; k++) {
            const double v = dem_sphere_mass(c.sphere[k].diameter, 1), r = 0.5 * c.sphere[k].diameter, *x = c.sphere[k].position;
            const double x2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
            for (int a = 0; a < 3; a++) {
                centre[a] += v * x[a];
                for (int b = 0; b < 3; b++) sum[a][b] += v * ((a == b) * (0.4 * r * r + x2) - x[a] * x[b]);
            }
        }
        for (int a = 0; a < 3; a++) {
            CHECK_NEAR(centre[a], 0, 1e-12); /* sums of numbers near 1 to 10, rounded */
            for (int b = 0; b < 3; b++) CHECK_NEAR(sum[a][b], a == b ? c.inertia[a] : 0, 1e-11);
        }
    }
}

static void what_is_no_body_is_told(void **unused)
{
    (void)unused;
    int in = -1;
    dem_cluster c = { .sphere_count = 3, .sphere = { { { 0, 0, 0 }, 1 }, { { 2.1, 0, 0 }, 1 }, { { 1.05, 0, 0 }, 1.1 } } };
    assert_int_equal(dem_cluster_loose_sphere(&c), -1); /* joined by the third */
    assert_int_equal(dem_cluster_hidden_sphere(&c, &in), -1);
    c.sphere[2].diameter = 1.0999;
    assert_int_equal(dem_cluster_loose_sphere(&c), 1); /* gaps of 5e-5 */
    c.sphere[2] = c.sphere[0];
    assert_int_equal(dem_cluster_hidden_sphere(&c, &in), 2);
    assert_int_equal(in, 0);
    c.sphere[2] = (dem_cluster_sphere){ { 0.2, 0, 0 }, 0.5 };
    assert_int_equal(dem_cluster_hidden_sphere(&c, &in), 2);
}

/* ---- rotation ---- */

typedef struct top {
    double omega[3], change[3]; /* omega: half a step behind */
    quaternion q;
} top;

/* Started such that the velocity half a step back is right to second order. */
static top top_start(const double omega[3], const double torque[3], const double inertia[3], double dt)
{
    top t = { .q = { 0, 0, 0, 1 } };
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        t.change[a] = (torque[a] + omega[b] * omega[c] * (inertia[b] - inertia[c])) / inertia[a] * dt;
        t.omega[a] = omega[a] - 0.5 * t.change[a];
    }
    return t;
}

/* Largest relative errors of energy and angular momentum over 20 s without torque, I = (1,2,3). */
static void top_errors(double dt, int corrections, double *energy_error, double *momentum_error)
{
    static const double inertia[3] = { 1, 2, 3 }, start[3] = { 1, 0.6, 0.4 }, none[3] = { 0 };
    top t = top_start(start, none, inertia, dt);
    double energy_0 = 0, momentum_0[3], size = 0;
    for (int a = 0; a < 3; a++) {
        energy_0 += 0.5 * inertia[a] * start[a] * start[a];
        momentum_0[a] = inertia[a] * start[a];
        size += momentum_0[a] * momentum_0[a];
    }
    *energy_error = *momentum_error = 0;
    for (int n = 0; n < (int)(20 / dt + 0.5); n++) {
        double before[3], on_step[3], l_body[3], l[3], a[3][3], energy = 0, off = 0;
        memcpy(before, t.omega, sizeof before);
        euler_advance(t.omega, t.change, none, inertia, dt, corrections);
        for (int c = 0; c < 3; c++) on_step[c] = 0.5 * (before[c] + t.omega[c]);
        quaternion_matrix(t.q, a);
        for (int c = 0; c < 3; c++) l_body[c] = inertia[c] * on_step[c];
        to_space(a, l_body, l);
        for (int c = 0; c < 3; c++) {
            energy += 0.5 * inertia[c] * on_step[c] * on_step[c];
            off += (l[c] - momentum_0[c]) * (l[c] - momentum_0[c]);
        }
        *energy_error = fmax(*energy_error, fabs(energy / energy_0 - 1));
        *momentum_error = fmax(*momentum_error, sqrt(off / size));
        t.q = quaternion_advance(t.q, t.omega, dt);
    }
}

/* Errors at dt = 0.01 are of the order of (omega dt)^2/12, some 1e-5; a wrong sign or index in the quaternions' lines
 * lets the angular momentum wander by its own size. */
static void a_free_top_keeps_energy_and_angular_momentum_to_second_order(void **unused)
{
    (void)unused;
    double energy[2], momentum[2];
    top_errors(0.01, 1, &energy[0], &momentum[0]);
    top_errors(0.005, 1, &energy[1], &momentum[1]);
    CHECK_BETWEEN(energy[0], 1e-7, 4e-5);
    CHECK_BETWEEN(momentum[0], 1e-7, 4e-5);
    CHECK_BETWEEN(log2(energy[0] / energy[1]), 1.8, 2.3);
    CHECK_BETWEEN(log2(momentum[0] / momentum[1]), 1.9, 2.1);
    double energy_of_three, momentum_of_three; /* further passes do not raise the order */
    top_errors(0.01, 3, &energy_of_three, &momentum_of_three);
    CHECK_BETWEEN(momentum_of_three / momentum[0], 0.5, 2);
}

/* A step's rotation is that of the vector (Rodrigues), about the axis by the angle, but for the third order. */
static void a_quaternion_turns_by_the_angle_about_the_axis(void **unused)
{
    (void)unused;
    dice d = { 9 };
    for (int round = 0; round < 100; round++) {
        double n[3], x[3], a[3][3], omega[3], turned[3], y[3];
        dice_direction(&d, n);
        dice_direction(&d, x);
        const double angle = dice_uniform(&d, 1e-3, 0.02), c = cos(angle), s = sin(angle);
        for (int k = 0; k < 3; k++) omega[k] = n[k] * angle / 0.5; /* a step of 0.5 s */
        quaternion_matrix(quaternion_advance((quaternion){ 0, 0, 0, 1 }, omega, 0.5), a);
        to_space(a, x, turned); /* a vector fixed in the body, which was along the axes of space */
        const double nx = n[0] * x[0] + n[1] * x[1] + n[2] * x[2];
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            y[k] = c * x[k] + s * (n[i] * x[j] - n[j] * x[i]) + (1 - c) * nx * n[k];
            CHECK_NEAR(turned[k], y[k], angle * angle * angle);
        }
    }
}

/* ---- a heavy top against another integration ---- */

/* d(omega)/dt and d(R)/dt, R from body to space, of a body whose centre hangs under a fixed point: torque r x F. */
typedef struct heavy {
    double omega[3], r[3][3];
} heavy;

static const double HEAVY_INERTIA[3] = { 1, 2, 2.5 }, HEAVY_ARM[3] = { 0.2, 0.1, 1 }, HEAVY_FORCE[3] = { 0, -3, 0 };

static void heavy_torque(double r[3][3], double torque[3])
{
    double f[3];
    for (int a = 0; a < 3; a++) f[a] = r[0][a] * HEAVY_FORCE[0] + r[1][a] * HEAVY_FORCE[1] + r[2][a] * HEAVY_FORCE[2];
    for (int a = 0; a < 3; a++) torque[a] = HEAVY_ARM[(a + 1) % 3] * f[(a + 2) % 3] - HEAVY_ARM[(a + 2) % 3] * f[(a + 1) % 3];
}

static heavy heavy_rate(heavy h)
{
    heavy d;
    double torque[3];
    heavy_torque(h.r, torque);
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        d.omega[a] = (torque[a] + (HEAVY_INERTIA[b] - HEAVY_INERTIA[c]) * h.omega[b] * h.omega[c]) / HEAVY_INERTIA[a];
        for (int row = 0; row < 3; row++) d.r[row][a] = h.r[row][b] * h.omega[c] - h.r[row][c] * h.omega[b];
    }
    return d;
}

static heavy heavy_sum(heavy h, heavy d, double dt)
{
    for (int a = 0; a < 3; a++) {
        h.omega[a] += dt * d.omega[a];
        for (int b = 0; b < 3; b++) h.r[a][b] += dt * d.r[a][b];
    }
    return h;
}

/* Runge-Kutta of fourth order on the rotation matrix, 1e4 steps: good to 1e-12. */
static heavy heavy_reference(heavy h, double duration)
{
    enum { STEPS = 10000 };
    const double dt = duration / STEPS;
    for (int n = 0; n < STEPS; n++) {
        const heavy a = heavy_rate(h), b = heavy_rate(heavy_sum(h, a, dt / 2)), c = heavy_rate(heavy_sum(h, b, dt / 2)),
                    d = heavy_rate(heavy_sum(h, c, dt));
        h = heavy_sum(heavy_sum(heavy_sum(heavy_sum(h, a, dt / 6), b, dt / 3), c, dt / 3), d, dt / 6);
    }
    return h;
}

static double heavy_error(const heavy *start, const heavy *reference, double duration, int steps)
{
    const double dt = duration / steps;
    double torque[3], r[3][3], error = 0;
    memcpy(r, start->r, sizeof r);
    heavy_torque(r, torque);
    top t = top_start(start->omega, torque, HEAVY_INERTIA, dt);
    for (int n = 0; n < steps; n++) {
        double a[3][3];
        quaternion_matrix(t.q, a);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) r[i][j] = a[j][i];
        heavy_torque(r, torque);
        euler_advance(t.omega, t.change, torque, HEAVY_INERTIA, dt, 1);
        t.q = quaternion_advance(t.q, t.omega, dt);
    }
    double a[3][3];
    quaternion_matrix(t.q, a);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) error = fmax(error, fabs(a[j][i] - reference->r[i][j]));
    return error;
}

static void a_heavy_top_moves_as_by_another_integration(void **unused)
{
    (void)unused;
    const heavy start = { .omega = { 0.5, -0.3, 6 }, .r = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    const heavy reference = heavy_reference(start, 3);
    const double coarse = heavy_error(&start, &reference, 3, 1000), fine = heavy_error(&start, &reference, 3, 2000);
    CHECK_BETWEEN(coarse, 0, 1e-2); /* 18 rad of spin: (omega dt)^2/12 of them */
    CHECK_BETWEEN(coarse / fine, 3.8, 4.2);
}

/* ---- in a drum ---- */

/* One sphere of a diameter and density that powers of two are, so that no rounding differs: then a cluster of one goes
 * the clusters' way through filling, forces and integration, and must come out as the sphere does. */
static void a_cluster_of_one_is_a_sphere_bit_for_bit(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    d.species[0] = (dem_species){ .diameter = 0.00390625, .density = 2048, .share = 1 };
    d.particle_count = 120;
    follow_rules(&d, 0.03);
    dem_scene *sphere = drum_scene(&d);
    d.species[0].cluster = (dem_cluster){ .sphere_count = 1, .sphere = { { { 0, 0, 0 }, d.species[0].diameter } } };
    dem_scene *cluster = drum_scene(&d);
    assert_int_equal(cluster->spheres.clusters.count, 120);
    assert_int_equal(sphere->spheres.clusters.count, 0);
    double x[2][360], v[2][360], w[2][360];
    dem_scene *const scenes[2] = { sphere, cluster };
    for (int look = 0; look < 40; look++) {
        for (int k = 0; k < 2; k++) {
            if (look < 20) run(scenes[k], 150);
            else {
                run_to_phase(scenes[k], DEM_PHASE_RUNNING);
                run(scenes[k], 100);
            }
            dem_scene_particles(scenes[k], &(dem_particle_arrays){ .position = x[k], .velocity = v[k], .angular_velocity = w[k] });
        }
        assert_memory_equal(x[0], x[1], sizeof x[0]);
        for (int i = 0; i < 360; i++) assert_true(v[0][i] == v[1][i] && w[0][i] == w[1][i]);
    }
    assert_int_equal(dem_scene_phase(sphere), DEM_PHASE_RUNNING);
    dem_scene_free(sphere);
    dem_scene_free(cluster);
}

/* Spheres, tetrahedra, and a bent cluster of three that overlap, with three different moments. */
static dem_scene_definition mixed_drum(void)
{
    dem_scene_definition d = small_drum();
    d.length = 0.02;
    d.species_count = 3;
    d.species[0] = (dem_species){ .diameter = 0.003, .density = 2500, .share = 0.3 };
    d.species[1] = (dem_species){ .density = 2500, .share = 0.3 };
    dem_cluster_of_shape(&d.species[1].cluster, DEM_TETRAHEDRON, 0.002);
    d.species[2] = (dem_species){
        .density = 2000,
        .share = 0.4,
        .cluster = { .sphere_count = 3,
                     .sphere = { { { 0, 0, 0 }, 0.003 }, { { 0.002, 0, 0 }, 0.0025 }, { { 0.002, 0.0015, 0 }, 0.002 } } }
    };
    for (int k = 0; k < 3; k++) dem_cluster_complete(&d.species[k].cluster);
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, 0.4, d.species, 3);
    d.fill_fraction = 0.4;
    follow_rules(&d, 0.05);
    return d;
}

static bool same_bits(dem_scene *a, dem_scene *b)
{
    dem_state x, y;
    assert_int_equal(dem_scene_save(a, &x), DEM_OK);
    assert_int_equal(dem_scene_save(b, &y), DEM_OK);
    bool same = x.array_count == y.array_count;
    for (size_t k = 0; same && k < x.array_count; k++) {
        const size_t bytes = x.array[k].rows * x.array[k].columns * (x.array[k].element == DEM_INT32 ? 4 : 8);
        same = x.array[k].rows == y.array[k].rows && memcmp(x.array[k].data, y.array[k].data, bytes) == 0;
    }
    dem_state_clear(&x);
    dem_state_clear(&y);
    return same;
}

/* A scene of two threads takes over from one thread's state in each phase, and both go on. */
static void threads_and_restarts_leave_the_same_bits_in_every_phase(void **unused)
{
    (void)unused;
    dem_scene_definition d = mixed_drum();
    dem_scene *one = drum_scene(&d);
    d.threads = 2;
    for (int look = 0; look < 6; look++) {
        run_to_phase(one, (dem_phase)(look / 2));
        run(one, 173);
        dem_scene *two = drum_scene(&d);
        dem_state state;
        assert_int_equal(dem_scene_save(one, &state), DEM_OK);
        assert_int_equal(dem_scene_restore(two, &state), DEM_OK);
        dem_state_clear(&state);
        run(one, 120);
        run(two, 73);
        run(two, 47);
        assert_true(same_bits(one, two));
        dem_scene_free(two);
    }
    assert_int_equal(dem_scene_phase(one), DEM_PHASE_RUNNING);
    dem_scene_free(one);
}

/* Every sphere is where its cluster's place and orientation, as a snapshot has them, put it: by e p e*, written out. */
static void spheres_stay_where_their_cluster_puts_them(void **unused)
{
    (void)unused;
    dem_scene_definition d = mixed_drum();
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    run(scene, 2000);
    const size_t n = dem_scene_sphere_count(scene);
    double *x = calloc(7 * n, sizeof *x), *e = x + 3 * n;
    int32_t *cluster = calloc(n, sizeof *cluster);
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = x, .orientation = e, .cluster = cluster });
    size_t joined = 0;
    for (size_t i = scene->spheres.single_count, member = 0; i < n; i++) {
        member = i > 0 && cluster[i] == cluster[i - 1] ? member + 1 : 0;
        const dem_cluster *c = &scene->definition.species[scene->spheres.species[i]].cluster;
        const double *p = c->sphere[member].position, *q = e + 4 * i, *centre = particle_place(&scene->spheres, (size_t)cluster[i]);
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, g = (a + 2) % 3;
            const double qp = q[1] * p[0] + q[2] * p[1] + q[3] * p[2], q2 = q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
            const double r = (q[0] * q[0] - q2) * p[a] + 2 * qp * q[1 + a] + 2 * q[0] * (q[1 + b] * p[g] - q[1 + g] * p[b]);
            /* rounding of coordinates of 0.01 m */
            CHECK_NEAR(remainder(x[3 * i + (size_t)a] - centre[a] - r, a == 2 ? d.length : 1), 0, 1e-15);
        }
        joined++;
    }
    assert_int_equal(joined, scene->spheres.clusters.sphere_count);
    free(x);
    free(cluster);
    dem_scene_free(scene);
}

/* Two bodies of a scene of many, put where the test wants them; the rest are far along the axis, apart from each other. */
static void set_body(dem_scene *scene, size_t b, const double x[3], const double v[3], const double spin[3])
{
    cluster_body *body = &scene->spheres.clusters.body[b];
    const cluster_shape *shape = &scene->spheres.clusters.shape[body->species];
    memcpy(body->x, x, sizeof body->x);
    memset(body->spin_change, 0, sizeof body->spin_change);
    for (int c = 0; c < 3; c++) {
        body->spin[c] = spin[c];
        body->velocity[c] = v[c];
    }
    double a[3][3];
    quaternion_matrix(body->orientation, a);
    for (size_t k = 0; k < shape->sphere_count; k++) {
        const vector4 r = cluster_offset(shape, k, a, 1);
        const double place[3] = { body->x[0] + r[0], body->x[1] + r[1], body->x[2] + r[2] };
        sphere_set_place(&scene->spheres, (size_t)body->first_sphere + k, place);
    }
}

typedef struct motion {
    double energy, momentum[3], angular[3];
} motion;

static motion motion_of(const dem_scene *scene)
{
    motion m = { .energy = dem_scene_kinetic_energy(scene) };
    for (size_t b = 0; b < scene->spheres.clusters.count; b++) {
        const cluster_body *body = &scene->spheres.clusters.body[b];
        const cluster_shape *shape = &scene->spheres.clusters.shape[body->species];
        double a[3][3], l_body[3], l[3];
        quaternion_matrix(body->orientation, a);
        for (int c = 0; c < 3; c++) l_body[c] = shape->inertia[c] * body->spin[c];
        if (shape->is_isotropic) memcpy(l, l_body, sizeof l);
        else to_space(a, l_body, l);
        for (int c = 0; c < 3; c++) {
            const int i = (c + 1) % 3, j = (c + 2) % 3;
            m.momentum[c] += shape->mass * body->velocity[c];
            m.angular[c] += l[c] + shape->mass * (body->x[i] * body->velocity[j] - body->x[j] * body->velocity[i]);
        }
    }
    return m;
}

/* A drum of 24 bent clusters without weight, all at rest at places of their own but the first two. */
static dem_scene *weightless_clusters(dem_scene_definition *d, double friction, double restitution)
{
    *d = mixed_drum();
    d->species_count = 1;
    d->species[0] = d->species[2];
    d->species[0].share = 1;
    d->particle_count = 24;
    d->diameter = 0.1;
    d->length = 0.1;
    d->contact.friction = friction;
    d->contact.restitution = restitution;
    d->time_step /= 4;
    dem_scene *scene = drum_scene(d);
    dem_state state; /* goes on at full size and rotating, without a bed being made first */
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    ((int64_t *)state.array[0].data)[0] = DEM_PHASE_RUNNING;
    ((int64_t *)state.array[0].data)[3] = 0;
    assert_string_equal(state.array[0].name, "counters");
    assert_int_equal(dem_scene_restore(scene, &state), DEM_OK);
    dem_state_clear(&state);
    scene->definition.gravity = 0;
    for (size_t b = 0; b < d->particle_count; b++) {
        const double x[3] = { b < 2 ? 0 : 0.01 * ((double)(b % 5) - 2), b < 2 ? 0.02 : -0.02,
                              b < 2 ? 0 : 0.01 * (double)(b / 5) - 0.02 },
                     none[3] = { 0 };
        set_body(scene, b, x, none, none);
    }
    return scene;
}

/* One step of a free body with three different moments; euler_advance, which other claims hold against energy and angular
 * momentum, says what so many passes give. At 300 rad/s and dt a few 1e-6 s a second pass changes the spin by the order
 * of (omega dt)^2, here 1e-7 of it. */
static void a_scene_corrects_spins_as_often_as_asked(void **unused)
{
    (void)unused;
    for (int passes = 0; passes <= 3; passes++) {
        dem_scene_definition d = mixed_drum();
        d.corrector_passes = passes;
        dem_scene *made = drum_scene(&d);
        const int kept = made->spheres.clusters.corrector_passes;
        dem_scene_free(made);
        assert_int_equal(kept, passes > 1 ? passes : 1);
        dem_scene *scene = weightless_clusters(&d, 0, 1);
        scene->spheres.clusters.corrector_passes = kept;
        const double spin[3] = { 100, 250, -150 }, none[3] = { 0 };
        set_body(scene, 0, (double[]){ 0, 0.02, 0.01 }, none, spin);
        neighbor_list_invalidate(&scene->neighbors);
        double as_asked[3], once[3], change[3] = { 0 }, change_once[3] = { 0 };
        memcpy(as_asked, spin, sizeof spin);
        memcpy(once, spin, sizeof spin);
        const cluster_body *body = &scene->spheres.clusters.body[0];
        for (int step = 0; step < 3; step++) {
            euler_advance(as_asked, change, none, scene->spheres.clusters.shape[0].inertia, d.time_step, kept);
            euler_advance(once, change_once, none, scene->spheres.clusters.shape[0].inertia, d.time_step, 1);
            run(scene, 1);
            assert_memory_equal(body->spin, as_asked, sizeof as_asked);
        }
        assert_int_equal(kept > 1, memcmp(as_asked, once, sizeof once) != 0);
        dem_scene_free(scene);
    }
}

/* Elastic and smooth, hit off the centre: energy, momentum and angular momentum come out as they went in. With friction
 * and latching springs energy is lost, the other two are not. Angular momentum: the sum over contacts in single
 * precision, and forces at r = R - overlap/2 on both sides, which differ by rounding alone. */
static void a_collision_of_clusters_keeps_what_it_must(void **unused)
{
    (void)unused;
    for (int rough = 0; rough < 2; rough++) {
        dem_scene_definition d;
        dem_scene *scene = weightless_clusters(&d, rough ? 0.5 : 0.0, rough ? 0.7 : 1.0);
        set_body(scene, 0, (double[]){ -0.006, 0.02, 0.001 }, (double[]){ 0.4, 0.02, 0 }, (double[]){ 20, 30, -60 });
        set_body(scene, 1, (double[]){ 0.001, 0.0212, 0 }, (double[]){ -0.2, 0, 0.03 }, (double[]){ 0, 10, 50 });
        neighbor_list_invalidate(&scene->neighbors);
        const motion before = motion_of(scene);
        run(scene, (int64_t)(0.02 / d.time_step));
        const motion after = motion_of(scene);
        const double mass = scene->spheres.clusters.shape[0].mass;
        CHECK_BETWEEN(fabs(scene->spheres.clusters.body[0].velocity[0] - 0.4), 0.05, 1); /* they did meet */
        for (int c = 0; c < 3; c++) {
            CHECK_NEAR(after.momentum[c], before.momentum[c], 1e-6 * mass * 0.6);
            CHECK_NEAR(after.angular[c], before.angular[c], 2e-4 * mass * 0.6 * 0.02);
        }
        if (rough) CHECK_BETWEEN(after.energy / before.energy, 0.2, 0.97);
        else CHECK_NEAR(after.energy / before.energy, 1, 2e-3); /* 80 steps a collision */
        dem_scene_free(scene);
    }
}

/* A free cluster with three moments tumbles for 0.2 s, some 2 turns: its energy stays. */
static void a_tumbling_cluster_keeps_its_energy(void **unused)
{
    (void)unused;
    dem_scene_definition d;
    dem_scene *scene = weightless_clusters(&d, 0.3, 0.8);
    set_body(scene, 0, (double[]){ 0, 0.03, 0 }, (double[]){ 0, 0, 0.1 }, (double[]){ 0.3, 60, 0.2 }); /* nearly the middle axis */
    set_body(scene, 1, (double[]){ 0.02, 0.02, 0 }, (double[]){ 0, 0, 0 }, (double[]){ 0, 0, 0 });
    neighbor_list_invalidate(&scene->neighbors);
    const motion before = motion_of(scene);
    run(scene, (int64_t)(0.2 / d.time_step));
    const motion after = motion_of(scene);
    CHECK_NEAR(after.energy / before.energy, 1, 1e-6); /* (60 rad/s x 3e-6 s)^2 and 7e4 roundings */
    CHECK_NEAR(after.angular[1] / before.angular[1], 1, 1e-3);
    dem_scene_free(scene);
}

/* A settled bed of clusters in a drum that stands still: what moves at first comes to rest and stays. */
static void clusters_at_rest_keep_still(void **unused)
{
    (void)unused;
    dem_scene_definition d = mixed_drum();
    d.rotation_rate = 0;
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    run(scene, (int64_t)(0.6 / d.time_step)); /* one that rocks may take its time */
    const double energy = dem_scene_kinetic_energy(scene);
    const double weight = dem_species_mass(&d.species[2]) * d.gravity * 0.003 * (double)d.particle_count;
    CHECK_BETWEEN(energy / weight, 0, 1e-6);
    const size_t n = dem_scene_sphere_count(scene);
    double *x = calloc(6 * n, sizeof *x), *y = x + 3 * n, moved = 0;
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = x });
    run(scene, (int64_t)(0.1 / d.time_step));
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = y });
    for (size_t k = 0; k < 3 * n; k++) moved = fmax(moved, fabs(remainder(y[k] - x[k], d.length)));
    CHECK_BETWEEN(moved / 0.003, 0, 1e-3);
    free(x);
    dem_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(touching_spheres_have_the_sums_of_their_moments),
        cmocka_unit_test(nothing_is_counted_twice_where_spheres_overlap),
        cmocka_unit_test(many_spheres_in_one_place_have_the_volume_of_their_union),
        cmocka_unit_test(two_overlapping_spheres_are_the_body_of_revolution),
        cmocka_unit_test(the_frame_is_the_principal_one),
        cmocka_unit_test(what_is_no_body_is_told),
        cmocka_unit_test(a_free_top_keeps_energy_and_angular_momentum_to_second_order),
        cmocka_unit_test(a_quaternion_turns_by_the_angle_about_the_axis),
        cmocka_unit_test(a_heavy_top_moves_as_by_another_integration),
        cmocka_unit_test(a_cluster_of_one_is_a_sphere_bit_for_bit),
        cmocka_unit_test(threads_and_restarts_leave_the_same_bits_in_every_phase),
        cmocka_unit_test(spheres_stay_where_their_cluster_puts_them),
        cmocka_unit_test(a_scene_corrects_spins_as_often_as_asked),
        cmocka_unit_test(a_collision_of_clusters_keeps_what_it_must),
        cmocka_unit_test(a_tumbling_cluster_keeps_its_energy),
        cmocka_unit_test(clusters_at_rest_keep_still),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
