/* Writes the results document from a process's table of results. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "json_text.h"
#include "result_fields.h"

void results_init(const result_table *table, void *results, size_t size)
{
    memset(results, 0, size);
    for (size_t f = 0; f < table->count; f++) {
        const result_kind kind = table->field[f].kind;
        if (kind == RESULT_REAL || kind == RESULT_WHOLE || kind == RESULT_MAYBE)
            *(double *)((char *)results + table->field[f].offset) = NAN;
    }
}

static json_t *field_value(const result_field *field, const void *results)
{
    const char *place = (const char *)results + field->offset;
    switch (field->kind) {
    case RESULT_SIZE: return json_integer((json_int_t) * (const size_t *)place);
    case RESULT_TRUTH: return json_boolean(*(const bool *)place);
    case RESULT_WHOLE:
        if (isfinite(*(const double *)place)) return json_integer((json_int_t) * (const double *)place);
        return json_null();
    case RESULT_MAYBE: return isnan(*(const double *)place) ? json_null() : json_boolean(*(const double *)place != 0.0);
    case RESULT_WORD:
    case RESULT_TEXT: return *(const char *const *)place ? json_string(*(const char *const *)place) : json_null();
    default: return json_real_or_null(*(const double *)place);
    }
}

/* The object that a field is a member of, made when it is first needed. Borrowed. */
static json_t *field_parent(json_t *document, const result_field *field)
{
    json_t *output = json_object_get(document, field->output);
    if (!output && json_object_set_new(document, field->output, json_object()) != 0) return NULL;
    output = json_object_get(document, field->output);
    if (!field->group) return output;
    if (!json_object_get(output, field->group)) json_object_set_new(output, field->group, json_object());
    return json_object_get(output, field->group);
}

json_t *results_to_json(const result_table *table, const void *results)
{
    json_t *document = json_object();
    bool complete = document != NULL;
    for (size_t f = 0; complete && f < table->count; f++) {
        const result_field *field = &table->field[f];
        if (field->kind == RESULT_WARNINGS) continue;
        complete = json_object_set_new(field_parent(document, field), field->name, field_value(field, results)) == 0;
    }
    if (complete) return document;
    json_decref(document);
    return NULL;
}
