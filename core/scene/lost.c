#include "lost.h"

#include "array.h"

enum { STEPS_BETWEEN_LOOKS = 50 };

static bool has_orifice(const dem_scene *scene) { return scene->container.kind == DEM_VESSEL; }

/* Distance between places on the tray: nobody can reach a neighbor. */
static double tray_pitch(const spheres *s) { return 2.5 * s->largest_reach; }

/* m below the plate or orifice. */
static double tray_depth(const dem_scene *scene)
{
    const container *c = &scene->container;
    return fmax(0.5 * (c->high[0] - c->low[0]), 20 * scene->spheres.largest_reach);
}

/* m: of a square below the plate; of one that the walls of a vessel, which have no lower end, are not in reach of. */
static double tray_width(const dem_scene *scene)
{
    const container *c = &scene->container;
    if (!has_orifice(scene)) return c->high[0] - c->low[0];
    return (c->half_depth > 0 ? 2 * c->inner_radius : sqrt(2) * c->radius) - 2 * scene->spheres.largest_reach;
}

/* Place of particle p on the tray: a lattice about the axis or, below a plate, from its corner on; layer below layer. */
static void tray_place(const dem_scene *scene, size_t p, double x[3])
{
    const double pitch = tray_pitch(&scene->spheres), width = tray_width(scene);
    const size_t side = (size_t)fmax(1.0, floor(width / pitch));
    const double low = has_orifice(scene) ? -0.5 * (double)side * pitch : scene->container.low[0];
    x[0] = low + ((double)(p % side) + 0.5) * pitch;
    x[1] = low + ((double)(p / side % side) + 0.5) * pitch;
    x[2] = -tray_depth(scene) - (double)(p / (side * side)) * pitch;
}

/* A cluster's spheres follow from it with the next step; until then they stand where they were, turned about it. */
static void lay_down(dem_scene *scene, size_t p)
{
    spheres *s = &scene->spheres;
    const vector4 rest = { 0 };
    double x[3];
    tray_place(scene, p, x);
    if (p < s->single_count) {
        sphere_set(s, p, (vector4){ x[0], x[1], x[2] }, rest, rest);
        return;
    }
    cluster_body *body = &s->clusters.body[p - s->single_count];
    const size_t first = (size_t)body->first_sphere, end = first + s->clusters.shape[body->species].sphere_count;
    for (size_t i = first; i < end; i++) {
        const double *now = sphere_place(s, i);
        sphere_set(s, i, (vector4){ now[0] - body->x[0] + x[0], now[1] - body->x[1] + x[1], now[2] - body->x[2] + x[2] }, rest,
                   rest);
    }
    memcpy(body->x, x, sizeof x);
    body->velocity = (vector4){ 0 };
    memset(body->spin, 0, sizeof body->spin);
    memset(body->spin_change, 0, sizeof body->spin_change);
}

/* All may be on the tray in the end: the box that particles are looked for in has it, too. */
dem_status lost_init(dem_scene *scene)
{
    if (scene->container.kind != DEM_TUBE_ON_PLATE && !has_orifice(scene)) return DEM_OK;
    const size_t n = particles_count(&scene->spheres);
    if (has_orifice(scene)) {
        double last[3];
        tray_place(scene, n - 1, last);
        scene->container.low[2] = last[2] - tray_pitch(&scene->spheres);
    }
    scene->lost = array_create(n, sizeof *scene->lost);
    scene->is_lost = array_create(n, sizeof *scene->is_lost);
    return scene->lost && scene->is_lost ? DEM_OK : DEM_NO_MEMORY;
}

void lost_clear(dem_scene *scene)
{
    free(scene->lost);
    free(scene->is_lost);
}

static bool is_beneath_plate(const dem_scene *scene, size_t i)
{
    const double *x = sphere_place(&scene->spheres, i), edge = 0.5 * scene->definition.plate.diameter;
    return !(x[2] > 0) && x[0] * x[0] + x[1] * x[1] < edge * edge;
}

bool lost_came_through_plate(const dem_scene *scene, size_t i)
{
    const double way = fabs(scene->spheres.velocity[i][2]) * scene->definition.time_step;
    return is_beneath_plate(scene, i) && !(way < sphere_radius(&scene->spheres, i));
}

bool lost_came_through_floor(const dem_scene *scene, size_t i)
{
    const vector4 v = scene->spheres.velocity[i];
    const double way = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * scene->definition.time_step;
    return wall_is_beneath_funnel(&scene->container.wall[scene->container.funnel], sphere_place(&scene->spheres, i))
           && !(way < sphere_radius(&scene->spheres, i));
}

/* A plate has a thickness in which nobody fits: who reaches beneath it does not come back, nor hang on to its edge. */
static bool has_tipped_over(const dem_scene *scene, size_t p)
{
    const spheres *s = &scene->spheres;
    size_t first = p, end = p + 1;
    if (p >= s->single_count) {
        const cluster_body *body = &s->clusters.body[p - s->single_count];
        first = (size_t)body->first_sphere;
        end = first + s->clusters.shape[body->species].sphere_count;
    }
    bool beneath = false;
    for (size_t i = first; i < end; i++) {
        if (lost_came_through_plate(scene, i)) return false; /* a failure, which is found and told elsewhere */
        beneath = beneath || is_beneath_plate(scene, i);
    }
    return beneath || particle_place(s, p)[2] < -2 * particle_reach(s, p);
}

static bool is_through_orifice(const dem_scene *scene, size_t p)
{
    return particle_place(&scene->spheres, p)[2] < -2 * particle_reach(&scene->spheres, p);
}

static void lose(dem_scene *scene, size_t p)
{
    scene->is_lost[p] = true;
    scene->lost[scene->lost_count++] = (int32_t)p;
}

void lost_look(dem_scene *scene)
{
    if (!scene->is_lost || scene->step_count % STEPS_BETWEEN_LOOKS) return;
    const size_t before = scene->lost_count, n = particles_count(&scene->spheres);
    for (size_t p = 0; p < n; p++)
        if (!scene->is_lost[p] && (has_orifice(scene) ? is_through_orifice(scene, p) : has_tipped_over(scene, p))) lose(scene, p);
    for (size_t k = has_orifice(scene) ? 0 : before; k < scene->lost_count; k++) lay_down(scene, (size_t)scene->lost[k]);
    if (scene->lost_count > before) neighbor_list_invalidate(&scene->neighbors);
}

void lost_hold(dem_scene *scene)
{
    for (size_t k = 0; !has_orifice(scene) && k < scene->lost_count; k++) lay_down(scene, (size_t)scene->lost[k]);
}

void lost_recognize(dem_scene *scene)
{
    if (!scene->is_lost) return;
    const size_t n = particles_count(&scene->spheres);
    scene->lost_count = 0;
    for (size_t p = 0; p < n; p++) {
        const double *place = particle_place(&scene->spheres, p);
        double x[3];
        tray_place(scene, p, x);
        scene->is_lost[p] = false;
        const bool is_on_tray =
            has_orifice(scene) ? place[2] < -0.5 * tray_depth(scene) : place[0] == x[0] && place[1] == x[1] && place[2] == x[2];
        if (is_on_tray) lose(scene, p);
    }
}
