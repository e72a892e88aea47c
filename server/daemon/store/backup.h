/* A copy of a data folder, whole as of one moment, also while a daemon and workers are at work in it. It is a data folder itself:
 * a daemon that is started on it goes on from that moment. */
#ifndef BACKUP_H
#define BACKUP_H

#include <stdbool.h>

/* to: made, and there under this name only once it is whole. Files that never change are there under a second name where both
 * are on one file system, so they take no room. False: logged. */
bool backup_make(const char *data, const char *to);

#endif
