/* What wide.h needs of AVX-512, in single precision: 16 lanes. Included by wide.h alone. */
#ifndef WIDE_AVX512_H
#define WIDE_AVX512_H

typedef __mmask16 wide_mask;

WIDE_INLINE wide wide_greater(wide a, wide b) { return (wide)_mm512_max_ps((__m512)a, (__m512)b); }
WIDE_INLINE wide wide_lesser(wide a, wide b) { return (wide)_mm512_min_ps((__m512)a, (__m512)b); }
WIDE_INLINE wide_mask wide_exceeds(wide a, wide b) { return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_GT_OQ); }
WIDE_INLINE wide wide_select(wide_mask m, wide a, wide b) { return (wide)_mm512_mask_blend_ps(m, (__m512)b, (__m512)a); }
/* -a where the sign of s is negative. */
WIDE_INLINE wide wide_times_sign(wide a, wide s)
{
    enum { A_XOR_B_AND_C = 0x78 };
    return (wide)_mm512_castsi512_ps(_mm512_ternarylogic_epi32(_mm512_castps_si512((__m512)a), _mm512_castps_si512((__m512)s),
                                                               _mm512_set1_epi32(INT32_MIN), A_XOR_B_AND_C));
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

WIDE_INLINE void wide_row_pairs(const void *rows, const int32_t *a, const int32_t *b, wide_pairs *out)
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
        out->turned[c] = (wide_ring)_mm512_castps_si512(place);
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

/* LANES rows of 8: f, q, 0, 0; two with one store. */
WIDE_INLINE void wide_store_rows(row8 *rows, const wide f[3], const wide q[3])
{
    enum { NUMBERS = 0x77 }; /* of the pairs that two rows are */
    const __m512 from[4] = { (__m512)f[0], (__m512)f[1], (__m512)f[2], (__m512)q[0] };
    const __m512d rest[2] = { _mm512_castps_pd(_mm512_unpacklo_ps((__m512)q[1], (__m512)q[2])),
                              _mm512_castps_pd(_mm512_unpackhi_ps((__m512)q[1], (__m512)q[2])) };
    const __m512i front[2] = { _mm512_setr_epi64(0, 1, 8, 0, 2, 3, 10, 0), _mm512_setr_epi64(0, 1, 9, 0, 2, 3, 11, 0) };
    const __m512i back[2] = { _mm512_setr_epi64(4, 5, 12, 0, 6, 7, 14, 0), _mm512_setr_epi64(4, 5, 13, 0, 6, 7, 15, 0) };
    __m512 to[4];
    __m512d *pairs = (__m512d *)rows;
    transpose_quarters(from, to);
    for (int c = 0; c < 4; c++) {
        const __m512d start = _mm512_castps_pd(to[c]);
        pairs[c] = _mm512_maskz_permutex2var_pd(NUMBERS, start, front[c % 2], rest[c / 2]);
        pairs[4 + c] = _mm512_maskz_permutex2var_pd(NUMBERS, start, back[c % 2], rest[c / 2]);
    }
}

/* Where wide_store_rows puts the row of lane k. */
WIDE_INLINE int wide_row_slot(int k) { return (k & ~7) | (k & 3) << 1 | (k >> 2 & 1); }

#endif
