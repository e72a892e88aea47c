#ifndef NEIGHBOR_PICK_H
#define NEIGHBOR_PICK_H

#include "neighbor_list.h"

/* Makes the inner list for list->safe_steps steps from now. Errors: DEM_NO_MEMORY. */
dem_status neighbor_list_pick(neighbor_list *list, spheres *s, const container *vessel, const dem_contact_parameters *contact,
                              double time_step, int threads);

#endif
