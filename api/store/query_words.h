/* What the tables and columns of SQL mean, where the rows of inputs and results do not say it. */
#ifndef QUERY_WORDS_H
#define QUERY_WORDS_H

#include "field_columns.h"

/* NULL: the table is for the daemon's own use. */
const char *query_table_meaning(const field_columns *columns, const char *table);

typedef struct column_words {
    const char *unit, *meaning; /* "" where there is none */
} column_words;
column_words query_column_words(const field_columns *columns, const char *table, const char *column);

#endif
