/* The OpenAPI document in the version before, 3.0, for programs that read no other. What 3.0 can't say is left out, so that
 * its schemas let through all that those of 3.1 do, and sometimes more. */
#ifndef OPENAPI_DOWN_H
#define OPENAPI_DOWN_H

#include <jansson.h>

/* Changes the document in its place. Parameters of a path stand in its operations afterwards. */
void openapi_turn_down(json_t *document);

#endif
