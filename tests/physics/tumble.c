/* A rigid cluster that spins in place, without weight or contacts, in the scene's own step. Prints as JSON its mass and
 * principal moments in units of a sphere's mass m and radius a, and where it came to: orientation (w, x, y, z), energy
 * and angular momentum over those at the start.
 *
 * The spin asked for is that at time zero, along the principal axes. */
#include "../unit/core/small_drum.h"
#include "dem_cluster.h"
#include "named_numbers.h"
#include "scene.h"

enum { SHAPE, SPACING, W_X, W_Y, W_Z, STEP, STEPS };

static named_number asked[] = {
    { "shape", 0 },   /* 0: three spheres of different sizes, bent; else one of dem_shape */
    { "spacing", 1 }, /* of the centres, over where the spheres touch */
    { "spin_x", 60 }, { "spin_y", 40 }, { "spin_z", 30 }, { "time_step", 1e-5 }, { "steps", 0 }, { NULL, 0 },
};

static const double RADIUS = 0.001;

static double of(int which) { return asked[which].value; }

static dem_cluster cluster_asked(void)
{
    dem_cluster c = { .sphere_count = 3,
                      .sphere = { { { 0, 0, 0 }, 0.002 }, { { 0.0018, 0, 0 }, 0.0016 }, { { -0.0005, 0.0015, 0.0005 }, 0.0014 } } };
    if (of(SHAPE) > 0) dem_cluster_of_shape(&c, (dem_shape)of(SHAPE), 2 * RADIUS);
    for (size_t k = 0; k < c.sphere_count; k++)
        for (int a = 0; a < 3; a++) c.sphere[k].position[a] *= of(SPACING);
    dem_cluster_complete(&c);
    return c;
}

/* Clusters far from each other and the wall, all at rest. */
static void set_apart(dem_scene *scene)
{
    spheres *s = &scene->spheres;
    for (size_t b = 0; b < s->clusters.count; b++) {
        cluster_body *body = &s->clusters.body[b];
        const cluster_shape *shape = &s->clusters.shape[body->species];
        const double x[3] = { 0.02 * ((double)(b % 3) - 1), 0, 0.02 * (double)(b / 3) - 0.06 };
        memcpy(body->x, x, sizeof x);
        body->velocity = (vector4){ 0 };
        memset(body->spin, 0, sizeof body->spin);
        memset(body->spin_change, 0, sizeof body->spin_change);
        double a[3][3];
        quaternion_matrix(body->orientation, a);
        for (size_t k = 0; k < shape->sphere_count; k++) {
            const vector4 r = cluster_offset(shape, k, a, 1);
            sphere_set_place(s, (size_t)body->first_sphere + k, (double[]){ x[0] + r[0], x[1] + r[1], x[2] + r[2] });
        }
    }
    neighbor_list_invalidate(&scene->neighbors);
}

/* Half a step before time zero, to second order, with the change that led there. */
static void spin_up(cluster_body *body, const double inertia[3], const double omega[3], double dt)
{
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        body->spin_change[a] = omega[b] * omega[c] * (inertia[b] - inertia[c]) / inertia[a] * dt;
        body->spin[a] = omega[a] - 0.5 * body->spin_change[a];
    }
}

static dem_scene *scene_of(const dem_cluster *cluster)
{
    dem_scene_definition d = small_drum();
    d.diameter = 0.2;
    d.length = 0.2;
    d.species[0].cluster = *cluster;
    d.particle_count = 20;
    follow_rules(&d, 0.03);
    d.time_step = of(STEP);
    dem_scene *scene = drum_scene(&d);
    dem_state state; /* goes on at full size and rotating, without a bed being made first */
    assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
    int64_t *counters = state_array(&state, "counters")->data;
    counters[0] = DEM_PHASE_RUNNING;
    counters[3] = 0;
    assert_int_equal(dem_scene_restore(scene, &state), DEM_OK);
    dem_state_clear(&state);
    scene->definition.gravity = 0;
    set_apart(scene);
    return scene;
}

static void orientation_of(const dem_scene *scene, double e[4])
{
    double *all = calloc(4 * dem_scene_sphere_count(scene), sizeof *all);
    dem_scene_particles(scene, &(dem_particle_arrays){ .orientation = all });
    memcpy(e, all, 4 * sizeof *e);
    free(all);
}

static void print_triple(const char *name, const double x[3], double unit)
{
    printf("\"%s\": [%.17g, %.17g, %.17g], ", name, x[0] / unit, x[1] / unit, x[2] / unit);
}

int main(int argc, char **argv)
{
    read_named_numbers(argc, argv, asked);
    const dem_cluster cluster = cluster_asked();
    const double m = dem_sphere_mass(2 * RADIUS, 1), omega[3] = { of(W_X), of(W_Y), of(W_Z) };
    printf("{\"mass\": %.17g, ", cluster.volume / m);
    print_triple("inertia", cluster.inertia, m * RADIUS * RADIUS);
    dem_scene *scene = scene_of(&cluster);
    cluster_body *body = &scene->spheres.clusters.body[0];
    const cluster_shape *shape = &scene->spheres.clusters.shape[0];
    double start[4], end[4], on_step[3] = { of(W_X), of(W_Y), of(W_Z) };
    orientation_of(scene, start);
    spin_up(body, shape->inertia, omega, of(STEP));
    for (int64_t k = 0; k < (int64_t)of(STEPS); k++) {
        double before[3];
        memcpy(before, body->spin, sizeof before);
        run(scene, 1);
        for (int c = 0; c < 3; c++) on_step[c] = 0.5 * (before[c] + body->spin[c]); /* at the step's beginning */
    }
    orientation_of(scene, end);
    print_triple("spin", on_step, 1);
    printf("\"start\": [%.17g, %.17g, %.17g, %.17g], ", start[0], start[1], start[2], start[3]);
    printf("\"end\": [%.17g, %.17g, %.17g, %.17g]}\n", end[0], end[1], end[2], end[3]);
    dem_scene_free(scene);
    return 0;
}
