/* The statusInfo document of OGC API - Processes, with what a list of runs needs besides. */
#ifndef STATUS_INFO_H
#define STATUS_INFO_H

#include "store.h"

json_t *status_info(const job_record *job);                           /* new reference; NULL: no memory */
json_t *link_to(const char *rel, const char *type, const char *href); /* new reference */

#endif
