/* fields.hdf: fields over the cross-section, averaged over the run, that ParaView and h5py open. */
#ifndef FIELDS_FILE_H
#define FIELDS_FILE_H

#include <stdbool.h>

#include "dem.h"

/* sums: of dem_fields_add. params: the canonical spec. False: the disk, or no memory
 * (logged). */
bool fields_file_write(const dem_scene *scene, bool is_mirrored, const double *sums, const dem_scene_definition *drum,
                       const char *params);

#endif
