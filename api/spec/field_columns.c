#include "field_columns.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t count_rows(void)
{
    size_t count = 0;
    for (size_t p = 0; process_types[p]; p++) count += process_types[p]->inputs->count + process_types[p]->results->count;
    return count;
}

/* A name that does not fit is a mistake in a row. */
__attribute__((format(printf, 3, 4))) static void write_name(char *name, size_t size, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(name, size, format, values);
    va_end(values);
    assert(length > 0 && (size_t)length < size);
    (void)length;
}

static const char *type_of_input(const spec_field *field)
{
    switch (field->column_kind) {
    case COLUMN_REAL: return "REAL";
    case COLUMN_WORD: return "TEXT";
    default: return "INTEGER";
    }
}

static const char *type_of_result(const result_field *field)
{
    switch (field->kind) {
    case RESULT_REAL: return "REAL";
    case RESULT_TEXT:
    case RESULT_WORD: return "TEXT";
    default: return "INTEGER";
    }
}

static void add_input(field_columns *columns, const process_type *process, const spec_field *field)
{
    field_column *column = &columns->column[columns->count++];
    *column = (field_column){
        .type = type_of_input(field), .process = process, .input = field, .in_view = field->in_view, .is_listed = field->is_listed
    };
    write_name(column->table, sizeof column->table, "%s_input", process->name);
    write_name(column->name, sizeof column->name, "%s", field->column);
    write_name(column->shown_as, sizeof column->shown_as, "%s", field->column);
}

static field_column *find(const field_columns *columns, const char *table, const char *name)
{
    for (size_t c = 0; c < columns->count; c++)
        if (strcmp(columns->column[c].name, name) == 0 && strcmp(columns->column[c].table, table) == 0) return &columns->column[c];
    return NULL;
}

/* What this row says of a column that another process's row may have begun. */
static void add_result(field_columns *columns, const process_type *process, const result_field *field)
{
    char table[sizeof columns->column->table], name[sizeof columns->column->name];
    write_name(table, sizeof table, "%s_result", field->output);
    write_name(name, sizeof name, "%s%s%s", field->group ? field->group : "", field->group ? "_" : "", field->name);
    field_column *column = find(columns, table, name);
    if (!column) {
        column = &columns->column[columns->count++];
        *column = (field_column){ .type = type_of_result(field), .process = process, .result = field };
        memcpy(column->table, table, sizeof table);
        memcpy(column->name, name, sizeof name);
        memcpy(column->shown_as, name, sizeof name);
    }
    assert(strcmp(column->type, type_of_result(field)) == 0);
    assert(!field->in_view || !column->in_view || field->in_view == column->in_view);
    if (field->view_name) write_name(column->shown_as, sizeof column->shown_as, "%s", field->view_name);
    if (field->in_view) column->in_view = field->in_view;
    if (field->in_study) column->in_study = field->in_study;
    if (field->is_listed) column->is_listed = true;
    if (field->run_error) column->run_error = field->run_error;
}

bool field_columns_gather(field_columns *columns)
{
    const size_t rows = count_rows();
    assert(rows > 0);
    *columns = (field_columns){ .column = calloc(rows, sizeof *columns->column) };
    if (!columns->column) return false;
    for (size_t p = 0; process_types[p]; p++) {
        const spec_table *table = process_types[p]->inputs;
        for (size_t f = 0; f < table->count; f++)
            if (table->field[f].column) add_input(columns, process_types[p], &table->field[f]);
    }
    for (size_t p = 0; process_types[p]; p++) {
        const result_table *table = process_types[p]->results;
        for (size_t f = 0; f < table->count; f++)
            if (table->field[f].is_stored) add_result(columns, process_types[p], &table->field[f]);
    }
    return true;
}

void field_columns_clear(field_columns *columns)
{
    free(columns->column);
    *columns = (field_columns){ .column = NULL };
}

static int place_of(const field_column *column, field_columns_kind kind)
{
    switch (kind) {
    case COLUMNS_IN_VIEW: return column->in_view;
    case COLUMNS_IN_STUDY: return column->in_study;
    default: return column->is_listed;
    }
}

size_t field_columns_select(const field_columns *columns, field_columns_kind kind, const field_column **list)
{
    size_t count = 0;
    for (size_t c = 0; c < columns->count; c++) {
        const field_column *column = &columns->column[c];
        const int place = place_of(column, kind);
        if (place == 0) continue;
        size_t at = count++;
        for (; at > 0 && place_of(list[at - 1], kind) > place; at--) list[at] = list[at - 1];
        list[at] = column;
    }
    return count;
}

bool field_column_is_truth(const field_column *column)
{
    return column->result && (column->result->kind == RESULT_TRUTH || column->result->kind == RESULT_MAYBE);
}
