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

/* Numbers behind the place in a sphere's row: radius, velocity, R omega, omega (spheres.h). */
enum { ROW_NUMBERS = 10 };

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

WIDE_INLINE wide_double wide_double_rint(wide_double x)
{
    return (wide_double)_mm512_roundscale_pd((__m512d)x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
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

/* Two places beside each other: the three doubles of each and whatever follows. */
WIDE_INLINE __m512d two_places(const char *rows, size_t row_size, int32_t low, int32_t high)
{
    const __m512d x = _mm512_castpd256_pd512(_mm256_loadu_pd((const double *)(rows + row_size * (size_t)low)));
    return _mm512_insertf64x4(x, _mm256_loadu_pd((const double *)(rows + row_size * (size_t)high)), 1);
}

WIDE_INLINE void wide_place_differences(const void *rows, size_t row_size, const int32_t *a, const int32_t *b, wide_double *x,
                                        wide_double *y, wide_double *z)
{
    const __m512i lower = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), upper = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    __m512d d[4];
    for (int k = 0; k < 4; k++)
        d[k] = _mm512_sub_pd(two_places(rows, row_size, b[k], b[k + 4]), two_places(rows, row_size, a[k], a[k + 4]));
    const __m512d low_01 = _mm512_unpacklo_pd(d[0], d[1]), low_23 = _mm512_unpacklo_pd(d[2], d[3]);
    const __m512d high_01 = _mm512_unpackhi_pd(d[0], d[1]), high_23 = _mm512_unpackhi_pd(d[2], d[3]);
    *x = (wide_double)_mm512_permutex2var_pd(low_01, lower, low_23);
    *z = (wide_double)_mm512_permutex2var_pd(low_01, upper, low_23);
    *y = (wide_double)_mm512_permutex2var_pd(high_01, lower, high_23);
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

WIDE_INLINE void wide_row_sums(const void *rows, size_t row_size, const int32_t *a, const int32_t *b, const float sign[16],
                               wide sum[ROW_NUMBERS])
{
    enum { PLACE = 6 }; /* numbers that the place takes in front */
    const __mmask16 behind_place = (__mmask16)(0xffff & (0xffff << PLACE));
    const __m512 signs = _mm512_loadu_ps(sign);
    const char *base = rows;
    __m512 t[4][4]; /* [rows 4g ... 4g+3][column 4L + c in quarter L] */
    for (int g = 0; g < 4; g++) {
        __m512 row[4];
        for (int k = 0; k < 4; k++) {
            const __m512 row_a = _mm512_maskz_load_ps(behind_place, base + row_size * (size_t)a[4 * g + k]);
            const __m512 row_b = _mm512_maskz_load_ps(behind_place, base + row_size * (size_t)b[4 * g + k]);
            row[k] = _mm512_xor_ps(row_a, signs);
            row[k] = _mm512_add_ps(row_b, row[k]);
        }
        transpose_quarters(row, t[g]);
    }
    for (int c = 0; c < 4; c++) {
        const __m512 even_01 = _mm512_shuffle_f32x4(t[0][c], t[1][c], 0x88), odd_01 = _mm512_shuffle_f32x4(t[0][c], t[1][c], 0xdd);
        const __m512 even_23 = _mm512_shuffle_f32x4(t[2][c], t[3][c], 0x88), odd_23 = _mm512_shuffle_f32x4(t[2][c], t[3][c], 0xdd);
        if (c >= 2) sum[4 + c - PLACE] = (wide)_mm512_shuffle_f32x4(odd_01, odd_23, 0x88);
        sum[8 + c - PLACE] = (wide)_mm512_shuffle_f32x4(even_01, even_23, 0xdd);
        sum[12 + c - PLACE] = (wide)_mm512_shuffle_f32x4(odd_01, odd_23, 0xdd);
    }
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

/* Quarter k of each of LANES rows: x, y, z, 0. */
WIDE_INLINE void store_quarters(real *rows, int quarter, wide x, wide y, wide z)
{
    const __m512 from[4] = { (__m512)x, (__m512)y, (__m512)z, _mm512_setzero_ps() };
    __m512 to[4];
    transpose_quarters(from, to);
    for (int c = 0; c < 4; c++) {
        float *at = rows + 16 * c + 4 * quarter;
        _mm_store_ps(at, _mm512_castps512_ps128(to[c]));
        _mm_store_ps(at + 64, _mm512_extractf32x4_ps(to[c], 1));
        _mm_store_ps(at + 128, _mm512_extractf32x4_ps(to[c], 2));
        _mm_store_ps(at + 192, _mm512_extractf32x4_ps(to[c], 3));
    }
}

WIDE_INLINE void wide_store_ends(real *rows, const wide f[3], const wide torque_a[3], const wide torque_b[3])
{
    store_quarters(rows, 0, f[0], f[1], f[2]);
    store_quarters(rows, 1, torque_a[0], torque_a[1], torque_a[2]);
    store_quarters(rows, 2, -f[0], -f[1], -f[2]);
    store_quarters(rows, 3, torque_b[0], torque_b[1], torque_b[2]);
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
WIDE_INLINE wide_double wide_double_rint(wide_double x)
{
    for (int k = 0; k < 8; k++) x[k] = rint(x[k]);
    return x;
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

/* b less a of 8 pairs of rows that begin with three doubles. */
WIDE_INLINE void wide_place_differences(const void *rows, size_t row_size, const int32_t *a, const int32_t *b, wide_double *x,
                                        wide_double *y, wide_double *z)
{
    for (int k = 0; k < 8; k++) {
        const double *place_a = (const double *)((const char *)rows + row_size * (size_t)a[k]);
        const double *place_b = (const double *)((const char *)rows + row_size * (size_t)b[k]);
        (*x)[k] = place_b[0] - place_a[0];
        (*y)[k] = place_b[1] - place_a[1];
        (*z)[k] = place_b[2] - place_a[2];
    }
}

/* sum[c] = b's number c plus a's, or less a's where sign[...] is negative, for LANES pairs of rows. */
WIDE_INLINE void wide_row_sums(const void *rows, size_t row_size, const int32_t *a, const int32_t *b, const float sign[16],
                               wide sum[ROW_NUMBERS])
{
    for (int k = 0; k < LANES; k++) {
        const real *row_a = (const real *)((const char *)rows + row_size * (size_t)a[k] + 3 * sizeof(double));
        const real *row_b = (const real *)((const char *)rows + row_size * (size_t)b[k] + 3 * sizeof(double));
        for (int c = 0; c < ROW_NUMBERS; c++) sum[c][k] = row_b[c] + (signbit(sign[c + 6]) ? -row_a[c] : row_a[c]);
    }
}

/* LANES rows of 16: f, 0, torque_a, 0, -f, 0, torque_b, 0. */
WIDE_INLINE void wide_store_ends(real *rows, const wide f[3], const wide torque_a[3], const wide torque_b[3])
{
    for (int k = 0; k < LANES; k++)
        for (int c = 0; c < 3; c++) {
            rows[16 * k + c] = f[c][k];
            rows[16 * k + 4 + c] = torque_a[c][k];
            rows[16 * k + 8 + c] = -f[c][k];
            rows[16 * k + 12 + c] = torque_b[c][k];
        }
}

#endif

/* ---- one sphere's vectors ---- */

#if defined(__AVX__) && !defined(DEM_DOUBLE)
#include <immintrin.h>
WIDE_INLINE vector4 vector4_low(const row8 *row) { return (vector4)_mm256_cvtps_pd(_mm_load_ps((const float *)row)); }
WIDE_INLINE vector4 vector4_high(const row8 *row) { return (vector4)_mm256_cvtps_pd(_mm_load_ps((const float *)row + 4)); }
WIDE_INLINE half_row half_row_of(vector4 x) { return (half_row)_mm256_cvtpd_ps((__m256d)x); }
WIDE_INLINE vector4 vector4_rint(vector4 x)
{
    return (vector4)_mm256_round_pd((__m256d)x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
/* What follows a place in a row is no double: read as one it may be denormal, and slow. */
WIDE_INLINE vector4 vector4_place(const double *x) { return (vector4)_mm256_blend_pd(_mm256_loadu_pd(x), _mm256_setzero_pd(), 8); }
/* radius, v0, v1, v2 and a0, a1, a2, b0. */
WIDE_INLINE void half_row_weave(real radius, half_row v, half_row a, half_row b, half_row *front, half_row *middle)
{
    *front = (half_row)_mm_move_ss(_mm_permute_ps((__m128)v, 0x93), _mm_set_ss(radius));
    *middle = (half_row)_mm_insert_ps((__m128)a, (__m128)b, 0x30);
}
#else
WIDE_INLINE vector4 vector4_low(const row8 *row) { return (vector4){ (double)(*row)[0], (double)(*row)[1], (double)(*row)[2] }; }
WIDE_INLINE vector4 vector4_high(const row8 *row) { return (vector4){ (double)(*row)[4], (double)(*row)[5], (double)(*row)[6] }; }
WIDE_INLINE half_row half_row_of(vector4 x) { return (half_row){ (real)x[0], (real)x[1], (real)x[2], (real)x[3] }; }
WIDE_INLINE vector4 vector4_rint(vector4 x) { return (vector4){ rint(x[0]), rint(x[1]), rint(x[2]), rint(x[3]) }; }
WIDE_INLINE vector4 vector4_place(const double *x) { return (vector4){ x[0], x[1], x[2] }; }
WIDE_INLINE void half_row_weave(real radius, half_row v, half_row a, half_row b, half_row *front, half_row *middle)
{
    *front = (half_row){ radius, v[0], v[1], v[2] };
    *middle = (half_row){ a[0], a[1], a[2], b[0] };
}
#endif

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
