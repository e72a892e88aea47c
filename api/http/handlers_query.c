/* Read-only SQL of a user, as JSON or CSV. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"

enum { QUERY_BYTES = 8 << 20, QUERY_ROWS = 10000, QUERY_CSV_BYTES = 32 << 20 };

typedef struct query_table {
    text_buffer out;
    bool csv, truncated;
} query_table;

/* A cast of bytes can give a text that is no UTF-8, which JSON can't hold. */
static bool is_utf8(const query_value *value)
{
    json_t *check = json_stringn(value->text, value->length);
    json_decref(check);
    return check != NULL;
}

static void add_value(query_table *table, const query_value *value)
{
    switch (value->kind) {
    case QUERY_INTEGER: text_buffer_print(&table->out, "%lld", (long long)value->integer); break;
    case QUERY_REAL:
        if (!table->csv || isfinite(value->real)) text_buffer_add_number(&table->out, value->real);
        break;
    case QUERY_TEXT:
        if (table->csv) text_buffer_add_csv_field(&table->out, value->text, value->length);
        else if (is_utf8(value)) text_buffer_add_json_string(&table->out, value->text, value->length);
        else text_buffer_print(&table->out, "null");
        break;
    default: text_buffer_print(&table->out, "%s", table->csv ? "" : "null");
    }
}

static void add_row(query_table *table, int64_t row, const query_value *values, int count)
{
    if (!table->csv) text_buffer_print(&table->out, row == 0 ? "{\"columns\":[" : row == 1 ? "[" : ",[");
    for (int i = 0; i < count; i++) {
        if (i > 0) text_buffer_print(&table->out, ",");
        add_value(table, &values[i]);
    }
    text_buffer_print(&table->out, table->csv ? "\r\n" : row == 0 ? "],\"rows\":[" : "]");
}

static bool take_row(void *context, int64_t row, const query_value *values, int count)
{
    query_table *table = context;
    if (row == 0) table->out.length = 0;
    const size_t length = table->out.length;
    const bool fits = table->csv || row <= QUERY_ROWS;
    if (fits) add_row(table, row, values, count);
    table->truncated = !fits || table->out.failed;
    if (row > 0 && table->out.failed && length > 0) { /* the cap: give what is whole */
        table->out.failed = false;
        table->out.length = length;
        table->out.text[length] = '\0';
    }
    return !table->truncated;
}

static void respond_query_failure(api_service *service, http_response *response, query_status status, const char *sql,
                                  const char *problem)
{
    if (status == QUERY_REFUSED) {
        char *names = names_for_error(service, sql, problem);
        http_respond_problem(response, 400, NULL, "The query can't be run", "%s%s", problem, names ? names : "");
        free(names);
    } else {
        http_respond_problem(response, 503, NULL, status == QUERY_TOO_SLOW ? "The query takes too long" : "Store not available",
                             "%s", problem);
        response->retry_after = 5;
    }
}

void run_query(api_service *service, const http_request *request, http_response *response)
{
    const char *sql = http_request_parameter(request, "sql");
    query_table table = { .csv = wants_csv(request) };
    if (!sql) {
        show_tables(service, request, response);
        return;
    }
    const char *form = http_request_parameter(request, http_request_parameter(request, "f") ? "f" : "format");
    if (form && strcmp(form, "html") == 0) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "html is a form of the list of tables alone, without sql");
        return;
    }
    name_file(response, "query", table.csv ? ".csv" : ".json", table.csv);
    text_buffer_init(&table.out, table.csv ? QUERY_CSV_BYTES : QUERY_BYTES);
    char problem[400];
    const query_status status = store_query(service->store, sql, &request->client, take_row, &table, problem, sizeof problem);
    if (status != QUERY_OK) {
        text_buffer_clear(&table.out);
        respond_query_failure(service, response, status, sql, problem);
        return;
    }
    if (table.csv && table.truncated) { /* a table without its end could not be told from a whole one */
        text_buffer_clear(&table.out);
        http_respond_problem(response, 400, NULL, "The answer is too long",
                             "as CSV it has more than %d MB; ask for it in parts, with ORDER BY, LIMIT and OFFSET",
                             QUERY_CSV_BYTES >> 20);
        return;
    }
    table.out.limit += 64; /* the end always fits */
    if (!table.csv) text_buffer_print(&table.out, "],\"truncated\":%s}", table.truncated ? "true" : "false");
    http_respond_text(response, 200, table.csv ? "text/csv; charset=utf-8" : "application/json", table.out.text, table.out.length);
}
