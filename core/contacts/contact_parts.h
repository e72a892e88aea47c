/* How the contacts between spheres are dealt out to parts, one for each thread.
 *
 * A part has whole blocks of the list, and the spheres from its first contact's first on are its own, up to the next part's.
 * A contact across, of spheres that are not all the part's own, is computed again, from a copy, by every later part that has
 * a sphere in it: so each part has all the forces on its own spheres, in the list's order, and waits for none. Others'
 * spheres in such contacts it knows from copies of their rows, which their parts hand out: there are two of each in turn, so
 * that one can be written in a step that reads the other. */
#ifndef CONTACT_PARTS_H
#define CONTACT_PARTS_H

#include "contact_list.h"
#include "spheres.h"
#include "team.h"

/* Where the rows of a block's spheres are: with copies instead of those of other parts' spheres, in either turn. */
typedef struct block_rows {
    int32_t first[2][BLOCK], second[2][BLOCK];
} block_rows;

typedef struct contact_part {
    size_t *across; /* (across_capacity) its blocks with contacts across, ascending */
    size_t across_count, across_capacity;
    contact_list copies; /* of contacts that earlier parts have and remember */
    block_rows *rows;    /* (rows_capacity) of the blocks across, then of the copies' */
    size_t rows_capacity;
    double took;  /* processor's ticks, in all steps since the last deal; who runs the parts adds it */
    double later; /* ns by which it begins later than with an even share of the expected time: what parts took decides */
} contact_part;

typedef struct contact_parts {
    int count;
    size_t block[MOST_PARTS + 1];  /* the first of each part */
    size_t sphere[MOST_PARTS + 1]; /* the first of each part's own */
    size_t shared_begin[MOST_PARTS + 1];
    int32_t *shared; /* (mobile) spheres in contacts across, ascending; NULL before there are several parts */
    int32_t *slot;   /* (mobile) of each sphere: 1 + its place among the part's in `shared`; 0: not there */
    size_t most_spheres;
    contact_part part[MOST_PARTS];
} contact_parts;

/* most_spheres: mobile ones that there will ever be. */
void contact_parts_init(contact_parts *parts, size_t most_spheres);
void contact_parts_clear(contact_parts *parts);
/* Deals out the pairs of a new list. wall_start: (mobile + 1) where each sphere's contacts with walls begin. Errors:
 * DEM_NO_MEMORY. */
dem_status contact_parts_deal(contact_parts *parts, const contact_list *pairs, const uint32_t *wall_start, spheres *spheres,
                              int threads);
/* Where each part begins of work on n spheres: with its own, as last dealt out, so that they stay in its core's cache. */
static inline size_t contact_parts_begin(const contact_parts *parts, size_t n, int part, int count)
{
    return parts->count == count && parts->sphere[count] == n ? parts->sphere[part] : part_start(n, part, count);
}
/* The copies of now, where they are not those of the rows any more. */
void contact_parts_hand_out(const contact_parts *parts, spheres *spheres);
/* The copies of a turn of the spheres in `shared` from *next on that are before `to`; *next: the first of those left. */
static inline void contact_parts_copy_rows(const contact_parts *parts, spheres *s, int turn, size_t end, size_t to, size_t *next)
{
    const size_t copies = s->first_copy + (turn ? parts->shared_begin[parts->count] : 0);
    for (; *next < end && (size_t)parts->shared[*next] < to; ++*next) {
        s->row[copies + *next] = s->row[parts->shared[*next]];
        s->rest[copies + *next] = s->rest[parts->shared[*next]];
    }
}

#endif
