/* What wide.h needs of AVX2, in single precision: 8 lanes. Included by wide.h alone.
 *
 * A vector's two halves of 16 bytes hardly talk to each other on such processors. So halves are filled from the start
 * with what belongs there: pair k beside pair k + 4. */
#ifndef WIDE_AVX2_H
#define WIDE_AVX2_H

typedef __m256 wide_mask; /* a lane's bits all set, or none */

WIDE_INLINE wide wide_greater(wide a, wide b) { return (wide)_mm256_max_ps((__m256)a, (__m256)b); }
WIDE_INLINE wide wide_lesser(wide a, wide b) { return (wide)_mm256_min_ps((__m256)a, (__m256)b); }
WIDE_INLINE wide_mask wide_exceeds(wide a, wide b) { return _mm256_cmp_ps((__m256)a, (__m256)b, _CMP_GT_OQ); }
WIDE_INLINE wide wide_select(wide_mask m, wide a, wide b) { return (wide)_mm256_blendv_ps((__m256)b, (__m256)a, m); }
WIDE_INLINE wide_mask wide_both(wide_mask m, wide_mask o) { return _mm256_and_ps(m, o); }
/* a where m says so, else 0. */
WIDE_INLINE wide wide_where(wide_mask m, wide a) { return (wide)_mm256_and_ps(m, (__m256)a); }
WIDE_INLINE wide wide_rint(wide x) { return (wide)_mm256_round_ps((__m256)x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }
WIDE_INLINE uint32_t wide_mask_bits(wide_mask m) { return (uint32_t)_mm256_movemask_ps(m); }
WIDE_INLINE uint32_t wide_index_above(const int32_t *index, int32_t i)
{
    const __m256i above = _mm256_cmpgt_epi32(_mm256_loadu_si256((const __m256i_u *)index), _mm256_set1_epi32(i));
    return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(above));
}

/* -a where the sign of s is negative. */
WIDE_INLINE wide wide_times_sign(wide a, wide s)
{
    return (wide)_mm256_xor_ps((__m256)a, _mm256_and_ps((__m256)s, _mm256_set1_ps(-0.0f)));
}

/* 4 x 4 numbers within each half of a vector: to[c] has in half L what from[0..3] have at 4 L + c. */
WIDE_INLINE void transpose_halves(const __m256 from[4], __m256 to[4])
{
    const __m256d low_01 = _mm256_castps_pd(_mm256_unpacklo_ps(from[0], from[1])),
                  high_01 = _mm256_castps_pd(_mm256_unpackhi_ps(from[0], from[1]));
    const __m256d low_23 = _mm256_castps_pd(_mm256_unpacklo_ps(from[2], from[3])),
                  high_23 = _mm256_castps_pd(_mm256_unpackhi_ps(from[2], from[3]));
    to[0] = _mm256_castpd_ps(_mm256_unpacklo_pd(low_01, low_23));
    to[1] = _mm256_castpd_ps(_mm256_unpackhi_pd(low_01, low_23));
    to[2] = _mm256_castpd_ps(_mm256_unpacklo_pd(high_01, high_23));
    to[3] = _mm256_castpd_ps(_mm256_unpackhi_pd(high_01, high_23));
}

WIDE_INLINE wide wide_from_quads(const __m128 x[2]) { return (wide)_mm256_set_m128(x[1], x[0]); }

/* One half of two rows, whose other half begins 16 bytes away. */
WIDE_INLINE __m256 halves_of(const __m128 *row, const __m128 *other)
{
    return _mm256_insertf128_ps(_mm256_castps128_ps256(*row), *other, 1);
}
WIDE_INLINE const __m128 *halves_at(const void *rows, int32_t i) { return (const __m128 *)rows + 2 * (size_t)(uint32_t)i; }

/* LANES rows, of which vectors k have those of k and k + 4: front halves, then back halves. */
WIDE_INLINE wide_rows rows_transposed(const __m256 from[8])
{
    __m256 front[4], back[4];
    transpose_halves(from, front);
    transpose_halves(from + 4, back);
    wide_rows out = { .omega = { (wide)front[3], (wide)back[3] } };
    for (int c = 0; c < 3; c++) {
        out.place[c] = (wide_ring)_mm256_castps_si256(front[c]);
        out.v[c] = (wide)back[c];
    }
    return out;
}

WIDE_INLINE wide_rows wide_rows_load(const void *rows, const int32_t *i)
{
    __m256 halves[8];
    for (int k = 0; k < 4; k++) {
        const __m128 *const row = halves_at(rows, i[k]), *const other = halves_at(rows, i[k + 4]);
        halves[k] = halves_of(row, other);
        halves[k + 4] = halves_of(row + 1, other + 1);
    }
    return rows_transposed(halves);
}

WIDE_INLINE wide_rows wide_rows_of_pairs(const void *rows, const int32_t *a, const int32_t *b)
{
    enum { PLACES = 0x77 }; /* whose bits, read as floats, might be denormal and slow */
    const __m256 sign = _mm256_setr_ps(-1, -1, -1, 1, -1, -1, -1, 1), zero = _mm256_setzero_ps();
    __m256 halves[8];
    for (int k = 0; k < 4; k++) {
        const __m128 *const row_a = halves_at(rows, a[k]), *const other_a = halves_at(rows, a[k + 4]);
        const __m128 *const row_b = halves_at(rows, b[k]), *const other_b = halves_at(rows, b[k + 4]);
        const __m256 front_a = halves_of(row_a, other_a), front_b = halves_of(row_b, other_b);
        const __m256i turned = _mm256_sub_epi32(_mm256_castps_si256(front_b), _mm256_castps_si256(front_a));
        const __m256 sum = _mm256_add_ps(_mm256_blend_ps(front_b, zero, PLACES), _mm256_blend_ps(front_a, zero, PLACES));
        halves[k] = _mm256_blend_ps(sum, _mm256_castsi256_ps(turned), PLACES);
        halves[4 + k] = _mm256_fmadd_ps(halves_of(row_a + 1, other_a + 1), sign, halves_of(row_b + 1, other_b + 1));
    }
    return rows_transposed(halves);
}

/* LANES rows of 8: f, q, 0, 0. */
WIDE_INLINE void wide_store_rows(row8 *rows, const wide f[3], const wide q[3])
{
    const __m256 low[4] = { (__m256)f[0], (__m256)f[1], (__m256)f[2], (__m256)q[0] };
    const __m256d zero = _mm256_setzero_pd(), of_01 = _mm256_castps_pd(_mm256_unpacklo_ps((__m256)q[1], (__m256)q[2])),
                  of_23 = _mm256_castps_pd(_mm256_unpackhi_ps((__m256)q[1], (__m256)q[2]));
    const __m256d b[4] = { _mm256_unpacklo_pd(of_01, zero), _mm256_unpackhi_pd(of_01, zero), _mm256_unpacklo_pd(of_23, zero),
                           _mm256_unpackhi_pd(of_23, zero) };
    __m256 a[4];
    transpose_halves(low, a);
    for (int k = 0; k < 4; k++) {
        rows[k] = (row8)_mm256_permute2f128_ps(a[k], _mm256_castpd_ps(b[k]), 0x20);
        rows[4 + k] = (row8)_mm256_permute2f128_ps(a[k], _mm256_castpd_ps(b[k]), 0x31);
    }
}

/* Where wide_store_rows puts the row of lane k. */
WIDE_INLINE int wide_row_slot(int k) { return k; }

/* For each set of lanes, a byte a lane (lane_tables.c). closing: which lane comes to lane k when the lanes of the set move together;
 * opening: the reverse, where lanes that are not in the set have NO_LANE. */
enum { NO_LANE = 0x80 };
extern const uint64_t lanes_closing[1 << 8], lanes_opening[1 << 8];

WIDE_INLINE __m256i lanes_of(uint64_t bytes) { return _mm256_cvtepi8_epi32(_mm_cvtsi64_si128((int64_t)bytes)); }

WIDE_INLINE size_t wide_compress(int32_t *to, uint32_t bits, const int32_t *from)
{
    const __m256i all = _mm256_loadu_si256((const __m256i_u *)from);
    _mm256_storeu_si256((__m256i_u *)to, _mm256_permutevar8x32_epi32(all, lanes_of(lanes_closing[bits])));
    return (size_t)__builtin_popcount(bits);
}

typedef struct wide_move {
    __m256i lane, is_none; /* where each lane comes from; all bits set: from nowhere */
} wide_move;

WIDE_INLINE wide_move wide_move_of(uint32_t bits, uint32_t before)
{
    const __m256i lane = _mm256_permutevar8x32_epi32(lanes_of(lanes_opening[before]), lanes_of(lanes_closing[bits]));
    return (wide_move){ lane, _mm256_srai_epi32(lane, 31) };
}

WIDE_INLINE void wide_carry(real *to, const wide_move *move, const real *from)
{
    const __m256 moved = _mm256_permutevar8x32_ps(_mm256_loadu_ps(from), move->lane);
    _mm256_storeu_ps(to, _mm256_andnot_ps(_mm256_castsi256_ps(move->is_none), moved));
}

#endif
