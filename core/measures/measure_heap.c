/* The heap below a lifted tube, under four definitions of its angle. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "array.h"
#include "dem_rules.h"
#include "height_map.h"
#include "statistics.h"

static const double UPPER = 0.8, LOWER = 0.2; /* of the height: where the line is fitted */

const char *dem_heap_method_name(dem_heap_method method)
{
    static const char *const name[DEM_HEAP_METHODS] = { "azimuthal-fit", "apex-to-base", "equal-volume-cone", "silhouette" };
    return name[method];
}

/* Where the profile, going outward, falls to `height` for the last time; `radius` where it never does. */
static double falls_to(const double *place, const double *value, size_t count, double height, double radius)
{
    size_t last = count;
    while (last > 0 && !(value[last - 1] >= height)) last--;
    if (last == 0) return NAN;
    if (last == count) return radius;
    return place[last - 1] + (place[last] - place[last - 1]) * (value[last - 1] - height) / (value[last - 1] - value[last]);
}

static void fit_azimuths(const height_map *map, const dem_profile *mean, double grain, double level, double radius,
                         dem_angle *angle)
{
    double top = 0.0, radians[DEM_AZIMUTHS];
    for (size_t k = 0; k < mean->count; k++) top = fmax(top, mean->value[k]);
    const double from = falls_to(mean->place, mean->value, mean->count, level + UPPER * (top - level), radius);
    const double to = falls_to(mean->place, mean->value, mean->count, level + LOWER * (top - level), radius);
    ring_sums sums[DEM_AZIMUTHS];
    height_map_sum(map, from, to, sums);
    /* A flank shorter than two grains has no slope to speak of, nor has a single layer with some grains on it. */
    const bool has_flank = to - from >= 2 * grain && top - level >= grain;
    for (int a = 0; a < DEM_AZIMUTHS; a++) radians[a] = has_flank ? atan(-ring_slope(&sums[a])) : NAN;
    *angle = angle_over_azimuths(radians);
}

/* Cones of each sector's base: of the heap's height, and of the sector's volume; both over the level of the base. */
static void measure_cones(const height_map *map, const dem_profile *mean, double (*rings)[DEM_AZIMUTHS], double level,
                          double radius, dem_heap_results *results)
{
    double height_cone[DEM_AZIMUTHS], volume_cone[DEM_AZIMUTHS], base[DEM_AZIMUTHS], sector[DEM_PROFILE_POINTS];
    for (int a = 0; a < DEM_AZIMUTHS; a++) {
        for (size_t k = 0; k < mean->count; k++) sector[k] = rings[k][a];
        base[a] = falls_to(mean->place, sector, mean->count, level, radius);
        ring_sums sums[DEM_AZIMUTHS];
        height_map_sum(map, 0, isnan(base[a]) ? 0 : base[a], sums);
        /* The mean height over the base is a third of the cone's. */
        const double mean_height = sums[a].cells > 0 ? sums[a].h / sums[a].cells - level : NAN;
        height_cone[a] = atan((results->height - level) / base[a]);
        volume_cone[a] = atan(3 * mean_height / base[a]);
    }
    results->angle[DEM_APEX_TO_BASE] = angle_over_azimuths(height_cone);
    results->angle[DEM_EQUAL_VOLUME] = angle_over_azimuths(volume_cone);
    results->base_diameter = 2 * statistics_mean(base, DEM_AZIMUTHS);
}

/* Angle of the triangle that has the outline's area and base, as seen along the direction across `azimuth`. */
static double silhouette_angle(const height_map *map, double azimuth, double level, double *outline, int bins)
{
    const double c = cos(azimuth), sine = sin(azimuth), width = 2 * map->size;
    double area = 0.0;
    int first = bins, last = -1;
    memset(outline, 0, (size_t)bins * sizeof *outline);
    for (int row = 0; row < map->cells; row++)
        for (int column = 0; column < map->cells; column++) {
            const double s = c * height_map_place(map, column) + sine * height_map_place(map, row);
            const int bin = (int)floor(s / width + 0.5 * bins);
            if (bin >= 0 && bin < bins)
                outline[bin] = fmax(outline[bin], map->value[(size_t)row * (size_t)map->cells + (size_t)column]);
        }
    for (int b = 0; b < bins; b++) {
        if (outline[b] < level) continue;
        area += (outline[b] - level) * width;
        first = b < first ? b : first;
        last = b;
    }
    const double base = (last - first + 1) * width;
    return last < first ? NAN : atan(4 * area / (base * base));
}

static dem_status measure_silhouette(const height_map *map, double level, dem_angle *angle)
{
    const int bins = map->cells; /* of two cells: enough for the diagonal */
    double *outline = array_create((size_t)bins, sizeof *outline), radians[DEM_AZIMUTHS];
    if (!outline) return DEM_NO_MEMORY;
    for (int a = 0; a < DEM_AZIMUTHS; a++) radians[a] = silhouette_angle(map, DEM_PI * a / DEM_AZIMUTHS, level, outline, bins);
    free(outline);
    *angle = angle_over_azimuths(radians);
    return DEM_OK;
}

/* Mean over the rings of the base of the standard deviation over azimuths. */
static double cohesive_index(const dem_profile *mean, double (*rings)[DEM_AZIMUTHS], double base_radius)
{
    double deviation[DEM_PROFILE_POINTS];
    size_t n = 0;
    for (size_t k = 0; k < mean->count && mean->place[k] < base_radius; k++)
        deviation[n++] = statistics_deviation(rings[k], DEM_AZIMUTHS);
    return n ? statistics_mean(deviation, n) : NAN;
}

static void measure_volume(const height_map *map, const dem_mound *mound, dem_heap_results *results)
{
    double below = 0.0, solid = 0.0;
    for (size_t k = 0; k < (size_t)map->cells * (size_t)map->cells; k++) below += map->value[k];
    for (size_t i = 0; i < mound->count; i++) solid += mound->volume[i];
    results->volume = below * map->size * map->size;
    results->solid_fraction = results->volume > 0 ? solid / results->volume : NAN;
}

static void set_no_angles(dem_heap_results *results)
{
    for (int m = 0; m < DEM_HEAP_METHODS; m++) results->angle[m] = (dem_angle){ NAN, NAN, NAN, NAN };
}

static void set_nothing_known(dem_heap_results *results)
{
    memset(results, 0, sizeof *results);
    set_no_angles(results);
    results->base_diameter = results->static_cohesive_index = results->solid_fraction = NAN;
}

/* Another heap has another top, base and volume, which all azimuths of this one share, as sides share the outline: what they
 * differ by does not tell. */
static void claim_what_a_repeat_would_show(dem_heap_results *results)
{
    for (int m = 0; m < DEM_HEAP_METHODS; m++)
        if (m != DEM_AZIMUTHAL_FIT) results->angle[m].standard_error_deg = NAN;
}

dem_status dem_heap_measure(const dem_mound *mound, double plate_radius, double rim_height, dem_heap_results *results)
{
    const double level = fmax(rim_height, 0.5 * mound->grain);
    double rings[DEM_PROFILE_POINTS][DEM_AZIMUTHS];
    height_map map;
    arrays_begin();
    set_nothing_known(results);
    /* Of a plate too wide for rings of one grain the bare part is left out; no measure looks beyond the ring after the last
     * that a grain is in. */
    const double reach = height_map_reach(mound);
    const double radius = fmin(plate_radius, fmax(DEM_PROFILE_POINTS * mound->grain, reach + mound->grain));
    const double ring = fmax(2 * mound->grain, radius / DEM_PROFILE_POINTS);
    dem_status status = height_map_init(&map, mound, plate_radius + mound->grain, reach + 2 * ring);
    if (status != DEM_OK) return status;
    for (size_t i = 0; i < mound->count; i++)
        results->height = fmax(results->height, mound->position[3 * i + 2] + mound->radius[i]);
    height_map_profile(&map, radius, mound->grain, &results->surface, rings);
    fit_azimuths(&map, &results->surface, mound->grain, level, radius, &results->angle[DEM_AZIMUTHAL_FIT]);
    measure_cones(&map, &results->surface, rings, level, radius, results);
    results->static_cohesive_index = cohesive_index(&results->surface, rings, 0.5 * results->base_diameter);
    measure_volume(&map, mound, results);
    status = measure_silhouette(&map, level, &results->angle[DEM_SILHOUETTE]);
    height_map_clear(&map);
    claim_what_a_repeat_would_show(results);
    if (mound->count < DEM_LEAST_BED_PARTICLES) set_no_angles(results);
    return arrays_end(status);
}
