#include "yaml_text.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <yaml.h>

enum { DEEPEST = 60, LONGEST_LINE = 118 };

/* --- reading --- */

typedef struct yaml_reader {
    yaml_parser_t parser;
    size_t line; /* of the last event, from 0 */
    int depth;
} yaml_reader;

/* The event is to be deleted, also where it is false. */
static bool next_event(yaml_reader *reader, yaml_event_t *event)
{
    memset(event, 0, sizeof *event);
    const bool good = yaml_parser_parse(&reader->parser, event);
    reader->line = good ? event->start_mark.line : reader->parser.problem_mark.line;
    return good;
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

static json_t *value_of(yaml_reader *reader, const yaml_event_t *event);

static json_t *read_list(yaml_reader *reader)
{
    json_t *list = json_array();
    for (bool good = list != NULL;;) {
        yaml_event_t event;
        good = good && next_event(reader, &event);
        const bool is_end = good && event.type == YAML_SEQUENCE_END_EVENT;
        if (good && !is_end) good = json_array_append_new(list, value_of(reader, &event)) == 0;
        if (list) yaml_event_delete(&event);
        if (is_end) return list;
        if (good) continue;
        json_decref(list);
        return NULL;
    }
}

/* The member whose name is this event's. */
static bool read_member(yaml_reader *reader, json_t *object, const yaml_event_t *name)
{
    const char *text = name->type == YAML_SCALAR_EVENT ? (const char *)name->data.scalar.value : NULL;
    if (!text || json_object_get(object, text)) return false;
    yaml_event_t event;
    const bool good = next_event(reader, &event) && json_object_set_new(object, text, value_of(reader, &event)) == 0;
    yaml_event_delete(&event);
    return good;
}

static json_t *read_mapping(yaml_reader *reader)
{
    json_t *object = json_object();
    for (bool good = object != NULL;;) {
        yaml_event_t event;
        good = good && next_event(reader, &event);
        const bool is_end = good && event.type == YAML_MAPPING_END_EVENT;
        if (good && !is_end) good = read_member(reader, object, &event);
        if (object) yaml_event_delete(&event);
        if (is_end) return object;
        if (good) continue;
        json_decref(object);
        return NULL;
    }
}

/* What begins with this event; NULL: it is not of the kind that is read. */
static json_t *value_of(yaml_reader *reader, const yaml_event_t *event)
{
    if (event->type == YAML_SCALAR_EVENT) {
        const char *text = (const char *)event->data.scalar.value;
        if (event->data.scalar.anchor || event->data.scalar.tag) return NULL;
        return event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE ? resolve(text) : json_stringn(text, event->data.scalar.length);
    }
    const bool is_list = event->type == YAML_SEQUENCE_START_EVENT;
    if (!is_list && event->type != YAML_MAPPING_START_EVENT) return NULL;
    if (is_list ? event->data.sequence_start.anchor || event->data.sequence_start.tag
                : event->data.mapping_start.anchor || event->data.mapping_start.tag)
        return NULL;
    if (++reader->depth > DEEPEST) return NULL;
    json_t *value = is_list ? read_list(reader) : read_mapping(reader);
    reader->depth--;
    return value;
}

/* The one document of a stream. */
static json_t *read_document(yaml_reader *reader)
{
    static const yaml_event_type_t before[] = { YAML_STREAM_START_EVENT, YAML_DOCUMENT_START_EVENT },
                                   behind[] = { YAML_DOCUMENT_END_EVENT, YAML_STREAM_END_EVENT };
    json_t *value = NULL;
    bool good = true;
    yaml_event_t event;
    for (size_t k = 0; k < 5 && good; k++) {
        good = next_event(reader, &event);
        if (good && k == 2) good = (value = value_of(reader, &event)) != NULL;
        else if (good) good = event.type == (k < 2 ? before[k] : behind[k - 3]);
        yaml_event_delete(&event);
    }
    if (good) return value;
    json_decref(value);
    return NULL;
}

json_t *yaml_read(const char *text, size_t length, int *line)
{
    yaml_reader reader = { .depth = 0 };
    *line = 1;
    if (!yaml_parser_initialize(&reader.parser)) return NULL;
    yaml_parser_set_input_string(&reader.parser, (const unsigned char *)text, length);
    json_t *document = read_document(&reader);
    *line = (int)reader.line + 1;
    yaml_parser_delete(&reader.parser);
    return document;
}

/* --- writing --- */

/* A text that no reader takes for a number, a date or a word of its own. */
static bool is_text_without_quotes(const char *text)
{
    static const char *const words[] = { "true", "false", "null", "yes", "no", "on", "off", "y", "n" };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcasecmp(text, words[i]) == 0) return false;
    return isalpha((unsigned char)text[0]);
}

static bool emit_scalar(yaml_emitter_t *emitter, const char *text, yaml_scalar_style_t style)
{
    yaml_event_t event;
    return yaml_scalar_event_initialize(&event, NULL, NULL, (const yaml_char_t *)text, (int)strlen(text), 1, 1, style)
           && yaml_emitter_emit(emitter, &event);
}

static bool emit_text(yaml_emitter_t *emitter, const char *text)
{
    return emit_scalar(emitter, text, is_text_without_quotes(text) ? YAML_PLAIN_SCALAR_STYLE : YAML_SINGLE_QUOTED_SCALAR_STYLE);
}

/* With a point before the exponent, without which YAML 1.1 reads a text. */
static bool emit_real(yaml_emitter_t *emitter, double value)
{
    char with_point[64];
    text_buffer number;
    text_buffer_init(&number, sizeof with_point - 4);
    text_buffer_add_number(&number, value);
    const char *text = number.text ? number.text : "";
    const size_t mantissa = strcspn(text, "e");
    snprintf(with_point, sizeof with_point, "%.*s%s%s", (int)mantissa, text,
             text[mantissa] && !memchr(text, '.', mantissa) ? ".0" : "", text + mantissa);
    const bool good = !number.failed && emit_scalar(emitter, with_point, YAML_PLAIN_SCALAR_STYLE);
    text_buffer_clear(&number);
    return good;
}

static bool emit(yaml_emitter_t *emitter, const json_t *value, int column);

/* As JSON it takes no more room than the line has left. */
static bool is_short(const json_t *value, int column)
{
    return json_dumpb(value, NULL, 0, JSON_ENCODE_ANY) + (size_t)column <= LONGEST_LINE;
}

static bool emit_object(yaml_emitter_t *emitter, const json_t *object, int column)
{
    yaml_event_t event;
    const char *name;
    json_t *value;
    const yaml_mapping_style_t style = is_short(object, column) ? YAML_FLOW_MAPPING_STYLE : YAML_BLOCK_MAPPING_STYLE;
    bool good = yaml_mapping_start_event_initialize(&event, NULL, NULL, 1, style) && yaml_emitter_emit(emitter, &event);
    json_object_foreach((json_t *)object, name, value) good =
        good && emit_text(emitter, name) && emit(emitter, value, column + 2 + (int)strlen(name));
    return good && yaml_mapping_end_event_initialize(&event) && yaml_emitter_emit(emitter, &event);
}

static bool emit_list(yaml_emitter_t *emitter, const json_t *list, int column)
{
    yaml_event_t event;
    size_t i;
    json_t *value;
    const yaml_sequence_style_t style = is_short(list, column) ? YAML_FLOW_SEQUENCE_STYLE : YAML_BLOCK_SEQUENCE_STYLE;
    bool good = yaml_sequence_start_event_initialize(&event, NULL, NULL, 1, style) && yaml_emitter_emit(emitter, &event);
    json_array_foreach(list, i, value) good = good && emit(emitter, value, column + 2);
    return good && yaml_sequence_end_event_initialize(&event) && yaml_emitter_emit(emitter, &event);
}

static bool emit(yaml_emitter_t *emitter, const json_t *value, int column)
{
    char whole[24];
    switch (json_typeof(value)) {
    case JSON_OBJECT: return emit_object(emitter, value, column);
    case JSON_ARRAY: return emit_list(emitter, value, column);
    case JSON_STRING: return emit_text(emitter, json_string_value(value));
    case JSON_REAL: return emit_real(emitter, json_real_value(value));
    case JSON_INTEGER:
        snprintf(whole, sizeof whole, "%lld", (long long)json_integer_value(value));
        return emit_scalar(emitter, whole, YAML_PLAIN_SCALAR_STYLE);
    default: break;
    }
    return emit_scalar(emitter, json_is_true(value) ? "true" : json_is_false(value) ? "false" : "null", YAML_PLAIN_SCALAR_STYLE);
}

typedef struct indented {
    text_buffer *out;
    int indent;
    bool at_start; /* of a line */
} indented;

static int write_indented(void *context, unsigned char *bytes, size_t size)
{
    indented *const to = context;
    for (const unsigned char *at = bytes, *end = bytes + size; at < end;) {
        const unsigned char *line_end = memchr(at, '\n', (size_t)(end - at)), *next = line_end ? line_end + 1 : end;
        if (to->at_start) text_buffer_print(to->out, "%*s", to->indent, "");
        text_buffer_add(to->out, (const char *)at, (size_t)(next - at));
        to->at_start = line_end != NULL;
        at = next;
    }
    return !to->out->failed;
}

bool yaml_write_members(text_buffer *out, const json_t *object, int indent)
{
    yaml_emitter_t emitter;
    yaml_event_t event;
    indented to = { out, indent, true };
    if (!yaml_emitter_initialize(&emitter)) return false;
    yaml_emitter_set_output(&emitter, write_indented, &to);
    yaml_emitter_set_width(&emitter, -1);
    yaml_emitter_set_unicode(&emitter, 1);
    const bool good = yaml_stream_start_event_initialize(&event, YAML_UTF8_ENCODING) && yaml_emitter_emit(&emitter, &event)
                      && yaml_document_start_event_initialize(&event, NULL, NULL, NULL, 1) && yaml_emitter_emit(&emitter, &event)
                      && emit(&emitter, object, indent) && yaml_document_end_event_initialize(&event, 1)
                      && yaml_emitter_emit(&emitter, &event) && yaml_stream_end_event_initialize(&event)
                      && yaml_emitter_emit(&emitter, &event);
    yaml_emitter_delete(&emitter);
    return good && !out->failed;
}
