/* The mean interface of a drum: the height of the bed's surface over x, in the laboratory frame, averaged over the frames that the
 * angle is measured in. Definition: core/NUMERICS.md, "Angles". */
#ifndef DEM_INTERFACE_H
#define DEM_INTERFACE_H

#include "dem.h"
#include "dem_mound.h"

/* frames: as dem_drum_results_measure takes them; measured: what that made of them. Points of the profile are those where there is a
 * height in at least half of the frames; none where there was no angle. Errors: DEM_NO_MEMORY. */
dem_status dem_drum_interface_measure(const dem_scene *scene, const double *frames, size_t count, const dem_drum_results *measured,
                                      dem_profile *interface);

#endif
