/* Claims about rigid clusters: volume and inertia of the union, Euler's equations and quaternions. */
#include "cluster.h"
#include "dem_cluster.h"
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

UNIT_TESTS(touching_spheres_have_the_sums_of_their_moments, nothing_is_counted_twice_where_spheres_overlap,
           many_spheres_in_one_place_have_the_volume_of_their_union, two_overlapping_spheres_are_the_body_of_revolution,
           the_frame_is_the_principal_one, what_is_no_body_is_told, a_free_top_keeps_energy_and_angular_momentum_to_second_order,
           a_quaternion_turns_by_the_angle_about_the_axis, a_heavy_top_moves_as_by_another_integration)
