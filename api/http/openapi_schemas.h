/* The part of the OpenAPI document that follows from the rows of inputs and results: schemas that stand at the end of its
 * components, behind a line that says so. All before that line is kept by hand. */
#ifndef OPENAPI_SCHEMAS_H
#define OPENAPI_SCHEMAS_H

#include <jansson.h>

#include "text_buffer.h"

/* {name: schema}. New reference; NULL: no memory. */
json_t *openapi_schemas(void);

/* The document with these schemas in the place of those that it has. False: it has no such line, or there is no memory; `out`
 * is then of no use. */
bool openapi_write(const char *document, size_t length, text_buffer *out);

/* All of a file, to be cleared; false: errno says why not. */
bool openapi_read(int file, text_buffer *document);
/* `reposed openapi FILE`: the file itself, in one step. False: standard error says why not. */
bool openapi_file_update(const char *path);

#endif
