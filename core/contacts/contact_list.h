/* Contacts in reach: pairs (or sphere and wall) that touch or can touch before the list is made again, with
 * what each remembers.
 *
 * Order: by first sphere, then by second, first < second, as they lie in memory (sorting.h). Each sphere's sum over
 * its contacts therefore runs in an order that does not depend on when a list was made or on how many threads made
 * it: the same bits either way. */
#ifndef CONTACT_LIST_H
#define CONTACT_LIST_H

#include "contact_law.h"
#include "dem_types.h"
#include "wide.h"

/* What a contact gives: f on the first (N), moment about a centre (N m), 0, 0. The second has -f, and the same moment
 * where radii are all the same and nothing resists rolling: then one row serves both ends, else each has one of its own. */
typedef row8 contact_row;

/* For whom a list holds what does not change in a step: nobody (a list before: who, and what they remember, is left), all
 * contacts together since they are alike, or each. */
typedef enum contact_constants { CONSTANTS_OF_NONE, CONSTANTS_OF_ALL, CONSTANTS_OF_EACH } contact_constants;

enum { CONTACT_CONSTANTS = 5, CONSTANTS_OF_ROLLING = 1 };

typedef struct contact_list {
    bool has_rolling; /* else there are none of what is for it alone */
    contact_constants constants;
    /* (capacity) a multiple of BLOCK; slots behind count hold a pair that nobody reads */
    size_t count, capacity;
    int32_t *first;  /* sphere index */
    int32_t *second; /* sphere index, or that of the wall */
    /* contact_history, an array for each number of it */
    union {
        real *memory[CONTACT_NUMBERS];
        struct {
            real *t[3];
            real *t_star;
            real *alpha_0;
            real *roll[3];
        };
    };
    /* What does not change in a step; last what is for rolling friction alone. (constant_capacity) of all: one block, which
     * serves every other. To add one: here; contact_constants.c and wall_reach.c set them. */
    size_t constant_capacity;
    union {
        real *constant[CONTACT_CONSTANTS];
        struct {
            real *friction;     /* mu */
            real *first_radius; /* m, at full size */
            real *root_mass; /* kg^(1/2), root of the effective mass m_i m_j/(m_i + m_j); of the first's where the other is fixed */
            real *radius;    /* m, effective: R_i R_j/(R_i + R_j), of the first alone to a wall */
            real *rolling_friction; /* mu_r */
        };
    };
    bool ends_differ;   /* in their moments */
    damped_law damped;  /* of the list's materials, where contacts have a damped law */
    real latch_damping; /* likewise, where Walton & Braun's: latch_damping_of */
    contact_row *row;   /* of walls alone: what each contact gave at the last step */
} contact_list;

_Static_assert(offsetof(contact_list, roll) - offsetof(contact_list, memory)
                   == (CONTACT_NUMBERS - NUMBERS_OF_ROLLING) * sizeof(real *),
               "arrays stand in the order of contact_history");
_Static_assert(offsetof(contact_list, rolling_friction) - offsetof(contact_list, constant)
                   == (CONTACT_CONSTANTS - CONSTANTS_OF_ROLLING) * sizeof(real *),
               "every constant is counted");

/* How many of the arrays the list has. */
static inline int contact_list_numbers(const contact_list *list)
{
    return list->has_rolling ? CONTACT_NUMBERS : CONTACT_NUMBERS - NUMBERS_OF_ROLLING;
}
static inline int contact_list_constants(const contact_list *list)
{
    return list->has_rolling ? CONTACT_CONSTANTS : CONTACT_CONSTANTS - CONSTANTS_OF_ROLLING;
}
/* Where the constants of the block at `start` are in their arrays. */
static inline size_t constants_of(const contact_list *list, size_t start)
{
    return list->constants == CONSTANTS_OF_ALL ? 0 : start;
}

/* Of a damped law: what its springs and dashpots are made of at a time step of dt, between particles or to a wall
 * (law_damped_springs.c). */
damped_law damped_law_of(const dem_contact_parameters *contact, bool is_wall, double dt);
/* Of Walton & Braun's: c_n of an effective mass of 1 kg, 2 zeta sqrt(K2); with variable unloading, K2 is that of the hardest
 * impact. */
static inline real latch_damping_of(const dem_contact_parameters *c)
{
    return (real)(2 * c->latch_damping * sqrt(c->stiffness) / c->restitution);
}
dem_status contact_list_init(contact_list *list, bool has_rolling, contact_constants constants);
void contact_list_clear(contact_list *list);
/* Room for count contacts; what was in the list is lost. */
dem_status contact_list_reserve(contact_list *list, size_t count);
/* Fill the slots from count up to the next whole block with a pair whose result nobody reads: it may have no radius, so
 * there may be NaN in it. */
void contact_list_pad(contact_list *list, int32_t first, int32_t second);
void contact_list_forget(contact_list *list, size_t slot);
contact_history contact_list_history(const contact_list *list, size_t slot);
void contact_list_set_history(contact_list *list, size_t slot, const contact_history *history);
/* Who, what they remember and the constants of each; of all: the latter once for the whole list. Both have room for it. */
void contact_list_copy(contact_list *to, size_t slot, const contact_list *from, size_t k);
void contact_list_copy_constants(contact_list *to, const contact_list *from);
/* Exchanges who and what they remember. */
void contact_list_swap(contact_list *a, contact_list *b);
/* Copy the histories of the contacts from..to-1 from the list before (same first, same second). */
void contact_list_carry(contact_list *list, const contact_list *before, size_t from, size_t to);

#endif
