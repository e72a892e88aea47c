/* The interface of each frame, a height over x in the laboratory frame, as the table of frames keeps it behind the scalars:
 * one number a column of the drum; or, where a bed is so small that it never covers half of the columns, pairs of column and
 * height. Either way the same results come of it. */
#ifndef INTERFACE_H
#define INTERFACE_H

#include "dem_mound.h"
#include "density_grid.h"
#include "measure.h"

/* Numbers that a frame has for it. */
size_t interface_numbers(const dem_scene *scene);
void interface_set(const dem_scene *scene, const surface_heights *surface, double *frame);
/* rad, slope between +-D/10 of the interface averaged over the window: what a GranuDrum reports. NaN: none there. */
double interface_chord_angle(const dem_scene *scene, const frame_window *window);
/* m, deviation in time of the height of a column, averaged over those nearer than `reach` (m) to the axis; NaN: none. */
double interface_fluctuation(const dem_scene *scene, const frame_window *window, double reach);
/* The height of each of so many columns as a profile has room for, averaged over the window, and its error. Errors: DEM_NO_MEMORY. */
dem_status interface_profile(const dem_scene *scene, const frame_window *window, dem_profile *profile);

/* The interface of a frame seen in a mirror, x for -x. Errors: none. */
void interface_mirror(const dem_scene *scene, double *frame);

#endif
