/* What is left on the flat floor of a vessel that has drained: the slope of its surface down to the orifice. */
#ifndef DRAINED_H
#define DRAINED_H

#include "scene.h"

/* m: of a place from the axis, or from the middle of a slot. */
double distance_from_middle(const dem_scene *scene, const double x[3]);
/* m3: of a cluster's sphere its share of the cluster. */
double volume_of_sphere(const dem_scene *scene, size_t i);
/* angle_deg: mean over 16 sectors of the angle of a line through the surface, and of the pit with straight sides from the edge of the
 * orifice up that has the volume below the surface. NaN: a hopper, or too few particles. Errors: DEM_NO_MEMORY. */
dem_status drained_measure(const dem_scene *scene, double angle_deg[2]);

#endif
