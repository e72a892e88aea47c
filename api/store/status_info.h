/* The statusInfo document of OGC API - Processes, with what a list of runs needs besides. */
#ifndef STATUS_INFO_H
#define STATUS_INFO_H

#include "store.h"
#include "text_buffer.h"

/* The document as it is sent; base stands before its addresses. */
void status_info_write(text_buffer *out, const job_record *job, const char *base);
/* The same as a value, its addresses without a base. New reference; NULL: no memory. */
json_t *status_info(const job_record *job);
json_t *link_to(const char *rel, const char *type, const char *href); /* new reference */

#endif
