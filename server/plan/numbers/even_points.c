#include "even_points.h"

#include <math.h>

static const unsigned primes[EVEN_MOST_DIMENSIONS] = { 2, 3, 5, 7, 11, 13, 17, 19 };

uint64_t mix_bits(uint64_t bits)
{
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94d049bb133111eb);
    return bits ^ (bits >> 31);
}

double even_point(uint64_t seed, size_t index, unsigned dimension)
{
    const unsigned base = primes[dimension];
    double place = 1.0, point = 0.0;
    /* As many digits as a double has, leading zeros included: they are permuted, too. */
    for (uint64_t position = 0; place > 0x1p-52; position++, index /= base) {
        const uint64_t bits = mix_bits(seed + UINT64_C(0x9e3779b97f4a7c15) * (position * EVEN_MOST_DIMENSIONS + dimension + 1));
        const uint64_t factor = 1 + bits % (base - 1), shift = (bits >> 32) % base;
        place /= base;
        point += place * (double)((factor * (index % base) + shift) % base);
    }
    return fmin(point, 1.0 - 0x1p-53);
}

static uint64_t next_bits(random_source *source)
{
    source->state += UINT64_C(0x9e3779b97f4a7c15);
    return mix_bits(source->state);
}

double random_uniform(random_source *source) { return (double)(next_bits(source) >> 11) * 0x1p-53; }

double random_normal(random_source *source)
{
    const double radius = sqrt(-2.0 * log(1.0 - random_uniform(source)));
    return radius * cos(2.0 * M_PI * random_uniform(source));
}

size_t random_below(random_source *source, size_t count) { return (size_t)(random_uniform(source) * (double)count); }
