/* Cohesion of a block of contacts, LANES at a time: what pulls beside the spring of any law (core/NUMERICS.md, "Cohesion"). JKR is
 * no such part, but a spring of its own (law_damped_springs.c); both use the mark that a contact is joined. */
#include "contact_block.h"

/* A contact that holds together where nothing overlaps, or did a step ago, has an alpha_0 that is not 0: where a latch has set none,
 * this. It is below 0, so that for the latching spring it is as none. */
#define JOINED ((real)-1e-30)

/* Whether a contact was joined a step ago; to be asked before a law changes alpha_0. */
static void recall(contact_block *restrict block, const real *restrict alpha_0)
{
    for (int k = 0; k < BLOCK; k++) block->joined[k] = alpha_0[k] != 0;
}

void contact_block_recall(contact_block *block, const contact_list *list, size_t start) { recall(block, list->alpha_0 + start); }

static void mark(contact_block *block, contact_list *list, size_t start)
{
    real *restrict alpha_0 = list->alpha_0 + start;
    for (int k = 0; k < BLOCK; k++) {
        const real kept = alpha_0[k] > 0 ? alpha_0[k] : JOINED;
        alpha_0[k] = block->joined[k] > 0 ? kept : 0;
    }
}

/* A pull of its own while they touch. */
static void pull_constantly(contact_block *restrict block, const real *restrict pull)
{
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide_mask touching = wide_exceeds(wide_load(block->overlap + k), wide_all(0));
        wide_store(block->f_n + k, wide_load(block->f_n + k) - wide_where(touching, wide_load(pull + k)));
    }
}

/* The energy density times the area in which the spheres cut each other, pi/4 alpha (2 (Ri + Rj) - alpha) (r^2 - (Ri - Rj)^2)/r^2 at
 * the distance r of their centres; in which a wall cuts a sphere, pi alpha (2 R - alpha). */
WIDE_INLINE void pull_by_section(contact_block *restrict block, const real *restrict density, const real *restrict first_radius,
                                 bool is_wall)
{
    const wide quarter_pi = wide_all((real)0.78539816339744831), pi = wide_all((real)3.14159265358979324), two = wide_all(2);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide alpha = wide_load(block->overlap + k), radii = wide_load(block->radii + k);
        const wide_mask touching = wide_exceeds(alpha, wide_all(0));
        wide area = alpha * (two * radii - alpha);
        if (is_wall) area = pi * area;
        else {
            const wide r = radii - alpha, differ = two * wide_load(first_radius + k) - radii, share = differ / r;
            area = quarter_pi * area * (wide_all(1) - share * share);
        }
        wide_store(block->f_n + k, wide_load(block->f_n + k) - wide_where(touching, wide_load(density + k) * area));
    }
}

/* The energy density times 4 pi R* alpha, or half of that at a wall. pull: N/m, their product without alpha. */
static void pull_by_overlap(contact_block *restrict block, const real *restrict pull)
{
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide alpha = wide_load(block->overlap + k);
        const wide f = wide_where(wide_exceeds(alpha, wide_all(0)), wide_load(pull + k) * alpha);
        wide_store(block->f_n + k, wide_load(block->f_n + k) - f);
    }
}

/* A bridge that formed when they touched pulls by F0 (1 - H/sqrt(H^2 + V/(pi R*))), H the gap or 0, until the gap exceeds the
 * rupture distance. pull: N, F0; width2: m2, V/(pi R*); rupture: m. */
static void pull_by_bridge(contact_block *restrict block, const real *restrict pull, const real *restrict width2,
                           const real *restrict rupture)
{
    const wide zero = wide_all(0), one = wide_all(1), tiny = wide_all(TINY_SQUARE);
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide alpha = wide_load(block->overlap + k), gap = wide_greater(-alpha, zero);
        const wide_mask holds =
            wide_both(wide_exceeds(wide_load(block->joined + k), zero), wide_exceeds(wide_load(rupture + k), gap));
        const wide joined = wide_greater(wide_where(holds, one), wide_where(wide_exceeds(alpha, zero), one));
        const wide size2 = wide_greater(wide_fused(gap, gap, wide_load(width2 + k)), tiny);
        const wide f = wide_load(pull + k) * wide_minus_product(one, gap, wide_inverse_root(size2));
        wide_store(block->joined + k, joined);
        wide_store(block->f_n + k, wide_load(block->f_n + k) - wide_where(wide_exceeds(joined, zero), f));
    }
}

void contact_block_cohere(contact_block *block, contact_list *list, size_t start, dem_cohesion_law law, bool is_wall)
{
    const size_t at = constants_of(list, start);
    const real *const number[COHESION_NUMBERS] = { list->cohesion[0] + at, list->cohesion[1] + at, list->cohesion[2] + at };
    switch (law) {
    case DEM_CONSTANT_PULL: pull_constantly(block, number[0]); break;
    case DEM_SJKR:
        if (is_wall) pull_by_section(block, number[0], NULL, true);
        else pull_by_section(block, number[0], list->first_radius + at, false);
        break;
    case DEM_SJKR2: pull_by_overlap(block, number[0]); break;
    case DEM_LIQUID_BRIDGE:
        pull_by_bridge(block, number[0], number[1], number[2]);
        mark(block, list, start);
        break;
    case DEM_JKR: mark(block, list, start); break;
    case DEM_NO_COHESION: break;
    }
}
