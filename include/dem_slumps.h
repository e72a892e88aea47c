/* The slumps or avalanches of a drum's bed one by one, which dem_slumps (dem_types.h) sums up. */
#ifndef DEM_SLUMPS_H
#define DEM_SLUMPS_H

#include "dem.h"

typedef struct dem_slump {
    double start_time, stop_time; /* s since rotation began */
    double start_deg, stop_deg;   /* direction of the centre of mass then */
} dem_slump;

/* Those that dem_drum_results_measure counts in a drum that turns at one rate, in order of time, at most `room` of them. *found: how
 * many there are. frames: (count, dem_frame_width), as there. Errors: DEM_NO_MEMORY. */
dem_status dem_drum_slumps_list(const dem_scene *scene, const double *frames, size_t count, dem_slump *slump, size_t room,
                                size_t *found);

#endif
