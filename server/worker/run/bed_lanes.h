/* Beds that advance side by side, each by a thread of its own while it does. */
#ifndef BED_LANES_H
#define BED_LANES_H

#include "scene_run.h"

/* Lets every bed advance for about half a second at most, as far as it may: to its end, to the next look, to a snapshot. A stop
 * ends it early, as does a bed that fails. */
void bed_lanes_advance(scene_group *group);

/* It has all the frames that the next look takes, and no step beyond them. */
bool bed_is_at_look(const scene_group *group, const scene_run *bed);

#endif
