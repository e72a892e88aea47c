#include "failure.h"

#include "lost.h"

/* Keeps a failure in the scene. `what` names spheres by their index; the failure that is kept names, by their id, the particles
 * that these spheres are or belong to. Returns the status. */
static dem_status fail(dem_scene *scene, const dem_failure *what)
{
    scene->failure = *what;
    scene->failure.step = scene->step_count;
    scene->failure.time = dem_scene_time(scene);
    if (what->particle >= 0) {
        memcpy(scene->failure.position, sphere_place(&scene->spheres, (size_t)what->particle), 3 * sizeof(double));
        scene->failure.particle = particle_id(&scene->spheres, particle_of_sphere(&scene->spheres, (size_t)what->particle));
    }
    if (what->other >= 0)
        scene->failure.other = particle_id(&scene->spheres, particle_of_sphere(&scene->spheres, (size_t)what->other));
    return what->status;
}

/* The same advice for each container, by its name. */
#define FOR_EACH_CONTAINER(before, after)                                                                                          \
    {                                                                                                                              \
        [DEM_DRUM] = before "drum" after, [DEM_CYLINDER] = before "cylinder" after, [DEM_TUBE_ON_PLATE] = before "heap" after,     \
        [DEM_VESSEL] = before "vessel" after                                                                                       \
    }
static const char *const too_soft_for_speeds[] =
    FOR_EACH_CONTAINER("the contacts are too soft for the speeds in this ",
                       ": a larger stiffness (or a smaller maximum_overlap) keeps particles inside the wall");
static const char *const too_soft_for_loads[] =
    FOR_EACH_CONTAINER("the stiffness is too small for the loads and speeds in this ",
                       ": give a larger stiffness, or a smaller maximum_overlap and let it be chosen");

/* The bound that a sphere's place breaks: what it is (quantity), its value and its limit, m. NULL quantity: the place is inside. */
typedef struct bound {
    double value, limit;
    const char *quantity;
} bound;

/* The first bound that sphere i breaks. Inline, because it is called for every sphere, and often. */
WIDE_INLINE bound bound_broken(const dem_scene *scene, size_t i)
{
    const double *x = sphere_place(&scene->spheres, i);
    const container *c = &scene->container;
    const double rho2 = x[0] * x[0] + x[1] * x[1];
    /* Written so that a NaN fails each of them. */
    if (c->kind != DEM_TUBE_ON_PLATE && c->half_depth == 0 && !(rho2 < c->radius * c->radius))
        return (bound){ sqrt(rho2), c->radius, "distance from the axis" };
    if (c->period > 0 && !(fabs(x[2]) <= c->length)) return (bound){ fabs(x[2]), c->length, "distance along the axis" };
    if (!(rho2 <= 1e18) || !(fabs(x[2]) <= 1e9)) return (bound){ sqrt(rho2), 1e9, "distance from the axis" };
    for (int k = 0; k < c->wall_count; k++) {
        const container_wall *w = &c->wall[k];
        if (w->kind == WALL_PLANE && !(wall_seen_from(w, x).distance > 0))
            return (bound){ wall_seen_from(w, x).distance, 0,
                            c->kind == DEM_DRUM ? "distance before the end wall" : "height above the floor" };
        if (w->kind == WALL_DISC && lost_came_through_plate(scene, i)) return (bound){ x[2], w->low, "height above the plate" };
        if (w->kind == WALL_FACE && !(wall_seen_from(w, x).distance > 0))
            return (bound){ wall_seen_from(w, x).distance, 0, "distance before the side" };
        if (w->kind == WALL_FUNNEL && lost_came_through_floor(scene, i)) return (bound){ x[2], w->low, "height above the orifice" };
        if (w->kind == WALL_BAR && rho2 > c->bars_from * c->bars_from && !(wall_seen_from(w, x).distance > 0))
            return (bound){ wall_seen_from(w, x).distance, 0, "distance before a lifter" };
    }
    return (bound){ 0, 0, NULL };
}

typedef struct places_work {
    const dem_scene *scene;
    size_t wrong[MOST_PARTS]; /* of each part: the first sphere that is somewhere else; the first of the next part: none */
} places_work;

static void check_places_of_part(void *context, int part, int parts)
{
    places_work *const work = context;
    const dem_scene *const scene = work->scene;
    const spheres *const s = &scene->spheres;
    const contact_parts *const own = &scene->neighbors.parts;
    const size_t end = contact_parts_begin(own, s->mobile_count, part + 1, parts);
    size_t i = contact_parts_begin(own, s->mobile_count, part, parts);
    for (; i < end; i++) {
        const vector4 v = s->velocity[i];
        if (!bound_broken(scene, i).quantity && fabs(v[0]) + fabs(v[1]) + fabs(v[2]) < 1e6) continue;
        if (!particle_is_lost(scene, particle_of_sphere(s, i))) break;
    }
    work->wrong[part] = i;
}

dem_status failure_check_places(dem_scene *scene)
{
    const spheres *s = &scene->spheres;
    const int parts = team_parts(scene->definition.threads);
    places_work work = { .scene = scene };
    team_run(parts, check_places_of_part, &work);
    for (int part = 0; part < parts; part++) {
        const size_t i = work.wrong[part];
        if (i == contact_parts_begin(&scene->neighbors.parts, s->mobile_count, part + 1, parts)) continue;
        const double *x = sphere_place(s, i);
        const vector4 v = s->velocity[i];
        bound broken = bound_broken(scene, i);
        if (!broken.quantity)
            broken = (bound){ sqrt(x[0] * x[0] + x[1] * x[1]), scene->container.radius, "distance from the axis" };
        const bool escaped =
            isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]) && isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
        const dem_failure what = {
            .status = escaped ? DEM_PARTICLE_ESCAPED : DEM_NOT_A_NUMBER,
            .particle = (int64_t)i,
            .other = -1,
            .value = broken.value,
            .limit = broken.limit,
            .quantity = broken.quantity,
            .unit = "m",
            .likely_cause = too_soft_for_speeds[scene->container.kind],
        };
        return fail(scene, &what);
    }
    return DEM_OK;
}

static dem_status overlap_failure(dem_scene *scene, int32_t i, int32_t j, double overlap, double limit)
{
    const dem_failure what = {
        .status = DEM_OVERLAP_TOO_LARGE,
        .particle = i,
        .other = j,
        .value = overlap,
        .limit = limit,
        .quantity = "overlap",
        .unit = "m",
        .likely_cause = too_soft_for_loads[scene->container.kind],
    };
    return fail(scene, &what);
}

/* Where sphere i was when the forces were computed. since: s, by which single spheres have moved on; others have not. */
static vector4 place_before(const spheres *s, int32_t i, double since)
{
    const size_t k = (size_t)i;
    return k < s->single_count ? s->place[k] - since * s->velocity[k] : s->place[k];
}

dem_status failure_check_overlaps(dem_scene *scene, double since)
{
    /* A place that is no number overlaps with anything: tell the cause. */
    const dem_status places = failure_check_places(scene);
    if (places != DEM_OK) return places;
    const spheres *s = &scene->spheres;
    const container *vessel = &scene->container;
    const contact_list *pairs = &scene->neighbors.pairs, *walls = &scene->neighbors.walls;
    for (size_t k = 0; k < pairs->count; k++) {
        const int32_t i = pairs->first[k], j = pairs->second[k];
        const vector4 a = place_before(s, i, since), b = place_before(s, j, since);
        const double distance2 = squared_distance((const double *)&a, (const double *)&b, vessel->period, vessel->inverse_period);
        const double overlap = sphere_radius(s, (size_t)i) + sphere_radius(s, (size_t)j) - sqrt(distance2);
        const double limit = FAILURE_OVERLAP * fmin(s->full_radius[i], s->full_radius[j]);
        if (!(overlap <= limit)) return overlap_failure(scene, i, (size_t)j < s->mobile_count ? j : -1, overlap, limit);
    }
    for (size_t k = 0; k < walls->count; k++) {
        const int32_t i = walls->first[k];
        const vector4 a = place_before(s, i, since);
        const double overlap =
            sphere_radius(s, (size_t)i) - wall_seen_from(&vessel->wall[walls->second[k]], (const double *)&a).distance;
        const double limit = FAILURE_OVERLAP * s->full_radius[i];
        if (!(overlap <= limit)) return overlap_failure(scene, i, -1, overlap, limit);
    }
    return DEM_OK;
}

dem_status failure_of_settling(dem_scene *scene, double energy)
{
    const dem_failure what = {
        .status = DEM_NEVER_SETTLED,
        .particle = -1,
        .other = -1,
        .value = energy,
        .limit = scene->filling.rest_energy,
        .quantity = "kinetic energy of the bed",
        .unit = "J",
        .likely_cause = "a restitution near 1 or a very low friction keeps the bed moving",
    };
    return fail(scene, &what);
}

dem_status failure_of_memory(dem_scene *scene)
{
    const dem_failure what = {
        .status = DEM_NO_MEMORY,
        .particle = -1,
        .other = -1,
        .quantity = "memory",
        .unit = "",
        .likely_cause = "the neighbor lists could not grow: fewer particles, or more memory",
    };
    return fail(scene, &what);
}
