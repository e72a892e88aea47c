/* picture.png and picture-96.png: the bed as it is now, for lists, reports and chat. A drum is seen along its axis, what stands from
 * the side. Spheres are shaded, and coloured by their speeds. */
#ifndef PICTURE_FILE_H
#define PICTURE_FILE_H

#include <stdbool.h>

#include "dem.h"

/* False: logged. */
bool picture_files_write(const dem_scene *scene, const dem_scene_definition *definition, bool is_mirrored);

#endif
