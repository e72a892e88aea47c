/* `repose calibrate`: measures how fast this machine computes, in a second or two, for the estimates of `repose check` and
 * of the daemon. */
#ifndef CALIBRATE_H
#define CALIBRATE_H

#include <stdbool.h>

#include "calibration.h"

/* Sets *machine to the calibration of this processor and program. It is looked for in `folder`, then in the user's cache, from where
 * it is copied; else it is measured, and kept in both. One that was measured in part, for want of time, is kept in the folder
 * alone. folder NULL: ./data where there is such a folder, else the cache alone. False: it could not be measured (stderr says
 * why), and *machine is the built-in one. A calibration that can't be kept is only warned of. */
bool calibrate(const char *folder, calibration *machine, bool *is_new);

/* Of the same machine and program as before? */
bool calibrate_is_current(const calibration *machine);

#endif
