/* How the contacts between spheres are divided among threads: one part for each.
 *
 * A part has consecutive whole blocks of the list. It owns the spheres from the first sphere of its first contact on, up to
 * those that the next part owns, and it alone writes to their loads and rows. A contact that has a sphere which an earlier
 * part's block names but a later part owns is a contact across. Every later part that owns a sphere of it computes the contact
 * again, from a copy of its history: so each part has all forces on its own spheres, in the list's order, and no part
 * waits for another.
 *
 * A part reads other parts' spheres from copies of their rows (the halo), which lie behind all rows in spheres.row and
 * spheres.rest. The part that owns a sphere writes its copies. There are two sets of copies, which alternate from step to
 * step: spheres that move early in a step are written to the one set while other parts still read the other. */
#ifndef CONTACT_PARTS_H
#define CONTACT_PARTS_H

#include "contact_list.h"
#include "spheres.h"
#include "team.h"

/* Which rows a part reads for the spheres of a block: its own spheres' rows, and copies of other parts'. [0], [1]: for each of
 * the two sets of copies. */
typedef struct block_rows {
    int32_t first[2][BLOCK], second[2][BLOCK];
} block_rows;

typedef struct contact_part {
    size_t *across; /* (across_capacity) the part's blocks that have contacts across, ascending */
    size_t across_count, across_capacity;
    contact_list copies; /* of the contacts across of earlier parts that have a sphere of this part; theirs are saved */
    block_rows *rows;    /* (rows_capacity) of the blocks in `across`, then of the blocks of `copies` */
    size_t rows_capacity;
    double took;  /* ticks of the processor's clock, in all steps since the last division; the loop over a part adds to it */
    double later; /* ns by which the part begins later than an even share of the expected time would have it */
} contact_part;

typedef struct contact_parts {
    int count;
    size_t block[MOST_PARTS + 1];        /* the first block of each part; then how many there are */
    size_t sphere[MOST_PARTS + 1];       /* the first sphere that each part owns; then how many are mobile */
    size_t shared_begin[MOST_PARTS + 1]; /* where each part's spheres begin in `shared`; then how many there are */
    int32_t *shared;                     /* (mobile) spheres in contacts across, ascending; NULL before there are several parts */
    int32_t *slot;       /* (mobile) 1 + the sphere's place among its part's in `shared`; 0: the sphere is in no contact across */
    size_t most_spheres; /* mobile */
    contact_part part[MOST_PARTS];
} contact_parts;

/* most_spheres: the largest number of mobile spheres that there will ever be. */
void contact_parts_init(contact_parts *parts, size_t most_spheres);
void contact_parts_clear(contact_parts *parts);
/* Divides the pairs of a new list among `threads` threads, makes the copies of contacts across, and copies the shared rows.
 * wall_start: (mobile + 1) where each sphere's contacts with walls begin. Errors: DEM_NO_MEMORY. */
dem_status contact_parts_deal(contact_parts *parts, const contact_list *pairs, const uint32_t *wall_start, spheres *spheres,
                              int threads);
/* The first sphere of a part in a loop over n spheres. Each thread takes the spheres that its part of the contacts owns, so that
 * they stay in its core's cache; where these do not fit n or count, the shares are equal. */
static inline size_t contact_parts_begin(const contact_parts *parts, size_t n, int part, int count)
{
    return parts->count == count && parts->sphere[count] == n ? parts->sphere[part] : part_start(n, part, count);
}
/* Copies all shared rows into the front set of copies, if some row has changed since it was copied (spheres.copies_hold). */
void contact_parts_hand_out(const contact_parts *parts, spheres *spheres);
/* Copies the rows of the spheres in `shared` from *next to end-1 that are before sphere `to`. set: 0 or 1, which set of
 * copies. *next becomes the first that is left. */
static inline void contact_parts_copy_rows(const contact_parts *parts, spheres *s, int set, size_t end, size_t to, size_t *next)
{
    const size_t copies = s->first_copy + (set ? parts->shared_begin[parts->count] : 0);
    for (; *next < end && (size_t)parts->shared[*next] < to; ++*next) {
        s->row[copies + *next] = s->row[parts->shared[*next]];
        s->rest[copies + *next] = s->rest[parts->shared[*next]];
    }
}

#endif
