/* Writing: the canonical inputs, in the order of the table. */
#include <math.h>

#include "spec_fields.h"
#include "spec_text.h"

static json_t *write_scalar(const spec_field *field, double value)
{
    if (field->kind == FIELD_INTEGER) return json_integer((json_int_t)value);
    if (field->kind == FIELD_CHOICE) return json_string(field->choices[(size_t)value]);
    if (field->kind == FIELD_TRUE) return json_true();
    return json_real(value);
}

/* What is written: all inputs, or those that a settled bed depends on. */
typedef enum written { ALL_INPUTS, INPUTS_OF_BED } written;

/* place: the struct that the offsets of the group's fields count from. NULL: no memory. */
static json_t *write_group(const spec_table *table, spec_group group, const char *place, written what);

static json_t *write_list(const spec_table *table, const spec_field *field, const char *place, written what)
{
    const bool is_named = field->kind == FIELD_NAMED_LIST;
    json_t *list = is_named ? json_object() : json_array();
    const size_t count = *(const size_t *)(place + field->count_offset);
    const char *first = place + field->offset;
    if (field->kind >= FIELD_LONG_LIST) first = *(const char *const *)first;
    for (size_t s = 0; list && s < count; s++) {
        const char *entry = first + s * field->entry_size;
        json_t *object = write_group(table, field->child, entry, what);
        if (is_named ? json_object_set_new(list, entry, object) : json_array_append_new(list, object)) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}

static json_t *write_numbers(const double *numbers, size_t count)
{
    json_t *list = json_array();
    for (size_t k = 0; k < count; k++) json_array_append_new(list, json_real(numbers[k]));
    return list;
}

static json_t *write_member(const spec_table *table, const spec_field *field, const char *place, written what)
{
    if (field->kind >= FIELD_LIST) return write_list(table, field, place, what);
    if (field->kind == FIELD_OBJECT_OR_NULL && isnan(*(const double *)(place + field->offset))) return json_null();
    return write_group(table, field->child, place, what);
}

static json_t *write_group(const spec_table *table, spec_group group, const char *place, written what)
{
    json_t *object = json_object();
    for (size_t f = 0; object && f < table->count; f++) {
        const spec_field *field = &table->field[f];
        if (field->group != group || (field->acts_later && what == INPUTS_OF_BED)) continue;
        if (field->is_left_out_where_null && isnan(*(const double *)(place + field->offset))) continue;
        json_t *member;
        if (field->kind == FIELD_TEXT) {
            if (!place[field->offset]) continue;
            member = json_string(place + field->offset);
        } else if (field->kind == FIELD_NUMBERS) {
            const size_t count = *(const size_t *)(place + field->count_offset);
            if (count == 0) continue;
            member = write_numbers((const double *)(place + field->offset), count);
        } else if (field->kind >= FIELD_LONG_LIST && *(const size_t *)(place + field->count_offset) == 0) {
            continue;
        } else if (field->kind == FIELD_ORIENTATION) {
            const double *q = (const double *)(place + field->offset);
            if (isnan(q[0])) continue;
            member = json_pack("[f, f, f, f]", q[0], q[1], q[2], q[3]);
        } else if (field->kind == FIELD_TWO_NAMES) {
            const spec_name *names = (const spec_name *)(place + field->offset);
            member = json_pack("[s, s]", names[0], names[1]);
        } else if (field->kind == FIELD_PLACE) {
            const double *x = (const double *)(place + field->offset);
            member = json_pack("[f, f, f]", x[0], x[1], x[2]);
        } else if (field->kind == FIELD_CHOICE_OR_OBJECT) {
            const char *word = field->choices[(size_t) * (const double *)(place + field->offset)];
            member = word ? json_string(word) : write_group(table, field->child, place, what);
        } else if (field->kind >= FIELD_OBJECT) {
            member = write_member(table, field, place, what);
        } else {
            const double value = *(const double *)(place + field->offset);
            if (isnan(value)) continue; /* its alternative was given, or it has no default */
            if (field->is_left_out_by_default && value == field->fallback) continue;
            member = write_scalar(field, value);
        }
        if (json_object_set_new(object, field->name, member) != 0) {
            json_decref(object);
            return NULL;
        }
    }
    return object;
}

json_t *spec_inputs_write(const spec_table *table, const void *inputs)
{
    return write_group(table, SPEC_INPUTS, inputs, ALL_INPUTS);
}

json_t *spec_inputs_of_bed(const spec_table *table, const void *inputs)
{
    return write_group(table, SPEC_INPUTS, inputs, INPUTS_OF_BED);
}
