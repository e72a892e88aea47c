/* The core's own check of a definition: the last line of defence, so that no caller can make it divide by zero. */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include "dem_types.h"

/* Completes the clusters. Errors: DEM_BAD_PARAMETER. */
dem_status parameters_complete(dem_scene_definition *definition);

#endif
