/* `repose calibrate`: measures how fast this machine computes, in a second or two, for the estimates of `repose check` and
 * of the daemon. */
#ifndef CALIBRATE_H
#define CALIBRATE_H

#include <stdbool.h>

#include "calibration.h"

/* The calibration kept in `folder`, measured anew and kept there where there is none of this processor and this program.
 * folder NULL: in ./data where that is a folder, else in the user's cache. False: it could not be measured (said on
 * stderr); *machine is then the built-in one. What was measured but can't be kept is only warned of. */
bool calibrate(const char *folder, calibration *machine, bool *is_new);

/* Of the same machine and program as before? */
bool calibrate_is_current(const calibration *machine);

#endif
