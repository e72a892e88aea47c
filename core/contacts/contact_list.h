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

/* For which contacts a list has constants, the numbers that do not change from step to step. NONE: for no contact (the list of the
 * pick before keeps only spheres and histories). ALL: one set for all contacts, because they are alike. EACH: a set for
 * each contact. */
typedef enum contact_constants { CONSTANTS_OF_NONE, CONSTANTS_OF_ALL, CONSTANTS_OF_EACH } contact_constants;

/* What a law is made of for the two materials of a contact, where not all contacts have the same. Of the damped laws: k_n, k_t,
 * damping and lag of damped_law. Of Walton & Braun's: K1, K_T0, K2 (or S, where unloading is variable), latch_damping_of, and K_T0
 * over a step. */
enum { LAW_K_N, LAW_K_T, LAW_DAMPING, LAW_LAG, LAW_PUSH, LAW_NUMBERS, LAW_K_2 = LAW_DAMPING, LAW_LATCH = LAW_LAG };

enum { COHESION_NUMBERS = 3 }; /* what they are of each law: contact_constants.c */
enum { CONSTANTS_OF_ANY = 4, CONSTANTS_OF_ROLLING = 2 };
enum { CONTACT_CONSTANTS = CONSTANTS_OF_ANY + LAW_NUMBERS + COHESION_NUMBERS + CONSTANTS_OF_ROLLING };

/* What contacts of a list may have beside the rest: then it has the arrays for it. */
enum { CONTACTS_ROLL = 1, CONTACT_LAWS_DIFFER = 2, CONTACTS_COHERE = 4 };

typedef struct contact_list {
    bool has_rolling; /* contacts resist rolling; else the arrays that only rolling friction needs are NULL */
    bool laws_differ; /* from contact to contact in the numbers of the law; else these arrays are NULL */
    bool coheres;     /* some contacts do; likewise */
    contact_constants constants;
    /* Arrays are (capacity), a multiple of BLOCK. The slots from count to the end of the block are padding: a pair of spheres
     * that exist, whose result is never read. */
    size_t count, capacity;
    int32_t *first;  /* sphere index */
    int32_t *second; /* sphere index, or that of the wall */
    /* The contacts' histories: an array for each number of contact_history. */
    union {
        real *memory[CONTACT_NUMBERS];
        struct {
            real *t[3];
            real *t_star;
            real *alpha_0;
            real *roll[3];
        };
    };
    /* The constants, (constant_capacity); last those that not every list needs. With CONSTANTS_OF_ALL an array has one
     * block, which serves every block of contacts. A new constant is declared here and set in contact_constants.c (pairs) and
     * wall_reach.c (walls). */
    size_t constant_capacity;
    union {
        real *constant[CONTACT_CONSTANTS];
        struct {
            real *friction;     /* mu */
            real *first_radius; /* m, at full size */
            real *root_mass; /* kg^(1/2), root of the effective mass m_i m_j/(m_i + m_j); of the first's where the other is fixed */
            real *radius;    /* m, effective: R_i R_j/(R_i + R_j), of the first alone to a wall */
            real *law[LAW_NUMBERS];
            real *cohesion[COHESION_NUMBERS];
            real *rolling_friction; /* mu_r */
            real *rolling_root;     /* kg^(1/2): root of the inertia about the contact over R*^2 (contact_constants.c) */
        };
    };
    bool ends_differ;   /* the two spheres of a contact may get different moments: each has a row of its own */
    damped_law damped;  /* its coefficients for the list's materials, if the law is a damped one */
    real latch_damping; /* latch_damping_of, if the law is Walton & Braun's */
    contact_row *row;   /* (capacity) lists of walls only: the force and moment of each contact in the last step */
} contact_list;

_Static_assert(offsetof(contact_list, roll) - offsetof(contact_list, memory)
                   == (CONTACT_NUMBERS - NUMBERS_OF_ROLLING) * sizeof(real *),
               "arrays stand in the order of contact_history");
_Static_assert(offsetof(contact_list, law) - offsetof(contact_list, constant) == CONSTANTS_OF_ANY * sizeof(real *),
               "the constants of every list are counted");
_Static_assert(offsetof(contact_list, rolling_friction) - offsetof(contact_list, constant)
                   == (CONTACT_CONSTANTS - CONSTANTS_OF_ROLLING) * sizeof(real *),
               "every constant is counted");

/* How many arrays of histories the list has, and whether it has that of a constant. */
static inline int contact_list_numbers(const contact_list *list)
{
    return list->has_rolling ? CONTACT_NUMBERS : CONTACT_NUMBERS - NUMBERS_OF_ROLLING;
}
static inline bool contact_list_keeps(const contact_list *list, int constant)
{
    if (constant < CONSTANTS_OF_ANY) return true;
    if (constant < CONSTANTS_OF_ANY + LAW_NUMBERS) return list->laws_differ;
    return constant < CONTACT_CONSTANTS - CONSTANTS_OF_ROLLING ? list->coheres : list->has_rolling;
}
/* Index, in the arrays of constants, of the first constant of the block of contacts that begins at `start`. */
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
/* extras: CONTACTS_ROLL and what is beside it, added. */
dem_status contact_list_init(contact_list *list, int extras, contact_constants constants);
static inline int contact_list_extras(const contact_list *list)
{
    return (list->has_rolling ? CONTACTS_ROLL : 0) + (list->laws_differ ? CONTACT_LAWS_DIFFER : 0)
           + (list->coheres ? CONTACTS_COHERE : 0);
}
void contact_list_clear(contact_list *list);
/* Room for count contacts; what was in the list is lost. */
dem_status contact_list_reserve(contact_list *list, size_t count);
/* Fills the padding, the slots from count up to the next whole block, with the pair (first, second). Its result may be NaN, as
 * its radii may be zero, and is never read. */
void contact_list_pad(contact_list *list, int32_t first, int32_t second);
/* Sets the history of a contact to zeros, that of a contact which has just begun. */
void contact_list_forget(contact_list *list, size_t slot);
contact_history contact_list_history(const contact_list *list, size_t slot);
void contact_list_set_history(contact_list *list, size_t slot, const contact_history *history);
/* The first copies one contact: its spheres, its history and, with CONSTANTS_OF_EACH, its constants. The second copies the one set
 * of constants of CONSTANTS_OF_ALL. `to` has room. */
void contact_list_copy(contact_list *to, size_t slot, const contact_list *from, size_t k);
void contact_list_copy_constants(contact_list *to, const contact_list *from);
/* Exchanges the spheres and the histories of two lists; their constants stay. */
void contact_list_swap(contact_list *a, contact_list *b);
/* Gives the contacts from..to-1 the histories that they have in `before` (same first, same second); a contact that is not there
 * begins with zeros. */
void contact_list_carry(contact_list *list, const contact_list *before, size_t from, size_t to);

#endif
