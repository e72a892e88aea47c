/* The processes as OGC API - Processes describes them; inputs come from the table of fields. */
#include <math.h>
#include <string.h>

#include "job_spec.h"
#include "result_fields.h"
#include "spec_fields.h"

#define DRUM_TITLE "Rotating drum"
#define DRUM_DESCRIPTION "A horizontal drum, part full of particles, turns about its axis: dynamic angle of repose, " \
                         "flow regime, segregation and packing of the bed. SI units; angles in degrees."

static json_t *group_schema(spec_group group);

static json_t *whole_or_real(double number)
{
    return number == floor(number) && fabs(number) < 9007199254740992.0 ? json_integer((json_int_t)number)
                                                                        : json_real(number);
}

static json_t *number_schema(const spec_field *field)
{
    json_t *schema = json_pack("{s:s}", "type", field->kind == FIELD_INTEGER ? "integer" : "number");
    json_object_set_new(schema, field->minimum_open ? "exclusiveMinimum" : "minimum", whole_or_real(field->minimum));
    json_object_set_new(schema, "maximum", whole_or_real(field->maximum));
    if (!isnan(field->fallback)) json_object_set_new(schema, "default", whole_or_real(field->fallback));
    if (*field->unit) json_object_set_new(schema, "x-unit", json_string(field->unit));
    return schema;
}

static json_t *choice_schema(const spec_field *field)
{
    json_t *choices = json_array();
    for (size_t c = 0; field->choices[c]; c++) json_array_append_new(choices, json_string(field->choices[c]));
    return json_pack("{s:s, s:o, s:s}", "type", "string", "enum", choices, "default", field->choices[0]);
}

static json_t *field_schema(const spec_field *field)
{
    json_t *schema;
    switch (field->kind) {
    case FIELD_REAL:
    case FIELD_INTEGER:
        schema = number_schema(field);
        break;
    case FIELD_CHOICE:
        schema = choice_schema(field);
        break;
    case FIELD_LIST:
        schema = json_pack("{s:s, s:I, s:I, s:o}", "type", "array", "minItems", (json_int_t)field->minimum, "maxItems",
                           (json_int_t)field->maximum, "items", group_schema(field->child));
        break;
    case FIELD_OBJECT_OR_NULL:
        schema = group_schema(field->child);
        json_object_set_new(schema, "type", json_pack("[s, s]", "object", "null"));
        json_object_set_new(schema, "default", json_null());
        break;
    default:
        schema = group_schema(field->child);
    }
    json_object_set_new(schema, "description", json_string(field->meaning));
    return schema;
}

/* Two members of which at most one may be given. */
static json_t *exclusion(const spec_field *field)
{
    return json_pack("{s:{s:[s, s]}}", "not", "required", field->name, field->excludes);
}

static json_t *group_schema(spec_group group)
{
    json_t *properties = json_object(), *required = json_array(), *exclusions = json_array();
    for (size_t f = 0; f < spec_field_count; f++) {
        const spec_field *field = &spec_fields[f];
        if (field->group != group) continue;
        json_object_set_new(properties, field->name, field_schema(field));
        if (field->required) json_array_append_new(required, json_string(field->name));
        if (field->excludes && !isnan(field->fallback)) json_array_append_new(exclusions, exclusion(field));
    }
    json_t *schema = json_pack("{s:s, s:o, s:b}", "type", "object", "properties", properties, "additionalProperties", 0);
    if (json_array_size(required)) json_object_set(schema, "required", required);
    if (json_array_size(exclusions)) json_object_set(schema, "allOf", exclusions);
    json_decref(required);
    json_decref(exclusions);
    return schema;
}

static json_t *inputs_description(void)
{
    json_t *inputs = json_object();
    for (size_t f = 0; f < spec_field_count; f++) {
        const spec_field *field = &spec_fields[f];
        if (field->group != SPEC_INPUTS) continue;
        json_object_set_new(inputs, field->name,
                            json_pack("{s:s, s:s, s:i, s:i, s:o}", "title", field->name, "description", field->meaning,
                                      "minOccurs", field->required, "maxOccurs", 1, "schema", field_schema(field)));
    }
    return inputs;
}

static json_t *drum_summary(void)
{
    return json_pack("{s:s, s:s, s:s, s:s, s:[s, s], s:[s]}", "id", "drum", "title", DRUM_TITLE, "description",
                     DRUM_DESCRIPTION, "version", "1.0.0", "jobControlOptions", "async-execute", "dismiss",
                     "outputTransmission", "value");
}

json_t *process_description(const char *process)
{
    if (strcmp(process, "drum") != 0) return NULL;
    json_t *description = drum_summary();
    json_object_set_new(description, "inputs", inputs_description());
    json_object_set_new(description, "outputs", result_outputs_description());
    return description;
}

json_t *process_summaries(void)
{
    return json_pack("[o]", drum_summary());
}
