/* Describing results from a process's table of them. */
#include "result_fields.h"

#include <string.h>

static const char *const nullable_types[] = {
    [RESULT_REAL] = "number",
    [RESULT_WHOLE] = "integer",
    [RESULT_MAYBE] = "boolean",
    [RESULT_TEXT] = "string",
};

static json_t *warnings_schema(const result_field *field)
{
    return json_pack("{s:s, s:s, s:{s:s, s:[s, s], s:{s:{s:s, s:s}, s:{s:s}}, s:b}}", "type", "array", "description",
                     field->meaning, "items", "type", "object", "required", "field", "text", "properties", "field", "type",
                     "string", "description", "JSON Pointer into the results", "text", "type", "string", "additionalProperties", 0);
}

static json_t *words_or_null(const char *const *choices)
{
    json_t *words = json_array();
    for (size_t c = 0; choices[c]; c++) json_array_append_new(words, json_string(choices[c]));
    json_array_append_new(words, json_null());
    return words;
}

static json_t *field_schema(const result_field *field)
{
    if (field->kind == RESULT_WARNINGS) return warnings_schema(field);
    json_t *schema = json_pack("{s:s}", "description", field->meaning);
    json_t *type;
    if (field->kind == RESULT_TRUTH) type = json_string("boolean");
    else if (field->kind == RESULT_SIZE) type = json_string("integer");
    else if (field->kind == RESULT_WORD) type = json_string("string");
    else type = json_pack("[s, s]", nullable_types[field->kind], "null");
    json_object_set_new(schema, "type", type);
    if (*field->unit) json_object_set_new(schema, "x-unit", json_string(field->unit));
    if (field->label) json_object_set_new(schema, "title", json_string(field->label));
    if (field->suffix)
        json_object_set_new(
            schema, "x-shown",
            json_pack("{s:f, s:i, s:s}", "factor", field->factor, "digits", field->digits, "suffix", field->suffix));
    if (field->is_main) json_object_set_new(schema, "x-study-order", json_integer(field->in_study));
    if (field->choices) json_object_set_new(schema, "enum", words_or_null(field->choices));
    return schema;
}

/* The properties that a field is one of: those of the output itself or of an object in it. Borrowed. */
static json_t *properties_of(json_t *properties, const char *group)
{
    if (!group) return properties;
    if (!json_object_get(properties, group))
        json_object_set_new(properties, group, json_pack("{s:s, s:{}}", "type", "object", "properties"));
    return json_object_get(json_object_get(properties, group), "properties");
}

static json_t *schema_of_members(const result_table *table, const char *output)
{
    json_t *properties = json_object();
    if (table->describe_words) table->describe_words(properties, output);
    for (size_t f = 0; f < table->count; f++) {
        const result_field *field = &table->field[f];
        if (strcmp(field->output, output) != 0) continue;
        json_object_set_new(properties_of(properties, field->group), field->name, field_schema(field));
    }
    return json_pack("{s:s, s:o}", "type", "object", "properties", properties);
}

json_t *result_outputs_description(const result_table *table)
{
    json_t *description = json_object();
    for (size_t o = 0; o < table->output_count; o++) {
        const result_output *output = &table->output[o];
        const bool is_list = table->list && strcmp(table->list, output->name) == 0;
        json_t *schema = is_list
                             ? json_pack("{s:s, s:o}", "type", "array", "items", schema_of_members(table->entries, output->name))
                             : schema_of_members(table, output->name);
        json_object_set_new(description, output->name,
                            json_pack("{s:s, s:s, s:o}", "title", output->name, "description", output->meaning, "schema", schema));
    }
    return description;
}
