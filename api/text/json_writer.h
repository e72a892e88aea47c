/* JSON written straight into a buffer, in the form in which answers are sent: without spaces, reals with up to 15 digits. For
 * what is long, or asked for often: a tree of values that is then written and freed takes some six times as long. */
#ifndef JSON_WRITER_H
#define JSON_WRITER_H

#include <jansson.h>
#include <stdbool.h>

#include "text_buffer.h"

/* A value that is there already. False: there is none, or no memory. */
bool json_write(text_buffer *out, const json_t *value);

void json_write_string(text_buffer *out, const char *text);
void json_write_real(text_buffer *out, double number); /* of a finite number, as it is read back: with a point or an exponent */
/* Only a number of few decimal places, as most that people give are; false: it is not one, and nothing was written. */
bool json_write_short(text_buffer *out, double number);
void json_write_integer(text_buffer *out, int64_t number);

#endif
