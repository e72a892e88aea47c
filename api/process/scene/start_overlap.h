/* Which particles of a bed that is given particle by particle lie too far within one another.
 *
 * Spheres are sorted into cells, a grid for each power of two of their diameters, so that each meets those nearby alone:
 * also where all lie in one place, where one is a thousand times another, and where a cluster's spheres share one spot.
 * The search ends as soon as it has found more than anybody will read. */
#ifndef START_OVERLAP_H
#define START_OVERLAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct placed_sphere {
    double x[3], radius; /* m; all finite, radius above 0 */
    size_t particle;     /* spheres of the same particle may overlap */
    int level;           /* set by the search: diameters from 2^level to 2^(level + 1), */
    int64_t cell[3];     /* and the cell of that grid */
} placed_sphere;

typedef struct placed_pair {
    size_t low, high; /* particles */
    double overlap;   /* m, the largest of any two of their spheres, */
    double most;      /* and what those two may have */
    double order[2];  /* x of the two: pairs are told from left to right */
} placed_pair;

/* Pairs of particles whose spheres overlap by more than the share `most` of the smaller one's diameter, from left to right;
 * at most `room` of them are found. period: length of the periodic axis z; 0: it is none. Sorts the spheres. */
size_t start_overlaps_find(placed_sphere *spheres, size_t count, double period, double most, placed_pair *pairs, size_t room);

#endif
