/* JSON Pointer, RFC 6901: "/inputs/particles/0/diameter". */
#ifndef JSON_POINTER_H
#define JSON_POINTER_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

enum { JSON_POINTER_SIZE = 256 };

/* Begins with "/", and every ~ is followed by 0 or 1. */
bool json_pointer_is_valid(const char *pointer);
/* Borrowed; NULL: nothing is there. "" is the document itself. */
json_t *json_pointer_find(const json_t *document, const char *pointer);
/* Puts the value there. What lies on the way is copied, what lies beside it is not: documents that share it with this one
 * stay as they are. Objects on the way that are missing are made; entries of lists must be there. False:
 * the way leads through something that is neither, or memory is out; the document may have got empty objects. */
bool json_pointer_set(json_t *document, const char *pointer, const json_t *value);
/* Appends "/" and the name, its ~ and / escaped, to a pointer of JSON_POINTER_SIZE; false: it doesn't fit. */
bool json_pointer_append(char *pointer, const char *name);
/* Is `pointer` at `place` or below it? */
bool json_pointer_is_within(const char *pointer, const char *place);

#endif
