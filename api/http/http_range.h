/* The Range header (RFC 9110, 14.2). One part only: several at once, other units and broken syntax are ignored, as
 * the RFC allows, and the whole is sent. */
#ifndef HTTP_RANGE_H
#define HTTP_RANGE_H

#include <stdint.h>

typedef enum http_range_kind { HTTP_RANGE_WHOLE, HTTP_RANGE_PART, HTTP_RANGE_OUTSIDE } http_range_kind;

/* header may be NULL. *offset and *length are set for HTTP_RANGE_PART alone. */
http_range_kind http_range_parse(const char *header, uint64_t size, uint64_t *offset, uint64_t *length);

#endif
