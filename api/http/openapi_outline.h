#ifndef OPENAPI_OUTLINE_H
#define OPENAPI_OUTLINE_H

#include <jansson.h>

/* base: of the addresses, "http://host:port". New reference; NULL: no memory. */
json_t *openapi_outline(const char *base);

#endif
