/* Wide arithmetic: LANES contacts at once. The only intrinsics of the program are here and in wide_*.h.
 *
 * Sums, products and quotients are the compiler's own vector operators. What these lack is here: fused products,
 * selection, and turning rows (one sphere or contact after the other, as memory has them) into lanes (one number of LANES
 * contacts, as arithmetic wants them) and back. The core is compiled once for each instruction set: a vector is as wide
 * as its registers. Every operation rounds as its scalar counterpart in real.h does, so a lane's result depends neither
 * on the instruction set nor on how many lanes there are. */
#ifndef WIDE_H
#define WIDE_H

#include "real.h"

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include <immintrin.h>
#define WIDE_BYTES 64
#elif defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#define WIDE_BYTES 32
#else
#define WIDE_BYTES 16
#endif

enum {
    LANES = WIDE_BYTES / sizeof(real),
    DOUBLES = WIDE_BYTES / sizeof(double), /* lanes of a wide_double */
    HALVES = LANES / DOUBLES               /* wide_doubles beside one wide */
};

typedef real wide __attribute__((vector_size(WIDE_BYTES)));
typedef double wide_double __attribute__((vector_size(WIDE_BYTES)));
typedef float wide_floats __attribute__((vector_size(LANES * sizeof(float))));
typedef int32_t wide_ints __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef uint32_t wide_counts __attribute__((vector_size(LANES * sizeof(uint32_t))));
typedef real row8 __attribute__((vector_size(8 * sizeof(real)))); /* force, torque of one body, 0, 0 */

typedef real half_row __attribute__((vector_size(4 * sizeof(real))));
typedef on_ring ring_row __attribute__((vector_size(4 * sizeof(on_ring))));
typedef double vector4 __attribute__((vector_size(32))); /* x, y, z and one that is not used */

#define WIDE_INLINE static inline __attribute__((always_inline))

WIDE_INLINE wide wide_all(real x) { return x - (wide){ 0 }; }
WIDE_INLINE wide wide_load(const real *p) { return *(const wide *)p; }
WIDE_INLINE void wide_store(real *p, wide x) { *(wide *)p = x; }
WIDE_INLINE wide wide_load_any(const real *p) /* not aligned */
{
    wide x;
    memcpy(&x, p, sizeof x);
    return x;
}

#ifdef DEM_DOUBLE
typedef wide wide_ring; /* LANES times on_ring */
#else
typedef wide_ints wide_ring;
#endif

/* LANES rows (spheres.h, sphere_row), transposed: each member has one number of LANES spheres, or of LANES pairs of spheres. */
typedef struct wide_rows {
    wide_ring place[3]; /* ring units; of pairs: from the first to the second, the shorter way round */
    wide v[3];          /* m/s; of pairs: the second's less the first's */
    wide omega[2];      /* rad/s, about x and y; of pairs: the sum of both */
} wide_rows;
/* What does not fit into the rows (spheres.h, sphere_rest), of LANES spheres, transposed. */
typedef struct wide_rests {
    wide omega_z; /* rad/s */
    wide radius;  /* m */
} wide_rests;

/* Each of the three files below has these, too:
 *
 * size_t wide_compress(int32_t *to, uint32_t bits, const int32_t *from)
 *     Copies those of the LANES numbers `from` whose bit is set to `to`, without gaps. `to` has room for LANES numbers, all of
 *     which may be overwritten. Returns how many were copied.
 * wide_move wide_move_of(uint32_t bits, uint32_t before); void wide_carry(real *to, const wide_move *move, const real *from)
 *     Copies numbers from one compressed array to another. `from` has, without gaps, the numbers of those lanes whose bit is
 *     set in `before`; `to` gets, without gaps, those of the lanes whose bit is set in `bits`, and 0 where `from` has no number
 *     for such a lane. Both have room for LANES numbers: all of `from` may be read, and all of `to` overwritten. */
#if WIDE_BYTES == 64 && !defined(DEM_DOUBLE)
#include "wide_avx512.h"
#elif WIDE_BYTES == 32 && !defined(DEM_DOUBLE)
#include "wide_avx2.h"
#else
#include "wide_any.h"
#endif

/* ring_difference (real.h) in each lane. */
WIDE_INLINE wide_ring wide_ring_difference(wide_ring a, wide_ring b)
{
#ifdef DEM_DOUBLE
    return b - a - wide_rint(b - a);
#else
    return (wide_ring)((wide_counts)b - (wide_counts)a);
#endif
}

#if WIDE_BYTES > 16 && !defined(DEM_DOUBLE)
WIDE_INLINE void rests_of_four(const void *rests, const int32_t *i, __m128 *omega_z, __m128 *radius)
{
    const __m64 *rest = rests; /* a type that may alias any */
    const __m128 rest_0 = _mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(rest + (uint32_t)i[0]))),
                 rest_2 = _mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(rest + (uint32_t)i[2])));
    const __m128 low = _mm_loadh_pi(rest_0, rest + (uint32_t)i[1]), high = _mm_loadh_pi(rest_2, rest + (uint32_t)i[3]);
    *omega_z = _mm_shuffle_ps(low, high, _MM_SHUFFLE(2, 0, 2, 0));
    *radius = _mm_shuffle_ps(low, high, _MM_SHUFFLE(3, 1, 3, 1));
}
WIDE_INLINE wide_rests wide_rests_load(const void *rests, const int32_t *i)
{
    __m128 omega_z[LANES / 4], radius[LANES / 4];
    for (int k = 0; k < LANES / 4; k++) rests_of_four(rests, i + 4 * k, &omega_z[k], &radius[k]);
    return (wide_rests){ wide_from_quads(omega_z), wide_from_quads(radius) };
}
#endif

/* Gathers omega_z of the spheres i[0..LANES-1]. Fast where these ascend and are less than LANES apart, as the first spheres of
 * neighboring contacts mostly are. end: the spheres before it ascend and may be read, even those that i does not name; 0: i may
 * be in any order. */
WIDE_INLINE wide wide_spins_in_order(const void *rests, const int32_t *i, size_t end)
{
#if WIDE_BYTES == 64 && !defined(DEM_DOUBLE)
    const uint32_t first = (uint32_t)i[0];
    if ((uint32_t)i[LANES - 1] - first < LANES && first + LANES <= end) {
        const float *from = (const float *)rests + 2 * (size_t)first;
        const __m512i to = _mm512_slli_epi32(_mm512_sub_epi32(_mm512_loadu_si512(i), _mm512_set1_epi32(i[0])), 1);
        return (wide)_mm512_permutex2var_ps(_mm512_loadu_ps(from), to, _mm512_loadu_ps(from + LANES));
    }
#elif WIDE_BYTES == 32 && !defined(DEM_DOUBLE)
    const uint32_t first = (uint32_t)i[0];
    if ((uint32_t)i[LANES - 1] - first < LANES && first + LANES <= end) {
        const float *from = (const float *)rests + 2 * (size_t)first;
        const __m256i lane = _mm256_sub_epi32(_mm256_loadu_si256((const __m256i_u *)i), _mm256_set1_epi32(i[0]));
        const __m256 mixed = _mm256_shuffle_ps(_mm256_loadu_ps(from), _mm256_loadu_ps(from + LANES), _MM_SHUFFLE(2, 0, 2, 0));
        const __m256d spins = _mm256_permute4x64_pd(_mm256_castps_pd(mixed), _MM_SHUFFLE(3, 1, 2, 0));
        return (wide)_mm256_permutevar8x32_ps(_mm256_castpd_ps(spins), lane);
    }
#else
    (void)end;
#endif
    return wide_rests_load(rests, i).omega_z;
}

/* a b + c, rounded once */
WIDE_INLINE wide_double wide_double_fused(wide_double a, wide_double b, wide_double c)
{
#if WIDE_BYTES == 64
    return (wide_double)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif WIDE_BYTES == 32
    return (wide_double)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
    return (wide_double){ __builtin_fma(a[0], b[0], c[0]), __builtin_fma(a[1], b[1], c[1]) };
#endif
}
#if WIDE_BYTES == 16 && !defined(DEM_DOUBLE)
/* a + b; where that is not exact, of the two doubles around it the one whose last bit is 1. Finite numbers. */
WIDE_INLINE wide_double wide_double_sum_to_odd(wide_double a, wide_double b)
{
    typedef int64_t wide_longs __attribute__((vector_size(WIDE_BYTES)));
    const wide_double sum = a + b, of_b = sum - a, cut_off = (a - (sum - of_b)) + (b - of_b); /* Knuth's TwoSum */
    const wide_longs bits = (wide_longs)sum, is_even = (bits & 1) - 1, is_cut = (wide_longs)(cut_off != 0);
    const wide_longs outwards = 1 | (wide_longs)((cut_off > 0) ^ (sum > 0)); /* -1 where what was cut off leads towards zero */
    return (wide_double)(bits + (outwards & is_even & is_cut));
}
#endif

WIDE_INLINE wide wide_fused(wide a, wide b, wide c)
{
#if defined(DEM_DOUBLE)
    return wide_double_fused(a, b, c);
#elif WIDE_BYTES == 64
    return (wide)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif WIDE_BYTES == 32
    return (wide)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
    /* A product of floats is exact in double. Its sum is rounded to odd, and so keeps a trace of what was cut off: a second
     * rounding, to float, then comes out as if it were the only one (Boldo & Melquiond 2008). */
    wide_double x[HALVES], y[HALVES], z[HALVES];
    wide_to_doubles(a, x);
    wide_to_doubles(b, y);
    wide_to_doubles(c, z);
    for (int h = 0; h < HALVES; h++) z[h] = wide_double_sum_to_odd(x[h] * y[h], z[h]);
    return wide_from_doubles(z);
#endif
}

/* c - a b, rounded once */
WIDE_INLINE wide wide_minus_product(wide c, wide a, wide b)
{
#if WIDE_BYTES == 64 && !defined(DEM_DOUBLE)
    return (wide)_mm512_fnmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif WIDE_BYTES == 32 && !defined(DEM_DOUBLE)
    return (wide)_mm256_fnmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
    return wide_fused(-a, b, c);
#endif
}

/* a b + c, rounded once, in the lanes of the mask m; c in the others, where a zero may lose its sign. b is finite. */
WIDE_INLINE wide wide_fused_where(wide_mask m, wide a, wide b, wide c)
{
#if WIDE_BYTES == 64 && !defined(DEM_DOUBLE)
    return (wide)_mm512_mask3_fmadd_ps((__m512)a, (__m512)b, (__m512)c, m);
#else
    return wide_fused(wide_where(m, a), b, c);
#endif
}

WIDE_INLINE double wide_largest_lane(wide x)
{
    double largest = (double)x[0];
    for (int k = 1; k < LANES; k++) largest = (double)x[k] > largest ? (double)x[k] : largest;
    return largest;
}

/* ---- one sphere's vectors ---- */

#if WIDE_BYTES > 16 && !defined(DEM_DOUBLE)
WIDE_INLINE vector4 vector4_of_three(const float *x) /* three floats; the fourth is read, but not used */
{
#if WIDE_BYTES == 64
    return (vector4)_mm256_maskz_cvtps_pd(7, _mm_loadu_ps(x));
#else
    return (vector4)_mm256_blend_pd(_mm256_cvtps_pd(_mm_loadu_ps(x)), _mm256_setzero_pd(), 8);
#endif
}
WIDE_INLINE vector4 row8_force(const row8 *row) { return vector4_of_three((const float *)row); }
WIDE_INLINE vector4 row8_torque(const row8 *row) { return vector4_of_three((const float *)row + 3); }
WIDE_INLINE vector4 vector4_of(const half_row *x) { return (vector4)_mm256_cvtps_pd((__m128)*x); }
WIDE_INLINE half_row half_row_of(vector4 x) { return (half_row)_mm256_cvtpd_ps((__m256d)x); }
WIDE_INLINE vector4 vector4_rint(vector4 x)
{
    return (vector4)_mm256_round_pd((__m256d)x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
#else
WIDE_INLINE vector4 row8_force(const row8 *row) { return (vector4){ (double)(*row)[0], (double)(*row)[1], (double)(*row)[2] }; }
WIDE_INLINE vector4 row8_torque(const row8 *row) { return (vector4){ (double)(*row)[3], (double)(*row)[4], (double)(*row)[5] }; }
WIDE_INLINE vector4 vector4_of(const half_row *x) { return (vector4){ (double)(*x)[0], (double)(*x)[1], (double)(*x)[2] }; }
WIDE_INLINE half_row half_row_of(vector4 x) { return (half_row){ (real)x[0], (real)x[1], (real)x[2], (real)x[3] }; }
WIDE_INLINE vector4 vector4_rint(vector4 x) { return (vector4){ rint(x[0]), rint(x[1]), rint(x[2]), rint(x[3]) }; }
#endif

/* The first half of a sphere's row: its place in ring units, rounded to whole units in single precision, then the first number of
 * w. */
WIDE_INLINE half_row half_row_place(vector4 place, half_row w)
{
#ifdef DEM_DOUBLE
    return __builtin_shufflevector(place, w, 0, 1, 2, 4);
#elif WIDE_BYTES == 64
    const __m256i low_and_w = _mm256_setr_epi32(0, 2, 4, 8, 0, 0, 0, 0);
    const __m256 shifted = (__m256)(place + RING_SHIFT);
    return (half_row)_mm256_castps256_ps128(_mm256_permutex2var_ps(shifted, low_and_w, _mm256_castps128_ps256((__m128)w)));
#elif WIDE_BYTES == 32
    const __m256 shifted = (__m256)(place + RING_SHIFT);
    const __m128 low = _mm_shuffle_ps(_mm256_castps256_ps128(shifted), _mm256_extractf128_ps(shifted, 1), _MM_SHUFFLE(2, 0, 2, 0));
    return (half_row)_mm_insert_ps(low, (__m128)w, 3 << 4);
#else
    typedef int64_t long4 __attribute__((vector_size(32)));
    return __builtin_shufflevector((half_row) __builtin_convertvector((long4)(place + RING_SHIFT), ring_row), w, 0, 1, 2, 4);
#endif
}

/* The second half: three numbers of v, then the second of w. */
WIDE_INLINE half_row half_row_velocity(half_row v, half_row w)
{
#if WIDE_BYTES > 16 && !defined(DEM_DOUBLE)
    return (half_row)_mm_insert_ps((__m128)v, (__m128)w, 1 << 6 | 3 << 4);
#else
    return __builtin_shufflevector(v, w, 0, 1, 2, 5);
#endif
}

/* a b + c, where all numbers of a are 0, 1 or -1: the products are exact, so that fused and separate operations give the same. */
WIDE_INLINE row8 row8_fused(row8 a, row8 b, row8 c)
{
#if WIDE_BYTES > 16 && !defined(DEM_DOUBLE)
    return (row8)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
    return a * b + c;
#endif
}
WIDE_INLINE vector4 vector4_fused(vector4 a, vector4 b, vector4 c)
{
#if WIDE_BYTES > 16
    return (vector4)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
    return (vector4){ __builtin_fma(a[0], b[0], c[0]), __builtin_fma(a[1], b[1], c[1]), __builtin_fma(a[2], b[2], c[2]),
                      __builtin_fma(a[3], b[3], c[3]) };
#endif
}

/* One number four times, loaded from memory: a broadcast costs no arithmetic instruction. */
WIDE_INLINE vector4 vector4_from(const double *x)
{
#if WIDE_BYTES > 16
    return (vector4)_mm256_broadcast_sd(x);
#else
    return (vector4){ *x, *x, *x, *x };
#endif
}

/* In each lane the greater of a and |b|. */
WIDE_INLINE vector4 vector4_greater_size(vector4 a, vector4 b)
{
#if WIDE_BYTES == 64
    enum { LARGER_SIZE = 11 };
    return (vector4)_mm256_range_pd((__m256d)a, (__m256d)b, LARGER_SIZE);
#elif WIDE_BYTES > 16
    return (vector4)_mm256_max_pd((__m256d)a, _mm256_andnot_pd(_mm256_set1_pd(-0.0), (__m256d)b));
#else
    for (int k = 0; k < 4; k++) a[k] = a[k] > fabs(b[k]) ? a[k] : fabs(b[k]);
    return a;
#endif
}

/* ---- powers ---- */

WIDE_INLINE wide wide_inverse_root_guess(wide x)
{
    const wide_counts half = (wide_counts) __builtin_convertvector(x, wide_floats) >> 1;
    return __builtin_convertvector((wide_floats)(INVERSE_ROOT_MAGIC - half), wide);
}
WIDE_INLINE wide wide_inverse_cube_root_guess(wide x)
{
    const wide_ints bits = (wide_ints) __builtin_convertvector(x, wide_floats);
    const wide_floats third = __builtin_convertvector(bits, wide_floats) * (1.0f / 3.0f);
    return __builtin_convertvector((wide_floats)(INVERSE_CUBE_ROOT_MAGIC - __builtin_convertvector(third, wide_ints)), wide);
}

/* 1/sqrt(x), x^(-1/3) and x^(-1/4) in each lane for x > 0, with the same rounding as their scalar counterparts in real.h. */
WIDE_INLINE wide wide_inverse_root(wide x)
{
    const real term[] = INVERSE_ROOT_TERMS;
    wide y = wide_inverse_root_guess(x);
    for (int k = 0; k < INVERSE_ROOT_STEPS; k++) {
        const wide e = wide_fused(-(x * y), y, wide_all(1));
        const wide high = wide_fused(wide_fused(wide_all(term[3]), e, wide_all(term[2])), e, wide_all(term[1]));
        y = wide_fused(y * e, wide_fused(high, e, wide_all(term[0])), y);
    }
    return y;
}

WIDE_INLINE wide wide_inverse_cube_root(wide x)
{
    const real term[] = INVERSE_CUBE_ROOT_TERMS;
    wide y = wide_inverse_cube_root_guess(x);
    for (int k = 0; k < INVERSE_CUBE_ROOT_STEPS; k++) {
        const wide e = wide_fused(-(x * y), y * y, wide_all(1));
        y = wide_fused(y * e, wide_fused(wide_fused(wide_all(term[2]), e, wide_all(term[1])), e, wide_all(term[0])), y);
    }
    return y;
}

WIDE_INLINE wide wide_inverse_fourth_root(wide x)
{
    const real term[] = INVERSE_FOURTH_ROOT_TERMS;
    const wide_counts quarter = (wide_counts) __builtin_convertvector(x, wide_floats) >> 2;
    wide y = __builtin_convertvector((wide_floats)(INVERSE_FOURTH_ROOT_MAGIC - quarter), wide);
    for (int k = 0; k < INVERSE_FOURTH_ROOT_STEPS; k++) {
        const wide yy = y * y, e = wide_minus_product(wide_all(1), x * yy, yy);
        const wide high = wide_fused(wide_fused(wide_all(term[3]), e, wide_all(term[2])), e, wide_all(term[1]));
        y = wide_fused(y * e, wide_fused(high, e, wide_all(term[0])), y);
    }
    return y;
}

/* reach^2 - |x|^2, in ring units squared. apart: a displacement, which x becomes in floating point; reach: in ring units. A
 * displacement has up to 32 bits and a float has 24, so it is split into high and low bits: the squares of the high bits are
 * exact, and so is their difference from reach^2 where the two are near each other. */
WIDE_INLINE wide wide_ring_gap2(const wide_ring apart[3], wide reach, wide x[3])
{
    wide gap2 = reach * reach;
#ifdef DEM_DOUBLE
    for (int c = 0; c < 3; c++) {
        x[c] = apart[c];
        gap2 = wide_fused(-x[c], x[c], gap2);
    }
#else
    wide high[3], low[3];
    const int32_t of_low = (1 << RING_LOW_BITS) - 1;
    for (int c = 0; c < 3; c++) {
        high[c] = __builtin_convertvector(apart[c] & ~of_low, wide);
        low[c] = __builtin_convertvector(apart[c] & of_low, wide);
        x[c] = high[c] + low[c];
        gap2 = wide_fused(-high[c], high[c], gap2);
    }
    for (int c = 0; c < 3; c++) gap2 = wide_fused(-(high[c] + x[c]), low[c], gap2);
#endif
    return gap2;
}

WIDE_INLINE wide wide_dot(const wide a[3], const wide b[3]) { return wide_fused(a[2], b[2], wide_fused(a[1], b[1], a[0] * b[0])); }

#endif
