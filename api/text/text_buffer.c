#include "text_buffer.h"

#include <ctype.h>
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
    while (capacity < needed) capacity += capacity / 2;
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

/* [+-]digits[.digits][e[+-]digits], as a spreadsheet reads it, too; nothing else that strtod takes. */
static bool is_number(const char *text, size_t length)
{
    size_t at = length > 0 && (text[0] == '+' || text[0] == '-'), digits = 0;
    for (; at < length && isdigit((unsigned char)text[at]); at++) digits++;
    if (at < length && text[at] == '.')
        for (at++; at < length && isdigit((unsigned char)text[at]); at++) digits++;
    if (digits > 0 && at < length && (text[at] == 'e' || text[at] == 'E')) {
        at += at + 1 < length && (text[at + 1] == '+' || text[at + 1] == '-') ? 2 : 1;
        for (digits = 0; at < length && isdigit((unsigned char)text[at]); at++) digits++;
    }
    return digits > 0 && at == length;
}

/* What a spreadsheet would take for a formula, and run: it begins with one of these, or with their full-width forms. */
static bool is_formula(const char *text, size_t length)
{
    if (length == 0 || is_number(text, length)) return false;
    if (memchr("=+-@\t\r\n", text[0], 7)) return true;
    static const char *const wide[] = { "\uff1d", "\uff0b", "\uff0d", "\uff20" };
    for (size_t i = 0; i < sizeof wide / sizeof wide[0]; i++)
        if (length >= 3 && memcmp(text, wide[i], 3) == 0) return true;
    return false;
}

void text_buffer_add_csv_field(text_buffer *buffer, const char *text, size_t length)
{
    const bool formula = is_formula(text, length);
    bool quote = formula;
    for (size_t i = 0; i < length && !quote; i++) quote = memchr(",;\"\t\r\n", text[i], 6) != NULL;
    if (!quote) {
        text_buffer_add(buffer, text, length);
        return;
    }
    text_buffer_add(buffer, "\"'", formula ? 2 : 1);
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
