#include "json_text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json_writer.h"
#include "text_buffer.h"

/* What of a number is shown in a message. */
enum { LONGEST_SHOWN = 20 };

/* A piece of the text: it ends after `length` bytes and not with a zero byte, for what lies behind it is not ours. */
typedef struct text_piece {
    const char *start;
    size_t length;
} text_piece;

/* Whether strtod, which reads up to a zero byte, makes 0 of this number. */
static bool vanishes(text_piece number)
{
    char few[64], *copy = number.length < sizeof few ? few : malloc(number.length + 1);
    if (!copy) return true; /* better to refuse a good number than to take 0 for it */
    memcpy(copy, number.start, number.length);
    copy[number.length] = '\0';
    const bool is_zero = strtod(copy, NULL) == 0.0;
    if (copy != few) free(copy);
    return is_zero;
}

/* A number that is not 0 as written but too small for a double: strtod makes 0 of it, and the parser does not tell.
 * start NULL: there is none. The text is known to be good JSON. */
static text_piece find_vanishing_number(const char *text, const char *end)
{
    for (const char *c = text; c < end;) {
        if (*c == '"') {
            for (c++; c < end && *c != '"'; c++)
                if (*c == '\\') c++;
            c++;
        } else if (isdigit((unsigned char)*c)) {
            const char *start = c;
            size_t digits = 0; /* of the mantissa, other than 0 */
            for (; c < end && (isdigit((unsigned char)*c) || *c == '.'); c++) digits += *c >= '1' && *c <= '9';
            while (c < end && (isalnum((unsigned char)*c) || *c == '+' || *c == '-' || *c == '.')) c++;
            const text_piece number = { start, (size_t)(c - start) };
            if (digits && vanishes(number)) return number;
        } else {
            c++;
        }
    }
    return (text_piece){ NULL, 0 };
}

/* Of this thread: the parser does not tell of every refusal, clears errno, and may go on without a character. */
static _Thread_local bool was_refused;

static void *watched_malloc(size_t bytes)
{
    void *memory = malloc(bytes);
    if (!memory) was_refused = true;
    return memory;
}

void json_text_watch_memory(void) { json_set_alloc_funcs(watched_malloc, free); }

json_t *json_text_load(const char *text, size_t length, problem_list *problems)
{
    json_error_t error;
    was_refused = false;
    errno = 0;
    json_t *document = json_loadb(text, length, JSON_REJECT_DUPLICATES | JSON_DECODE_ANY, &error);
    if (was_refused || errno == ENOMEM) {
        json_decref(document);
        problem_list_add(problems, "", "can't be read: out of memory");
        errno = ENOMEM;
        return NULL;
    }
    if (!document) {
        problem_list_add(problems, "", "is not JSON: %s (line %d, column %d)", error.text, error.line, error.column);
        return NULL;
    }
    const text_piece vanishing = find_vanishing_number(text, text + length);
    if (!vanishing.start) return document;
    int line = 1;
    for (const char *c = text; c < vanishing.start; c++) line += *c == '\n';
    problem_list_add(problems, "", "has in line %d a number too close to 0 to be kept: %.*s...", line,
                     vanishing.length > LONGEST_SHOWN ? LONGEST_SHOWN : (int)vanishing.length, vanishing.start);
    json_decref(document);
    return NULL;
}

static void write_value(text_buffer *out, const json_t *value, int depth);

static void write_char(text_buffer *out, char c) { text_buffer_add(out, &c, 1); }

/* Without a point or an exponent it would be read back as an integer. */
static void write_real(text_buffer *out, double number)
{
    char text[40];
    int digits = 15;
    if (json_write_short(out, number)) return;
    do snprintf(text, sizeof text, "%.*g", digits, number);
    while (strtod(text, NULL) != number && ++digits <= 17);
    text_buffer_add(out, text, strlen(text));
    if (!strpbrk(text, ".e")) text_buffer_add(out, ".0", 2);
}

/* Nearly all are plain, and written as they are; the rest as the library does. */
static void write_string(text_buffer *out, const char *text, size_t length)
{
    size_t plain = 0;
    while (plain < length && (unsigned char)text[plain] >= 0x20 && text[plain] != '"' && text[plain] != '\\') plain++;
    if (plain < length) {
        json_t *string = json_stringn(text, length);
        char *escaped = json_dumps(string, JSON_ENCODE_ANY);
        if (escaped) text_buffer_add(out, escaped, strlen(escaped));
        else out->failed = true;
        free(escaped);
        json_decref(string);
        return;
    }
    write_char(out, '"');
    text_buffer_add(out, text, length);
    write_char(out, '"');
}

static void write_indent(text_buffer *out, int depth)
{
    static const char spaces[] = "\n                                ";
    const size_t step = sizeof spaces - 2;
    size_t left = 2 * (size_t)depth, now = left < step ? left : step;
    text_buffer_add(out, spaces, 1 + now);
    for (left -= now; left > 0; left -= now) {
        now = left < step ? left : step;
        text_buffer_add(out, spaces + 1, now);
    }
}

static void write_object(text_buffer *out, const json_t *object, int depth)
{
    const char *name;
    json_t *value;
    bool first = true;
    write_char(out, '{');
    json_object_foreach((json_t *)object, name, value)
    {
        if (!first) write_char(out, ',');
        first = false;
        write_indent(out, depth + 1);
        write_string(out, name, strlen(name));
        text_buffer_add(out, ": ", 2);
        write_value(out, value, depth + 1);
    }
    if (!first) write_indent(out, depth);
    write_char(out, '}');
}

static void write_array(text_buffer *out, const json_t *array, int depth)
{
    size_t index;
    json_t *value;
    write_char(out, '[');
    json_array_foreach(array, index, value)
    {
        if (index) write_char(out, ',');
        write_indent(out, depth + 1);
        write_value(out, value, depth + 1);
    }
    if (json_array_size(array)) write_indent(out, depth);
    write_char(out, ']');
}

static void write_value(text_buffer *out, const json_t *value, int depth)
{
    if (json_is_object(value)) write_object(out, value, depth);
    else if (json_is_array(value)) write_array(out, value, depth);
    else if (json_is_real(value)) write_real(out, json_real_value(value));
    else if (json_is_string(value)) write_string(out, json_string_value(value), json_string_length(value));
    else if (json_is_integer(value)) text_buffer_print(out, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
    else if (json_is_null(value)) text_buffer_add(out, "null", 4);
    else if (json_is_true(value)) text_buffer_add(out, "true", 4);
    else text_buffer_add(out, "false", 5);
}

static char *write_text(const json_t *value, int depth, const char *end)
{
    text_buffer out;
    if (!value) return NULL;
    text_buffer_init(&out, SIZE_MAX / 4);
    write_value(&out, value, depth);
    text_buffer_add(&out, end, strlen(end));
    if (out.failed) text_buffer_clear(&out);
    return out.text;
}

char *json_text_write(const json_t *document) { return write_text(document, 0, "\n"); }

char *json_text_write_within(const json_t *value, int depth) { return write_text(value, depth, ""); }

json_t *json_real_or_null(double number) { return isfinite(number) ? json_real(number) : json_null(); }
