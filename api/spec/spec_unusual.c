/* Numbers that are allowed, but that hardly anybody means: a unit was mistaken, or a decimal point. */
#include <math.h>
#include <stdio.h>

#include "spec_fields.h"
#include "spec_text.h"

static void warn_number(const spec_field *field, double value, const char *pointer, problem_list *warnings)
{
    if (!(field->usual_high > 0.0) || !(value < field->usual_low || value > field->usual_high)) return;
    const double meant = value * field->slip_factor;
    char slip[160] = "";
    if (field->slip_unit && meant >= field->usual_low && meant <= field->usual_high)
        snprintf(slip, sizeof slip, "; if %.6g %s were meant, give %.6g %s", value, field->slip_unit, meant, field->unit);
    problem_list_add(warnings, pointer, "is %.6g%s%s; usual is %g to %g%s%s%s", value, *field->unit ? " " : "", field->unit,
                     field->usual_low, field->usual_high, *field->unit ? " " : "", field->unit, slip);
}

/* place: the struct that the offsets of the group's fields count from. */
static void warn_group(const spec_table *table, spec_group group, const char *pointer, const char *place, problem_list *warnings);

static void warn_list(const spec_table *table, const spec_field *field, const char *pointer, const char *place,
                      problem_list *warnings)
{
    for (size_t s = 0; s < *(const size_t *)(place + field->count_offset); s++) {
        char entry[LONGEST_POINTER];
        snprintf(entry, sizeof entry, "%.200s/%zu", pointer, s);
        warn_group(table, field->child, entry, place + field->offset + s * field->entry_size, warnings);
    }
}

static void warn_group(const spec_table *table, spec_group group, const char *pointer, const char *place, problem_list *warnings)
{
    for (size_t f = 0; f < table->count; f++) {
        const spec_field *field = &table->field[f];
        if (field->group != group) continue;
        char member[LONGEST_POINTER];
        pointer_to_member(member, pointer, field->name);
        if (field->kind == FIELD_REAL || field->kind == FIELD_INTEGER)
            warn_number(field, *(const double *)(place + field->offset), member, warnings);
        else if (field->kind == FIELD_LIST) warn_list(table, field, member, place, warnings);
        else if (field->kind == FIELD_OBJECT || field->kind == FIELD_OBJECT_OR_NULL || field->kind == FIELD_CHOICE_OR_OBJECT)
            warn_group(table, field->child, member, place, warnings);
        /* long lists, of places one by one, have no unusual members */
    }
}

void spec_inputs_warn(const spec_table *table, const void *inputs, problem_list *warnings)
{
    warn_group(table, SPEC_INPUTS, "/inputs", inputs, warnings);
}
