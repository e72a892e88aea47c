/* Wide arithmetic: LANES contacts at once, 64 bytes a vector. The only intrinsics of the program.
 *
 * Sums, products and quotients are the compiler's own vector operators; what these lack (square root, selection,
 * gathering, transposing) is here, for AVX-512 where the processor has it and as plain loops elsewhere. Every
 * operation rounds as its scalar counterpart does, so a lane's result does not depend on the instruction set. */
#ifndef WIDE_H
#define WIDE_H

#include "real.h"

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include <immintrin.h>
#define WIDE_AVX512 1
#else
#define WIDE_AVX512 0
#endif

enum { LANES = 64 / sizeof(real), HALVES = LANES / 8 };

typedef real wide __attribute__((vector_size(64)));
typedef double wide_double __attribute__((vector_size(64))); /* 8 lanes; HALVES of them beside one wide */
typedef real row_vector __attribute__((vector_size(8 * sizeof(real)))); /* 8 numbers: one contact's row */

#define WIDE_INLINE static inline __attribute__((always_inline))

WIDE_INLINE wide wide_all(real x) { return x - (wide){ 0 }; }
WIDE_INLINE wide_double wide_double_all(double x) { return x - (wide_double){ 0 }; }
WIDE_INLINE wide wide_load(const real *p) { return *(const wide *)p; }
WIDE_INLINE void wide_store(real *p, wide x) { *(wide *)p = x; }

#if WIDE_AVX512

typedef __mmask16 wide_mask;

#ifdef DEM_SINGLE
WIDE_INLINE wide wide_root(wide x) { return (wide)_mm512_sqrt_ps((__m512)x); }
WIDE_INLINE wide wide_greater(wide a, wide b) { return (wide)_mm512_max_ps((__m512)a, (__m512)b); }
WIDE_INLINE wide wide_lesser(wide a, wide b) { return (wide)_mm512_min_ps((__m512)a, (__m512)b); }
WIDE_INLINE wide_mask wide_exceeds(wide a, wide b) { return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_GT_OQ); }
WIDE_INLINE wide wide_select(wide_mask m, wide a, wide b) { return (wide)_mm512_mask_blend_ps(m, (__m512)b, (__m512)a); }
WIDE_INLINE wide wide_cube_root_guess(wide x)
{
    const __m512 third = _mm512_mul_ps(_mm512_cvtepi32_ps(_mm512_castps_si512((__m512)x)), _mm512_set1_ps(1.0f / 3.0f));
    return (wide)_mm512_castsi512_ps(_mm512_add_epi32(_mm512_cvttps_epi32(third), _mm512_set1_epi32(0x2a5137a0)));
}
WIDE_INLINE wide wide_gather(const void *base, int offset, int stride, const int32_t *index)
{
    const __m512i i = _mm512_mullo_epi32(_mm512_load_si512(index), _mm512_set1_epi32(stride / (int)sizeof(real)));
    return (wide)_mm512_i32gather_ps(i, (const char *)base + offset, sizeof(real));
}
WIDE_INLINE wide wide_from_doubles(const wide_double x[HALVES])
{
    return (wide)_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps((__m512d)x[0])), _mm512_cvtpd_ps((__m512d)x[1]), 1);
}
#else
WIDE_INLINE wide wide_root(wide x) { return (wide)_mm512_sqrt_pd((__m512d)x); }
WIDE_INLINE wide wide_greater(wide a, wide b) { return (wide)_mm512_max_pd((__m512d)a, (__m512d)b); }
WIDE_INLINE wide wide_lesser(wide a, wide b) { return (wide)_mm512_min_pd((__m512d)a, (__m512d)b); }
WIDE_INLINE wide_mask wide_exceeds(wide a, wide b) { return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_GT_OQ); }
WIDE_INLINE wide wide_select(wide_mask m, wide a, wide b) { return (wide)_mm512_mask_blend_pd((__mmask8)m, (__m512d)b, (__m512d)a); }
WIDE_INLINE wide wide_cube_root_guess(wide x)
{
    const __m256i bits = _mm256_castps_si256(_mm512_cvtpd_ps((__m512d)x));
    const __m256 third = _mm256_mul_ps(_mm256_cvtepi32_ps(bits), _mm256_set1_ps(1.0f / 3.0f));
    const __m256i guess = _mm256_add_epi32(_mm256_cvttps_epi32(third), _mm256_set1_epi32(0x2a5137a0));
    return (wide)_mm512_cvtps_pd(_mm256_castsi256_ps(guess));
}
WIDE_INLINE wide wide_gather(const void *base, int offset, int stride, const int32_t *index)
{
    const __m256i i = _mm256_mullo_epi32(_mm256_load_si256((const __m256i *)index), _mm256_set1_epi32(stride / (int)sizeof(real)));
    return (wide)_mm512_i32gather_pd(i, (const char *)base + offset, sizeof(real));
}
WIDE_INLINE wide wide_from_doubles(const wide_double x[HALVES]) { return x[0]; }
#endif
WIDE_INLINE wide_double wide_double_gather(const void *base, int offset, int stride, const int32_t *index)
{
    const __m256i i = _mm256_mullo_epi32(_mm256_load_si256((const __m256i *)index), _mm256_set1_epi32(stride / 8));
    return (wide_double)_mm512_i32gather_pd(i, (const char *)base + offset, 8);
}
WIDE_INLINE wide_double wide_double_rint(wide_double x)
{
    return (wide_double)_mm512_roundscale_pd((__m512d)x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}

#else

typedef struct { uint8_t lane[LANES]; } wide_mask;

WIDE_INLINE wide wide_root(wide x)
{
    for (int k = 0; k < LANES; k++) x[k] = root(x[k]);
    return x;
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
WIDE_INLINE wide wide_cube_root_guess(wide x)
{
    for (int k = 0; k < LANES; k++) x[k] = cube_root_guess(x[k]);
    return x;
}
WIDE_INLINE wide wide_gather(const void *base, int offset, int stride, const int32_t *index)
{
    wide x;
    for (int k = 0; k < LANES; k++) x[k] = *(const real *)((const char *)base + offset + (size_t)stride * (size_t)index[k]);
    return x;
}
WIDE_INLINE wide wide_from_doubles(const wide_double x[HALVES])
{
    wide y;
    for (int k = 0; k < LANES; k++) y[k] = (real)x[k / 8][k % 8];
    return y;
}
WIDE_INLINE wide_double wide_double_gather(const void *base, int offset, int stride, const int32_t *index)
{
    wide_double x;
    for (int k = 0; k < 8; k++) x[k] = *(const double *)((const char *)base + offset + (size_t)stride * (size_t)index[k]);
    return x;
}
WIDE_INLINE wide_double wide_double_rint(wide_double x)
{
    for (int k = 0; k < 8; k++) x[k] = rint(x[k]);
    return x;
}

#endif

#endif
