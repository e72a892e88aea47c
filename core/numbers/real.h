/* The number type of contact arithmetic, and memory for wide loops.
 *
 * Positions, velocities and their integration are double always. Contacts are computed in `real`: differences
 * of positions are taken in fixed point first, so nothing is lost by cancellation when real is float. */
#ifndef REAL_H
#define REAL_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef DEM_DOUBLE
typedef double real;
typedef double on_ring;
#else
typedef float real;
typedef int32_t on_ring;
#endif
/* on_ring: a coordinate modulo a length, in fixed point of 2^32 parts of it (DEM_DOUBLE: in shares of it). Differences are
 * exact, and come out as the way round that is shorter: a periodic axis needs nothing more. */
#define RING_UNITS (sizeof(real) == sizeof(float) ? 4294967296.0 : 1.0)
/* The way round from a to b. */
static inline on_ring ring_difference(on_ring a, on_ring b)
{
#ifdef DEM_DOUBLE
    return b - a - rint(b - a);
#else
    return (int32_t)((uint32_t)b - (uint32_t)a);
#endif
}

/* Displacements are squared in two parts, of which the lower has as many bits. The ring is 3 to 8 of the largest diameters,
 * so that two spheres that touch are 1024 to 2731 of the lower part's ranges apart at most: squares of the upper parts and
 * their sum fit into a float, with bits to spare. */
enum { RING_LOW_BITS = 19 };
/* Adding this to a double leaves its nearest whole number in the lowest bits. */
#define RING_SHIFT 6755399441055744.0

/* Contacts are computed in blocks of this many: a multiple of every vector width, so that each contact goes
 * through the same instructions wherever it stands in the list, and small enough that a block's intermediate
 * values stay in the first-level cache. */
enum { BLOCK = 64, ALIGNMENT = 64 };

static inline size_t round_up_to_block(size_t count) { return (count + BLOCK - 1) / BLOCK * BLOCK; }

/* Where part k of `parts` begins among `count`. */
static inline size_t part_start(size_t count, int part, int parts) { return count * (size_t)part / (size_t)parts; }

static inline real greater(real a, real b) { return a > b ? a : b; }
static inline real lesser(real a, real b) { return a < b ? a : b; }

/* a b + c, rounded once. Written out everywhere, and left to no compiler's choice, so that every build has the same
 * bits. */
static inline real fused(real a, real b, real c)
{
    return sizeof(real) == sizeof(float) ? (real)__builtin_fmaf((float)a, (float)b, (float)c)
                                         : (real)__builtin_fma((double)a, (double)b, (double)c);
}
static inline real dot(const real a[3], const real b[3]) { return fused(a[2], b[2], fused(a[1], b[1], a[0] * b[0])); }

/* Roots without the processor's own, which are slow where there are many: a guess y from the bits of a float, then one step
 * by a polynomial in what it is off by, e = 1 - x y^2 (or y^3, y^4), of which the root is y (1 - e)^(-1/2) (or -1/3, -1/4).
 * 1/sqrt ends within a rounding or two and errs to both sides: an error that is always low makes friction at rest leak away.
 * x^(-1/3), of which only a stiffness is made, ends within 3e-6 in single, x^(-1/4) within 2e-7. In double the step is
 * repeated. wide.h does the same for many at once. x: 1e-37 to 1e37. */
enum {
    INVERSE_ROOT_MAGIC = 0x5f374753,
    INVERSE_CUBE_ROOT_MAGIC = 0x54a1f5af,
    INVERSE_FOURTH_ROOT_MAGIC = 0x4f580000,
    IN_DOUBLE = sizeof(real) == sizeof(double),
    INVERSE_ROOT_STEPS = IN_DOUBLE ? 3 : 1,
    INVERSE_CUBE_ROOT_STEPS = IN_DOUBLE ? 3 : 1,
    INVERSE_FOURTH_ROOT_STEPS = IN_DOUBLE ? 3 : 1,
};
/* Whose largest error is least over the guess's e, of at most 0.0681 (0.102, 0.125): 2.3e-8 (2.7e-6, 1.5e-7). From the
 * constant on; the series are 1/2, 3/8, 5/16, 35/128, and 1/3, 2/9, 14/81, and 1/4, 5/32, 15/128, 195/2048. */
#define INVERSE_ROOT_TERMS                                                                                                         \
    {                                                                                                                              \
        (real)0.49999836, (real)0.3749968, (real)0.31392676, (real)0.27517833                                                      \
    }
#define INVERSE_CUBE_ROOT_TERMS                                                                                                    \
    {                                                                                                                              \
        (real)0.33332763, (real)0.22347455, (real)0.17469921                                                                       \
    }
#define INVERSE_FOURTH_ROOT_TERMS                                                                                                  \
    {                                                                                                                              \
        (real)0.24999439, (real)0.15623354, (real)0.11871463, (real)0.09763363                                                     \
    }

typedef union float_bits {
    float f;
    int32_t i;
} float_bits;

static inline real inverse_root_guess(real x)
{
    float_bits bits = { .f = (float)x };
    bits.i = INVERSE_ROOT_MAGIC - (int32_t)((uint32_t)bits.i >> 1);
    return bits.f;
}

static inline real inverse_cube_root_guess(real x)
{
    float_bits bits = { .f = (float)x };
    bits.i = INVERSE_CUBE_ROOT_MAGIC - (int32_t)((float)bits.i * (1.0f / 3.0f));
    return bits.f;
}

/* 1/sqrt(x); a large finite number for x = 0, so that x times it is the root of x there, too. */
static inline real inverse_root(real x)
{
    const real term[] = INVERSE_ROOT_TERMS;
    real y = inverse_root_guess(x);
    for (int k = 0; k < INVERSE_ROOT_STEPS; k++) {
        const real e = fused(-(x * y), y, 1);
        y = fused(y * e, fused(fused(fused(term[3], e, term[2]), e, term[1]), e, term[0]), y);
    }
    return y;
}

static inline real inverse_cube_root(real x)
{
    const real term[] = INVERSE_CUBE_ROOT_TERMS;
    real y = inverse_cube_root_guess(x);
    for (int k = 0; k < INVERSE_CUBE_ROOT_STEPS; k++) {
        const real e = fused(-(x * y), y * y, 1);
        y = fused(y * e, fused(fused(term[2], e, term[1]), e, term[0]), y);
    }
    return y;
}

static inline real inverse_fourth_root(real x)
{
    const real term[] = INVERSE_FOURTH_ROOT_TERMS;
    float_bits bits = { .f = (float)x };
    bits.i = INVERSE_FOURTH_ROOT_MAGIC - (int32_t)((uint32_t)bits.i >> 2);
    real y = bits.f;
    for (int k = 0; k < INVERSE_FOURTH_ROOT_STEPS; k++) {
        const real yy = y * y, e = fused(-(x * yy), yy, 1);
        y = fused(y * e, fused(fused(fused(term[3], e, term[2]), e, term[1]), e, term[0]), y);
    }
    return y;
}

#endif
