/* SQL of users, read-only and bounded.
 *
 * The connection is opened mode=ro; on top of that an authorizer lets through SELECT over our tables with functions
 * of a list, limits keep one value and one statement small, a progress handler ends what runs too long, the
 * functions that could run for minutes in one call are our own (query_functions.c), and sqlite3_stmt_readonly stops
 * what preparing lets pass (VACUUM INTO writes a file and still prepares). */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "database.h"
#include "job_store.h"
#include "log.h"
#include "query_cost.h"

enum { LONGEST_SQL = 20000, MOST_COLUMNS = 200 };
#define QUERY_SECONDS 2.0
#define STEPS_BETWEEN_LOOKS 200 /* of the virtual machine, some microseconds where each is short */

/* Beside these every table and view of the schema may be read: none holds a secret. */
static const char other_tables[] = " sqlite_master sqlite_schema json_each json_tree ";
static const char functions[] =
    " abs avg ceil ceiling coalesce count cume_dist date datetime degrees dense_rank exp first_value floor format glob"
    " group_concat hex ifnull iif instr json json_array json_array_length json_extract json_group_array json_group_object"
    " json_object json_type json_valid julianday lag last_value lead length like ln log log10 log2 lower ltrim max min mod"
    " nth_value ntile nullif percent_rank pi pow power printf quantile quote radians rank replace round row_number rtrim sign sin "
    "stddev"
    " cos tan asin acos atan atan2 sqrt strftime substr substring sum time total trim trunc typeof unicode unixepoch upper"
    " -> ->> current_date current_time current_timestamp ";

static bool is_listed(const char *list, const char *name)
{
    char wanted[72];
    if (!name || strlen(name) > 60 || strchr(name, ' ')) return false;
    snprintf(wanted, sizeof wanted, " %s ", name);
    return strcasestr(list, wanted) != NULL;
}

/* count(*) over a WITH or a subquery comes here with the name the user gave it, and no column. */
static bool reads_no_column(const char *table, const char *column)
{
    return column && column[0] == '\0' && table && strncasecmp(table, "pragma_", 7) != 0;
}

static int authorize(void *context, int action, const char *first, const char *second, const char *database, const char *trigger)
{
    (void)database, (void)trigger;
    const job_store *store = context;
    switch (action) {
    case SQLITE_SELECT:
    case SQLITE_RECURSIVE: return SQLITE_OK;
    case SQLITE_READ:
        return is_listed(store->query_tables, first) || is_listed(other_tables, first) || reads_no_column(first, second)
                   ? SQLITE_OK
                   : SQLITE_DENY;
    case SQLITE_FUNCTION: return is_listed(functions, second) ? SQLITE_OK : SQLITE_DENY;
    default: return SQLITE_DENY;
    }
}

/* With a space before and behind each; NULL: no memory, or the schema can't be read. */
static char *names_of_tables(sqlite3 *database)
{
    sqlite3_stmt *row = NULL;
    char *names = NULL;
    const char *sql = "SELECT ' '||group_concat(name, ' ')||' ' FROM sqlite_schema WHERE type IN ('table', 'view')";
    if (sqlite3_prepare_v2(database, sql, -1, &row, NULL) == SQLITE_OK && sqlite3_step(row) == SQLITE_ROW) {
        const char *text = (const char *)sqlite3_column_text(row, 0);
        if (text) names = strdup(text);
    }
    sqlite3_finalize(row);
    return names;
}

static int is_past(void *watch) { return query_watch_is_over(watch); }

bool query_connection_restrict(job_store *store)
{
    sqlite3 *database = store->query;
    static const int limits[][2] = {
        { SQLITE_LIMIT_LENGTH, QUERY_LONGEST_TEXT }, { SQLITE_LIMIT_SQL_LENGTH, LONGEST_SQL + 10 },
        { SQLITE_LIMIT_COLUMN, MOST_COLUMNS },       { SQLITE_LIMIT_EXPR_DEPTH, 100 },
        { SQLITE_LIMIT_COMPOUND_SELECT, 20 },        { SQLITE_LIMIT_VDBE_OP, 50000 },
        { SQLITE_LIMIT_FUNCTION_ARG, 100 },          { SQLITE_LIMIT_ATTACHED, 0 },
        { SQLITE_LIMIT_VARIABLE_NUMBER, 16 },        { SQLITE_LIMIT_TRIGGER_DEPTH, 1 },
        { SQLITE_LIMIT_WORKER_THREADS, 0 },
    };
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++) sqlite3_limit(database, limits[i][0], limits[i][1]);
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    /* The schema is our own, and its columns that are computed from others use functions, which this lets them do;
     * what they and the views call is looked up in the lists above like the rest. */
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 1, NULL);
    sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, NULL);
    /* Their first use declares them, which the authorizer would refuse. */
    sqlite3_exec(database, "SELECT 1 FROM json_each('[]'), json_tree('[]')", NULL, NULL, NULL);
    store->query_tables = names_of_tables(database);
    if (!store->query_tables) return false;
    sqlite3_set_authorizer(database, authorize, store);
    sqlite3_progress_handler(database, STEPS_BETWEEN_LOOKS, is_past, &store->query_watch);
    return query_functions_install(database, &store->query_watch);
}

/* Spaces, semicolons and comments after a statement are none. */
static bool holds_statement(sqlite3 *database, const char *sql)
{
    sqlite3_stmt *statement = NULL;
    int code = SQLITE_OK;
    while (*sql && !statement && code == SQLITE_OK) code = sqlite3_prepare_v2(database, sql, -1, &statement, &sql);
    sqlite3_finalize(statement);
    return statement || code != SQLITE_OK;
}

static sqlite3_stmt *prepare_one(sqlite3 *database, const char *sql, char *problem, size_t size)
{
    sqlite3_stmt *statement = NULL;
    const char *tail = "";
    const int code = sqlite3_prepare_v2(database, sql, -1, &statement, &tail);
    if (code == SQLITE_OK) tail += strspn(tail, " \t\r\n;");
    if (code != SQLITE_OK) snprintf(problem, size, "%s", sqlite3_errmsg(database));
    else if (!statement) snprintf(problem, size, "the query is empty");
    else if (holds_statement(database, tail))
        snprintf(problem, size, "only one statement is allowed; a second begins with \"%.40s\"", tail);
    else if (!sqlite3_stmt_readonly(statement)) snprintf(problem, size, "only reading is allowed");
    else return statement;
    sqlite3_finalize(statement);
    return NULL;
}

static query_value value_of(sqlite3_stmt *row, int column)
{
    switch (sqlite3_column_type(row, column)) {
    case SQLITE_INTEGER: return (query_value){ .kind = QUERY_INTEGER, .integer = sqlite3_column_int64(row, column) };
    case SQLITE_FLOAT: return (query_value){ .kind = QUERY_REAL, .real = sqlite3_column_double(row, column) };
    case SQLITE_TEXT: {
        const char *text = (const char *)sqlite3_column_text(row, column);
        return (query_value){ .kind = QUERY_TEXT, .text = text, .length = (size_t)sqlite3_column_bytes(row, column) };
    }
    default: return (query_value){ .kind = QUERY_NULL }; /* our tables hold no blobs */
    }
}

static int walk(sqlite3_stmt *statement, query_watch *watch, query_visitor *visit, void *context)
{
    query_value values[MOST_COLUMNS];
    const int count = sqlite3_column_count(statement);
    for (int i = 0; i < count; i++) {
        const char *name = sqlite3_column_name(statement, i);
        values[i] = (query_value){ .kind = QUERY_TEXT, .text = name ? name : "", .length = name ? strlen(name) : 0 };
    }
    bool more = visit(context, 0, values, count);
    int code = SQLITE_DONE;
    for (int64_t row = 1; more && (code = sqlite3_step(statement)) == SQLITE_ROW; row++) {
        for (int i = 0; i < count; i++) values[i] = value_of(statement, i);
        more = visit(context, row, values, count);
        if (more && query_watch_is_over(watch)) return SQLITE_INTERRUPT;
    }
    return more ? code : SQLITE_DONE;
}

/* Runs with texts of at most so many bytes; the limit is then as it was. */
static int walk_within(sqlite3_stmt *statement, int longest, query_watch *watch, query_visitor *visit, void *context)
{
    sqlite3 *database = sqlite3_db_handle(statement);
    const int before = sqlite3_limit(database, SQLITE_LIMIT_LENGTH, longest);
    const int code = walk(statement, watch, visit, context);
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, before);
    return code;
}

static void write_problem(int code, sqlite3 *database, int longest, char *problem, size_t size)
{
    if (code == SQLITE_INTERRUPT) snprintf(problem, size, "it ran for %.0f s, which is the limit", QUERY_SECONDS);
    else if (code == SQLITE_TOOBIG)
        snprintf(problem, size,
                 "it works on a text or row of more than %d bytes; name the columns that are wanted, or fetch a long"
                 " specification from /jobs/{id}/spec",
                 longest);
    else snprintf(problem, size, "%s", sqlite3_errmsg(database));
}

static query_status status_of(int code)
{
    return code == SQLITE_DONE                           ? QUERY_OK
           : code == SQLITE_INTERRUPT                    ? QUERY_TOO_SLOW
           : code == SQLITE_IOERR || code == SQLITE_BUSY ? QUERY_UNAVAILABLE
                                                         : QUERY_REFUSED;
}

query_status store_query(job_store *store, const char *sql, const client_watch *client, query_visitor *visit, void *context,
                         char *problem, size_t problem_size)
{
    const double now = monotonic_seconds();
    store->query_watch = (query_watch){ .deadline = now + QUERY_SECONDS, .looked = now, .client = client };
    snprintf(problem, problem_size, "%s", "");
    if (strlen(sql) > LONGEST_SQL) {
        snprintf(problem, problem_size, "it has %zu bytes; may have %d", strlen(sql), LONGEST_SQL);
        return QUERY_REFUSED;
    }
    sqlite3_stmt *statement = prepare_one(store->query, sql, problem, problem_size);
    int longest = statement ? query_longest_text(store->query, sql) : 0;
    if (!statement) return QUERY_REFUSED;
    int code = longest > 0 ? walk_within(statement, longest, &store->query_watch, visit, context) & 0xff : SQLITE_ERROR;
    const int stored = code == SQLITE_TOOBIG ? query_longest_stored_text(store->query, sql) : 0;
    if (stored > longest) {
        longest = stored;
        sqlite3_reset(statement);
        code = walk_within(statement, longest, &store->query_watch, visit, context) & 0xff;
    }
    if (code != SQLITE_DONE) write_problem(code, store->query, longest, problem, problem_size);
    sqlite3_finalize(statement);
    return status_of(code);
}
