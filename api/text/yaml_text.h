/* YAML as JSON values and back, by libyaml. */
#ifndef YAML_TEXT_H
#define YAML_TEXT_H

#include <jansson.h>

#include "text_buffer.h"

/* One document without anchors and tags, whose keys are texts that stand once in their mapping. New reference; NULL: no memory,
 * or something that is not of this kind, in *line (from 1). */
json_t *yaml_read(const char *text, size_t length, int *line);
/* The members of an object, each line behind so many spaces, such that readers of YAML 1.1 and 1.2 take it for the same. What
 * is short stands on one line. False: no memory, or the text is full. */
bool yaml_write_members(text_buffer *out, const json_t *object, int indent);

#endif
