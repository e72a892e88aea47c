/* Forces of all contacts in reach: each contact writes its own row, then each sphere sums its rows in order. */
#ifndef CONTACT_FORCES_H
#define CONTACT_FORCES_H

#include "neighbor_list.h"

/* Contact forces at the positions of this step, each into its own row of its list; updates what contacts
 * remember. dt: s, the step since the last call. Returns the largest overlap, m. */
double contact_forces_between_spheres(contact_list *pairs, const spheres *spheres, const dem_contact_parameters *contact, double dt,
                                      int threads);
/* spheres->load of all from `from` on. */
void contact_forces_sum(const neighbor_list *list, spheres *spheres, size_t from, int threads);

/* Force (N), 0, moment about the centre (N m), 0 of one sphere's contacts, from their rows: forces with the sign of the
 * end. One sum after the other: rows of contacts in reach that do not touch, whose number depends on when the list was
 * made, add zeros. Whole groups of ends, the last filled up with rows of zeros: almost every sphere has one, so that the processor
 * foresees the end of the loop. */
static inline row8 contact_forces_of(const neighbor_list *list, size_t i)
{
#define AS_SECOND                                                                                                                  \
    {                                                                                                                              \
        -1, -1, -1, 0, 1, 1, 1, 0                                                                                                  \
    }
#define AS_FIRST                                                                                                                   \
    {                                                                                                                              \
        1, 1, 1, 0, 1, 1, 1, 0                                                                                                     \
    }
    static const row8 sign[2 * ENDS_A_GROUP] = { AS_SECOND, AS_SECOND, AS_SECOND, AS_SECOND, AS_SECOND, AS_SECOND,
                                                 AS_SECOND, AS_SECOND, AS_FIRST,  AS_FIRST,  AS_FIRST,  AS_FIRST,
                                                 AS_FIRST,  AS_FIRST,  AS_FIRST,  AS_FIRST };
#undef AS_SECOND
#undef AS_FIRST
    const char *restrict rows = (const char *)list->rows;
    row8 sum = { 0 };
    int32_t second = list->ends_second[i]; /* of the ends ahead */
    for (size_t k = list->ends_start[i]; k < list->ends_start[i + 1]; k += ENDS_A_GROUP, second -= ENDS_A_GROUP) {
        const uint32_t *restrict end = list->ends + k;
        const row8 *restrict own = sign + ENDS_A_GROUP - (second < 0 ? 0 : second < ENDS_A_GROUP ? second : ENDS_A_GROUP);
        __asm__("" : "+r"(own)); /* else gcc works out each of the eight addresses anew */
        for (int m = 0; m < ENDS_A_GROUP; m++) sum = row8_fused(*(const contact_row *)(rows + end[m]), own[m], sum);
    }
    return sum;
}

#endif
