/* The least of a function without derivatives: the simplex of Nelder & Mead (1965, Comput. J. 7, 308). */
#ifndef SIMPLEX_H
#define SIMPLEX_H

#include <stddef.h>

enum { SIMPLEX_MOST_DIMENSIONS = 8 };

/* Where nothing is known, the function may say infinite. */
typedef double (*simplex_function)(void *context, const double *x);

/* x: where to begin, then the best place found; step: how far to look at first. Returns the function there. Ends when the simplex's
 * values differ by less than the tolerance, or after so many evaluations. */
double simplex_minimize(simplex_function function, void *context, size_t dimensions, double *x, double step, double tolerance,
                        int evaluations);

#endif
