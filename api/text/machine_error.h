/* Tells what the machine lacks from what a job does wrong. */
#ifndef MACHINE_ERROR_H
#define MACHINE_ERROR_H

#include <stdbool.h>

/* Whether a call that failed with this errno failed for want of something of the machine (room, memory, descriptors,
 * processes, a disk that answers): the same call may succeed later. */
bool machine_error_is(int error);

#endif
