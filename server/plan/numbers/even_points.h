/* Points that fill the unit cube evenly, and random numbers: both follow from a seed alone.
 *
 * Even: Halton's sequence (Halton 1960, Numer. Math. 2, 84), the digits of the index in a prime base of its own for each dimension,
 * mirrored behind the point. Every digit goes through a random permutation a d + b modulo the base, as in the linear scrambling of
 * Matousek (1998, J. Complexity 14, 527), with a and b from the seed. */
#ifndef EVEN_POINTS_H
#define EVEN_POINTS_H

#include <stddef.h>
#include <stdint.h>

enum { EVEN_MOST_DIMENSIONS = 8 };

/* Of the point with this index; in [0, 1). */
double even_point(uint64_t seed, size_t index, unsigned dimension);

/* splitmix64 (Steele, Lea & Flood 2014, OOPSLA): a counter that is mixed. */
typedef struct random_source {
    uint64_t state;
} random_source;

uint64_t mix_bits(uint64_t bits);
double random_uniform(random_source *source); /* in [0, 1) */
double random_normal(random_source *source);  /* mean 0, standard deviation 1 (Box & Muller 1958) */
size_t random_below(random_source *source, size_t count);

#endif
