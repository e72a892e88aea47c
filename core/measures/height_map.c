#include "height_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "array.h"
#include "dem_rules.h"
#include "statistics.h"

/* The part of a sphere's upper half that is above what was there. */
static void add_sphere(height_map *map, const double x[3], double radius)
{
    const double middle = 0.5 * map->cells - 0.5;
    int low[2], high[2];
    for (int a = 0; a < 2; a++) {
        low[a] = (int)fmax(0.0, ceil((x[a] - radius) / map->size + middle));
        high[a] = (int)fmin(map->cells - 1.0, floor((x[a] + radius) / map->size + middle));
    }
    for (int row = low[1]; row <= high[1]; row++)
        for (int column = low[0]; column <= high[0]; column++) {
            const double dx = height_map_place(map, column) - x[0], dy = height_map_place(map, row) - x[1];
            const double up2 = radius * radius - dx * dx - dy * dy;
            double *value = &map->value[(size_t)row * (size_t)map->cells + (size_t)column];
            if (up2 > 0) *value = fmax(*value, x[2] + sqrt(up2));
        }
}

double height_map_reach(const dem_mound *mound)
{
    double reach = 0.0;
    for (size_t i = 0; i < mound->count; i++)
        reach = fmax(reach, hypot(mound->position[3 * i], mound->position[3 * i + 1]) + mound->radius[i]);
    return reach;
}

/* Cells lie where they would if all were kept, so that what is measured is the same. */
dem_status height_map_init(height_map *map, const dem_mound *mound, double half_width, double kept)
{
    enum { CELLS_A_GRAIN = 4, MOST_CELLS = 4000 };
    double all = fmax(ceil(2 * half_width / mound->grain * CELLS_A_GRAIN), 8.0);
    all = fmin(all, floor(MOST_CELLS * fmax(half_width / kept, 1.0)));
    map->size = 2 * half_width / all;
    map->cells = (int)(all - 2 * fmax(floor(0.5 * all - kept / map->size), 0.0));
    map->reach = height_map_reach(mound);
    map->value = array_create((size_t)map->cells * (size_t)map->cells, sizeof *map->value);
    if (!map->value) return DEM_NO_MEMORY;
    for (size_t i = 0; i < mound->count; i++) add_sphere(map, mound->position + 3 * i, mound->radius[i]);
    return DEM_OK;
}

void height_map_clear(height_map *map)
{
    free(map->value);
    map->value = NULL;
}

int height_map_sector(double x, double y)
{
    const double turns = atan2(y, x) / (2 * DEM_PI) + 0.5;
    const int sector = (int)floor(turns * DEM_AZIMUTHS);
    return sector < DEM_AZIMUTHS ? sector : 0;
}

void height_map_sum(const height_map *map, double from, double to, ring_sums sums[DEM_AZIMUTHS])
{
    memset(sums, 0, DEM_AZIMUTHS * sizeof *sums);
    for (int row = 0; row < map->cells; row++)
        for (int column = 0; column < map->cells; column++) {
            const double x = height_map_place(map, column), y = height_map_place(map, row), r = sqrt(x * x + y * y);
            if (r < from || r >= to) continue;
            const double h = map->value[(size_t)row * (size_t)map->cells + (size_t)column];
            ring_sums *s = &sums[height_map_sector(x, y)];
            s->cells += 1;
            s->r += r;
            s->h += h;
            s->rr += r * r;
            s->rh += r * h;
        }
}

double ring_slope(const ring_sums *s)
{
    const double spread = s->cells * s->rr - s->r * s->r;
    return spread > 0 ? (s->cells * s->rh - s->r * s->h) / spread : NAN;
}

void height_map_profile(const height_map *map, double radius, double grain, dem_profile *profile, double (*rings)[DEM_AZIMUTHS])
{
    profile->count = (size_t)fmin(fmax(floor(radius / grain), 1.0), DEM_PROFILE_POINTS);
    const double width = radius / (double)profile->count;
    for (size_t k = 0; k < profile->count; k++) {
        ring_sums sums[DEM_AZIMUTHS];
        double mean[DEM_AZIMUTHS], cells = 0, height = 0;
        profile->place[k] = ((double)k + 0.5) * width;
        if ((double)k * width > map->reach) {
            profile->value[k] = profile->standard_error[k] = 0.0;
            if (rings) memset(rings[k], 0, sizeof rings[k]);
            continue;
        }
        height_map_sum(map, (double)k * width, (double)(k + 1) * width, sums);
        for (int a = 0; a < DEM_AZIMUTHS; a++) {
            mean[a] = sums[a].cells > 0 ? sums[a].h / sums[a].cells : NAN;
            cells += sums[a].cells;
            height += sums[a].h;
        }
        profile->value[k] = cells > 0 ? height / cells : NAN;
        profile->standard_error[k] = statistics_standard_error(mean, DEM_AZIMUTHS);
        if (rings) memcpy(rings[k], mean, sizeof mean);
    }
}

dem_angle angle_over_azimuths(const double radians[DEM_AZIMUTHS])
{
    dem_angle angle = { NAN, NAN, NAN, NAN };
    double degrees[DEM_AZIMUTHS];
    for (int a = 0; a < DEM_AZIMUTHS; a++) {
        degrees[a] = radians[a] * (180 / DEM_PI);
        angle.minimum_deg = fmin(angle.minimum_deg, degrees[a]);
        angle.maximum_deg = fmax(angle.maximum_deg, degrees[a]);
    }
    angle.mean_deg = statistics_mean(degrees, DEM_AZIMUTHS);
    angle.standard_error_deg = statistics_standard_error(degrees, DEM_AZIMUTHS);
    return angle;
}
