/* The outer list: all pairs of spheres closer than a skin, found through the cell grid and kept until displacements could
 * have brought a pair into reach that it does not have. */
#ifndef NEIGHBOR_OUTER_H
#define NEIGHBOR_OUTER_H

#include "cell_grid.h"
#include "contact_parts.h"
#include "container.h"

enum { STRETCH = 256 }; /* spheres in a row in memory */

typedef struct pair_part {
    size_t count, capacity;
    int32_t *second;
} pair_part;

typedef struct outer_list {
    bool valid;
    double skin; /* m: pairs with a smaller gap are listed */
    size_t pair_count, pair_capacity, second_capacity;
    uint32_t *start;         /* (mobile + 1) */
    int32_t *first, *second; /* (pair_capacity, second_capacity) by first, then by second; padded with a pair far apart */
    uint32_t *farthest;      /* (mobile / STRETCH + 1) for waves: the last sphere of each stretch or of a pair that begins in it */
    uint16_t *in_reach;      /* (pair_capacity / LANES) one bit for each pair: it is picked for the inner list */
    uint16_t *was_in_reach;  /* likewise, at the pick before */
    pair_part part[MOST_PARTS];
    ring_row *built_at;    /* (mobile) places when the list was made */
    double angle_at_build; /* rad: the container's angle when the list was made */
    cell_grid grid;
    int64_t builds;
} outer_list;

/* Makes an empty list of a struct of zeros. Errors: DEM_NO_MEMORY; the caller then calls outer_list_clear, too. */
dem_status outer_list_init(outer_list *list, const spheres *spheres, double skin);
void outer_list_clear(outer_list *list);
/* Makes the list from the places of now. Each thread lists the neighbors of the spheres that its part in `shares` owns. Errors:
 * DEM_NO_MEMORY. */
dem_status outer_list_build(outer_list *list, const spheres *spheres, const container *vessel, const contact_parts *shares,
                            int threads);

#endif
