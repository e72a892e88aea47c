/* The job folder as a worker finds and leaves it; from here on it is the working directory. */
#ifndef RUN_FOLDER_H
#define RUN_FOLDER_H

#include <stdbool.h>

#include "event_log.h"

/* Makes the folder when it isn't there, enters it and takes its event log: no other worker can work in it now.
 * Leftovers of a worker that died while writing are removed. */
bool run_folder_enter(const char *folder, event_log *events);

/* In the folder: its spec.json says the same as params, a canonical spec. */
bool run_folder_is_of(const char *params);

/* Makes the folder that of the run `params` (canonical spec). What another run has left there is removed: it could
 * not be told from this run's. */
bool run_folder_claim(const char *params, event_log *events);

#endif
