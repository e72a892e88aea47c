/* The surface of a mound as seen from above: on square cells, the highest point of any sphere over the cell's middle;
 * the ground, 0, where there is none. And what is told from it sector by sector about the axis. */
#ifndef HEIGHT_MAP_H
#define HEIGHT_MAP_H

#include "dem_mound.h"

typedef struct height_map {
    int cells;     /* a side */
    double reach;  /* m from the axis: beyond, all is ground */
    double size;   /* m a cell */
    double *value; /* (cells, cells) m: rows in y, columns in x */
} height_map;

/* Over [-half_width, half_width]^2, on cells of a quarter of the grain, of which those are kept that come within `kept` of
 * either axis. Errors: DEM_NO_MEMORY. */
dem_status height_map_init(height_map *map, const dem_mound *mound, double half_width, double kept);
/* How far from the axis the spheres of a mound come, m. */
double height_map_reach(const dem_mound *mound);
void height_map_clear(height_map *map);

static inline double height_map_place(const height_map *map, int cell) { return (cell + 0.5 - 0.5 * map->cells) * map->size; }
/* Sector about the axis that a place is in, 0 to DEM_AZIMUTHS - 1. */
int height_map_sector(double x, double y);

/* Sums over the cells of a ring of each sector: what means and lines are made of. */
typedef struct ring_sums {
    double cells, r, h, rr, rh;
} ring_sums;
/* Cells whose distance from the axis is within [from, to) m. */
void height_map_sum(const height_map *map, double from, double to, ring_sums sums[DEM_AZIMUTHS]);
/* Of the line of height over distance, by least squares; NaN without two distances. */
double ring_slope(const ring_sums *sums);

/* Mean and errors over the sectors of rings one grain wide up to `radius`, into a profile; rings: (count, DEM_AZIMUTHS)
 * the mean heights of each, or NULL. At most DEM_PROFILE_POINTS rings, wider where there would be more. */
void height_map_profile(const height_map *map, double radius, double grain, dem_profile *profile, double (*rings)[DEM_AZIMUTHS]);

/* Over azimuths: mean, its error, least and largest; in degrees from radians. */
dem_angle angle_over_azimuths(const double radians[DEM_AZIMUTHS]);

#endif
