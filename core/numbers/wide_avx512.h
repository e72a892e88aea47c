/* What wide.h needs of AVX-512, in single precision: 16 lanes. Included by wide.h alone. */
#ifndef WIDE_AVX512_H
#define WIDE_AVX512_H

typedef __mmask16 wide_mask;

WIDE_INLINE wide wide_greater(wide a, wide b) { return (wide)_mm512_max_ps((__m512)a, (__m512)b); }
WIDE_INLINE wide wide_lesser(wide a, wide b) { return (wide)_mm512_min_ps((__m512)a, (__m512)b); }
WIDE_INLINE wide_mask wide_exceeds(wide a, wide b) { return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_GT_OQ); }
WIDE_INLINE wide wide_select(wide_mask m, wide a, wide b) { return (wide)_mm512_mask_blend_ps(m, (__m512)b, (__m512)a); }
WIDE_INLINE wide_mask wide_both(wide_mask m, wide_mask o) { return _kand_mask16(m, o); }
/* a where m says so, else 0. */
WIDE_INLINE wide wide_where(wide_mask m, wide a) { return (wide)_mm512_maskz_mov_ps(m, (__m512)a); }
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

WIDE_INLINE wide wide_from_quads(const __m128 x[4])
{
    const __m512 low = _mm512_castps256_ps512(_mm256_set_m128(x[1], x[0]));
    return (wide)_mm512_insertf32x8(low, _mm256_set_m128(x[3], x[2]), 1);
}

/* Rows i and j side by side. */
WIDE_INLINE __m512 two_rows(const void *rows, int32_t i, int32_t j)
{
    enum { SECOND = 0xff00 };
    const __m256 *row = rows;
    return _mm512_mask_broadcast_f32x8(_mm512_castps256_ps512(row[(uint32_t)i]), SECOND, row[(uint32_t)j]);
}

/* LANES rows, of which vectors k and 4 + k have rows k and 4 + k, 8 + k and 12 + k, turned. */
WIDE_INLINE wide_rows rows_transposed(const __m512 from[8])
{
    enum { EVEN_QUARTERS = 0x88, ODD_QUARTERS = 0xdd };
    __m512 low[4], high[4], front[4], back[4];
    transpose_quarters(from, low);
    transpose_quarters(from + 4, high);
    for (int c = 0; c < 4; c++) {
        front[c] = _mm512_shuffle_f32x4(low[c], high[c], EVEN_QUARTERS);
        back[c] = _mm512_shuffle_f32x4(low[c], high[c], ODD_QUARTERS);
    }
    wide_rows out = { .omega = { (wide)front[3], (wide)back[3] } };
    for (int c = 0; c < 3; c++) {
        out.place[c] = (wide_ring)_mm512_castps_si512(front[c]);
        out.v[c] = (wide)back[c];
    }
    return out;
}

WIDE_INLINE wide_rows wide_rows_load(const void *rows, const int32_t *i)
{
    __m512 two[8];
    for (int k = 0; k < 8; k++) {
        const int32_t *at = i + k / 4 * 8 + k % 4;
        two[k] = two_rows(rows, at[0], at[4]);
    }
    return rows_transposed(two);
}

WIDE_INLINE wide_rows wide_rows_of_pairs(const void *rows, const int32_t *a, const int32_t *b)
{
    enum { PLACES = 0x0707, OTHERS = 0xf8f8 }; /* bits of a place, read as a float, might be denormal and slow */
    const __m512 sign = _mm512_setr_ps(1, 1, 1, 1, -1, -1, -1, 1, 1, 1, 1, 1, -1, -1, -1, 1);
    __m512 two[8];
    for (int k = 0; k < 8; k++) {
        const int at = k / 4 * 8 + k % 4;
        const __m512 of_a = two_rows(rows, a[at], a[at + 4]), of_b = two_rows(rows, b[at], b[at + 4]);
        const __m512i sum = _mm512_castps_si512(_mm512_maskz_fmadd_ps(OTHERS, of_a, sign, of_b));
        two[k] = _mm512_castsi512_ps(_mm512_mask_sub_epi32(sum, PLACES, _mm512_castps_si512(of_b), _mm512_castps_si512(of_a)));
    }
    return rows_transposed(two);
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

WIDE_INLINE size_t wide_compress(int32_t *to, uint32_t bits, const int32_t *from)
{
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32((__mmask16)bits, _mm512_loadu_si512(from)));
    return (size_t)__builtin_popcount(bits);
}

typedef struct wide_move {
    __mmask16 bits, before;
} wide_move;

WIDE_INLINE wide_move wide_move_of(uint32_t bits, uint32_t before) { return (wide_move){ (__mmask16)bits, (__mmask16)before }; }

WIDE_INLINE void wide_carry(real *to, const wide_move *move, const real *from)
{
    const __m512 all = _mm512_maskz_expand_ps(move->before, _mm512_loadu_ps(from));
    _mm512_storeu_ps(to, _mm512_maskz_compress_ps(move->bits, all));
}

#endif
