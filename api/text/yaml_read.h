/* YAML as documents of this service are written: block and flow style, plain and quoted texts, folded and literal ones,
 * comments. No anchors, tags, directives, several documents or keys that are not texts. */
#ifndef YAML_READ_H
#define YAML_READ_H

#include <jansson.h>

/* New reference; NULL: no memory, or something that is not of this kind, in *line (from 1). */
json_t *yaml_read(const char *text, int *line);

#endif
