/* Which sphere may touch which wall before the next pick of contacts: never one too few. core/NUMERICS.md, "Neighbor
 * lists". */
#ifndef WALL_REACH_H
#define WALL_REACH_H

#include "contact_constants.h"
#include "container.h"

/* For how long, and how far a sphere may stray from its straight path meanwhile. */
typedef struct wall_outlook {
    double duration; /* s */
    double margin;   /* m */
} wall_outlook;

/* count[i]: how many walls sphere i may touch, from..to-1. */
void wall_reach_count(const spheres *spheres, const container *container, wall_outlook outlook, size_t from, size_t to,
                      uint32_t *count);
/* The same walls into the slots slot..end-1, ascending, and what the contacts need. */
void wall_reach_fill(contact_list *walls, size_t slot, size_t end, const spheres *spheres, const container *container,
                     const pair_table *table, wall_outlook outlook, size_t i);

#endif
