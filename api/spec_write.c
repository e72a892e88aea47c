/* Writing: the canonical inputs, in the order of the table. */
#include <math.h>

#include "spec_fields.h"
#include "spec_text.h"

static json_t *write_group(spec_group group, const drum_inputs *inputs, const void *place);

static json_t *write_scalar(const spec_field *field, double value)
{
    if (field->kind == FIELD_INTEGER) return json_integer((json_int_t)value);
    if (field->kind == FIELD_CHOICE) return json_string(field->choices[(size_t)value]);
    return json_real(value);
}

static json_t *write_list(const spec_field *field, const drum_inputs *inputs)
{
    json_t *list = json_array();
    for (size_t s = 0; list && s < inputs->species_count; s++) {
        if (json_array_append_new(list, write_group(field->child, inputs, &inputs->species[s])) != 0) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}

static json_t *write_member(const spec_field *field, const drum_inputs *inputs)
{
    if (field->kind == FIELD_LIST) return write_list(field, inputs);
    /* The lining is the only object that may be absent. */
    if (field->kind == FIELD_OBJECT_OR_NULL && isnan(inputs->lining_diameter)) return json_null();
    return write_group(field->child, inputs, inputs);
}

/* place: the struct that the offsets of the group's fields count from. NULL: no memory. */
static json_t *write_group(spec_group group, const drum_inputs *inputs, const void *place)
{
    json_t *object = json_object();
    for (size_t f = 0; object && f < spec_field_count; f++) {
        const spec_field *field = &spec_fields[f];
        if (field->group != group) continue;
        json_t *member;
        if (field->kind >= FIELD_OBJECT) {
            member = write_member(field, inputs);
        } else {
            const double value = *(const double *)((const char *)place + field->offset);
            if (isnan(value)) continue; /* its alternative was given */
            member = write_scalar(field, value);
        }
        if (json_object_set_new(object, field->name, member) != 0) {
            json_decref(object);
            return NULL;
        }
    }
    return object;
}

json_t *drum_inputs_write(const drum_inputs *inputs)
{
    return write_group(SPEC_INPUTS, inputs, inputs);
}
