/* The processes as OGC API - Processes describes them; inputs come from the table of fields. */
#include <math.h>

#include "process_type.h"
#include "unit_table.h"

static json_t *group_schema(const spec_table *table, spec_group group);

static json_t *whole_or_real(double number)
{
    return number == floor(number) && fabs(number) <= (double)LARGEST_WHOLE_NUMBER ? json_integer((json_int_t)number)
                                                                                   : json_real(number);
}

/* A number in the field's unit, or an object that names another. Words of a schema that are about numbers say nothing of
 * objects, and the other way round. */
static json_t *number_schema(const spec_field *field)
{
    json_t *schema = json_pack("{s:[s, s]}", "type", field->kind == FIELD_INTEGER ? "integer" : "number", "object");
    json_object_set_new(schema, field->minimum_open ? "exclusiveMinimum" : "minimum", whole_or_real(field->minimum));
    json_object_set_new(schema, "maximum", whole_or_real(field->maximum));
    if (field->least_size > 0.0)
        json_object_set_new(schema, "not",
                            json_pack("{s:s, s:f, s:f}", "type", "number", "exclusiveMinimum", -field->least_size,
                                      "exclusiveMaximum", field->least_size));
    if (!isnan(field->fallback)) json_object_set_new(schema, "default", whole_or_real(field->fallback));
    if (*field->unit) json_object_set_new(schema, "x-unit", json_string(field->unit));
    json_t *unit = json_pack("{s:s, s:o}", "type", "string", "enum", unit_names(field));
    if (field->kind != FIELD_INTEGER) json_object_set_new(unit, "title", json_sprintf("unit of %s", unit_dimension(field)));
    json_object_set_new(schema, "properties", json_pack("{s:{s:s}, s:o}", "value", "type", "number", "unit", unit));
    json_object_set_new(schema, "required", json_pack("[s, s]", "value", "unit"));
    json_object_set_new(schema, "additionalProperties", json_false());
    return schema;
}

static json_t *choice_schema(const spec_field *field)
{
    json_t *choices = json_array();
    for (size_t c = 0; field->choices[c]; c++) json_array_append_new(choices, json_string(field->choices[c]));
    return json_pack("{s:s, s:o, s:s}", "type", "string", "enum", choices, "default", field->choices[0]);
}

/* How a list of jobs shows the column. "of": what is of the first entry of a list is shown only where that has no other; its
 * column says how many it has. */
static json_t *listed_schema(const spec_table *table, const spec_field *field)
{
    json_t *listed = json_pack("{s:s, s:i, s:s, s:o}", "column", field->column, "order", field->list_order, "before",
                               field->list_before, "factor", whole_or_real(field->list_factor));
    if (field->list_after) json_object_set_new(listed, "after", json_string(field->list_after));
    else if (field->unit && *field->unit) json_object_set_new(listed, "unit", json_string(field->unit));
    if (field->list_above > 0.0) json_object_set_new(listed, "above", whole_or_real(field->list_above));
    for (size_t f = 0; f < table->count; f++)
        if (table->field[f].kind == FIELD_LIST && table->field[f].child == field->group && table->field[f].column)
            json_object_set_new(listed, "of", json_string(table->field[f].column));
    return listed;
}

/* A place among the inputs that a form asks for first, and the unit that it asks in where that is not the dimension's usual one. */
static json_t *form_schema(const spec_field *field)
{
    json_t *form = json_pack("{s:i}", "order", field->form_order);
    if (field->form_unit) json_object_set_new(form, "unit", json_string(field->form_unit));
    return form;
}

static json_t *field_schema(const spec_table *table, const spec_field *field)
{
    json_t *schema;
    switch (field->kind) {
    case FIELD_REAL:
    case FIELD_INTEGER: schema = number_schema(field); break;
    case FIELD_CHOICE: schema = choice_schema(field); break;
    case FIELD_TRUE: schema = json_pack("{s:b}", "const", 1); break;
    case FIELD_TEXT:
        schema = json_pack("{s:s, s:I, s:I}", "type", "string", "minLength", (json_int_t)field->minimum, "maxLength",
                           (json_int_t)field->maximum);
        break;
    case FIELD_ORIENTATION:
        schema = json_pack("{s:s, s:i, s:i, s:o}", "type", "array", "minItems", 4, "maxItems", 4, "items", number_schema(field));
        break;
    case FIELD_PLACE:
        schema = json_pack("{s:s, s:i, s:i, s:o}", "type", "array", "minItems", 3, "maxItems", 3, "items", number_schema(field));
        break;
    case FIELD_CHOICE_OR_OBJECT:
        schema = json_pack("{s:[o, o]}", "oneOf", choice_schema(field), group_schema(table, field->child));
        break;
    case FIELD_LIST:
    case FIELD_LONG_LIST:
        schema = json_pack("{s:s, s:I, s:I, s:o}", "type", "array", "minItems", (json_int_t)field->minimum, "maxItems",
                           (json_int_t)field->maximum, "items", group_schema(table, field->child));
        break;
    case FIELD_NAMED_LIST:
        schema = json_pack("{s:s, s:I, s:o}", "type", "object", "maxProperties", (json_int_t)field->maximum, "additionalProperties",
                           group_schema(table, field->child));
        break;
    case FIELD_NUMBERS:
        schema = json_pack("{s:s, s:I, s:I, s:o}", "type", "array", "minItems", (json_int_t)field->least_entries, "maxItems",
                           (json_int_t)field->most_entries, "items", number_schema(field));
        break;
    case FIELD_TWO_NAMES:
        schema = json_pack("{s:s, s:i, s:i, s:{s:s, s:I, s:I}}", "type", "array", "minItems", 2, "maxItems", 2, "items", "type",
                           "string", "minLength", (json_int_t)field->minimum, "maxLength", (json_int_t)field->maximum);
        break;
    case FIELD_OBJECT_OR_NULL:
        schema = group_schema(table, field->child);
        json_object_set_new(schema, "type", json_pack("[s, s]", "object", "null"));
        json_object_set_new(schema, "default", json_null());
        break;
    default: schema = group_schema(table, field->child);
    }
    json_object_set_new(schema, "description", json_string(field->meaning));
    if (field->is_listed && field->column) json_object_set_new(schema, "x-column", json_string(field->column));
    if (field->form_order) json_object_set_new(schema, "x-form", form_schema(field));
    if (field->list_order) json_object_set_new(schema, "x-listed", listed_schema(table, field));
    return schema;
}

/* Two members of which at most one may be given. */
static json_t *exclusion(const spec_field *field, const char *other)
{
    return json_pack("{s:{s:[s, s]}}", "not", "required", field->name, other);
}

/* A required field or what spares it. */
static json_t *one_of_siblings(const spec_field *field)
{
    const char *const names[] = { field->name, field->spared_by, field->spared_by_too };
    json_t *list = json_array();
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (names[k]) json_array_append_new(list, json_pack("{s:[s]}", "required", names[k]));
    return json_pack("{s:o}", "anyOf", list);
}

static bool is_list(const spec_table *table, spec_group group, const char *name)
{
    const spec_field *field = spec_field_find(table, group, name);
    return field && field->kind == FIELD_LONG_LIST;
}

static json_t *group_schema(const spec_table *table, spec_group group)
{
    json_t *properties = json_object(), *required = json_array(), *exclusions = json_array();
    for (size_t f = 0; f < table->count; f++) {
        const spec_field *field = &table->field[f];
        if (field->group != group) continue;
        json_object_set_new(properties, field->name, field_schema(table, field));
        if (field->required && !field->spared_by) json_array_append_new(required, json_string(field->name));
        const spec_field *other = field->required && field->spared_by ? spec_field_find(table, group, field->spared_by) : NULL;
        if (other && other->kind == FIELD_REAL) json_array_append_new(exclusions, one_of_siblings(field));
        if (field->excludes && (!isnan(field->fallback) || is_list(table, group, field->excludes)))
            json_array_append_new(exclusions, exclusion(field, field->excludes));
        if (field->excludes_too) json_array_append_new(exclusions, exclusion(field, field->excludes_too));
    }
    json_t *schema = json_pack("{s:s, s:o, s:b}", "type", "object", "properties", properties, "additionalProperties", 0);
    if (json_array_size(required)) json_object_set(schema, "required", required);
    if (json_array_size(exclusions)) json_object_set(schema, "allOf", exclusions);
    json_decref(required);
    json_decref(exclusions);
    return schema;
}

json_t *process_inputs_schema(const process_type *process) { return group_schema(process->inputs, SPEC_INPUTS); }

static json_t *inputs_description(const spec_table *table)
{
    json_t *inputs = json_object();
    for (size_t f = 0; f < table->count; f++) {
        const spec_field *field = &table->field[f];
        if (field->group != SPEC_INPUTS) continue;
        json_object_set_new(inputs, field->name,
                            json_pack("{s:s, s:s, s:i, s:i, s:o}", "title", field->name, "description", field->meaning, "minOccurs",
                                      field->required, "maxOccurs", 1, "schema", field_schema(table, field)));
    }
    return inputs;
}

/* Of each unit that a number of these inputs is kept in: the others that it may be given in, as multiples of it. */
static json_t *units_description(const spec_table *table)
{
    json_t *units = json_object();
    for (size_t f = 0; f < table->count; f++) {
        const spec_field *field = &table->field[f];
        if (field->kind != FIELD_REAL || json_object_get(units, field->unit)) continue;
        json_t *names = unit_names(field), *multiples = json_object(), *name;
        size_t i;
        double multiple;
        json_array_foreach(names, i, name) if (unit_convert(field, json_string_value(name), 1.0, &multiple))
            json_object_set_new(multiples, json_string_value(name), json_real(multiple));
        json_object_set_new(units, field->unit, json_pack("{s:s, s:o}", "usual", unit_usual(field), "multiples", multiples));
        json_decref(names);
    }
    return units;
}

static json_t *summary_of(const process_type *type)
{
    return json_pack("{s:s, s:s, s:s, s:s, s:[s, s], s:[s, s]}", "id", type->name, "title", type->title, "description",
                     type->description, "version", "1.0.0", "jobControlOptions", "async-execute", "dismiss", "outputTransmission",
                     "value", "reference");
}

json_t *process_description(const char *process)
{
    const process_type *type = process_type_find(process);
    if (!type) return NULL;
    json_t *description = summary_of(type);
    json_object_set_new(description, "inputs", inputs_description(type->inputs));
    json_object_set_new(description, "outputs", result_outputs_description(type->results));
    json_object_set_new(description, "x-units", units_description(type->inputs));
    return description;
}

json_t *process_summaries(void)
{
    json_t *summaries = json_array();
    for (size_t p = 0; process_types[p]; p++) json_array_append_new(summaries, summary_of(process_types[p]));
    return summaries;
}
