#include "yaml_write.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

enum { LONGEST_LINE = 118 };

static void write_flow(text_buffer *out, const json_t *value);

/* Words that would not be read as texts without quotes. */
static bool is_word_of_yaml(const char *text)
{
    static const char *const words[] = { "true", "false", "null", "yes", "no", "on", "off", "y", "n" };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcasecmp(text, words[i]) == 0) return true;
    return false;
}

/* Letters, digits and a few marks, from a letter on: nothing that means something to YAML, even within [] or {}. */
static bool is_plain(const char *text)
{
    if (!isalpha((unsigned char)text[0]) || is_word_of_yaml(text)) return false;
    for (const char *c = text; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr(" _-./%+()*;=<>", *c)) return false;
    return text[strlen(text) - 1] != ' ';
}

static void write_text(text_buffer *out, const char *text)
{
    if (is_plain(text)) {
        text_buffer_print(out, "%s", text);
        return;
    }
    text_buffer_print(out, "'");
    for (const char *c = text; *c; c++) text_buffer_print(out, *c == '\'' ? "''" : "%c", *c);
    text_buffer_print(out, "'");
}

/* With a point before the exponent, without which YAML 1.1 reads a text. */
static void write_real(text_buffer *out, double value)
{
    text_buffer number;
    text_buffer_init(&number, 100);
    text_buffer_add_number(&number, value);
    const size_t mantissa = number.text ? strcspn(number.text, "e") : 0;
    const bool bare = number.text && number.text[mantissa] == 'e' && !memchr(number.text, '.', mantissa);
    if (number.text) text_buffer_print(out, "%.*s%s%s", (int)mantissa, number.text, bare ? ".0" : "", number.text + mantissa);
    text_buffer_clear(&number);
}

static void write_flow_list(text_buffer *out, const json_t *list)
{
    size_t i;
    json_t *value;
    text_buffer_print(out, "[");
    json_array_foreach(list, i, value)
    {
        text_buffer_print(out, i ? ", " : "");
        write_flow(out, value);
    }
    text_buffer_print(out, "]");
}

static void write_flow_object(text_buffer *out, const json_t *object)
{
    const char *name, *comma = "";
    json_t *value;
    text_buffer_print(out, "{");
    json_object_foreach((json_t *)object, name, value)
    {
        text_buffer_print(out, "%s", comma);
        write_text(out, name);
        text_buffer_print(out, ": ");
        write_flow(out, value);
        comma = ", ";
    }
    text_buffer_print(out, "}");
}

static void write_flow(text_buffer *out, const json_t *value)
{
    switch (json_typeof(value)) {
    case JSON_OBJECT: write_flow_object(out, value); break;
    case JSON_ARRAY: write_flow_list(out, value); break;
    case JSON_STRING: write_text(out, json_string_value(value)); break;
    case JSON_INTEGER: text_buffer_print(out, "%lld", (long long)json_integer_value(value)); break;
    case JSON_REAL: write_real(out, json_real_value(value)); break;
    case JSON_TRUE: text_buffer_print(out, "true"); break;
    case JSON_FALSE: text_buffer_print(out, "false"); break;
    default: text_buffer_print(out, "null");
    }
}

static bool is_collection(const json_t *value) { return json_object_size(value) > 0 || json_array_size(value) > 0; }

/* Writes behind a name and its colon, or behind a dash, what fits into the line; false, and nothing is written: it does not. */
static bool write_in_line(text_buffer *out, const json_t *value, size_t before)
{
    text_buffer line;
    text_buffer_init(&line, out->limit);
    write_flow(&line, value);
    const bool fits = !is_collection(value) || (!line.failed && before + line.length <= LONGEST_LINE);
    if (fits) text_buffer_print(out, " %s\n", line.text ? line.text : "");
    if (line.failed) out->failed = true;
    text_buffer_clear(&line);
    return fits;
}

static void write_items(text_buffer *out, const json_t *list, int indent)
{
    size_t i;
    json_t *value;
    json_array_foreach(list, i, value)
    {
        text_buffer_print(out, "%*s-", indent, "");
        if (write_in_line(out, value, (size_t)indent + 2)) continue;
        text_buffer_print(out, "\n");
        if (json_is_object(value)) yaml_write_members(out, value, indent + 2);
        else write_items(out, value, indent + 2);
    }
}

void yaml_write_members(text_buffer *out, const json_t *object, int indent)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)object, name, value)
    {
        text_buffer_print(out, "%*s", indent, "");
        write_text(out, name);
        text_buffer_print(out, ":");
        if (write_in_line(out, value, (size_t)indent + strlen(name) + 2)) continue;
        text_buffer_print(out, "\n");
        if (json_is_object(value)) yaml_write_members(out, value, indent + 2);
        else write_items(out, value, indent + 2);
    }
}
