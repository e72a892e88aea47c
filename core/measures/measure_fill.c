/* The bed in a standing cylinder: the slope of its surface under three definitions, and its packing over the height. */
#include <math.h>
#include <string.h>

#include "array.h"
#include "ball_points.h"
#include "dem_rules.h"
#include "height_map.h"
#include "statistics.h"

static const double INNER = 0.2, OUTER = 0.8; /* of the radius: the line is fitted between, middle and wall lie beyond */

const char *dem_fill_method_name(dem_fill_method method)
{
    static const char *const name[DEM_FILL_METHODS] = { "radial-fit", "center-to-wall", "area-fit" };
    return name[method];
}

static dem_angle fit_between(const height_map *map, double from, double to)
{
    ring_sums sums[DEM_AZIMUTHS];
    double radians[DEM_AZIMUTHS];
    height_map_sum(map, from, to, sums);
    for (int a = 0; a < DEM_AZIMUTHS; a++) radians[a] = atan(-ring_slope(&sums[a]));
    return angle_over_azimuths(radians);
}

static ring_sums sum_of_all(const ring_sums sums[DEM_AZIMUTHS])
{
    ring_sums all = { 0 };
    for (int a = 0; a < DEM_AZIMUTHS; a++) {
        all.cells += sums[a].cells;
        all.r += sums[a].r;
        all.h += sums[a].h;
    }
    return all;
}

/* From the one middle to each sector's strip along the wall. */
static void measure_steps(const height_map *map, double radius, double edge, dem_fill_results *results)
{
    ring_sums middle[DEM_AZIMUTHS], wall[DEM_AZIMUTHS];
    double radians[DEM_AZIMUTHS];
    height_map_sum(map, 0, INNER * radius, middle);
    height_map_sum(map, OUTER * radius, edge, wall);
    const ring_sums inside = sum_of_all(middle), outside = sum_of_all(wall);
    results->center_height = inside.h / inside.cells;
    results->wall_height = outside.h / outside.cells;
    for (int a = 0; a < DEM_AZIMUTHS; a++)
        radians[a] =
            atan((results->center_height - wall[a].h / wall[a].cells) / (wall[a].r / wall[a].cells - inside.r / inside.cells));
    results->angle[DEM_CENTER_TO_WALL] = angle_over_azimuths(radians);
}

typedef struct slabs {
    size_t count;
    double thickness, core_radius, core_low, core_high; /* m */
    double solid[DEM_PROFILE_POINTS], core;             /* m3 */
} slabs;

static void slabs_add(slabs *s, double points[BALL_POINTS][3], const double x[3], double radius, double volume)
{
    for (int k = 0; k < BALL_POINTS; k++) {
        const double px = x[0] + radius * points[k][0], py = x[1] + radius * points[k][1], pz = x[2] + radius * points[k][2];
        /* a sphere reaches a little into the floor */
        const double slab = fmin(fmax(floor(pz / s->thickness), 0.0), (double)s->count - 1);
        s->solid[(size_t)slab] += volume / BALL_POINTS;
        if (pz >= s->core_low && pz < s->core_high && px * px + py * py < s->core_radius * s->core_radius)
            s->core += volume / BALL_POINTS;
    }
}

static void measure_packing(const dem_mound *mound, double radius, dem_fill_results *results)
{
    double points[BALL_POINTS][3], top = 0.0;
    for (size_t i = 0; i < mound->count; i++) top = fmax(top, mound->position[3 * i + 2] + mound->radius[i]);
    slabs s = { .core_radius = radius - 2 * mound->grain,
                .core_low = 2 * mound->grain,
                .core_high = fmin(results->center_height, results->wall_height) - 2 * mound->grain };
    s.count = (size_t)fmin(fmax(ceil(top / mound->grain), 1.0), DEM_PROFILE_POINTS);
    s.thickness = fmax(mound->grain, top / (double)s.count);
    ball_points(points);
    for (size_t i = 0; i < mound->count; i++) slabs_add(&s, points, mound->position + 3 * i, mound->radius[i], mound->volume[i]);
    results->packing.count = s.count;
    for (size_t k = 0; k < s.count; k++) {
        results->packing.place[k] = ((double)k + 0.5) * s.thickness;
        results->packing.value[k] = s.solid[k] / (DEM_PI * radius * radius * s.thickness);
        results->packing.standard_error[k] = NAN;
    }
    const double core = s.core_high - s.core_low;
    const bool has_core = core >= mound->grain && s.core_radius >= mound->grain;
    results->solid_fraction = has_core ? s.core / (DEM_PI * s.core_radius * s.core_radius * core) : NAN;
}

dem_status dem_fill_measure(const dem_mound *mound, double cylinder_radius, dem_fill_results *results)
{
    height_map map;
    arrays_begin();
    memset(results, 0, sizeof *results);
    const dem_status status = height_map_init(&map, mound, cylinder_radius, cylinder_radius);
    if (status != DEM_OK) return status;
    const double edge = cylinder_radius - 0.5 * mound->grain; /* beyond, spheres are seen from their sides alone */
    ring_sums sums[DEM_AZIMUTHS];
    height_map_sum(&map, 0, edge, sums);
    const ring_sums all = sum_of_all(sums);
    results->height = all.h / all.cells;
    results->angle[DEM_RADIAL_FIT] = fit_between(&map, INNER * cylinder_radius, OUTER * cylinder_radius);
    results->angle[DEM_AREA_FIT] = fit_between(&map, 0, edge);
    measure_steps(&map, cylinder_radius, edge, results);
    height_map_profile(&map, edge, mound->grain, &results->surface, NULL);
    measure_packing(mound, cylinder_radius, results);
    height_map_clear(&map);
    /* All sectors share the middle, and the layer along the wall: what they differ by does not tell how another bed would
     * differ. */
    results->angle[DEM_CENTER_TO_WALL].standard_error_deg = results->angle[DEM_AREA_FIT].standard_error_deg = NAN;
    if (mound->count < DEM_LEAST_BED_PARTICLES || results->height < DEM_LEAST_BED_LAYERS * mound->grain)
        for (int m = 0; m < DEM_FILL_METHODS; m++) results->angle[m] = (dem_angle){ NAN, NAN, NAN, NAN };
    return arrays_end(DEM_OK);
}
