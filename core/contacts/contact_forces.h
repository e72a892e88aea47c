/* Forces of all contacts between spheres in reach, and each sphere's sums over them. */
#ifndef CONTACT_FORCES_H
#define CONTACT_FORCES_H

#include "contact_block.h"
#include "leap_frog.h"
#include "neighbor_list.h"

/* Computes the forces of all contacts between spheres at the places of now, adds them and those of the walls to the spheres'
 * loads, and updates the contacts' histories. dt: s, the step since the last call. Returns the largest overlap, m, of the
 * contacts that were computed.
 *
 * walls: contacts with walls are computed on the way, while their spheres are in the cache. NULL: they have been computed
 * (contact_forces_with_walls), and their rows are only added.
 *
 * Each load is one running sum, over contacts with spheres in the list's order and then over those with walls. How many
 * contacts are listed that do not touch depends on when the list was made; they add zeros.
 *
 * leap: each single sphere takes its step as soon as its load is complete, while both are in the cache. strayed: becomes what
 * spheres_advance returns for these spheres. NULL: no sphere moves, and strayed becomes zeros. */
double contact_forces_between_spheres(neighbor_list *list, spheres *spheres, const container *walls,
                                      const dem_contact_parameters *contact, double dt, const leap_frog *leap, vector4 *strayed);

/* ---- the same block by block, for waves, which have several steps under way at once (wave.c) ---- */

/* What one part finds. Each result is in a cache line of its own, so that threads do not wait for each other's writes. */
typedef struct part_result {
    _Alignas(ALIGNMENT) uint64_t ticks; /* of the processor's clock, spent on the part: it decides shares, never results */
    double largest;                     /* m, the largest overlap */
    vector4 strayed;                    /* m/s, what spheres_advance returned for spheres that moved early */
} part_result;

/* What one step has to do: the arguments of contact_forces_between_spheres. */
typedef struct pair_work {
    neighbor_list *list;
    spheres *spheres;
    const container *walls; /* NULL: the contacts with walls have been computed */
    const dem_contact_parameters *contact;
    double dt;
    const leap_frog *leap; /* NULL: no sphere moves early */
    int front_copy;        /* the set of copies that this step reads: spheres.front_copy at its beginning */
    part_result part[MOST_PARTS];
} pair_work;

/* The place that one part has reached in one step. */
typedef struct list_cursor {
    const pair_work *work;
    int part;
    size_t next, end; /* blocks: the next one, and the one behind the part's last */
    size_t across;    /* how many of the part's blocks with contacts across it has passed: contact_part.across */
    size_t complete;  /* the part's first sphere whose load is not complete yet */
    size_t walls;     /* the part's first contact with a wall that has not been computed yet */
    size_t walls_end; /* such contacts from here on are not to be computed (yet) */
    size_t shared;    /* index into contact_parts.shared: the next sphere whose row is to be copied for other parts */
    contact_block *block;
    wide largest;    /* m, the largest overlap in each lane */
    vector4 strayed; /* m/s, as in part_result */
} list_cursor;

/* Sets all but the parts' results. */
void pair_work_begin(pair_work *work, neighbor_list *list, spheres *spheres, const container *walls,
                     const dem_contact_parameters *contact, double dt, const leap_frog *leap);
/* A cursor at the beginning of a part. block: scratch memory; cursors of which only one works at a time may share one. */
list_cursor list_cursor_begin(const pair_work *work, int part, contact_block *block);
/* Computes the next block, and completes the spheres that have all their contacts behind them. */
void list_cursor_next_block(list_cursor *cursor);
/* The same for a block whose first `done` contacts have been computed in this step already: they are left out. */
void list_cursor_rest_of_block(list_cursor *cursor, size_t done);
/* Completes the part's spheres before `to`, which have all their forces from other spheres: adds those of walls, computing them
 * where that is still to be done, and lets single spheres take their step if there is a leap. */
void list_cursor_complete(list_cursor *cursor, size_t to);

#endif
