/* JSON text read with the traps closed (no member twice, nothing after the document, no number that turns into 0
 * unnoticed) and written for people: 0.1 and not 0.10000000000000001. */
#ifndef JSON_TEXT_H
#define JSON_TEXT_H

#include <jansson.h>

#include "problem.h"

/* Once, before there are threads: json_text_load then misses no refusal of memory within the parser. */
void json_text_watch_memory(void);

/* New reference, or NULL and one problem (pointer "") that names line and column. */
json_t *json_text_load(const char *text, size_t length, problem_list *problems);

/* Indented, members in their order, every number in the fewest digits that read back as the same double; ends with
 * a line end. To be freed; NULL: document is NULL, or no memory. */
char *json_text_write(const json_t *document);
/* A value as it stands in such a text, so many objects and lists deep: from its first character to its last. */
char *json_text_write_within(const json_t *value, int depth);

/* New reference; NaN and infinities become null. */
json_t *json_real_or_null(double number);

#endif
