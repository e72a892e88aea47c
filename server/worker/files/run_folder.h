/* The job folder as a worker finds and leaves it; from here on it is the working directory. */
#ifndef RUN_FOLDER_H
#define RUN_FOLDER_H

#include <stdbool.h>

#include "event_log.h"

/* Makes the folder when it isn't there, enters it and takes its event log: no other worker can work in it now.
 * Leftovers of a worker that died while writing are removed. */
bool run_folder_enter(const char *folder, event_log *events);

/* Whose results and checkpoints the folder holds, in which the worker is. */
typedef enum folder_owner {
    FOLDER_OURS,
    FOLDER_OURS_BY_CHECKPOINT, /* spec.json is damaged, but there is a checkpoint of this run */
    FOLDER_OF_ANOTHER,         /* or of nobody */
    FOLDER_UNREADABLE          /* now; logged */
} folder_owner;

/* params: the canonical spec. brief: what a checkpoint carries of it. */
folder_owner run_folder_owner(const char *params, const char *brief);

/* Makes the folder, of this owner, that of the run `params`. What another run has left there is removed: it could not be
 * told from this run's. */
bool run_folder_claim(folder_owner owner, const char *params, event_log *events);

/* The folder for the checkpoints of all beds but the first, and the end of these. */
bool run_folder_add_beds(void);
void run_folder_empty_beds(void);

#endif
