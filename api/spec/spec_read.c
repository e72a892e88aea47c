/* Reading: from a request's inputs, whoever wrote them, to numbers within their ranges or a list of problems. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "spec_fields.h"
#include "spec_text.h"
#include "unit_table.h"

enum { LONGEST_MEMBER_NAME = 64, LONGEST_VALUE = 60 };

void json_value_text(const json_t *value, char *text, size_t size)
{
    const json_t *number = json_object_get(value, "value"), *unit = json_object_get(value, "unit");
    if (json_is_number(number) && json_is_string(unit)) {
        snprintf(text, size, "%.15g %.30s", json_number_value(number), json_string_value(unit));
        return;
    }
    if (json_is_object(value) || json_is_array(value)) {
        snprintf(text, size, json_is_object(value) ? "an object" : "a list");
        return;
    }
    if (json_is_real(value)) {
        snprintf(text, size, "%.15g", json_real_value(value));
        return;
    }
    /* ASCII, so that cutting it can't cut a character. */
    char *dumped = json_dumps(value, JSON_ENCODE_ANY | JSON_ENSURE_ASCII);
    const int length = snprintf(text, size, "%s", dumped ? dumped : "not writable");
    if (length >= (int)size) memcpy(text + size - 4, "...", 4);
    free(dumped);
}

void pointer_to_member(char pointer[LONGEST_POINTER], const char *parent, const char *name)
{
    size_t length = strnlen(parent, LONGEST_POINTER - 2);
    memcpy(pointer, parent, length);
    pointer[length++] = '/';
    for (; *name && length + 3 < LONGEST_POINTER; name++) {
        if (*name == '~' || *name == '/') {
            pointer[length++] = '~';
            pointer[length++] = *name == '~' ? '0' : '1';
        } else {
            pointer[length++] = *name;
        }
    }
    pointer[length] = '\0';
}

/* "[0.1, 5] m" */
static void range_text(const spec_field *field, char *text, size_t size)
{
    snprintf(text, size, "%s%.16g, %.16g]%s%s", field->minimum_open ? "(" : "[", field->minimum, field->maximum,
             field->unit && *field->unit ? " " : "", field->unit ? field->unit : "");
    const size_t length = strlen(text);
    if (field->least_size > 0.0) snprintf(text + length, size - length, ", and at least %g in size", field->least_size);
}

/* Why it can't be used. value: as it was written, a number or a quantity, which comes to this number. */
static void refuse_number(const spec_field *field, const json_t *value, double number, const char *pointer, problem_list *problems)
{
    const bool integer = field->kind == FIELD_INTEGER;
    const bool low = field->minimum_open ? number <= field->minimum : number < field->minimum;
    const char *space = *field->unit ? " " : "";
    char written[LONGEST_VALUE], seen[2 * LONGEST_VALUE], range[120];
    json_value_text(value, written, sizeof written);
    if (json_is_object(value)) snprintf(seen, sizeof seen, "%s, which is %.15g%s%s", written, number, space, field->unit);
    else snprintf(seen, sizeof seen, "%s%s%s", written, space, field->unit);
    range_text(field, range, sizeof range);
    if (!json_is_number(value) && !json_is_object(value))
        problem_list_add(problems, pointer, "is %s; must be %s in %s", written, integer ? "a whole number" : "a number", range);
    else if (low || !(number <= field->maximum) || fabs(number) < field->least_size)
        problem_list_add(problems, pointer, "is %s; must be in %s", seen, range);
    else if (integer && number != floor(number))
        problem_list_add(problems, pointer, "is %s; must be a whole number in %s", seen, range);
    else /* below the smallest normal double digits are already lost: such a number is a slip, not a wish */
        problem_list_add(problems, pointer, "is %s; too close to 0 to be kept, must be in %s", seen, range);
}

/* Of {"value": 15, "unit": "rpm"} what it comes to in the field's unit; false: that can't be told, and a problem says why. */
static bool read_quantity(const spec_field *field, const json_t *quantity, const char *pointer, double *number,
                          problem_list *problems)
{
    static const char *const known[] = { "value", "unit", NULL };
    const json_t *value = json_object_get(quantity, "value"), *unit = json_object_get(quantity, "unit");
    char seen[LONGEST_VALUE], allowed[UNITS_TEXT_SIZE], range[120];
    unit_names_text(field, allowed);
    range_text(field, range, sizeof range);
    if (value || unit) refuse_unknown_members(quantity, pointer, known, problems);
    if (!value && !unit) {
        problem_list_add(problems, pointer, "is an object; must be %s in %s, or {\"value\": ..., \"unit\": ...}",
                         field->kind == FIELD_INTEGER ? "a whole number" : "a number", range);
    } else if (!json_is_number(value)) {
        json_value_text(value, seen, sizeof seen);
        problem_list_add(problems, pointer, "has %s%s; must be a number in %s", value ? "the value " : "no value",
                         value ? seen : "", range);
    } else if (!json_is_string(unit)) {
        json_value_text(unit, seen, sizeof seen);
        problem_list_add(problems, pointer, "has the value %.15g and %s%s; units allowed: %s", json_number_value(value),
                         unit ? "the unit " : "no unit", unit ? seen : "", allowed);
    } else if (unit_convert(field, json_string_value(unit), json_number_value(value), number)) {
        return true;
    } else {
        json_value_text(unit, seen, sizeof seen);
        problem_list_add(problems, pointer, "is %.15g with the unit %s; units allowed: %s", json_number_value(value), seen,
                         allowed);
    }
    return false;
}

/* Nothing is written in words before something is wrong: a bed of ten thousand particles has ten times as many numbers. */
static double read_number(const spec_field *field, const json_t *value, const char *pointer, problem_list *problems)
{
    double number = json_number_value(value);
    if (json_is_object(value) && !read_quantity(field, value, pointer, &number, problems)) return NAN;
    const bool high_enough = field->minimum_open ? number > field->minimum : number >= field->minimum;
    const bool whole_where_asked = field->kind != FIELD_INTEGER || number == floor(number);
    const bool kept = number == 0.0 || fabs(number) >= 2.2250738585072014e-308; /* the smallest normal double */
    if ((json_is_number(value) || json_is_object(value)) && high_enough && number <= field->maximum
        && fabs(number) >= field->least_size && whole_where_asked && kept)
        return number == 0.0 ? 0.0 : number; /* -0 would be another text for the same input */
    refuse_number(field, value, number, pointer, problems);
    return NAN;
}

static double read_choice(const spec_field *field, const json_t *value, const char *pointer, problem_list *problems)
{
    const char *word = json_string_value(value);
    for (size_t c = 0; word && field->choices[c]; c++)
        if (strcmp(word, field->choices[c]) == 0) return (double)c;
    char seen[LONGEST_VALUE], available[200] = "";
    json_value_text(value, seen, sizeof seen);
    for (size_t c = 0; field->choices[c]; c++) {
        const size_t length = strlen(available);
        snprintf(available + length, sizeof available - length, "%s\"%s\"", c ? ", " : "", field->choices[c]);
    }
    if (field->kind == FIELD_CHOICE_OR_OBJECT)
        snprintf(available + strlen(available), sizeof available - strlen(available), ", or an object");
    problem_list_add(problems, pointer, "is %s; available: %s", seen, available);
    return NAN;
}

static void refuse_unknown_inputs(const spec_table *table, spec_group group, const json_t *object, const char *pointer,
                                  problem_list *problems)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)object, name, value)
    {
        if (problem_list_is_full(problems)) return;
        if (spec_field_find(table, group, name)) continue;
        if (strlen(name) > LONGEST_MEMBER_NAME) {
            problem_list_add(problems, pointer, "has an unknown member with a name of %zu bytes", strlen(name));
            continue;
        }
        char unknown[LONGEST_POINTER], near[100];
        pointer_to_member(unknown, pointer, name);
        const spec_field *nearest = spec_field_nearest(table, group, name);
        if (nearest) {
            spec_field_path(table, nearest, near, sizeof near);
            problem_list_add(problems, unknown, "is not an input; did you mean inputs/%s?", near);
            continue;
        }
        char known[300] = "";
        for (size_t f = 0; f < table->count; f++) {
            const size_t length = strlen(known);
            if (table->field[f].group == group)
                snprintf(known + length, sizeof known - length, "%s%s", length ? ", " : "", table->field[f].name);
        }
        problem_list_add(problems, unknown, "is not an input; available here: %s", known);
    }
}

void refuse_unknown_members(const json_t *object, const char *pointer, const char *const *known, problem_list *problems)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)object, name, value)
    {
        if (problem_list_is_full(problems)) return;
        size_t k = 0;
        while (known[k] && strcmp(known[k], name) != 0) k++;
        if (known[k]) continue;
        char unknown[LONGEST_POINTER] = "";
        if (strlen(name) <= LONGEST_MEMBER_NAME) pointer_to_member(unknown, pointer, name);
        problem_list_add(problems, *unknown ? unknown : pointer, "is not a known member");
    }
}

/* A pointer to entries of its own is not read as the entries themselves. */
static char *list_memory(const spec_field *field, size_t count, char *place)
{
    if (field->kind == FIELD_LIST) return place + field->offset;
    *(void **)(place + field->offset) = NULL;
    if (count == 0) return place;
    return *(void **)(place + field->offset) = calloc(count, field->entry_size);
}

/* object: NULL reads the defaults. place: the struct that the offsets of the group's fields count from. */
static void read_group(const spec_table *table, spec_group group, const json_t *object, const char *pointer, char *place,
                       problem_list *problems);

static void set_nothing_given(const spec_table *table, spec_group group, char *place);

/* An entry of a list, at the pointer. */
static void read_entry(const spec_table *table, const spec_field *field, const json_t *object, const char *pointer, char *entry,
                       problem_list *problems)
{
    set_nothing_given(table, field->child, entry);
    if (json_is_object(object)) {
        read_group(table, field->child, object, pointer, entry, problems);
        return;
    }
    char seen[LONGEST_VALUE];
    json_value_text(object, seen, sizeof seen);
    problem_list_add(problems, pointer, "is %s; must be an object", seen);
}

static void read_named_list(const spec_table *table, const spec_field *field, const json_t *list, const char *pointer, char *place,
                            problem_list *problems)
{
    char seen[LONGEST_VALUE], member[LONGEST_POINTER];
    const size_t count = json_object_size(list);
    if (!json_is_object(list)) {
        json_value_text(list, seen, sizeof seen);
        problem_list_add(problems, pointer, "is %s; must be an object whose members are objects", seen);
        return;
    }
    if (count > (size_t)field->maximum) {
        problem_list_add(problems, pointer, "has %zu members; must have at most %.0f", count, field->maximum);
        return;
    }
    char *entry = list_memory(field, count, place);
    if (!entry) {
        problem_list_add(problems, pointer, "could not be read: out of memory");
        return;
    }
    *(size_t *)(place + field->count_offset) = count;
    const char *name;
    json_t *object;
    json_object_foreach((json_t *)list, name, object)
    {
        const size_t length = strlen(name);
        if (length < 1 || length > NAME_MOST)
            problem_list_add(problems, pointer, "has a member whose name has %zu bytes; must have 1 to %d", length, NAME_MOST);
        pointer_to_member(member, pointer, length <= NAME_MOST ? name : "");
        read_entry(table, field, object, member, entry, problems);
        snprintf(entry, sizeof(spec_name), "%s", length <= NAME_MOST ? name : "");
        entry += field->entry_size;
    }
}

static void read_list(const spec_table *table, const spec_field *field, const json_t *list, const char *pointer, char *place,
                      problem_list *problems)
{
    const size_t count = json_array_size(list);
    char seen[LONGEST_VALUE];
    if (!json_is_array(list)) {
        json_value_text(list, seen, sizeof seen);
        problem_list_add(problems, pointer, "is %s; must be a list of objects", seen);
        return;
    }
    if (count < (size_t)field->minimum || count > (size_t)field->maximum) {
        problem_list_add(problems, pointer, "has %zu entries; must have %.0f to %.0f", count, field->minimum, field->maximum);
        return;
    }
    char *first = list_memory(field, count, place);
    if (!first) {
        problem_list_add(problems, pointer, "could not be read: out of memory");
        return;
    }
    for (size_t s = 0; s < count; s++) {
        char entry[LONGEST_POINTER];
        if (problem_list_is_full(problems)) { /* nobody reads on */
            set_nothing_given(table, field->child, first + s * field->entry_size);
            continue;
        }
        snprintf(entry, sizeof entry, "%.200s/%zu", pointer, s);
        read_entry(table, field, json_array_get(list, s), entry, first + s * field->entry_size, problems);
    }
    *(size_t *)(place + field->count_offset) = count;
}

static void read_object(const spec_table *table, const spec_field *field, const json_t *value, const char *pointer, char *place,
                        problem_list *problems)
{
    if (field->kind == FIELD_OBJECT_OR_NULL && (!value || json_is_null(value))) return;
    if (field->kind == FIELD_OBJECT_OR_NULL)
        *(double *)(place + field->offset) = 1.0; /* until a member that is kept there says it */
    if (value && !json_is_object(value)) {
        if (field->is_left_out_where_null) *(double *)(place + field->offset) = NAN; /* refused: none */
        char seen[LONGEST_VALUE];
        json_value_text(value, seen, sizeof seen);
        problem_list_add(problems, pointer, "is %s; must be an object%s", seen,
                         field->kind == FIELD_OBJECT_OR_NULL ? " or null" : "");
        return;
    }
    read_group(table, field->child, value, pointer, place, problems);
}

static bool is_given(const json_t *object, const char *name)
{
    const json_t *value = name ? json_object_get(object, name) : NULL;
    return value && !json_is_null(value);
}

static double read_true(const json_t *value, const char *pointer, problem_list *problems)
{
    if (json_is_true(value)) return 1.0;
    char seen[LONGEST_VALUE];
    json_value_text(value, seen, sizeof seen);
    problem_list_add(problems, pointer, "is %s; must be true, or be left out", seen);
    return NAN;
}

static bool is_spared(const char *by, const json_t *object)
{
    const json_t *sparing = by ? json_object_get(object, by) : NULL;
    return json_is_object(sparing) || json_is_array(sparing) || json_is_number(sparing);
}

/* A member that has a number or a word; the other of two alternatives stays NaN. */
static double read_scalar(const spec_field *field, const json_t *object, const char *pointer, problem_list *problems)
{
    const json_t *value = json_object_get(object, field->name);
    const char *other = is_given(object, field->excludes)       ? field->excludes
                        : is_given(object, field->excludes_too) ? field->excludes_too
                                                                : NULL;
    const bool excluded = other != NULL;
    if (value && excluded && isnan(field->fallback)) {
        problem_list_add(problems, pointer, "is given beside %s; give one of the two", other);
        return NAN;
    }
    if (value && field->kind == FIELD_CHOICE) return read_choice(field, value, pointer, problems);
    if (value && field->kind == FIELD_TRUE) return read_true(value, pointer, problems);
    if (value) return read_number(field, value, pointer, problems);
    if (field->required && !is_spared(field->spared_by, object) && !is_spared(field->spared_by_too, object)) {
        char range[120];
        range_text(field, range, sizeof range);
        problem_list_add(problems, pointer, "is missing; must be a number in %s", range);
    }
    return excluded || is_given(object, field->spared_beside) ? NAN : field->fallback;
}

static void read_text(const spec_field *field, const json_t *value, const char *pointer, char *text, problem_list *problems)
{
    char seen[LONGEST_VALUE];
    *text = '\0';
    if (!value && !field->required) return;
    const size_t length = json_string_length(value);
    if (!json_is_string(value)) {
        json_value_text(value, seen, sizeof seen);
        problem_list_add(problems, pointer, "is %s; must be a text of %g to %g bytes", value ? seen : "missing", field->minimum,
                         field->maximum);
    } else if ((double)length < field->minimum || (double)length > field->maximum)
        problem_list_add(problems, pointer, "has %zu bytes; must have %g to %g", length, field->minimum, field->maximum);
    else memcpy(text, json_string_value(value), length + 1);
}

static void read_two_names(const spec_field *field, const json_t *value, const char *pointer, spec_name *names,
                           problem_list *problems)
{
    char seen[LONGEST_VALUE], entry[LONGEST_POINTER];
    names[0][0] = names[1][0] = '\0';
    if (json_array_size(value) != 2) {
        json_value_text(value, seen, sizeof seen);
        if (json_is_array(value)) snprintf(seen, sizeof seen, "a list of %zu", json_array_size(value));
        problem_list_add(problems, pointer, "is %s; must be a list of two names", value ? seen : "missing");
        return;
    }
    for (size_t c = 0; c < 2; c++) {
        snprintf(entry, sizeof entry, "%.200s/%zu", pointer, c);
        read_text(field, json_array_get(value, c), entry, names[c], problems);
    }
}

/* unit: of all of them; NULL: that of the field. */
static void read_entries(const spec_field *field, const json_t *list, const json_t *unit, const char *pointer, double *numbers,
                         problem_list *problems)
{
    char entry[LONGEST_POINTER];
    for (size_t c = 0; c < json_array_size(list); c++) {
        snprintf(entry, sizeof entry, "%.200s/%zu", pointer, c);
        json_t *number = json_array_get(list, c);
        json_t *quantity = unit ? json_pack("{s:O, s:O}", "value", number, "unit", unit) : NULL;
        numbers[c] = read_number(field, quantity ? quantity : number, entry, problems);
        json_decref(quantity);
    }
}

/* Three or four numbers of the field's range. */
static void read_place(const spec_field *field, const json_t *value, const char *pointer, double *place, problem_list *problems)
{
    const size_t numbers = field->kind == FIELD_ORIENTATION ? 4 : 3;
    char seen[LONGEST_VALUE], range[120];
    for (size_t c = 0; c < numbers; c++) place[c] = field->required ? NAN : field->fallback;
    if (!value && !field->required) return;
    const json_t *unit = is_quantity(value) ? json_object_get(value, "unit") : NULL; /* of all of them */
    if (unit) value = json_object_get(value, "value");
    if (json_array_size(value) != numbers) {
        range_text(field, range, sizeof range);
        json_value_text(value, seen, sizeof seen);
        if (json_is_array(value)) snprintf(seen, sizeof seen, "a list of %zu", json_array_size(value));
        problem_list_add(problems, pointer, "is %s; must be a list of %s numbers, each in %s", value ? seen : "missing",
                         numbers == 4 ? "four" : "three", range);
        return;
    }
    read_entries(field, value, unit, pointer, place, problems);
}

/* Numbers of the field's range, as many as there are. */
static void read_numbers(const spec_field *field, const json_t *value, const char *pointer, char *place, problem_list *problems)
{
    char seen[LONGEST_VALUE], range[120];
    double *numbers = (double *)(place + field->offset);
    const json_t *unit = is_quantity(value) ? json_object_get(value, "unit") : NULL; /* of all of them */
    if (unit) value = json_object_get(value, "value");
    const size_t count = json_array_size(value);
    if (!value) return;
    if (!json_is_array(value) || count < field->least_entries || count > field->most_entries) {
        range_text(field, range, sizeof range);
        json_value_text(value, seen, sizeof seen);
        if (json_is_array(value)) snprintf(seen, sizeof seen, "a list of %zu", count);
        problem_list_add(problems, pointer, "is %s; must be a list of %zu to %zu numbers, each in %s", seen, field->least_entries,
                         field->most_entries, range);
        return;
    }
    read_entries(field, value, unit, pointer, numbers, problems);
    *(size_t *)(place + field->count_offset) = count;
}

static void read_choice_or_object(const spec_table *table, const spec_field *field, const json_t *value, const char *pointer,
                                  char *place, problem_list *problems)
{
    double *choice = (double *)(place + field->offset);
    *choice = field->fallback;
    if (json_is_object(value)) {
        size_t words = 0;
        while (field->choices[words]) words++;
        *choice = (double)words;
        read_group(table, field->child, value, pointer, place, problems);
    } else if (value) {
        *choice = read_choice(field, value, pointer, problems);
    }
}

static void read_group(const spec_table *table, spec_group group, const json_t *object, const char *pointer, char *place,
                       problem_list *problems)
{
    for (size_t f = 0; f < table->count; f++) {
        const spec_field *field = &table->field[f];
        if (field->group != group) continue;
        char member[LONGEST_POINTER];
        pointer_to_member(member, pointer, field->name);
        const json_t *value = json_object_get(object, field->name);
        if (field->kind >= FIELD_OBJECT && field->required && !value) {
            problem_list_add(problems, member, "is missing; must be %s",
                             field->kind >= FIELD_LIST ? "a list of objects" : "an object");
        } else if (field->kind == FIELD_LONG_LIST || field->kind == FIELD_NAMED_LIST) {
            if (value) (field->kind == FIELD_LONG_LIST ? read_list : read_named_list)(table, field, value, member, place, problems);
        } else if (field->kind == FIELD_LIST) {
            read_list(table, field, value, member, place, problems);
        } else if (field->kind == FIELD_TEXT) {
            read_text(field, value, member, place + field->offset, problems);
        } else if (field->kind == FIELD_TWO_NAMES) {
            read_two_names(field, value, member, (spec_name *)(place + field->offset), problems);
        } else if (field->kind == FIELD_PLACE || field->kind == FIELD_ORIENTATION) {
            read_place(field, value, member, (double *)(place + field->offset), problems);
        } else if (field->kind == FIELD_NUMBERS) {
            read_numbers(field, value, member, place, problems);
        } else if (field->kind == FIELD_CHOICE_OR_OBJECT) {
            read_choice_or_object(table, field, value, member, place, problems);
        } else if (field->kind >= FIELD_OBJECT) {
            read_object(table, field, value, member, place, problems);
        } else {
            *(double *)(place + field->offset) = read_scalar(field, object, member, problems);
        }
    }
    refuse_unknown_inputs(table, group, object, pointer, problems);
}

static void set_nothing_given(const spec_table *table, spec_group group, char *place)
{
    for (size_t f = 0; f < table->count; f++) {
        const spec_field *field = &table->field[f];
        if (field->group != group) continue;
        if (field->kind == FIELD_CHOICE_OR_OBJECT) set_nothing_given(table, field->child, place);
        if (field->kind == FIELD_OBJECT_OR_NULL) *(double *)(place + field->offset) = NAN;
        if (field->kind == FIELD_TEXT || field->kind == FIELD_TWO_NAMES) {
            place[field->offset] = '\0';
        } else if (field->kind == FIELD_NUMBERS) {
            *(size_t *)(place + field->count_offset) = 0;
        } else if (field->kind == FIELD_LONG_LIST || field->kind == FIELD_NAMED_LIST) {
            *(void **)(place + field->offset) = NULL;
            *(size_t *)(place + field->count_offset) = 0;
        } else if (field->kind < FIELD_OBJECT) *(double *)(place + field->offset) = NAN;
        else if (field->kind < FIELD_LIST) set_nothing_given(table, field->child, place);
        else {
            *(size_t *)(place + field->count_offset) = 0;
            /* The others as they are read: most lists are short, and have room for many. */
            set_nothing_given(table, field->child, place + field->offset);
        }
    }
}

void spec_inputs_read(const spec_table *table, const json_t *object, void *inputs, problem_list *problems)
{
    set_nothing_given(table, SPEC_INPUTS, inputs);
    read_group(table, SPEC_INPUTS, object, "/inputs", inputs, problems);
}

void spec_inputs_clear(const spec_table *table, void *inputs)
{
    for (size_t f = 0; f < table->count; f++) {
        if (table->field[f].kind != FIELD_LONG_LIST && table->field[f].kind != FIELD_NAMED_LIST) continue;
        void **memory = (void **)((char *)inputs + table->field[f].offset);
        free(*memory);
        *memory = NULL;
    }
}
