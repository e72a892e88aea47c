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

/* Force (N), 0, moment about the centre (N m), 0 of one sphere's contacts, from their rows. Each group has its ends that
 * are second, then those that are first, filled up with rows of zeros: almost every sphere has one group, so that the
 * processor foresees the end of the loop. radius: m, now. */
static inline row8 contact_forces_of(const neighbor_list *list, size_t i, real radius)
{
    const contact_row *restrict row = list->rows;
    row8 as_second = { 0 }, as_first = { 0 }, shorter = { 0 };
    for (size_t k = list->ends_start[i]; k < list->ends_start[i + 1]; k += 2 * ENDS_A_SIDE) {
        const int32_t *restrict end = list->ends + k;
        for (int m = 0; m < ENDS_A_SIDE; m++) {
            const row8 a = row[end[m]], b = row[end[ENDS_A_SIDE + m]];
            as_second += a;
            as_first += b;
            shorter = row8_fused(a, a[ROW_HALF_OVERLAP] - (row8){ 0 }, shorter);
            shorter = row8_fused(b, b[ROW_HALF_OVERLAP] - (row8){ 0 }, shorter);
        }
    }
    const row8 force = as_first - as_second, moment = radius * (as_first + as_second) - shorter;
    return (row8){ force[0], force[1], force[2], 0, moment[4], moment[5], moment[6], 0 };
}

#endif
