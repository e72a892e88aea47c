#include "field_tables.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "checksum.h"
#include "database.h"
#include "field_views.h"
#include "text_buffer.h"

enum { LONGEST_STATEMENT = 32768 };

/* --- pieces of statements --- */

static bool is_shown_before(const field_column *const *list, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (strcmp(list[k]->shown_as, list[i]->shown_as) == 0) return true;
    return false;
}

/* Takes out of a list what has the name of one before it; the new count. */
static size_t keep_first_of_each_name(const field_column **list, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (!is_shown_before(list, i)) list[kept++] = list[i];
    return kept;
}

/* Where several tables have a column of that name, a job has a row in at most one of them. */
static void write_column(text_buffer *sql, const field_column *const *list, size_t count, size_t i)
{
    size_t tables = 0;
    for (size_t k = i; k < count; k++) tables += strcmp(list[k]->shown_as, list[i]->shown_as) == 0;
    text_buffer_print(sql, tables > 1 ? ", coalesce(" : ", ");
    const char *comma = "";
    for (size_t k = i; k < count; k++) {
        if (strcmp(list[k]->shown_as, list[i]->shown_as) != 0) continue;
        text_buffer_print(sql, "%s%s.%s", comma, list[k]->table, list[k]->name);
        comma = ", ";
    }
    text_buffer_print(sql, "%s AS %s", tables > 1 ? ")" : "", list[i]->shown_as);
}

static void write_columns(text_buffer *sql, const field_column *const *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!is_shown_before(list, i)) write_column(sql, list, count, i);
}

static void write_joins(text_buffer *sql, const field_column *const *list, size_t count, const char *but)
{
    for (size_t i = 0; i < count; i++) {
        bool is_new = strcmp(list[i]->table, but) != 0;
        for (size_t k = 0; k < i; k++) is_new = is_new && strcmp(list[k]->table, list[i]->table) != 0;
        if (is_new) text_buffer_print(sql, " LEFT JOIN %s ON %s.job=job.number", list[i]->table, list[i]->table);
    }
}

static bool take_texts(text_buffer *columns, text_buffer *joins, char **select, char **join)
{
    *select = columns->text;
    *join = joins->text;
    return !columns->failed && !joins->failed && columns->text && joins->text;
}

/* The two pieces of a SELECT over `job` that show the columns of a list. */
static bool write_select(const field_column *const *list, size_t count, char **select, char **join)
{
    text_buffer columns, joins;
    text_buffer_init(&columns, LONGEST_STATEMENT);
    text_buffer_init(&joins, LONGEST_STATEMENT);
    write_columns(&columns, list, count);
    write_joins(&joins, list, count, "");
    return take_texts(&columns, &joins, select, join);
}

/* What a study tells, and the errors that single runs tell of it. */
static size_t select_for_study(const field_columns *columns, const field_column **list)
{
    size_t count = field_columns_select(columns, COLUMNS_IN_STUDY, list);
    const size_t told = count;
    for (size_t i = 0; i < told; i++)
        for (size_t c = 0; list[i]->run_error && c < columns->count; c++)
            if (strcmp(columns->column[c].shown_as, list[i]->run_error) == 0 && columns->column[c].in_study == 0)
                list[count++] = &columns->column[c];
    return count;
}

static char *write_insert(const field_columns *columns, const char *table)
{
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_STATEMENT);
    size_t count = 0;
    text_buffer_print(&sql, "INSERT OR REPLACE INTO %s(job", table);
    for (size_t c = 0; c < columns->count; c++) {
        if (strcmp(columns->column[c].table, table) != 0) continue;
        text_buffer_print(&sql, ",%s", columns->column[c].name);
        count++;
    }
    text_buffer_print(&sql, ") VALUES(?");
    for (size_t i = 0; i < count; i++) text_buffer_print(&sql, ",?");
    text_buffer_print(&sql, ")");
    if (!sql.failed) return sql.text;
    text_buffer_clear(&sql);
    return NULL;
}

static const field_insert *find_insert(const field_tables *tables, const char *table)
{
    for (size_t i = 0; i < tables->insert_count; i++)
        if (strcmp(tables->insert[i].table, table) == 0) return &tables->insert[i];
    return NULL;
}

static bool write_inserts(field_tables *tables)
{
    const field_columns *columns = &tables->columns;
    assert(tables->insert_count == 0);
    tables->insert = calloc(columns->count, sizeof *tables->insert);
    bool good = tables->insert != NULL;
    for (size_t c = 0; good && c < columns->count; c++) {
        const char *table = columns->column[c].table;
        if (find_insert(tables, table)) continue;
        field_insert *insert = &tables->insert[tables->insert_count++];
        *insert = (field_insert){ table, c, write_insert(columns, table) };
        good = insert->sql != NULL;
    }
    return good;
}

bool field_tables_init(field_tables *tables)
{
    *tables = (field_tables){ .listed_count = 0 };
    if (!field_columns_gather(&tables->columns)) return false;
    tables->listed = calloc(tables->columns.count, sizeof *tables->listed);
    const field_column **list = calloc(tables->columns.count, sizeof *list);
    bool good = tables->listed && list && write_inserts(tables);
    if (good) {
        const size_t listed = field_columns_select(&tables->columns, COLUMNS_LISTED, tables->listed);
        good = write_select(tables->listed, listed, &tables->select_listed, &tables->join_listed)
               && write_select(list, select_for_study(&tables->columns, list), &tables->select_study, &tables->join_study);
        tables->listed_count = keep_first_of_each_name(tables->listed, listed);
    }
    free(list);
    if (!good) field_tables_clear(tables);
    return good;
}

void field_tables_clear(field_tables *tables)
{
    for (size_t i = 0; i < tables->insert_count; i++) free(tables->insert[i].sql);
    free(tables->insert);
    field_columns_clear(&tables->columns);
    free(tables->listed);
    free(tables->select_listed);
    free(tables->join_listed);
    free(tables->select_study);
    free(tables->join_study);
    *tables = (field_tables){ .listed_count = 0 };
}

/* --- tables --- */

/* What jobs from before there was such an input ran with; false: nobody can tell. */
static bool write_earlier_value(text_buffer *sql, const spec_field *field)
{
    if (field->choices) text_buffer_print(sql, "'%s'", field->choices[0]);
    else if (field->kind == FIELD_OBJECT_OR_NULL && field->column_kind == COLUMN_COUNT) text_buffer_print(sql, "0");
    else if (field->kind < FIELD_CHOICE && !isnan(field->fallback)) text_buffer_print(sql, "%.17g", field->fallback);
    else return false;
    return true;
}

/* is_new: of a table that has rows, maybe, which then all have one value. */
static void write_definition(text_buffer *sql, const field_column *column, bool is_new)
{
    text_buffer_print(sql, "%s %s", column->name, column->type);
    if (!column->input || column->input->column_may_miss) return;
    text_buffer value;
    text_buffer_init(&value, 100);
    const bool has_value = is_new && write_earlier_value(&value, column->input);
    if (!is_new) text_buffer_print(sql, " NOT NULL");
    else if (has_value) text_buffer_print(sql, " NOT NULL DEFAULT %s", value.text);
    text_buffer_clear(&value);
}

static bool run_text(sqlite3 *writer, text_buffer *sql)
{
    const bool good = !sql->failed && sqlite3_exec(writer, sql->text, NULL, NULL, NULL) == SQLITE_OK;
    text_buffer_clear(sql);
    return good;
}

static bool create_table(const field_columns *columns, sqlite3 *writer, const char *table)
{
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_STATEMENT);
    text_buffer_print(&sql, "CREATE TABLE %s(job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE", table);
    for (size_t c = 0; c < columns->count; c++) {
        if (strcmp(columns->column[c].table, table) != 0) continue;
        text_buffer_print(&sql, ", ");
        write_definition(&sql, &columns->column[c], false);
    }
    text_buffer_print(&sql, ") STRICT");
    return run_text(writer, &sql);
}

static bool add_column(sqlite3 *writer, const field_column *column)
{
    text_buffer sql;
    text_buffer_init(&sql, LONGEST_STATEMENT);
    text_buffer_print(&sql, "ALTER TABLE %s ADD COLUMN ", column->table);
    write_definition(&sql, column, true);
    return run_text(writer, &sql);
}

/* Finds the name where it is not NULL, else any. -1: the database can't tell. */
static int has_column(sqlite3 *writer, const char *table, const char *name)
{
    sqlite3_stmt *row =
        sql_prepare(writer, "SELECT count(*) FROM pragma_table_info(?1) WHERE ?2 IS NULL OR name=?2", "tt", table, name);
    const int count = row && sqlite3_step(row) == SQLITE_ROW ? sqlite3_column_int(row, 0) : -1;
    sqlite3_finalize(row);
    return count < 0 ? -1 : count > 0;
}

static bool make_column(const field_columns *columns, sqlite3 *writer, const field_column *column)
{
    const int has_table = has_column(writer, column->table, NULL);
    if (has_table == 0) return create_table(columns, writer, column->table);
    const int has = has_table < 0 ? -1 : has_column(writer, column->table, column->name);
    return has == 0 ? add_column(writer, column) : has > 0;
}

bool field_tables_make(const field_tables *tables, sqlite3 *writer)
{
    /* Takes the lock for writing only when it comes to that. */
    bool good = sqlite3_exec(writer, "BEGIN", NULL, NULL, NULL) == SQLITE_OK;
    for (size_t c = 0; good && c < tables->columns.count; c++)
        good = make_column(&tables->columns, writer, &tables->columns.column[c]);
    return good && sqlite3_exec(writer, "COMMIT", NULL, NULL, NULL) == SQLITE_OK;
}

/* --- the views --- */

/* Of failed runs what was given, and nothing that came out. */
static void write_run_summary(const field_columns *columns, text_buffer *sql)
{
    const field_column **list = calloc(columns->count, sizeof *list);
    sql->failed = sql->failed || !list;
    if (!list) return;
    const size_t count = field_columns_select(columns, COLUMNS_IN_VIEW, list);
    text_buffer_print(sql, "CREATE VIEW run_summary AS SELECT job.id, job.process, job.label, job.status, job.created, job.started,"
                           " job.finished, job.attempt, job.priority, study.id AS study, job.study_case, job.study_repeat,"
                           " job.message");
    write_columns(sql, list, count);
    field_views_add_angles(sql);
    text_buffer_print(sql, " FROM job LEFT JOIN study ON study.number=job.study LEFT JOIN result ON result.job=job.number");
    write_joins(sql, list, count, "");
    text_buffer_print(sql, " WHERE job.status IN ('successful','failed')");
    free(list);
}

bool field_tables_make_view(const field_tables *tables, sqlite3 *writer)
{
    text_buffer summary, fields, inputs, stages;
    text_buffer_init(&summary, LONGEST_STATEMENT);
    text_buffer_init(&fields, LONGEST_STATEMENT);
    text_buffer_init(&inputs, LONGEST_STATEMENT);
    text_buffer_init(&stages, LONGEST_STATEMENT);
    write_run_summary(&tables->columns, &summary);
    field_views_write_input_field(&fields);
    field_views_write_job_input(&inputs);
    field_views_write_stage(&stages);
    /* Takes the lock for writing only when it comes to that. */
    bool good = sqlite3_exec(writer, "BEGIN", NULL, NULL, NULL) == SQLITE_OK;
    good = field_view_make(writer, "run_summary", &summary) && good;
    good = field_view_make(writer, "input_field", &fields) && good;
    good = field_view_make(writer, "job_input", &inputs) && good;
    good = field_view_make(writer, "stage", &stages) && good;
    return good && sqlite3_exec(writer, "COMMIT", NULL, NULL, NULL) == SQLITE_OK;
}

/* --- rows --- */

/* The word that a choice stands for; of an object in its place, the name of what it holds. */
static const char *word_of(const spec_table *table, const spec_field *field, double choice)
{
    for (int c = 0; field->choices[c]; c++)
        if (c == (int)choice) return field->choices[c];
    for (size_t f = 0; f < table->count; f++)
        if (field->kind == FIELD_CHOICE_OR_OBJECT && table->field[f].group == field->child) return table->field[f].name;
    return NULL;
}

static void bind_input(sqlite3_stmt *statement, int index, const spec_field *field, const job_spec *spec)
{
    const char *place = (const char *)spec + field->column_at;
    const double number = field->column_kind == COLUMN_COUNT ? NAN : *(const double *)place;
    switch (field->column_kind) {
    case COLUMN_COUNT:
        if (field->column_may_miss && *(const size_t *)place == 0) sqlite3_bind_null(statement, index);
        else sqlite3_bind_int64(statement, index, (int64_t) * (const size_t *)place);
        break;
    case COLUMN_WHOLE: sqlite3_bind_int64(statement, index, (int64_t)number); break;
    case COLUMN_WORD: sqlite3_bind_text(statement, index, word_of(spec->type->inputs, field, number), -1, SQLITE_STATIC); break;
    default: sqlite3_bind_double(statement, index, number); /* NaN binds NULL */
    }
}

store_status field_tables_insert_inputs(const field_tables *tables, sqlite3 *writer, int64_t job, const job_spec *spec)
{
    const field_insert *insert = NULL;
    for (size_t i = 0; i < tables->insert_count && !insert; i++) {
        const field_column *first = &tables->columns.column[tables->insert[i].first];
        if (first->input && first->process == spec->type) insert = &tables->insert[i];
    }
    assert(insert); /* each process has inputs that are columns */
    sqlite3_stmt *statement = sql_prepare(writer, insert->sql, "i", job);
    if (!statement) return STORE_FAILED;
    int index = 2;
    for (size_t c = insert->first; c < tables->columns.count; c++) {
        const field_column *column = &tables->columns.column[c];
        if (column->input && column->process == spec->type) bind_input(statement, index++, column->input, spec);
    }
    return sql_finish(statement, sqlite3_step(statement));
}

static void bind_json(sqlite3_stmt *statement, int index, const json_t *value)
{
    if (json_is_boolean(value)) sqlite3_bind_int(statement, index, json_is_true(value));
    else if (json_is_integer(value)) sqlite3_bind_int64(statement, index, json_integer_value(value));
    else if (json_is_real(value)) sqlite3_bind_double(statement, index, json_real_value(value));
    else if (json_is_array(value)) sqlite3_bind_int64(statement, index, (int64_t)json_array_size(value)); /* how many */
    else if (json_is_string(value)) sqlite3_bind_text(statement, index, json_string_value(value), -1, SQLITE_STATIC);
    else sqlite3_bind_null(statement, index);
}

static store_status insert_output(const field_columns *columns, sqlite3 *writer, int64_t job, const field_insert *insert,
                                  const json_t *output)
{
    sqlite3_stmt *statement = sql_prepare(writer, insert->sql, "i", job);
    if (!statement) return STORE_FAILED;
    int index = 2;
    for (size_t c = insert->first; c < columns->count; c++) {
        if (strcmp(columns->column[c].table, insert->table) != 0) continue;
        const result_field *field = columns->column[c].result;
        const json_t *object = field->group ? json_object_get(output, field->group) : output;
        bind_json(statement, index++, json_object_get(object, field->name));
    }
    return sql_finish(statement, sqlite3_step(statement));
}

store_status field_tables_insert_results(const field_tables *tables, sqlite3 *writer, int64_t job, const char *document,
                                         const json_t *results)
{
    store_status status = STORE_FAILED;
    if (results)
        status = sql_run(writer, NULL, "INSERT OR REPLACE INTO result(job, document, checksum) VALUES(?,?,?)", "iti", job, document,
                         (int64_t)checksum_of(document, strlen(document)));
    for (size_t i = 0; status == STORE_OK && i < tables->insert_count; i++) {
        const result_field *field = tables->columns.column[tables->insert[i].first].result;
        const json_t *output = field ? json_object_get(results, field->output) : NULL;
        if (output) status = insert_output(&tables->columns, writer, job, &tables->insert[i], output);
    }
    return status;
}
