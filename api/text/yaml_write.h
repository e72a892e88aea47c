/* JSON written as YAML 1.2 that readers of YAML 1.1 take for the same: block style, short values on one line. */
#ifndef YAML_WRITE_H
#define YAML_WRITE_H

#include <jansson.h>

#include "text_buffer.h"

/* The members of an object, one a line or more, each line behind so many spaces. */
void yaml_write_members(text_buffer *out, const json_t *object, int indent);

#endif
