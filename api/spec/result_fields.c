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

static json_t *field_schema(const result_field *field, bool has_beds)
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
    if (has_beds) json_object_set_new(schema, "x-over-beds", over_beds_to_json(field));
    if (field->is_main) json_object_set_new(schema, "x-study-order", json_integer(field->in_study));
    if (field->is_listed)
        json_object_set_new(schema, "x-column",
                            field->view_name
                                ? json_string(field->view_name)
                                : json_sprintf("%s%s%s", field->group ? field->group : "", field->group ? "_" : "", field->name));
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

static bool is_one_of(const char *name, const char *const *names)
{
    for (; *names; names++)
        if (strcmp(name, *names) == 0) return true;
    return false;
}

/* "beds" of the first output. */
static json_t *beds_schema(const result_table *table)
{
    json_t *bed = json_pack("{s:{s:s, s:s}}", "seed", "type", "integer", "description",
                            "a run of one bed with this seed is this bed; that of the first is the run's");
    json_t *required = json_pack("[s]", "seed");
    for (size_t f = 0; f < table->count; f++) {
        const result_field *field = &table->field[f];
        if (field->group || strcmp(field->output, table->output[0].name) != 0 || !is_one_of(field->name, table->of_each_bed))
            continue;
        json_object_set_new(bed, field->name, field_schema(field, false));
        json_array_append_new(required, json_string(field->name));
    }
    return json_pack("{s:s, s:[s, s], s:s, s:{s:s, s:o, s:o, s:b}}", "title", "beds", "type", "array", "null", "description",
                     "each bed of a run of several, in order; null: there is one", "items", "type", "object", "required", required,
                     "properties", bed, "additionalProperties", 0);
}

static json_t *schema_of_members(const result_table *table, const char *output)
{
    json_t *properties = json_object();
    if (table->of_each_bed && strcmp(output, table->output[0].name) == 0)
        json_object_set_new(properties, "beds", beds_schema(table));
    if (table->describe_words) table->describe_words(properties, output);
    for (size_t f = 0; f < table->count; f++) {
        const result_field *field = &table->field[f];
        if (strcmp(field->output, output) != 0) continue;
        json_object_set_new(properties_of(properties, field->group), field->name, field_schema(field, table->of_each_bed));
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
