#include "drained.h"

#include "array.h"
#include "dem_rules.h"
#include "height_map.h"
#include "statistics.h"

static const double INNER = 0.2, OUTER = 0.8; /* of the way from the orifice to the side: the line is fitted between */

/* A cluster's volume, which is less than that of its spheres where these overlap, shared among them. */
double volume_of_sphere(const dem_scene *scene, size_t i)
{
    const dem_cluster *cluster = &scene->definition.species[scene->spheres.species[i]].cluster;
    double all = 0.0;
    for (size_t k = 0; k < cluster->sphere_count; k++) all += dem_sphere_mass(cluster->sphere[k].diameter, 1.0);
    const double own = dem_sphere_mass(2 * sphere_radius(&scene->spheres, i), 1.0);
    return all > 0 ? own * cluster->volume / all : own;
}

/* Which of the sectors a place is in: azimuths of a round vessel; on either side of a slot, eight parts of its length. */
static int sector_of(const dem_scene *scene, double x, double y)
{
    const double half = scene->container.half_depth;
    if (half == 0) return height_map_sector(x, y);
    const int part = (int)floor((y / half + 1) * DEM_AZIMUTHS / 4);
    return (x < 0 ? DEM_AZIMUTHS / 2 : 0) + (part < 0 ? 0 : part < DEM_AZIMUTHS / 2 ? part : DEM_AZIMUTHS / 2 - 1);
}

/* Over the cells whose distance from the middle is within [from, to); r is that distance. */
static void sum_between(const dem_scene *scene, const height_map *map, double from, double to, ring_sums sums[DEM_AZIMUTHS])
{
    const double half = scene->container.half_depth;
    memset(sums, 0, DEM_AZIMUTHS * sizeof *sums);
    for (int row = 0; row < map->cells; row++)
        for (int column = 0; column < map->cells; column++) {
            const double x[3] = { height_map_place(map, column), height_map_place(map, row) };
            const double r = distance_from_middle(scene, x), h = map->value[(size_t)row * (size_t)map->cells + (size_t)column];
            if (r < from || r >= to || (half > 0 && fabs(x[1]) > half)) continue;
            ring_sums *s = &sums[sector_of(scene, x[0], x[1])];
            s->cells += 1;
            s->r += r;
            s->h += h;
            s->rr += r * r;
            s->rh += r * h;
        }
}

/* tan = (mean of the height) / (mean of the distance from the edge): what a pit of straight sides has. base: m, the height of the
 * surface where the floor is just covered. */
static double pit_slope(const ring_sums *s, double edge, double base)
{
    return (s->h / s->cells - base) / (s->r / s->cells - edge);
}

static dem_status gather(const dem_scene *scene, double **numbers, dem_mound *mound)
{
    const spheres *s = &scene->spheres;
    *numbers = array_create(4 * s->mobile_count, sizeof **numbers);
    if (!*numbers) return DEM_NO_MEMORY;
    double *radius = *numbers + 3 * s->mobile_count;
    size_t n = 0;
    for (size_t i = 0; i < s->mobile_count; i++) {
        if (particle_is_lost(scene, particle_of_sphere(s, i))) continue;
        memcpy(*numbers + 3 * n, sphere_place(s, i), 3 * sizeof **numbers);
        radius[n++] = sphere_radius(s, i);
    }
    *mound = (dem_mound){ .count = n, .position = *numbers, .radius = radius };
    mound->grain = cbrt(6 / DEM_PI * dem_mean_volume(scene->definition.species, scene->definition.species_count));
    return DEM_OK;
}

dem_status drained_measure(const dem_scene *scene, double angle_deg[2])
{
    const container *c = &scene->container;
    angle_deg[0] = angle_deg[1] = NAN;
    if (c->hopper_height > 0 || particles_count(&scene->spheres) - scene->lost_count < DEM_LEAST_BED_PARTICLES) return DEM_OK;
    double *numbers;
    dem_mound mound;
    height_map map;
    dem_status status = gather(scene, &numbers, &mound);
    if (status != DEM_OK) return status;
    const double widest = fmax(c->radius, c->half_depth), edge = 0.5 * scene->definition.orifice.opening;
    const double side = c->radius - 0.5 * mound.grain; /* beyond, spheres are seen from their sides alone */
    status = height_map_init(&map, &mound, widest, widest);
    if (status == DEM_OK) {
        ring_sums line[DEM_AZIMUTHS], pit[DEM_AZIMUTHS];
        double slope[2][DEM_AZIMUTHS];
        sum_between(scene, &map, edge + INNER * (side - edge), edge + OUTER * (side - edge), line);
        sum_between(scene, &map, edge, side, pit);
        for (int a = 0; a < DEM_AZIMUTHS; a++) {
            slope[0][a] = atan(ring_slope(&line[a])) * (180 / DEM_PI);
            slope[1][a] = atan(pit_slope(&pit[a], edge, 0.5 * mound.grain)) * (180 / DEM_PI);
        }
        for (int m = 0; m < 2; m++) angle_deg[m] = statistics_mean(slope[m], DEM_AZIMUTHS);
        height_map_clear(&map);
    }
    free(numbers);
    return status;
}
