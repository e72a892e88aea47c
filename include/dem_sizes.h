/* Sizes of a species' spheres that are not all alike: the distribution asked for, what it is cut to, and the diameters that
 * so many particles get. A part of the rules (dem_rules.h). Equations: core/NUMERICS.md, "Sizes". */
#ifndef DEM_SIZES_H
#define DEM_SIZES_H

#include "dem_rules.h"

/* Where a distribution that has no ends of its own is cut, as shares of itself, unless its ends are given. */
#define DEM_SIZES_LOW_END 0.001
#define DEM_SIZES_HIGH_END 0.999

/* A law of a name, with numbers within their ranges, and 0 < minimum < maximum. */
bool dem_sizes_are_good(const dem_sizes *sizes);

/* Share of the distribution, before it is cut, that is smaller; in its own terms, number or volume. */
double dem_sizes_below(const dem_sizes *sizes, double diameter);

/* m: the size that this share is smaller than, before it is cut. May be below 0 of a normal one. */
double dem_sizes_at(const dem_sizes *sizes, double share);

/* The distribution after it is cut, in cells of the diameter, in each of which the number is spread evenly. */
enum { DEM_SIZE_CELLS = 2048 };
typedef struct dem_size_table {
    double edge[DEM_SIZE_CELLS + 1];                               /* m */
    double number[DEM_SIZE_CELLS + 1], volume[DEM_SIZE_CELLS + 1]; /* share of all below the edge */
    double mean_diameter;                                          /* m, of the sphere of mean volume */
    double sauter_mean;                                            /* m: sum of d^3 over sum of d^2 */
} dem_size_table;

/* sizes: good. */
void dem_size_table_set(dem_size_table *table, const dem_sizes *sizes);

/* m: the size that this share of what is left after the cut is smaller than, by volume or by number. */
double dem_size_table_at(const dem_size_table *table, bool by_volume, double share);

/* Diameters of `count` particles, ascending: each has the mean volume of its share 1/count of all by number. */
void dem_size_table_draw(const dem_size_table *table, size_t count, double *diameter);

/* Sets the diameter of a species that has sizes. */
void dem_sizes_complete(dem_species *species);

#endif
