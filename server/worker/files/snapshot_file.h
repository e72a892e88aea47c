/* One time of a run as a file that ParaView, VTK and h5py open: VTKHDF 1.0, an unstructured grid of vertices.
 * All files of a run open as one time series through snapshots.hdf.series. */
#ifndef SNAPSHOT_FILE_H
#define SNAPSHOT_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "dem.h"
#include "schedule.h"

/* Somebody may have put a symbolic link in its place since the run began: what lies behind is not ours. False: logged. */
bool snapshot_folder_is_there(void);

/* Writes snapshots/NNNNNN.hdf. bytes: of the file. The same state and params give the same bytes.
 * params: canonical spec, kept in /run. */
bool snapshot_file_write(const dem_scene *scene, bool is_mirrored, int64_t number, const char *params, int64_t *bytes);

/* Rewrites snapshots.hdf.series for the first `count` snapshots of the plan. */
bool snapshot_series_write(const schedule *plan, double time_step, int64_t count);

#endif
