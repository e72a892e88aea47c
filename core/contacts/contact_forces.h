/* Forces of all contacts between spheres in reach, and each sphere's sums over them. */
#ifndef CONTACT_FORCES_H
#define CONTACT_FORCES_H

#include "contact_block.h"
#include "leap_frog.h"
#include "neighbor_list.h"

/* Contact forces at the positions of this step, and the spheres' loads of them and of the walls' rows; updates what contacts
 * remember. dt: s, the step since the last call. Returns the largest overlap, m.
 *
 * walls: whose contacts get their rows on the way, while their spheres are in the cache. NULL: they have them
 * (contact_forces_with_walls).
 *
 * Each load is one running sum, in the list's order and then of the walls: contacts in reach that do not touch, whose
 * number depends on when the list was made, add zeros.
 *
 * leap: single spheres take their step as soon as they have all their forces, while both are in the cache; strayed: of
 * these, what spheres_advance returns. NULL: none does. */
double contact_forces_between_spheres(neighbor_list *list, spheres *spheres, const container *walls,
                                      const dem_contact_parameters *contact, double dt, const leap_frog *leap, vector4 *strayed);

/* ---- the same block by block, for whoever has several steps on their way (wave.c) ---- */

/* Each in a line of memory of its own. */
typedef struct part_result {
    _Alignas(ALIGNMENT) uint64_t ticks; /* of the processor */
    double largest;                     /* m, overlaps */
    vector4 strayed;
} part_result;

typedef struct pair_work {
    neighbor_list *list;
    spheres *spheres;
    const container *walls; /* NULL: all their contacts have their rows */
    const dem_contact_parameters *contact;
    double dt;
    const leap_frog *leap;
    int front_copy;
    part_result part[MOST_PARTS];
} pair_work;

/* How far one part has come in one step. */
typedef struct list_cursor {
    const pair_work *work;
    int part;
    size_t next, end; /* block; behind the part's last */
    size_t across;    /* blocks with contacts across passed */
    size_t complete;  /* the first sphere of its own that has not all its forces yet */
    size_t walls;     /* the first contact of its own with a wall that has no row yet; */
    size_t walls_end; /* there are none from here on */
    size_t shared;    /* the next of its own whose row others know by a copy */
    contact_block *block;
    wide largest; /* m, overlaps */
    vector4 strayed;
} list_cursor;

/* All but the parts' results. */
void pair_work_begin(pair_work *work, neighbor_list *list, spheres *spheres, const container *walls,
                     const dem_contact_parameters *contact, double dt, const leap_frog *leap);
/* At the beginning. block: where it computes; several that take turns may share one. */
list_cursor list_cursor_begin(const pair_work *work, int part, contact_block *block);
/* The forces of its next block, and then the step of spheres that have all their forces. */
void list_cursor_next_block(list_cursor *cursor);
/* The same, but for the block's first `done` contacts, which have had theirs in this step. */
void list_cursor_rest_of_block(list_cursor *cursor, size_t done);
/* Its own spheres up to `to` have all their forces from others: those from walls, and their step. */
void list_cursor_complete(list_cursor *cursor, size_t to);

#endif
