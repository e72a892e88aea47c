/* snapshots/NNNNNN.bin: what the page shows of a snapshot, in some 7 bytes a sphere (frame_format.h, api/FRAMES.md). */
#ifndef FRAME_FILE_H
#define FRAME_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "dem.h"

/* Written before the snapshot of that number, so that one which is told of has its frame. The same state gives the same bytes.
 * False: logged. */
bool frame_file_write(const dem_scene *scene, bool is_mirrored, int64_t number);

#endif
