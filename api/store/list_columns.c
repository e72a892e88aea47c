#include "list_columns.h"

#include <string.h>

const list_column list_facts[] = {
    { "created", LIST_TIME, "", "when the job was posted" },
    { "started", LIST_TIME, "", "when it first began to run" },
    { "finished", LIST_TIME, "", "when it ended" },
    { "updated", LIST_TIME, "", "when what is told of it last changed" },
    { "progress", LIST_NUMBER, "%", "how much of it is done" },
    { "priority", LIST_NUMBER, "", "-10 to 10; higher ones run first" },
    { "attempt", LIST_NUMBER, "", "how many times it was begun" },
    { "estimated_seconds", LIST_NUMBER, "s", "how long it was expected to run when it was posted" },
};
const size_t list_fact_count = sizeof list_facts / sizeof list_facts[0];

static list_column_kind kind_of(const field_column *column)
{
    if (field_column_is_truth(column)) return LIST_TRUTH;
    return strcmp(column->type, "TEXT") == 0 ? LIST_WORD : LIST_NUMBER;
}

bool list_column_find(const field_columns *columns, const char *name, list_column *found)
{
    for (size_t f = 0; f < list_fact_count; f++) {
        *found = list_facts[f];
        if (strcmp(found->name, name) == 0) return true;
    }
    for (size_t c = 0; c < columns->count; c++) {
        const field_column *column = &columns->column[c];
        if (strcmp(column->shown_as, name) != 0) continue;
        *found = (list_column){ column->shown_as, kind_of(column), column->input ? column->input->unit : column->result->unit,
                                column->input ? column->input->meaning : column->result->meaning };
        return true;
    }
    return false;
}

const char *list_column_nearest(const field_columns *columns, const char *name)
{
    const char *nearest = NULL;
    size_t least = strlen(name) / 3 + 1; /* a third of the letters wrong is another word */
    for (size_t k = 0; k < list_fact_count + columns->count; k++) {
        const char *one = k < list_fact_count ? list_facts[k].name : columns->column[k - list_fact_count].shown_as;
        const size_t distance = name_distance(name, one);
        if (distance >= least) continue;
        least = distance;
        nearest = one;
    }
    return nearest;
}
