/* The posterior's shape: how well each direction is known, and whether it falls apart into islands. */
#ifndef SHAPE_H
#define SHAPE_H

#include "plan_fit.h"

enum { MOST_ISLANDS = 4 };

typedef struct shape_direction {
    double vector[PLAN_MOST_PARAMETERS]; /* of length 1, in the ranges of the parameters */
    double known_to;                     /* standard deviation along it, in the same */
    double share;                        /* what the middle 95 of 100 draws take, of what they would take if nothing were known */
    bool is_identified;                  /* less than half of it */
} shape_direction;

typedef struct shape {
    shape_direction direction[PLAN_MOST_PARAMETERS]; /* the best known first */
    size_t islands;
    double island[MOST_ISLANDS][PLAN_MOST_PARAMETERS]; /* their middles, in the unit cube */
    double island_share[MOST_ISLANDS];                 /* of the draws */
} shape;

/* False: no memory. */
bool shape_measure(const plan_fit *fit, shape *shape);
/* Every direction is, and it is in one piece. */
bool shape_is_identified(const shape *shape, size_t parameters);

/* The value below which this share of the draws of a parameter lie, in the unit cube; sorted (draws). */
double sorted_quantile(const double *sorted, size_t count, double share);
/* To be freed; NULL: no memory. */
double *sorted_along(const double *x, size_t count, size_t parameters, const double *vector);

#endif
