/* The walls of a run as a surface that ParaView shows beside its snapshots: XML of VTK, PolyData, with what turns or rises where
 * it is at this moment. Each cell says which part it is of (walls_part); the field drum_angle says how far the drum has turned. */
#ifndef WALLS_FILE_H
#define WALLS_FILE_H

#include <stdbool.h>

#include "dem.h"

typedef enum walls_part {
    WALLS_SHELL, /* of drum, cylinder or tube */
    WALLS_END,   /* of a closed drum, or a cylinder's floor */
    WALLS_LIFTER,
    WALLS_PLATE,
    WALLS_RIM
} walls_part;

/* Writes walls.vtp anew. */
bool walls_file_write(const dem_scene *scene, const dem_scene_definition *definition, bool is_mirrored);

#endif
