/* What wide.h needs, for any processor and precision, by the compiler's vectors and plain loops: the baseline in single
 * precision, and double precision everywhere. Included by wide.h alone. */
#ifndef WIDE_ANY_H
#define WIDE_ANY_H

#ifdef DEM_DOUBLE
typedef int64_t wide_mask __attribute__((vector_size(WIDE_BYTES)));
#else
typedef int32_t wide_mask __attribute__((vector_size(WIDE_BYTES)));
#endif

WIDE_INLINE wide_mask wide_exceeds(wide a, wide b) { return (wide_mask)(a > b); }
WIDE_INLINE wide wide_select(wide_mask m, wide a, wide b) { return (wide)((m & (wide_mask)a) | (~m & (wide_mask)b)); }
WIDE_INLINE wide_mask wide_both(wide_mask m, wide_mask o) { return m & o; }
/* a where m says so, else 0. */
WIDE_INLINE wide wide_where(wide_mask m, wide a) { return (wide)(m & (wide_mask)a); }
/* -a where the sign of s is negative. */
WIDE_INLINE wide wide_times_sign(wide a, wide s) { return (wide)((wide_mask)a ^ ((wide_mask)s & (wide_mask)wide_all((real)-0.0))); }
WIDE_INLINE wide wide_greater(wide a, wide b) { return wide_select(wide_exceeds(a, b), a, b); }
WIDE_INLINE wide wide_lesser(wide a, wide b) { return wide_select(wide_exceeds(b, a), a, b); }
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
#pragma GCC unroll 8
    for (int k = 0; k < LANES; k++) bits |= (uint32_t)(m[k] & 1) << k;
    return bits;
}

typedef real wide_part __attribute__((vector_size(DOUBLES * sizeof(real)))); /* what becomes one wide_double */
typedef union wide_parts {
    wide all;
    wide_part part[HALVES];
} wide_parts;

WIDE_INLINE wide wide_from_doubles(const wide_double x[HALVES])
{
    wide_parts y;
    for (int h = 0; h < HALVES; h++) y.part[h] = __builtin_convertvector(x[h], wide_part);
    return y.all;
}
WIDE_INLINE void wide_to_doubles(wide x, wide_double to[HALVES])
{
    const wide_parts y = { x };
    for (int h = 0; h < HALVES; h++) to[h] = __builtin_convertvector(y.part[h], wide_double);
}

/* As spheres.h has them. */
typedef struct any_row {
    on_ring place[3];
    real omega_x, v[3], omega_y;
} __attribute__((aligned(8 * sizeof(real)), may_alias)) any_row;

/* Rows as arrays of LANES numbers, for whole vectors to be loaded from. */
typedef struct rows_in_lanes {
    on_ring place[3][LANES];
    real v[3][LANES], omega[2][LANES];
} __attribute__((aligned(WIDE_BYTES))) rows_in_lanes;

WIDE_INLINE wide_rows wide_rows_from(const rows_in_lanes *lanes)
{
    wide_rows out;
    memcpy(out.place, lanes->place, sizeof out.place);
    memcpy(out.v, lanes->v, sizeof out.v);
    memcpy(out.omega, lanes->omega, sizeof out.omega);
    return out;
}

WIDE_INLINE wide_rows wide_rows_load(const void *rows, const int32_t *i)
{
    const any_row *all = rows;
    rows_in_lanes lanes;
#pragma GCC unroll 8
    for (int k = 0; k < LANES; k++) {
        const any_row *row = &all[i[k]];
        for (int c = 0; c < 3; c++) {
            lanes.place[c][k] = row->place[c];
            lanes.v[c][k] = row->v[c];
        }
        lanes.omega[0][k] = row->omega_x;
        lanes.omega[1][k] = row->omega_y;
    }
    return wide_rows_from(&lanes);
}

WIDE_INLINE wide_rows wide_rows_of_pairs(const void *rows, const int32_t *a, const int32_t *b)
{
    const any_row *all = rows;
    rows_in_lanes lanes;
#pragma GCC unroll 8
    for (int k = 0; k < LANES; k++) {
        const any_row *row_a = &all[a[k]], *row_b = &all[b[k]];
        for (int c = 0; c < 3; c++) {
            lanes.place[c][k] = ring_difference(row_a->place[c], row_b->place[c]);
            lanes.v[c][k] = row_b->v[c] - row_a->v[c];
        }
        lanes.omega[0][k] = row_b->omega_x + row_a->omega_x;
        lanes.omega[1][k] = row_b->omega_y + row_a->omega_y;
    }
    return wide_rows_from(&lanes);
}

WIDE_INLINE wide_rests wide_rests_load(const void *rests, const int32_t *i)
{
    const real *all = rests;
    real omega_z[LANES] __attribute__((aligned(WIDE_BYTES))), radius[LANES] __attribute__((aligned(WIDE_BYTES)));
#pragma GCC unroll 8
    for (int k = 0; k < LANES; k++) {
        omega_z[k] = all[2 * (size_t)i[k]];
        radius[k] = all[2 * (size_t)i[k] + 1];
    }
    return (wide_rests){ wide_load(omega_z), wide_load(radius) };
}

/* LANES rows of 8: f, q, 0, 0. */
WIDE_INLINE void wide_store_rows(row8 *rows, const wide f[3], const wide q[3])
{
#pragma GCC unroll 8
    for (int k = 0; k < LANES; k++) rows[k] = (row8){ f[0][k], f[1][k], f[2][k], q[0][k], q[1][k], q[2][k], 0, 0 };
}

/* Where wide_store_rows puts the row of lane k. */
WIDE_INLINE int wide_row_slot(int k) { return k; }

WIDE_INLINE size_t wide_compress(int32_t *to, uint32_t bits, const int32_t *from)
{
    size_t n = 0;
    for (int k = 0; k < LANES; k++) { /* no branch: it could not be predicted */
        to[n] = from[k];
        n += bits >> k & 1;
    }
    return n;
}

typedef struct wide_move {
    uint32_t bits, before;
} wide_move;

WIDE_INLINE wide_move wide_move_of(uint32_t bits, uint32_t before) { return (wide_move){ bits, before }; }

WIDE_INLINE void wide_carry(real *to, const wide_move *move, const real *from)
{
    for (int k = 0; k < LANES; k++) {
        *to = move->before >> k & 1 ? *from : 0;
        from += move->before >> k & 1;
        to += move->bits >> k & 1;
    }
}

#endif
