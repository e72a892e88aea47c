#include "yaml_read.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "text_buffer.h"

enum { DEEPEST = 60, LONGEST_TEXT = 1 << 20 };

typedef struct yaml_reader {
    const char *text, *at;
    int depth;
} yaml_reader;

static json_t *read_flow(yaml_reader *reader);
static json_t *read_block(yaml_reader *reader, int least);

static int column_of(const yaml_reader *reader)
{
    int column = 0;
    for (const char *c = reader->at; c > reader->text && c[-1] != '\n'; c--) column++;
    return column;
}

static bool is_end_of_line(const char *c) { return *c == '\0' || *c == '\n' || (*c == '#' && c[-1] == ' '); }

/* That an item of a list begins with. */
static bool is_dash(const char *c) { return c[0] == '-' && strchr(" \n", c[1]); }

static void skip_line(yaml_reader *reader)
{
    reader->at += strcspn(reader->at, "\n");
    if (*reader->at) reader->at++;
}

/* Spaces, line ends and comments. */
static void skip_to_content(yaml_reader *reader)
{
    for (;;) {
        reader->at += strspn(reader->at, " \n");
        if (*reader->at != '#') return;
        reader->at += strcspn(reader->at, "\n");
    }
}

/* --- texts --- */

static json_t *take_text(text_buffer *text)
{
    json_t *value = text->failed ? NULL : json_string(text->text ? text->text : "");
    text_buffer_clear(text);
    return value;
}

/* A line end and the spaces about it become one space. */
static void fold(yaml_reader *reader, text_buffer *text)
{
    while (text->length && text->text[text->length - 1] == ' ') text->text[--text->length] = '\0';
    reader->at += strspn(reader->at, " \n");
    text_buffer_add(text, " ", 1);
}

static json_t *read_quoted(yaml_reader *reader)
{
    const char quote = *reader->at++;
    text_buffer text;
    text_buffer_init(&text, LONGEST_TEXT);
    for (; *reader->at; reader->at++) {
        if (*reader->at == quote && quote == '\'' && reader->at[1] == '\'') reader->at++;
        else if (*reader->at == quote) break;
        else if (*reader->at == '\n') {
            fold(reader, &text);
            reader->at--;
            continue;
        } else if (quote == '"' && *reader->at == '\\' && reader->at[1]) {
            reader->at++;
            if (*reader->at != '"' && *reader->at != '\\') break; /* no others are in use */
        }
        text_buffer_add(&text, reader->at, 1);
    }
    if (*reader->at != quote) text.failed = true;
    else reader->at++;
    return take_text(&text);
}

/* The number or word that a plain text is, or the text. */
static json_t *resolve(const char *text)
{
    if (strcmp(text, "null") == 0 || strcmp(text, "~") == 0 || !*text) return json_null();
    if (strcmp(text, "true") == 0) return json_true();
    if (strcmp(text, "false") == 0) return json_false();
    if (!isdigit((unsigned char)text[text[0] == '-'])) return json_string(text);
    char *end;
    errno = 0;
    const long long whole = strtoll(text, &end, 10);
    if (*end == '\0' && errno == 0) return json_integer(whole);
    if (text[strspn(text, "+-.0123456789eE")]) return json_string(text);
    const double number = strtod(text, &end);
    return *end == '\0' && strchr(text, '.') ? json_real(number) : json_string(text);
}

static json_t *take_plain(text_buffer *text)
{
    while (text->length && text->text[text->length - 1] == ' ') text->text[--text->length] = '\0';
    json_t *value = text->failed ? NULL : resolve(text->text ? text->text : "");
    text_buffer_clear(text);
    return value;
}

/* Within [] or {}. */
static json_t *read_plain_in_flow(yaml_reader *reader)
{
    text_buffer text;
    text_buffer_init(&text, LONGEST_TEXT);
    while (*reader->at && !strchr(",[]{}", *reader->at) && !(*reader->at == ':' && strchr(" \n,]}", reader->at[1]))) {
        if (*reader->at == '\n') fold(reader, &text);
        else text_buffer_add(&text, reader->at++, 1);
    }
    return take_plain(&text);
}

/* To the end of the line, and on where the next one stands further in than its parent. */
static json_t *read_plain(yaml_reader *reader, int parent)
{
    text_buffer text;
    text_buffer_init(&text, LONGEST_TEXT);
    for (;;) {
        for (; !is_end_of_line(reader->at); reader->at++) {
            if (reader->at[0] == ':' && strchr(" \n", reader->at[1])) text.failed = true; /* a key within a text */
            text_buffer_add(&text, reader->at, 1);
        }
        const bool is_comment = *reader->at == '#';
        if (is_comment) reader->at += strcspn(reader->at, "\n");
        const char *next = reader->at + strspn(reader->at, "\n");
        const size_t indent = strspn(next, " ");
        if (is_comment || !*reader->at || (int)indent <= parent || strchr("\n#", next[indent])) break;
        fold(reader, &text);
    }
    return take_plain(&text);
}

/* > and |, with or without -: lines further in than the parent. */
static json_t *read_block_text(yaml_reader *reader, int parent)
{
    const bool folds = *reader->at == '>', strips = reader->at[1] == '-';
    text_buffer text;
    text_buffer_init(&text, LONGEST_TEXT);
    skip_line(reader);
    const size_t indent = strspn(reader->at, " ");
    size_t empty = 0;
    while (*reader->at) {
        const size_t spaces = strspn(reader->at, " "), length = strcspn(reader->at, "\n");
        if (spaces != length && (spaces < indent || (int)spaces <= parent)) break;
        if (spaces == length) empty++;
        else {
            if (text.length) text_buffer_add(&text, folds && empty == 0 ? " " : "\n", 1);
            for (; empty > (folds ? 1 : 0) && text.length; empty--) text_buffer_add(&text, "\n", 1);
            empty = 0;
            text_buffer_add(&text, reader->at + indent, length - indent);
        }
        skip_line(reader);
    }
    if (!strips) text_buffer_add(&text, "\n", 1);
    return take_text(&text);
}

/* --- flow style --- */

static json_t *read_flow_key(yaml_reader *reader)
{
    json_t *key = *reader->at == '\'' || *reader->at == '"' ? read_quoted(reader) : read_plain_in_flow(reader);
    skip_to_content(reader);
    if (key && json_is_string(key) && *reader->at == ':') {
        reader->at++;
        return key;
    }
    json_decref(key);
    return NULL;
}

/* Takes over both references. */
static bool put(json_t *object, json_t *key, json_t *value)
{
    const bool good = key && value && !json_object_get(object, json_string_value(key))
                      && json_object_set(object, json_string_value(key), value) == 0;
    json_decref(key);
    json_decref(value);
    return good;
}

static json_t *read_flow_collection(yaml_reader *reader)
{
    const bool is_list = *reader->at++ == '[';
    json_t *collection = is_list ? json_array() : json_object();
    bool good = collection != NULL;
    for (skip_to_content(reader); good && *reader->at != (is_list ? ']' : '}'); skip_to_content(reader)) {
        if (is_list) {
            good = json_array_append_new(collection, read_flow(reader)) == 0;
        } else {
            json_t *key = read_flow_key(reader);
            good = key && put(collection, key, read_flow(reader));
        }
        skip_to_content(reader);
        if (*reader->at == ',') reader->at++;
        else good = good && *reader->at == (is_list ? ']' : '}');
    }
    if (good) {
        reader->at++;
        return collection;
    }
    json_decref(collection);
    return NULL;
}

static json_t *read_flow(yaml_reader *reader)
{
    skip_to_content(reader);
    if (++reader->depth > DEEPEST) return NULL;
    json_t *value = strchr("[{", *reader->at) && *reader->at    ? read_flow_collection(reader)
                    : strchr("'\"", *reader->at) && *reader->at ? read_quoted(reader)
                                                                : read_plain_in_flow(reader);
    reader->depth--;
    return value;
}

/* --- block style --- */

/* A value behind a key or a dash: in the line, or in lines further in than `parent`; a list may stand as far out as its key. */
static json_t *read_value(yaml_reader *reader, int parent, bool behind_key)
{
    reader->at += strspn(reader->at, " ");
    if (is_end_of_line(reader->at)) {
        skip_to_content(reader);
        const int column = column_of(reader);
        const bool is_list = is_dash(reader->at);
        if (!*reader->at || column < parent || (column == parent && !(behind_key && is_list))) return json_null();
        return read_block(reader, column);
    }
    if (strchr("[{", *reader->at)) return read_flow(reader);
    if (strchr("'\"", *reader->at)) return read_quoted(reader);
    if (strchr(">|", *reader->at)) return read_block_text(reader, parent);
    return read_plain(reader, parent);
}

/* The key of a block mapping, and its colon; NULL: there is none here, and nothing was read. */
static json_t *read_key(yaml_reader *reader)
{
    const char *start = reader->at;
    json_t *key = NULL;
    if (strchr("'\"", *start) && *start) {
        key = read_quoted(reader);
    } else if (*start && !strchr("[{", *start)) {
        size_t length = 0;
        while (!is_end_of_line(start + length) && !(start[length] == ':' && strchr(" \n", start[length + 1]))) length++;
        key = json_stringn(start, length);
        reader->at += length;
    }
    if (key && reader->at[0] == ':' && strchr(" \n", reader->at[1])) {
        reader->at++;
        return key;
    }
    json_decref(key);
    reader->at = start;
    return NULL;
}

static json_t *read_list(yaml_reader *reader, int column)
{
    json_t *list = json_array();
    while (list && column_of(reader) == column && is_dash(reader->at)) {
        reader->at++;
        const char *dash = reader->at;
        reader->at += strspn(reader->at, " ");
        const int inner = column_of(reader);
        json_t *key = is_end_of_line(reader->at) || is_dash(reader->at) ? NULL : read_key(reader);
        reader->at = dash + strspn(dash, " ");
        json_t *value = key || is_dash(reader->at) ? read_block(reader, inner) : read_value(reader, column, false);
        json_decref(key);
        if (json_array_append_new(list, value) != 0) {
            json_decref(list);
            return NULL;
        }
        skip_to_content(reader);
    }
    return list;
}

static json_t *read_mapping(yaml_reader *reader, int column)
{
    json_t *object = json_object();
    while (object && *reader->at && column_of(reader) == column) {
        json_t *key = read_key(reader);
        if (!key || !put(object, key, read_value(reader, column, true))) {
            json_decref(object);
            return NULL;
        }
        skip_to_content(reader);
    }
    return object;
}

static json_t *read_block(yaml_reader *reader, int column)
{
    if (++reader->depth > DEEPEST) return NULL;
    json_t *value = is_dash(reader->at) ? read_list(reader, column) : read_mapping(reader, column);
    reader->depth--;
    return value;
}

json_t *yaml_read(const char *text, int *line)
{
    yaml_reader reader = { .text = text, .at = text };
    skip_to_content(&reader);
    json_t *document = read_block(&reader, column_of(&reader));
    *line = 1;
    for (const char *c = text; c < reader.at; c++) *line += *c == '\n';
    if (document && !*reader.at) return document;
    json_decref(document);
    return NULL;
}
