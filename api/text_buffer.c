#include "text_buffer.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void text_buffer_init(text_buffer *buffer, size_t limit) { *buffer = (text_buffer){ .limit = limit }; }

void text_buffer_clear(text_buffer *buffer)
{
    free(buffer->text);
    *buffer = (text_buffer){ .limit = buffer->limit };
}

static bool make_room(text_buffer *buffer, size_t extra)
{
    if (buffer->failed) return false;
    const size_t needed = buffer->length + extra + 1;
    const bool fits = needed - 1 <= buffer->limit;
    if (fits && needed <= buffer->capacity) return true;
    size_t capacity = buffer->capacity ? buffer->capacity : 512;
    while (capacity < needed) capacity *= 2;
    char *text = fits ? realloc(buffer->text, capacity) : NULL;
    if (!text) {
        buffer->failed = true;
        return false;
    }
    buffer->text = text;
    buffer->capacity = capacity;
    return true;
}

void text_buffer_add(text_buffer *buffer, const char *text, size_t length)
{
    if (!make_room(buffer, length)) return;
    memcpy(buffer->text + buffer->length, text, length);
    buffer->length += length;
    buffer->text[buffer->length] = '\0';
}

void text_buffer_print(text_buffer *buffer, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, arguments);
    if (length < 0) {
        buffer->failed = true;
    } else if (make_room(buffer, (size_t)length)) {
        vsnprintf(buffer->text + buffer->length, (size_t)length + 1, format, again);
        buffer->length += (size_t)length;
    }
    va_end(again);
    va_end(arguments);
}

void text_buffer_add_json_string(text_buffer *buffer, const char *text, size_t length)
{
    text_buffer_add(buffer, "\"", 1);
    for (size_t i = 0; i < length; i++) {
        const unsigned char c = (unsigned char)text[i];
        if (c == '"' || c == '\\') text_buffer_print(buffer, "\\%c", c);
        else if (c < 0x20) text_buffer_print(buffer, "\\u%04x", c);
        else text_buffer_add(buffer, &text[i], 1);
    }
    text_buffer_add(buffer, "\"", 1);
}

void text_buffer_add_csv_field(text_buffer *buffer, const char *text, size_t length)
{
    bool quote = false;
    for (size_t i = 0; i < length && !quote; i++) quote = strchr(",\"\r\n", text[i]) != NULL;
    if (!quote) {
        text_buffer_add(buffer, text, length);
        return;
    }
    text_buffer_add(buffer, "\"", 1);
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '"') text_buffer_add(buffer, "\"", 1);
        text_buffer_add(buffer, &text[i], 1);
    }
    text_buffer_add(buffer, "\"", 1);
}

void text_buffer_add_number(text_buffer *buffer, double value)
{
    if (!isfinite(value)) { /* JSON has no word for it */
        text_buffer_add(buffer, "null", 4);
        return;
    }
    char text[32];
    int digits = 15;
    do snprintf(text, sizeof text, "%.*g", digits, value);
    while (strtod(text, NULL) != value && digits++ < 17);
    text_buffer_add(buffer, text, strlen(text));
}
