/* The number type of contact arithmetic, and memory for wide loops.
 *
 * Positions, velocities and their integration are double always. Contacts are computed in `real`: differences
 * of positions are taken in double first, so nothing is lost by cancellation when real is float. */
#ifndef REAL_H
#define REAL_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef DEM_SINGLE
typedef float real;
#else
typedef double real;
#endif

/* Contacts are computed in blocks of this many: a multiple of every vector width, so that each contact goes
 * through the same instructions wherever it stands in the list, and small enough that a block's intermediate
 * values stay in the first-level cache. */
enum { BLOCK = 64, ALIGNMENT = 64 };

static inline size_t round_up_to_block(size_t count) { return (count + BLOCK - 1) / BLOCK * BLOCK; }

static inline real root(real x) { return sizeof(real) == sizeof(float) ? (real)sqrtf((float)x) : (real)sqrt((double)x); }
static inline real greater(real a, real b) { return a > b ? a : b; }
static inline real lesser(real a, real b) { return a < b ? a : b; }

/* Cube root of x > 0 within 4 %: a third of the exponent, as the bits of a float have it. */
static inline real cube_root_guess(real x)
{
    union { float f; int32_t i; } bits = { .f = (float)x };
    bits.i = (int32_t)((float)bits.i * (1.0f / 3.0f)) + 0x2a5137a0;
    return bits.f;
}

/* Zeroed, aligned to a cache line; NULL when out of memory; freed with free(). */
static inline void *array_create(size_t count, size_t size)
{
    if (size && count > (SIZE_MAX - ALIGNMENT) / size) return NULL;
    const size_t bytes = (count * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    void *memory = aligned_alloc(ALIGNMENT, bytes ? bytes : ALIGNMENT);
    if (memory) memset(memory, 0, bytes);
    return memory;
}

#endif
