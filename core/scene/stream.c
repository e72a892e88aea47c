#include "stream.h"

#include "array.h"
#include "dem_stream.h"
#include "random.h"

enum { TRIES_A_STEP = 50, MOST_AT_INLET = 1024 };

void stream_complete_species(dem_scene_definition *definition)
{
    bool has_clusters = false;
    for (size_t k = 0; k < definition->species_count; k++)
        has_clusters = has_clusters || definition->species[k].cluster.sphere_count > 0;
    if (!has_stream(definition) || !has_clusters) return;
    for (size_t k = 0; k < definition->species_count; k++) {
        dem_species *species = &definition->species[k];
        if (species->cluster.sphere_count > 0) continue;
        species->cluster = (dem_cluster){ .sphere_count = 1, .sphere = { { .diameter = species->diameter } } };
    }
}

/* The species of each particle in turn: shuffled (Fisher & Yates). */
static int32_t *shuffled_species(const dem_scene_definition *definition)
{
    int32_t *order = array_create(definition->particle_count, sizeof *order);
    if (!order) return NULL;
    size_t n = 0;
    for (size_t k = 0; k < definition->species_count; k++)
        for (size_t c = species_particles(definition, k); c > 0; c--) order[n++] = (int32_t)k;
    random_stream random;
    random_seed(&random, definition->seed);
    for (size_t i = n; i > 1; i--) {
        const size_t j = (size_t)(random_uniform(&random) * (double)i);
        const int32_t swapped = order[i - 1];
        order[i - 1] = order[j];
        order[j] = swapped;
    }
    return order;
}

/* Spheres that the first `particles` have. */
static size_t spheres_of(const dem_scene *scene, size_t particles)
{
    if (particles >= scene->stream.particles) return scene->stream.spheres;
    return scene->stream.has_clusters ? (size_t)scene->spheres.clusters.body[particles].first_sphere : particles;
}

/* Spheres behind the last one inside are those that no list names but in its padding. */
static void set_inside(dem_scene *scene, size_t particles)
{
    spheres *s = &scene->spheres;
    s->mobile_count = spheres_of(scene, particles);
    if (scene->stream.has_clusters) s->clusters.count = particles;
    else s->single_count = particles;
    spheres_pad(s);
    spheres_set_scale(s, 1.0);
}

static size_t inside(const dem_scene *scene) { return particles_count(&scene->spheres); }

/* Spheres that may reach into a particle at the inlet's height, for all tries; more than these: all there are are looked at. */
typedef struct at_inlet {
    size_t count;
    int32_t sphere[MOST_AT_INLET];
} at_inlet;

static void find_at_inlet(at_inlet *near, const spheres *s, double reach, double height)
{
    near->count = 0;
    for (size_t i = 0; i < s->mobile_count && near->count <= MOST_AT_INLET; i++) {
        if (!(fabs(s->place[i][2] - height) < reach + sphere_radius(s, i))) continue;
        if (near->count < MOST_AT_INLET) near->sphere[near->count] = (int32_t)i;
        near->count++;
    }
}

/* Nothing inside reaches into the sphere about x that holds the particle. */
static bool is_free(const spheres *s, const at_inlet *near, const double x[3], double reach)
{
    const bool are_listed = near->count <= MOST_AT_INLET;
    const size_t count = are_listed ? near->count : s->mobile_count;
    for (size_t k = 0; k < count; k++) {
        const size_t i = are_listed ? (size_t)near->sphere[k] : k;
        const double *o = sphere_place(s, i), e[3] = { o[0] - x[0], o[1] - x[1], o[2] - x[2] };
        const double apart = reach + sphere_radius(s, i);
        if (e[0] * e[0] + e[1] * e[1] + e[2] * e[2] < apart * apart) return false;
    }
    return true;
}

static bool find_place(const dem_scene *scene, double reach, double height, random_stream *random, double x[3])
{
    const double room = 0.5 * scene->definition.stream.diameter - reach;
    at_inlet near;
    find_at_inlet(&near, &scene->spheres, reach, height);
    for (int k = 0; k < TRIES_A_STEP; k++) {
        const double r = room * sqrt(random_uniform(random)), turn = 2 * DEM_PI * random_uniform(random);
        x[0] = r * cos(turn);
        x[1] = r * sin(turn);
        x[2] = height;
        if (is_free(&scene->spheres, &near, x, reach)) return true;
    }
    return false;
}

static void put_sphere(spheres *s, size_t i, const double x[3], vector4 velocity)
{
    const vector4 none = { 0 };
    s->velocity[i] = velocity; /* as yet behind the last one */
    s->angular_velocity[i] = none;
    sphere_set(s, i, (vector4){ x[0], x[1], x[2] }, velocity, none);
}

static void put_cluster(spheres *s, cluster_body *body, const double x[3], vector4 velocity, random_stream *random)
{
    const cluster_shape *shape = &s->clusters.shape[body->species];
    double a[3][3];
    memcpy(body->x, x, sizeof body->x);
    body->velocity = velocity;
    body->orientation = filling_random_orientation(random);
    quaternion_matrix(body->orientation, a);
    for (size_t k = 0; k < shape->sphere_count; k++) {
        const vector4 r = cluster_offset(shape, k, a, 1.0);
        put_sphere(s, (size_t)body->first_sphere + k, (double[3]){ x[0] + r[0], x[1] + r[1], x[2] + r[2] }, velocity);
    }
}

/* The next particle, if there is room for it now. */
static bool enter_one(dem_scene *scene)
{
    const dem_scene_definition *definition = &scene->definition;
    spheres *s = &scene->spheres;
    const size_t p = inside(scene);
    const double reach = scene->stream.has_clusters ? s->clusters.shape[s->clusters.body[p].species].reach : s->full_radius[p];
    random_stream random;
    random_seed(&random, definition->seed ^ (UINT64_C(0x9e3779b97f4a7c15) * (p + 1)) ^ (uint64_t)scene->step_count << 32);
    double x[3];
    const double height = dem_stream_inlet_height(definition, (double)p);
    if (!find_place(scene, reach, height, &random, x)) return false;
    const vector4 velocity = { 0, 0, -dem_stream_entry_speed(definition) };
    if (scene->stream.has_clusters) put_cluster(s, &s->clusters.body[p], x, velocity, &random);
    else put_sphere(s, p, x, velocity);
    set_inside(scene, p + 1);
    return true;
}

void stream_enter(dem_scene *scene)
{
    if (!has_stream(&scene->definition)) return;
    const double due = (double)scene->step_count * scene->definition.time_step * scene->definition.stream.rate;
    const size_t before = inside(scene);
    while (inside(scene) < scene->stream.particles && (double)inside(scene) <= due)
        if (!enter_one(scene)) break;
    if (inside(scene) > before) neighbor_list_invalidate(&scene->neighbors);
}

dem_status stream_init(dem_scene *scene)
{
    spheres *s = &scene->spheres;
    int32_t *order = shuffled_species(&scene->definition);
    if (!order) return DEM_NO_MEMORY;
    scene->stream = (stream){ .particles = particles_count(s), .spheres = s->mobile_count, .has_clusters = s->clusters.count > 0 };
    const dem_status status = filling_assign_in_order(s, &scene->definition, order);
    free(order);
    return status;
}

void stream_begin(dem_scene *scene)
{
    scene->spheres.single_count = scene->spheres.clusters.count = scene->spheres.mobile_count = 0;
    scene->run_start = 0;
    enter_one(scene);
    scene_enter_phase(scene, DEM_PHASE_RUNNING);
}

dem_status stream_restore(dem_scene *scene, size_t sphere_count)
{
    if (!has_stream(&scene->definition)) return DEM_OK;
    size_t particles = 0;
    while (particles < scene->stream.particles && spheres_of(scene, particles) < sphere_count) particles++;
    if (particles == 0 || spheres_of(scene, particles) != sphere_count) return DEM_STATE_MISMATCH;
    set_inside(scene, particles);
    return DEM_OK;
}
