/* Claims about clusters in a drum: the same as spheres where they are spheres, at rest where they rest, conserved where
 * nothing is lost. */
#include "cluster.h"
#include "dem_cluster.h"
#include "scene.h"
#include "small_drum.h"

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

UNIT_TESTS(a_cluster_of_one_is_a_sphere_bit_for_bit, threads_and_restarts_leave_the_same_bits_in_every_phase,
           spheres_stay_where_their_cluster_puts_them, a_scene_corrects_spins_as_often_as_asked,
           a_collision_of_clusters_keeps_what_it_must, a_tumbling_cluster_keeps_its_energy, clusters_at_rest_keep_still)
