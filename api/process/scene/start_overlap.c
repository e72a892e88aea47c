#include "start_overlap.h"

#include <math.h>
#include <stdlib.h>

/* Levels that are told apart: diameters of 5e-10 m to 2e9 m. What lies beyond shares the outermost. */
enum { LEAST_LEVEL = -31, LEVELS = 63 };

typedef struct overlap_search {
    placed_sphere *spheres; /* (count) in order of levels, cells and particles */
    size_t count;
    double period, most;
    double cell_size[LEVELS]; /* m, the largest diameter of the level; 0: it has no sphere */
    placed_pair *pairs;
    size_t room, found;
} overlap_search;

/* --- cells --- */

/* No sphere of the level is wider than a cell, so those that touch lie in neighbouring ones. */
static double cell_size(const overlap_search *search, int level) { return search->cell_size[level - LEAST_LEVEL]; }

static int level_of(const placed_sphere *s)
{
    const int level = ilogb(2.0 * s->radius), last = LEAST_LEVEL + LEVELS - 1;
    return level < LEAST_LEVEL ? LEAST_LEVEL : level > last ? last : level;
}

/* How many cells the periodic axis is divided into. */
static int64_t cells_of_period(const overlap_search *search, int level)
{
    const double fit = floor(search->period / cell_size(search, level));
    return fit < 1.0 ? 1 : (int64_t)fit;
}

static void find_cell(const overlap_search *search, const placed_sphere *s, int level, int64_t cell[3])
{
    for (int c = 0; c < 3; c++) cell[c] = (int64_t)floor(s->x[c] / cell_size(search, level));
    if (!(search->period > 0.0)) return;
    const int64_t cells = cells_of_period(search, level);
    const double turns = s->x[2] / search->period, within = turns - floor(turns);
    cell[2] = (int64_t)(within * (double)cells);
    if (cell[2] >= cells) cell[2] = cells - 1;
}

static int compare_cells(const placed_sphere *s, int level, const int64_t cell[3])
{
    if (s->level != level) return s->level > level ? 1 : -1;
    for (int c = 0; c < 3; c++)
        if (s->cell[c] != cell[c]) return s->cell[c] > cell[c] ? 1 : -1;
    return 0;
}

static int in_order(const void *a, const void *b)
{
    const placed_sphere *p = a, *q = b;
    const int cells = compare_cells(p, q->level, q->cell);
    return cells ? cells : (p->particle > q->particle) - (p->particle < q->particle);
}

/* The first sphere in that cell or behind it. */
static size_t first_in(const overlap_search *search, int level, const int64_t cell[3])
{
    size_t low = 0, high = search->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_cells(&search->spheres[middle], level, cell) < 0) low = middle + 1;
        else high = middle;
    }
    return low;
}

/* --- pairs --- */

/* Of two particles one pair, however many of their spheres overlap. */
static void add_pair(overlap_search *search, const placed_sphere *a, const placed_sphere *b, double distance, double most)
{
    const double overlap = a->radius + b->radius - distance;
    const bool first = a->particle < b->particle;
    placed_pair pair = { .low = first ? a->particle : b->particle,
                         .high = first ? b->particle : a->particle,
                         .overlap = overlap,
                         .most = most,
                         .order = { fmin(a->x[0], b->x[0]), fmax(a->x[0], b->x[0]) } };
    size_t k = 0;
    while (k < search->found && (search->pairs[k].low != pair.low || search->pairs[k].high != pair.high)) k++;
    if (k == search->found) search->pairs[search->found++] = pair;
    else if (overlap > search->pairs[k].overlap) search->pairs[k] = pair;
}

/* Sphere i against the spheres of one row of cells, from `first` to `last` along z. Of the same level each pair comes once. */
static void meet_row(overlap_search *search, size_t i, int level, const int64_t first[3], int64_t last)
{
    const int64_t behind[3] = { first[0], first[1], last + 1 };
    const placed_sphere *a = &search->spheres[i];
    size_t j = first_in(search, level, first);
    const size_t end = first_in(search, level, behind);
    if (level == a->level && j <= i) j = i + 1;
    for (; j < end && search->found < search->room; j++) {
        const placed_sphere *b = &search->spheres[j];
        double z = a->x[2] - b->x[2];
        if (search->period > 0.0 && fabs(z) > 0.5 * search->period) z -= search->period * round(z / search->period);
        const double x = a->x[0] - b->x[0], y = a->x[1] - b->x[1], r2 = x * x + y * y + z * z;
        const double most = search->most * 2 * fmin(a->radius, b->radius), least = a->radius + b->radius - most;
        if (r2 < least * least && a->particle != b->particle) add_pair(search, a, b, sqrt(r2), most);
    }
}

/* Sphere i against the cells around it in the grid of its own level or a coarser one. */
static void meet_level(overlap_search *search, size_t i, int level)
{
    int64_t at[3];
    find_cell(search, &search->spheres[i], level, at);
    const int64_t cells = search->period > 0.0 ? cells_of_period(search, level) : INT64_MAX;
    const bool all = cells <= 3, wraps = search->period > 0.0 && !all;
    for (int64_t x = at[0] - 1; x <= at[0] + 1; x++)
        for (int64_t y = at[1] - 1; y <= at[1] + 1; y++) {
            const int64_t low[3] = { x, y, all ? 0 : wraps && at[2] == 0 ? 0 : at[2] - 1 }, start[3] = { x, y, 0 };
            const int64_t before_first[3] = { x, y, cells - 1 };
            meet_row(search, i, level, low, all || (wraps && at[2] == cells - 1) ? cells - 1 : at[2] + 1);
            if (wraps && at[2] == 0) meet_row(search, i, level, before_first, cells - 1);
            if (wraps && at[2] == cells - 1) meet_row(search, i, level, start, 0);
        }
}

static int from_left_to_right(const void *a, const void *b)
{
    const placed_pair *p = a, *q = b;
    for (int k = 0; k < 2; k++)
        if (p->order[k] != q->order[k]) return p->order[k] > q->order[k] ? 1 : -1;
    if (p->low != q->low) return p->low > q->low ? 1 : -1;
    return (p->high > q->high) - (p->high < q->high);
}

size_t start_overlaps_find(placed_sphere *spheres, size_t count, double period, double most, placed_pair *pairs, size_t room)
{
    overlap_search search = { .spheres = spheres, .count = count, .period = period, .most = most, .pairs = pairs, .room = room };
    for (size_t i = 0; i < count; i++) {
        spheres[i].level = level_of(&spheres[i]);
        double *size = &search.cell_size[spheres[i].level - LEAST_LEVEL];
        *size = fmax(*size, 2.0 * spheres[i].radius);
    }
    for (size_t i = 0; i < count; i++) find_cell(&search, &spheres[i], spheres[i].level, spheres[i].cell);
    qsort(spheres, count, sizeof *spheres, in_order);
    for (size_t i = 0; i < count && search.found < room; i++) {
        /* The levels that there are, from its own on. */
        for (size_t next = i; next < count; next++) {
            const int level = spheres[next].level;
            meet_level(&search, i, level);
            const int64_t beyond[3] = { INT64_MIN, INT64_MIN, INT64_MIN };
            next = first_in(&search, level + 1, beyond) - 1;
        }
    }
    qsort(pairs, search.found, sizeof *pairs, from_left_to_right);
    return search.found;
}
