/* Looking up fields of a table by their names, right or nearly right. */
#include "spec_fields.h"

#include <stdio.h>
#include <string.h>

const spec_field *spec_field_find(const spec_table *table, spec_group group, const char *name)
{
    for (size_t f = 0; f < table->count; f++)
        if (table->field[f].group == group && strcmp(table->field[f].name, name) == 0) return &table->field[f];
    return NULL;
}

enum { LONGEST_NAME = 40 };

const spec_field *spec_field_at(const spec_table *table, const char *pointer)
{
    const spec_field *field = NULL;
    spec_group group = SPEC_INPUTS;
    bool is_inside = false; /* an entry of the list that `field` is */
    for (const char *step = pointer; *step;) {
        const size_t length = strcspn(step, "/");
        char name[LONGEST_NAME + 1];
        snprintf(name, sizeof name, "%.*s", (int)length, step);
        const bool is_number = strspn(name, "0123456789") == strlen(name), was_list = field && field->kind >= FIELD_LIST;
        const bool is_entry = was_list && !is_inside && (is_number || field->kind == FIELD_NAMED_LIST);
        if (!is_entry) field = spec_field_find(table, group, name);
        if (!field) return NULL;
        is_inside = is_entry;
        group = field->child;
        step += length + (step[length] == '/');
    }
    return field;
}

size_t name_distance(const char *a, const char *b)
{
    const size_t length_a = strlen(a), length_b = strlen(b);
    if (length_a > LONGEST_NAME || length_b > LONGEST_NAME) return LONGEST_NAME;
    size_t row[LONGEST_NAME + 1];
    for (size_t j = 0; j <= length_b; j++) row[j] = j;
    for (size_t i = 1; i <= length_a; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= length_b; j++) {
            const size_t above = row[j];
            size_t least = diagonal + (a[i - 1] != b[j - 1]);
            if (above + 1 < least) least = above + 1;
            if (row[j - 1] + 1 < least) least = row[j - 1] + 1;
            diagonal = above;
            row[j] = least;
        }
    }
    return row[length_b];
}

const spec_field *spec_field_nearest(const spec_table *table, spec_group group, const char *name)
{
    const spec_field *nearest = NULL;
    size_t least = strlen(name) / 3 + 1; /* a third of the letters wrong is another word */
    for (size_t f = 0; f < table->count; f++) {
        if (table->field[f].group != group) continue;
        const size_t distance = name_distance(name, table->field[f].name);
        if (distance < least) {
            least = distance;
            nearest = &table->field[f];
        }
    }
    /* Only the beginning of a name: "fill". */
    for (size_t f = 0; f < table->count && !nearest && strlen(name) >= 3; f++)
        if (table->field[f].group == group && strncmp(table->field[f].name, name, strlen(name)) == 0) nearest = &table->field[f];
    /* The right name in the wrong object. */
    for (size_t f = 0; f < table->count && !nearest; f++)
        if (strcmp(table->field[f].name, name) == 0) nearest = &table->field[f];
    return nearest;
}

void spec_field_path(const spec_table *table, const spec_field *field, char *path, size_t size)
{
    path[0] = '\0';
    if (field->group != SPEC_INPUTS)
        for (size_t f = 0; f < table->count; f++)
            if (table->field[f].kind >= FIELD_CHOICE_OR_OBJECT && table->field[f].child == field->group)
                spec_field_path(table, &table->field[f], path, size);
    const size_t length = strlen(path);
    snprintf(path + length, size - length, "%s%s", length ? "/" : "", field->name);
}
