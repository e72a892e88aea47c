/* Which inputs a request had. */
#include "spec_fields.h"
#include "spec_text.h"

#include <stdio.h>
#include <string.h>

enum { LONGEST_PATH = 200 };

static void add_given(const spec_table *table, spec_group group, const json_t *object, const char *above, json_t *given)
{
    const char *name;
    json_t *member;
    json_object_foreach((json_t *)object, name, member)
    {
        char path[LONGEST_PATH];
        const spec_field *field = spec_field_find(table, group, name);
        if (!field) continue;
        snprintf(path, sizeof path, "%s%s%s", above, *above ? "/" : "", name);
        const bool has_members = field->kind == FIELD_OBJECT || field->kind == FIELD_OBJECT_OR_NULL;
        if (has_members && json_is_object(member)) add_given(table, field->child, member, path, given);
        else json_array_append_new(given, json_string(path));
    }
}

json_t *spec_inputs_given(const spec_table *table, const json_t *inputs)
{
    json_t *given = json_array();
    if (given) add_given(table, SPEC_INPUTS, inputs, "", given);
    return given;
}
