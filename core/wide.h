/* Wide arithmetic: LANES contacts at once, 64 bytes a vector. The only intrinsics of the program.
 *
 * Sums, products and quotients are the compiler's own vector operators. What these lack is here: selection, and
 * turning rows (one sphere or contact after the other, as memory has them) into lanes (one number of LANES
 * contacts, as arithmetic wants them) and back; for AVX-512 where the compiler is told of it, and as plain loops
 * elsewhere. Every operation rounds as its scalar counterpart in real.h does, so a lane's result does not depend
 * on the instruction set. */
#ifndef WIDE_H
#define WIDE_H

#include "real.h"

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__) && !defined(DEM_DOUBLE)
#include <immintrin.h>
#define WIDE_AVX512 1
#else
#define WIDE_AVX512 0
#endif

enum { LANES = 64 / sizeof(real), HALVES = LANES / 8 };

typedef real wide __attribute__((vector_size(64)));
typedef double wide_double __attribute__((vector_size(64)));      /* 8 lanes; HALVES of them beside one wide */
typedef real row8 __attribute__((vector_size(8 * sizeof(real)))); /* force, 0, torque, 0 of one body */

typedef real half_row __attribute__((vector_size(4 * sizeof(real))));
typedef on_ring ring_row __attribute__((vector_size(4 * sizeof(on_ring))));
typedef double vector4 __attribute__((vector_size(32))); /* x, y, z and one unused */

#define WIDE_INLINE static inline __attribute__((always_inline))

WIDE_INLINE wide wide_all(real x) { return x - (wide){ 0 }; }
WIDE_INLINE wide_double wide_double_all(double x) { return x - (wide_double){ 0 }; }
WIDE_INLINE wide wide_load(const real *p) { return *(const wide *)p; }
WIDE_INLINE void wide_store(real *p, wide x) { *(wide *)p = x; }
WIDE_INLINE wide wide_load_any(const real *p) /* not aligned */
{
    wide x;
    memcpy(&x, p, sizeof x);
    return x;
}

/* Of LANES pairs of spheres (spheres.h, sphere_row), second less first or the sum of both. */
typedef struct wide_pairs {
    wide_double x[3][HALVES]; /* m, between centres */
    wide n[3];                /* the same in contact arithmetic */
    wide radii;               /* m, sum */
    wide v[3];                /* m/s, difference */
    wide r_omega[3];          /* m/s, sum */
    wide omega[3];            /* rad/s, sum */
} wide_pairs;

#if WIDE_AVX512

typedef __mmask16 wide_mask;

WIDE_INLINE wide wide_greater(wide a, wide b) { return (wide)_mm512_max_ps((__m512)a, (__m512)b); }
WIDE_INLINE wide wide_lesser(wide a, wide b) { return (wide)_mm512_min_ps((__m512)a, (__m512)b); }
WIDE_INLINE wide_mask wide_exceeds(wide a, wide b) { return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_GT_OQ); }
WIDE_INLINE wide wide_select(wide_mask m, wide a, wide b) { return (wide)_mm512_mask_blend_ps(m, (__m512)b, (__m512)a); }

/* a b + c, rounded once */
WIDE_INLINE wide wide_fused(wide a, wide b, wide c) { return (wide)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c); }
WIDE_INLINE wide_double wide_double_fused(wide_double a, wide_double b, wide_double c)
{
    return (wide_double)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
}

WIDE_INLINE wide wide_from_doubles(const wide_double x[HALVES])
{
    return (wide)_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps((__m512d)x[0])), _mm512_cvtpd_ps((__m512d)x[1]), 1);
}

WIDE_INLINE void wide_to_doubles(wide x, wide_double to[HALVES])
{
    to[0] = (wide_double)_mm512_cvtps_pd(_mm512_castps512_ps256((__m512)x));
    to[1] = (wide_double)_mm512_cvtps_pd(_mm512_extractf32x8_ps((__m512)x, 1));
}

WIDE_INLINE wide wide_inverse_root_guess(wide x)
{
    const __m512i half = _mm512_srli_epi32(_mm512_castps_si512((__m512)x), 1);
    return (wide)_mm512_castsi512_ps(_mm512_sub_epi32(_mm512_set1_epi32(INVERSE_ROOT_MAGIC), half));
}
WIDE_INLINE wide wide_inverse_guess(wide x)
{
    return (wide)_mm512_castsi512_ps(_mm512_sub_epi32(_mm512_set1_epi32(INVERSE_MAGIC), _mm512_castps_si512((__m512)x)));
}
WIDE_INLINE wide wide_inverse_cube_root_guess(wide x)
{
    const __m512 third = _mm512_mul_ps(_mm512_cvtepi32_ps(_mm512_castps_si512((__m512)x)), _mm512_set1_ps(1.0f / 3.0f));
    return (wide)_mm512_castsi512_ps(_mm512_sub_epi32(_mm512_set1_epi32(INVERSE_CUBE_ROOT_MAGIC), _mm512_cvttps_epi32(third)));
}

/* 4 x 4 numbers within each quarter of a vector: to[c] has in quarter L what from[0..3] have at 4 L + c. */
WIDE_INLINE void transpose_quarters(const __m512 from[4], __m512 to[4])
{
    const __m512d low_01 = _mm512_castps_pd(_mm512_unpacklo_ps(from[0], from[1])),
                  high_01 = _mm512_castps_pd(_mm512_unpackhi_ps(from[0], from[1]));
    const __m512d low_23 = _mm512_castps_pd(_mm512_unpacklo_ps(from[2], from[3])),
                  high_23 = _mm512_castps_pd(_mm512_unpackhi_ps(from[2], from[3]));
    to[0] = _mm512_castpd_ps(_mm512_unpacklo_pd(low_01, low_23));
    to[1] = _mm512_castpd_ps(_mm512_unpackhi_pd(low_01, low_23));
    to[2] = _mm512_castpd_ps(_mm512_unpacklo_pd(high_01, high_23));
    to[3] = _mm512_castpd_ps(_mm512_unpackhi_pd(high_01, high_23));
}

/* b less a where sign has -1, b plus a where it has 1, the fixed-point places exactly: one row of one pair. */
WIDE_INLINE __m512 row_pair(const void *rows, int32_t a, int32_t b, __m512 sign)
{
    enum { PLACE = 7, OTHERS = 0xfff8 }; /* lanes 0-2; bits of a place, read as a float, might be denormal and slow */
    const __m512 *row = rows;
    const __m512 row_a = row[(uint32_t)a], row_b = row[(uint32_t)b], sum = _mm512_maskz_fmadd_ps(OTHERS, row_a, sign, row_b);
    return _mm512_castsi512_ps(
        _mm512_mask_sub_epi32(_mm512_castps_si512(sum), PLACE, _mm512_castps_si512(row_b), _mm512_castps_si512(row_a)));
}

WIDE_INLINE void ring_displacement(__m512i turned, double unit, wide_double x[2], wide *n)
{
    const __m512d m = _mm512_set1_pd(unit);
    x[0] = (wide_double)_mm512_mul_pd(_mm512_cvtepi32_pd(_mm512_castsi512_si256(turned)), m);
    x[1] = (wide_double)_mm512_mul_pd(_mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(turned, 1)), m);
    *n = (wide)_mm512_mul_ps(_mm512_cvtepi32_ps(turned), _mm512_set1_ps((float)unit));
}

WIDE_INLINE void wide_row_pairs(const void *rows, const int32_t *a, const int32_t *b, const double unit[3], wide_pairs *out)
{
    const __m512 sign = _mm512_setr_ps(1, 1, 1, 1, -1, -1, -1, -1, 1, 1, 1, 1, 1, 1, 1, 1);
    __m512 t[4][4]; /* [rows 4g ... 4g+3][column 4L + c in quarter L] */
    for (int g = 0; g < 4; g++) {
        __m512 row[4];
        for (int k = 0; k < 4; k++) row[k] = row_pair(rows, a[4 * g + k], b[4 * g + k], sign);
        transpose_quarters(row, t[g]);
    }
    for (int c = 0; c < 4; c++) {
        const __m512 even_01 = _mm512_shuffle_f32x4(t[0][c], t[1][c], 0x88), even_23 = _mm512_shuffle_f32x4(t[2][c], t[3][c], 0x88);
        const __m512 place = _mm512_shuffle_f32x4(even_01, even_23, 0x88);
        if (c == 3) {
            out->radii = (wide)place;
            break;
        }
        const __m512 odd_01 = _mm512_shuffle_f32x4(t[0][c], t[1][c], 0xdd), odd_23 = _mm512_shuffle_f32x4(t[2][c], t[3][c], 0xdd);
        ring_displacement(_mm512_castps_si512(place), unit[c], out->x[c], &out->n[c]);
        out->v[c] = (wide)_mm512_shuffle_f32x4(odd_01, odd_23, 0x88);
        out->r_omega[c] = (wide)_mm512_shuffle_f32x4(even_01, even_23, 0xdd);
        out->omega[c] = (wide)_mm512_shuffle_f32x4(odd_01, odd_23, 0xdd);
    }
}

/* Of LANES pairs of spheres the first's spin less the second's, which the above leaves out. */
WIDE_INLINE void wide_row_spins(const void *rows, const int32_t *a, const int32_t *b, wide out[3])
{
    enum { SPIN = 12, ROW = 16 }; /* where in a row, and how long that is */
    const float *all = rows;
    __m512 pairs[4], to[4];
    for (int k = 0; k < 4; k++) {
        __m128 spin[4]; /* of pairs k, 4 + k, 8 + k, 12 + k */
        for (int g = 0; g < 4; g++)
            spin[g] = _mm_load_ps(all + ROW * (size_t)a[4 * g + k] + SPIN) - _mm_load_ps(all + ROW * (size_t)b[4 * g + k] + SPIN);
        const __m512 two = _mm512_insertf32x4(_mm512_castps128_ps512(spin[0]), spin[1], 1);
        pairs[k] = _mm512_insertf32x4(_mm512_insertf32x4(two, spin[2], 2), spin[3], 3);
    }
    transpose_quarters(pairs, to);
    for (int c = 0; c < 3; c++) out[c] = (wide)to[c];
}

WIDE_INLINE wide wide_rint(wide x) { return (wide)_mm512_roundscale_ps((__m512)x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }
WIDE_INLINE uint32_t wide_mask_bits(wide_mask m) { return m; }
WIDE_INLINE uint32_t wide_index_above(const int32_t *index, int32_t i)
{
    return _mm512_cmpgt_epi32_mask(_mm512_loadu_si512(index), _mm512_set1_epi32(i));
}

/* Those of LANES numbers whose bit is set, one after the other; room for LANES must be behind `to`. Returns how many. */
WIDE_INLINE size_t wide_compress(int32_t *to, uint32_t bits, const int32_t *from)
{
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32((__mmask16)bits, _mm512_loadu_si512(from)));
    return (size_t)__builtin_popcount(bits);
}

/* LANES rows of 8: f, 0, q, 0. */
WIDE_INLINE void wide_store_rows(row8 *rows, const wide f[3], const wide q[3])
{
    const __m512 low[4] = { (__m512)f[0], (__m512)f[1], (__m512)f[2], _mm512_setzero_ps() };
    const __m512 high[4] = { (__m512)q[0], (__m512)q[1], (__m512)q[2], _mm512_setzero_ps() };
    const __m512i front = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), back = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    __m512 a[4], b[4];
    transpose_quarters(low, a);
    transpose_quarters(high, b);
    for (int c = 0; c < 4; c++) {
        const __m512d two = _mm512_permutex2var_pd(_mm512_castps_pd(a[c]), front, _mm512_castps_pd(b[c]));
        const __m512d four = _mm512_permutex2var_pd(_mm512_castps_pd(a[c]), back, _mm512_castps_pd(b[c]));
        rows[c] = (row8)_mm512_castpd512_pd256(two);
        rows[4 + c] = (row8)_mm512_extractf64x4_pd(two, 1);
        rows[8 + c] = (row8)_mm512_castpd512_pd256(four);
        rows[12 + c] = (row8)_mm512_extractf64x4_pd(four, 1);
    }
}

#else

typedef struct {
    uint8_t lane[LANES];
} wide_mask;

WIDE_INLINE wide wide_fused(wide a, wide b, wide c)
{
    for (int k = 0; k < LANES; k++) c[k] = fused(a[k], b[k], c[k]);
    return c;
}
WIDE_INLINE wide_double wide_double_fused(wide_double a, wide_double b, wide_double c)
{
    for (int k = 0; k < 8; k++) c[k] = __builtin_fma(a[k], b[k], c[k]);
    return c;
}

WIDE_INLINE wide wide_greater(wide a, wide b)
{
    for (int k = 0; k < LANES; k++) a[k] = greater(a[k], b[k]);
    return a;
}
WIDE_INLINE wide wide_lesser(wide a, wide b)
{
    for (int k = 0; k < LANES; k++) a[k] = lesser(a[k], b[k]);
    return a;
}
WIDE_INLINE wide_mask wide_exceeds(wide a, wide b)
{
    wide_mask m;
    for (int k = 0; k < LANES; k++) m.lane[k] = a[k] > b[k];
    return m;
}
WIDE_INLINE wide wide_select(wide_mask m, wide a, wide b)
{
    for (int k = 0; k < LANES; k++) a[k] = m.lane[k] ? a[k] : b[k];
    return a;
}
WIDE_INLINE wide wide_rint(wide x)
{
    for (int k = 0; k < LANES; k++) x[k] = (real)rint((double)x[k]);
    return x;
}
/* Bit k: index[k] > i. */
WIDE_INLINE uint32_t wide_index_above(const int32_t *index, int32_t i)
{
    uint32_t bits = 0;
    for (int k = 0; k < LANES; k++) bits |= (uint32_t)(index[k] > i) << k;
    return bits;
}
WIDE_INLINE uint32_t wide_mask_bits(wide_mask m)
{
    uint32_t bits = 0;
    for (int k = 0; k < LANES; k++) bits |= (uint32_t)m.lane[k] << k;
    return bits;
}
WIDE_INLINE size_t wide_compress(int32_t *to, uint32_t bits, const int32_t *from)
{
    size_t n = 0;
    for (int k = 0; k < LANES; k++)
        if (bits >> k & 1) to[n++] = from[k];
    return n;
}
WIDE_INLINE wide wide_from_doubles(const wide_double x[HALVES])
{
    wide y = { 0 };
    for (int k = 0; k < LANES; k++) y[k] = (real)x[k / 8][k % 8];
    return y;
}
WIDE_INLINE void wide_to_doubles(wide x, wide_double to[HALVES])
{
    for (int k = 0; k < LANES; k++) to[k / 8][k % 8] = (double)x[k];
}
WIDE_INLINE wide wide_inverse_root_guess(wide x)
{
    for (int k = 0; k < LANES; k++) x[k] = inverse_root_guess(x[k]);
    return x;
}
WIDE_INLINE wide wide_inverse_guess(wide x)
{
    for (int k = 0; k < LANES; k++) x[k] = inverse_guess(x[k]);
    return x;
}
WIDE_INLINE wide wide_inverse_cube_root_guess(wide x)
{
    for (int k = 0; k < LANES; k++) x[k] = inverse_cube_root_guess(x[k]);
    return x;
}

/* The way round from a to b, in units. */
WIDE_INLINE double ring_difference(on_ring a, on_ring b)
{
#ifdef DEM_DOUBLE
    return b - a - rint(b - a);
#else
    return (double)(int32_t)((uint32_t)b - (uint32_t)a);
#endif
}

WIDE_INLINE void wide_row_pairs(const void *rows, const int32_t *a, const int32_t *b, const double unit[3], wide_pairs *out)
{
    typedef struct row {
        on_ring place[3];
        real radius, number[12];
    } __attribute__((aligned(64))) row;
    const row *all = rows;
    for (int k = 0; k < LANES; k++) {
        const row *row_a = &all[a[k]], *row_b = &all[b[k]];
        out->radii[k] = row_b->radius + row_a->radius;
        for (int c = 0; c < 3; c++) {
            const double turned = ring_difference(row_a->place[c], row_b->place[c]);
            out->x[c][k / 8][k % 8] = turned * unit[c];
            out->n[c][k] = (real)turned * (real)unit[c];
            out->v[c][k] = row_b->number[c] - row_a->number[c];
            out->r_omega[c][k] = row_b->number[4 + c] + row_a->number[4 + c];
            out->omega[c][k] = row_b->number[8 + c] + row_a->number[8 + c];
        }
    }
}

WIDE_INLINE void wide_row_spins(const void *rows, const int32_t *a, const int32_t *b, wide out[3])
{
    enum { SPIN = 12, ROW = 16 };
    const real *all = rows;
    for (int k = 0; k < LANES; k++)
        for (int c = 0; c < 3; c++)
            out[c][k] = all[ROW * (size_t)a[k] + SPIN + (size_t)c] - all[ROW * (size_t)b[k] + SPIN + (size_t)c];
}

/* LANES rows of 8: f, 0, q, 0. */
WIDE_INLINE void wide_store_rows(row8 *rows, const wide f[3], const wide q[3])
{
    for (int k = 0; k < LANES; k++) rows[k] = (row8){ f[0][k], f[1][k], f[2][k], 0, q[0][k], q[1][k], q[2][k], 0 };
}

#endif

WIDE_INLINE double wide_largest_lane(wide x)
{
    double largest = (double)x[0];
    for (int k = 1; k < LANES; k++) largest = (double)x[k] > largest ? (double)x[k] : largest;
    return largest;
}

/* ---- one sphere's vectors ---- */

#if defined(__AVX__)
#include <immintrin.h>
#endif
#if defined(__AVX__) && !defined(DEM_DOUBLE)
WIDE_INLINE vector4 vector4_low(const row8 *row) { return (vector4)_mm256_cvtps_pd(_mm_load_ps((const float *)row)); }
WIDE_INLINE vector4 vector4_high(const row8 *row) { return (vector4)_mm256_cvtps_pd(_mm_load_ps((const float *)row + 4)); }
WIDE_INLINE half_row half_row_of(vector4 x) { return (half_row)_mm256_cvtpd_ps((__m256d)x); }
WIDE_INLINE vector4 vector4_rint(vector4 x)
{
    return (vector4)_mm256_round_pd((__m256d)x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
#else
WIDE_INLINE vector4 vector4_low(const row8 *row) { return (vector4){ (double)(*row)[0], (double)(*row)[1], (double)(*row)[2] }; }
WIDE_INLINE vector4 vector4_high(const row8 *row) { return (vector4){ (double)(*row)[4], (double)(*row)[5], (double)(*row)[6] }; }
WIDE_INLINE half_row half_row_of(vector4 x) { return (half_row){ (real)x[0], (real)x[1], (real)x[2], (real)x[3] }; }
WIDE_INLINE vector4 vector4_rint(vector4 x) { return (vector4){ rint(x[0]), rint(x[1]), rint(x[2]), rint(x[3]) }; }
#endif

/* The front of a sphere's row: its place (ring units), rounded to whole ones in single precision, and its radius. */
#ifdef DEM_DOUBLE
WIDE_INLINE half_row half_row_place(vector4 place, real radius) { return (half_row){ place[0], place[1], place[2], radius }; }
#else
WIDE_INLINE half_row half_row_place(vector4 place, real radius)
{
    typedef int64_t long4 __attribute__((vector_size(32)));
    const ring_row whole = __builtin_convertvector((long4)(place + RING_SHIFT), ring_row);
    half_row front = (half_row)whole;
    front[3] = radius;
    return front;
}
#endif

/* a b + c, rounded once */
WIDE_INLINE row8 row8_fused(row8 a, row8 b, row8 c)
{
#if defined(__AVX2__) && defined(__FMA__) && !defined(DEM_DOUBLE)
    return (row8)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
    for (int k = 0; k < 8; k++) c[k] = fused(a[k], b[k], c[k]);
    return c;
#endif
}
WIDE_INLINE vector4 vector4_fused(vector4 a, vector4 b, vector4 c)
{
#if defined(__AVX2__) && defined(__FMA__)
    return (vector4)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
    for (int k = 0; k < 4; k++) c[k] = __builtin_fma(a[k], b[k], c[k]);
    return c;
#endif
}

WIDE_INLINE vector4 vector4_greater(vector4 a, vector4 b)
{
#if defined(__AVX2__)
    return (vector4)_mm256_max_pd((__m256d)a, (__m256d)b);
#else
    for (int k = 0; k < 4; k++) a[k] = a[k] > b[k] ? a[k] : b[k];
    return a;
#endif
}

/* ---- powers ---- */

/* 1/sqrt(x), 1/x and x^(-1/3) for x > 0, as real.h has them for one. */
WIDE_INLINE wide wide_inverse_root(wide x)
{
    wide y = wide_inverse_root_guess(x);
    y *= wide_all(INVERSE_ROOT_FACTOR) * wide_fused(-(x * y), y, wide_all(INVERSE_ROOT_OFFSET));
    for (int k = 0; k < INVERSE_ROOT_STEPS; k++) {
        const wide e = wide_fused(-(x * y), y, wide_all(1));
        y = wide_fused(y * e, wide_fused(wide_all((real)0.375), e, wide_all((real)0.5)), y);
    }
    return y;
}

WIDE_INLINE wide wide_inverse(wide x)
{
    wide y = wide_inverse_guess(x);
    for (int k = 0; k < INVERSE_STEPS; k++) y *= wide_fused(-x, y, wide_all(2));
    return y;
}

WIDE_INLINE wide wide_inverse_cube_root(wide x)
{
    const wide third = wide_all((real)(-1.0 / 3.0)) * x;
    wide y = wide_inverse_cube_root_guess(x);
    for (int k = 0; k < INVERSE_CUBE_ROOT_STEPS; k++) y *= wide_fused(third * y, y * y, wide_all((real)(4.0 / 3.0)));
    return y;
}

WIDE_INLINE wide wide_dot(const wide a[3], const wide b[3]) { return wide_fused(a[2], b[2], wide_fused(a[1], b[1], a[0] * b[0])); }

#endif
