/* Random numbers with one stream a seed: xoshiro256** of Blackman & Vigna (2018), seeded by splitmix64. */
#ifndef RANDOM_H
#define RANDOM_H

#include <stdint.h>

typedef struct random_stream {
    uint64_t s[4];
} random_stream;

void random_seed(random_stream *stream, uint64_t seed);
double random_uniform(random_stream *stream); /* [0, 1), 53 bits */

#endif
