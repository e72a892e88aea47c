/* What is kept of inputs and results in SQL, gathered from the rows of all processes: the columns of the tables
 * <process>_input and <output>_result, and which of them the view run_summary, a job's summary and a study's results show. */
#ifndef FIELD_COLUMNS_H
#define FIELD_COLUMNS_H

#include "process_type.h"

typedef struct field_column {
    char table[40];              /* "drum_input", "repose_result" */
    char name[64];               /* in its table */
    char shown_as[64];           /* in the view, in summaries and in studies; columns of one such name are one there */
    const char *type;            /* of SQL: "REAL", "INTEGER", "TEXT" */
    const process_type *process; /* the first that has it */
    const spec_field *input;     /* the row; NULL: it is a result */
    const result_field *result;  /* the first row of its name; NULL: it is an input */
    int in_view, in_study;       /* places, as the rows say; 0: not there */
    bool is_listed;
    const char *run_error; /* shown_as of a single run's own error of it; NULL: there is none */
} field_column;

typedef struct field_columns {
    field_column *column; /* (count) in the order of the processes and of their rows; owned */
    size_t count;
} field_columns;

/* False: no memory. */
bool field_columns_gather(field_columns *columns);
void field_columns_clear(field_columns *columns);

typedef enum field_columns_kind { COLUMNS_IN_VIEW, COLUMNS_IN_STUDY, COLUMNS_LISTED } field_columns_kind;

/* Those of a kind by their places; the listed ones in the order of their rows. list: room for columns->count. */
size_t field_columns_select(const field_columns *columns, field_columns_kind kind, const field_column **list);

/* True or false, which SQL keeps as 1 or 0. */
bool field_column_is_truth(const field_column *column);

#endif
