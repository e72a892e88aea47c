/* The tables and columns that users' SQL may read: GET /query without a statement, and in the error for an unknown one. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"
#include "http_accept.h"
#include "query_words.h"

enum { LONGEST_PAGE = 1 << 20, LONGEST_NAMES = 8000 };

/* --- JSON --- */

typedef struct table_list {
    const field_columns *fields;
    json_t *tables;
} table_list;

static bool add_column(void *context, const char *table, const char *column, const char *type)
{
    table_list *list = context;
    const char *meaning = query_table_meaning(list->fields, table);
    if (!meaning) return true;
    json_t *last = json_array_get(list->tables, json_array_size(list->tables) - 1);
    if (!last || strcmp(json_string_value(json_object_get(last, "name")), table) != 0) {
        last = json_pack("{s:s, s:s, s:[]}", "name", table, "meaning", meaning, "columns");
        json_array_append_new(list->tables, last);
    }
    const column_words words = query_column_words(list->fields, table, column);
    return json_array_append_new(json_object_get(last, "columns"), json_pack("{s:s, s:s, s:s, s:s}", "name", column, "type", type,
                                                                             "unit", words.unit, "meaning", words.meaning))
           == 0;
}

/* NULL: the store refuses, or there is no memory. New reference. */
static json_t *list_tables(api_service *service)
{
    field_columns fields;
    if (!field_columns_gather(&fields)) return NULL;
    table_list list = { &fields, json_array() };
    const store_status status = store_list_columns(service->store, add_column, &list);
    field_columns_clear(&fields);
    if (status == STORE_OK) return list.tables;
    json_decref(list.tables);
    return NULL;
}

/* --- HTML --- */

static void add_text(text_buffer *page, const char *text)
{
    for (; *text; text++) {
        if (*text == '<') text_buffer_print(page, "&lt;");
        else if (*text == '&') text_buffer_print(page, "&amp;");
        else text_buffer_add(page, text, 1);
    }
}

static void add_cells(text_buffer *page, const json_t *column)
{
    static const char *const cells[] = { "name", "type", "unit", "meaning" };
    text_buffer_print(page, "<tr>");
    for (size_t k = 0; k < sizeof cells / sizeof cells[0]; k++) {
        text_buffer_print(page, k == 0 ? "<td><code>" : "<td>");
        add_text(page, json_string_value(json_object_get(column, cells[k])));
        text_buffer_print(page, k == 0 ? "</code>" : "");
    }
    text_buffer_print(page, "\n");
}

static void respond_page(http_response *response, const json_t *tables)
{
    text_buffer page;
    size_t t, c;
    json_t *table, *column;
    text_buffer_init(&page, LONGEST_PAGE);
    text_buffer_print(
        &page, "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Tables</title>\n<h1>Tables</h1>\n<p>SQL that "
               "reads them is asked for as <code>/query?sql=SELECT friction, angle_deg FROM run_summary</code>.\n");
    json_array_foreach(tables, t, table)
    {
        text_buffer_print(&page, "<h2 id=\"%s\">%s</h2>\n<p>", json_string_value(json_object_get(table, "name")),
                          json_string_value(json_object_get(table, "name")));
        add_text(&page, json_string_value(json_object_get(table, "meaning")));
        text_buffer_print(&page, ".\n<table><tr><th>column<th>type<th>unit<th>meaning\n");
        json_array_foreach(json_object_get(table, "columns"), c, column) add_cells(&page, column);
        text_buffer_print(&page, "</table>\n");
    }
    if (page.failed) {
        text_buffer_clear(&page);
        respond_store_failure(response, STORE_FAILED, "write the page");
        return;
    }
    http_respond_text(response, 200, "text/html; charset=utf-8", page.text, page.length);
}

/* --- CSV --- */

static void respond_columns(http_response *response, const json_t *tables)
{
    static const char *const cells[] = { "name", "type", "unit", "meaning" };
    text_buffer csv;
    size_t t, c;
    json_t *table, *column;
    text_buffer_init(&csv, LONGEST_PAGE);
    text_buffer_print(&csv, "table,column,type,unit,meaning\r\n");
    json_array_foreach(tables, t, table)
    {
        json_array_foreach(json_object_get(table, "columns"), c, column)
        {
            text_buffer_print(&csv, "%s", json_string_value(json_object_get(table, "name")));
            for (size_t k = 0; k < sizeof cells / sizeof cells[0]; k++) {
                const json_t *cell = json_object_get(column, cells[k]);
                text_buffer_print(&csv, ",");
                text_buffer_add_csv_field(&csv, json_string_value(cell), json_string_length(cell));
            }
            text_buffer_print(&csv, "\r\n");
        }
    }
    if (csv.failed) {
        text_buffer_clear(&csv);
        respond_store_failure(response, STORE_FAILED, "write the list of columns");
        return;
    }
    name_file(response, "columns", ".csv", true);
    http_respond_text(response, 200, "text/csv; charset=utf-8", csv.text, csv.length);
}

void show_tables(api_service *service, const http_request *request, http_response *response)
{
    static const http_format formats[] = { { "json", "application/json" }, { "html", "text/html" }, { "csv", "text/csv" } };
    json_t *tables = list_tables(service);
    if (!tables) {
        respond_store_failure(response, STORE_FAILED, "list the tables");
        return;
    }
    const size_t form = http_format_choose(request, formats, sizeof formats / sizeof formats[0]);
    if (form == 1) respond_page(response, tables);
    else if (form == 2) respond_columns(response, tables);
    else http_respond_json(response, 200, json_pack("{s:O, s:[o]}", "tables", tables, "links", list_link(request, "self", NULL)));
    json_decref(tables);
}

/* --- names in errors --- */

/* As a word of its own, whatever its case. */
static bool is_named(const char *sql, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = sql; (at = strcasestr(at, name)) != NULL; at++) {
        const bool begins = at == sql || (!isalnum((unsigned char)at[-1]) && at[-1] != '_');
        if (begins && !isalnum((unsigned char)at[length]) && at[length] != '_') return true;
    }
    return false;
}

static void add_names(text_buffer *names, const json_t *list)
{
    size_t i;
    json_t *one;
    json_array_foreach(list, i, one)
        text_buffer_print(names, "%s%s", i ? ", " : "", json_string_value(json_object_get(one, "name")));
}

char *names_for_error(api_service *service, const char *sql, const char *problem)
{
    const bool of_table = strncmp(problem, "no such table", 13) == 0, of_column = strncmp(problem, "no such column", 14) == 0;
    json_t *tables = of_table || of_column ? list_tables(service) : NULL, *table;
    if (!tables) return NULL;
    size_t t, named = 0;
    text_buffer names;
    text_buffer_init(&names, LONGEST_NAMES);
    json_array_foreach(tables, t, table)
    {
        const char *name = json_string_value(json_object_get(table, "name"));
        if (!of_column || !is_named(sql, name)) continue;
        text_buffer_print(&names, "; %s has ", name);
        add_names(&names, json_object_get(table, "columns"));
        named++;
    }
    if (named == 0) {
        text_buffer_print(&names, "; there are the tables ");
        add_names(&names, tables);
    }
    json_decref(tables);
    if (!names.failed) return names.text;
    text_buffer_clear(&names);
    return NULL;
}
