/* fields.hdf: fields over the cross-section of a drum, or at the outlet of a vessel, averaged over the run, that ParaView and h5py
 * open. */
#ifndef FIELDS_FILE_H
#define FIELDS_FILE_H

#include <stdbool.h>

#include "dem_flow.h"

/* sums: of dem_fields_add. params: the canonical spec. False: the disk, or no memory
 * (logged). */
bool fields_file_write(const dem_scene *scene, bool is_mirrored, const double *sums, const dem_scene_definition *drum,
                       const char *params);
/* The same at an outlet; sums: of dem_outlet_add. */
bool fields_file_write_outlet(const dem_scene *scene, const double *sums, const dem_orifice *orifice, const char *params);

#endif
