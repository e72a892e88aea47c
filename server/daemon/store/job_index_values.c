/* Columns of numbers and words of the index (job_index_rows.h), read when the first filter needs them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "database.h"
#include "job_index_rows.h"
#include "list_columns.h"

/* --- one value --- */

/* "2026-11-30T10:43:10.250Z" in ms since 1970; NaN: not yet. */
static double time_of(const char *text)
{
    struct tm parts = { .tm_isdst = 0 };
    int ms = 0;
    if (!text
        || sscanf(text, "%d-%d-%dT%d:%d:%d.%dZ", &parts.tm_year, &parts.tm_mon, &parts.tm_mday, &parts.tm_hour, &parts.tm_min,
                  &parts.tm_sec, &ms)
               < 6)
        return NAN;
    parts.tm_year -= 1900;
    parts.tm_mon--;
    return 1000.0 * (double)timegm(&parts) + ms;
}

static double value_of(value_column *column, list_column_kind kind, sqlite3_stmt *row, int place)
{
    uint32_t word;
    if (sqlite3_column_type(row, place) == SQLITE_NULL) return NAN;
    if (kind == LIST_TIME) return time_of((const char *)sqlite3_column_text(row, place));
    if (kind != LIST_WORD) return sqlite3_column_double(row, place);
    const char *text = (const char *)sqlite3_column_text(row, place);
    return text && text_pool_add(&column->words, text, &word) ? word : NAN;
}

/* --- where they are --- */

value_column *value_column_find(job_index *index, const char *name)
{
    for (size_t c = 0; c < index->columns; c++)
        if (strcmp(index->column[c].name, name) == 0) return &index->column[c];
    return NULL;
}

/* The k-th SELECT of a job's number and its value; false: there are no more. */
static bool write_select(const job_index *index, const char *name, size_t k, char *sql, size_t size)
{
    const field_columns *fields = index->fields;
    for (size_t f = 0; f < list_fact_count; f++) {
        if (strcmp(list_facts[f].name, name) != 0) continue;
        /* The first three are in an index, which is a tenth of the table. */
        snprintf(sql, size, "SELECT number, %s FROM job%s", name, f < 3 ? " INDEXED BY job_listed" : "");
        return k == 0;
    }
    for (size_t c = 0; c < fields->count; c++) {
        if (strcmp(fields->column[c].shown_as, name) != 0 || k-- > 0) continue;
        snprintf(sql, size, "SELECT job, %s FROM %s", fields->column[c].name, fields->column[c].table);
        return true;
    }
    return false;
}

/* --- reading --- */

/* Of two tables that have such a column the first counts. */
static store_status read_from(job_index *index, sqlite3_stmt *row, value_column *column, list_column_kind kind)
{
    const index_rows *rows = &index->rows;
    if (!row) return STORE_FAILED;
    int code;
    size_t at = 0; /* as a rule they come in order */
    while ((code = sqlite3_step(row)) == SQLITE_ROW) {
        const int64_t number = sqlite3_column_int64(row, 0);
        if (at >= rows->count || rows->number[at] != number) at = index_rows_find(rows, number);
        if (at < rows->count && isnan(column->value[at])) column->value[at] = value_of(column, kind, row, 1);
        at++;
    }
    return sql_finish(row, code);
}

static void drop_column(value_column *column)
{
    free(column->value);
    text_pool_clear(&column->words);
    *column = (value_column){ .value = NULL };
}

/* The place of the one that was not asked for for the longest time, where all are taken. */
static value_column *place_for_column(job_index *index)
{
    if (index->columns < MOST_COLUMNS_KEPT) return &index->column[index->columns++];
    value_column *oldest = &index->column[0];
    for (size_t c = 1; c < index->columns; c++)
        if (index->column[c].used_at < oldest->used_at) oldest = &index->column[c];
    drop_column(oldest);
    return oldest;
}

store_status value_column_read(job_index *index, sqlite3 *reader, const char *name)
{
    list_column kind;
    char sql[200];
    if (!list_column_find(index->fields, name, &kind)) return STORE_REFUSED;
    value_column *column = place_for_column(index);
    snprintf(column->name, sizeof column->name, "%s", name);
    column->is_words = kind.kind == LIST_WORD;
    column->value = malloc((index->rows.most + 1) * sizeof *column->value);
    store_status status = column->value ? STORE_OK : STORE_FAILED;
    for (size_t row = 0; column->value && row <= index->rows.most; row++) column->value[row] = NAN;
    for (size_t k = 0; status == STORE_OK && write_select(index, name, k, sql, sizeof sql); k++)
        status = read_from(index, sql_prepare(reader, sql, ""), column, kind.kind);
    if (status == STORE_OK) return STORE_OK;
    drop_column(column);
    *column = index->column[--index->columns];
    return status;
}

static store_status refresh(job_index *index, sqlite3 *reader, value_column *column, int64_t first, int64_t last)
{
    const index_rows *rows = &index->rows;
    list_column kind;
    char sql[240];
    store_status status = list_column_find(index->fields, column->name, &kind) ? STORE_OK : STORE_FAILED;
    for (size_t row = index_rows_from(rows, first); row < rows->count && rows->number[row] <= last; row++) column->value[row] = NAN;
    for (size_t k = 0; status == STORE_OK && write_select(index, column->name, k, sql, 200); k++) {
        char *indexed = strstr(sql, " INDEXED BY");
        if (indexed) *indexed = '\0';
        snprintf(sql + strlen(sql), 40, " WHERE %s BETWEEN ? AND ?", strstr(sql, "number,") ? "number" : "job");
        status = read_from(index, sql_prepare(reader, sql, "ii", first, last), column, kind.kind);
    }
    return status;
}

store_status value_columns_refresh(job_index *index, sqlite3 *reader, int64_t first, int64_t last)
{
    store_status status = STORE_OK;
    for (size_t c = 0; status == STORE_OK && c < index->columns; c++)
        status = refresh(index, reader, &index->column[c], first, last);
    return status;
}

bool value_columns_grow(job_index *index, size_t most)
{
    bool good = true;
    for (size_t c = 0; c < index->columns; c++) {
        double *value = realloc(index->column[c].value, (most + 1) * sizeof *value);
        if (value) index->column[c].value = value;
        good = good && value;
    }
    return good;
}

void value_columns_drop(job_index *index)
{
    for (size_t c = 0; c < index->columns; c++) drop_column(&index->column[c]);
    index->columns = 0;
}
