/* A growing piece of text with a cap. A failure (no memory, cap reached) sticks, so that a writer checks once, at the end. */
#ifndef TEXT_BUFFER_H
#define TEXT_BUFFER_H

#include <stdbool.h>
#include <stddef.h>

typedef struct text_buffer {
    char *text; /* always ends in \0 once something was added; owned */
    size_t length, capacity, limit;
    bool failed;
} text_buffer;

void text_buffer_init(text_buffer *buffer, size_t limit);
void text_buffer_clear(text_buffer *buffer);
void text_buffer_add(text_buffer *buffer, const char *text, size_t length);
void text_buffer_print(text_buffer *buffer, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_buffer_add_json_string(text_buffer *buffer, const char *text, size_t length); /* with quotes; text is UTF-8 */
/* Quoted where RFC 4180 asks, and where a semicolon or a tab would divide it. What a spreadsheet would run as a formula
 * gets an apostrophe before it, which makes it a text there; a text that is a number stays as it is. */
void text_buffer_add_csv_field(text_buffer *buffer, const char *text, size_t length);
void text_buffer_add_number(text_buffer *buffer, double value); /* shortest that reads back; "" never */

#endif
