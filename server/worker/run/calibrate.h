/* `repose calibrate`: measures how fast this machine computes, in a second or two, for the estimates of `repose check` and
 * of the daemon. */
#ifndef CALIBRATE_H
#define CALIBRATE_H

#include <stdbool.h>

#include "calibration.h"

/* The calibration of `folder`; where that has none of this processor and this program, the one of the user's cache, from
 * where it is copied; where that has none either it is measured, and kept in both (in the folder alone what was measured in part, for want of time). folder NULL: ./data where that is a
 * folder, else the cache alone. False: it could not be measured (said on stderr); *machine is then the built-in one. What
 * can't be kept is only warned of. */
bool calibrate(const char *folder, calibration *machine, bool *is_new);

/* Of the same machine and program as before? */
bool calibrate_is_current(const calibration *machine);

#endif
