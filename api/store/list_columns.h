/* What jobs are listed by beside their states: facts of each job, and the columns of inputs and results under the names that
 * summaries and the view run_summary have for them. */
#ifndef LIST_COLUMNS_H
#define LIST_COLUMNS_H

#include "field_columns.h"

typedef enum list_column_kind { LIST_NUMBER, LIST_TIME, LIST_WORD, LIST_TRUTH } list_column_kind;

typedef struct list_column {
    const char *name;
    list_column_kind kind;
    const char *unit, *meaning;
} list_column;

/* Columns of the table job. */
extern const list_column list_facts[];
extern const size_t list_fact_count;

/* False: there is none of that name. */
bool list_column_find(const field_columns *columns, const char *name, list_column *found);
/* What a name was probably meant to be; NULL: nothing is near. */
const char *list_column_nearest(const field_columns *columns, const char *name);

#endif
