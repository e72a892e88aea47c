/* SQLite looks whether a query may go on only between instructions that jump: hundreds of calls in one row are never
 * interrupted, and its own instr and replace take the product of both lengths. These look at the clock at each call,
 * and take the sum of the lengths (memmem) or, for patterns, a pattern of bounded length. */
#include "query_functions.h"

#include <string.h>

#include "log.h"

enum { LONGEST_PATTERN = 100 };
#define SECONDS_BETWEEN_LOOKS 0.05 /* at the client */

bool query_watch_is_over(query_watch *watch)
{
    const double now = monotonic_seconds();
    if (now > watch->deadline) return true;
    if (now - watch->looked < SECONDS_BETWEEN_LOOKS) return false;
    watch->looked = now;
    if (client_has_left(watch->client)) watch->deadline = 0.0;
    return watch->deadline == 0.0;
}

bool query_call_is_in_time(sqlite3_context *call)
{
    if (!query_watch_is_over(sqlite3_user_data(call))) return true;
    sqlite3_result_error_code(call, SQLITE_INTERRUPT);
    return false;
}

/* Also true where an argument is NULL: so is the answer then. */
static bool is_over(sqlite3_context *call, int count, sqlite3_value **values)
{
    if (!query_call_is_in_time(call)) return true;
    for (int i = 0; i < count; i++)
        if (sqlite3_value_type(values[i]) == SQLITE_NULL) return true;
    return false;
}

static bool takes_pattern(sqlite3_context *call, sqlite3_value *pattern)
{
    if (sqlite3_value_bytes(pattern) <= LONGEST_PATTERN) return true;
    sqlite3_result_error(call, "a pattern of LIKE or GLOB may have at most 100 bytes", -1);
    return false;
}

static const char *text_of(sqlite3_value *value)
{
    const char *text = (const char *)sqlite3_value_text(value);
    return text ? text : "";
}

/* values: pattern, text, and where given the escape character */
static void like(sqlite3_context *call, int count, sqlite3_value **values)
{
    if (is_over(call, count, values) || !takes_pattern(call, values[0])) return;
    const char *escape = count > 2 ? text_of(values[2]) : "";
    if (count > 2 && (strlen(escape) != 1 || (escape[0] & 0x80)))
        sqlite3_result_error(call, "ESCAPE must be one ASCII character", -1);
    else sqlite3_result_int(call, sqlite3_strlike(text_of(values[0]), text_of(values[1]), (unsigned char)escape[0]) == 0);
}

static void glob(sqlite3_context *call, int count, sqlite3_value **values)
{
    if (is_over(call, count, values) || !takes_pattern(call, values[0])) return;
    sqlite3_result_int(call, sqlite3_strglob(text_of(values[0]), text_of(values[1])) == 0);
}

/* Where values[1] begins in values[0], counted in characters from 1; 0: nowhere. */
static void instr(sqlite3_context *call, int count, sqlite3_value **values)
{
    if (is_over(call, count, values)) return;
    const char *text = text_of(values[0]), *wanted = text_of(values[1]);
    const char *found = memmem(text, (size_t)sqlite3_value_bytes(values[0]), wanted, (size_t)sqlite3_value_bytes(values[1]));
    int place = found ? 1 : 0;
    for (const char *c = text; found && c < found; c++) place += (*c & 0xc0) != 0x80; /* bytes that begin a character */
    sqlite3_result_int(call, place);
}

static void replace(sqlite3_context *call, int count, sqlite3_value **values)
{
    if (is_over(call, count, values)) return;
    const char *text = text_of(values[0]), *old = text_of(values[1]), *new = text_of(values[2]);
    const char *const end = text + sqlite3_value_bytes(values[0]);
    const size_t old_length = (size_t)sqlite3_value_bytes(values[1]);
    sqlite3_str *out = sqlite3_str_new(sqlite3_context_db_handle(call));
    const char *found;
    while (old_length > 0 && (found = memmem(text, (size_t)(end - text), old, old_length)) != NULL) {
        sqlite3_str_append(out, text, (int)(found - text));
        sqlite3_str_append(out, new, sqlite3_value_bytes(values[2]));
        text = found + old_length;
    }
    sqlite3_str_append(out, text, (int)(end - text));
    const int problem = sqlite3_str_errcode(out), length = sqlite3_str_length(out);
    char *result = sqlite3_str_finish(out);
    if (problem == SQLITE_OK) sqlite3_result_text(call, result ? result : "", length, result ? sqlite3_free : SQLITE_STATIC);
    else sqlite3_result_error_code(call, problem);
}

static void refuse_trim(sqlite3_context *call, int count, sqlite3_value **values)
{
    (void)count, (void)values;
    sqlite3_result_error(call, "trim, ltrim and rtrim take one argument here: they remove spaces", -1);
}

static const struct {
    const char *name;
    int arguments;
    void (*function)(sqlite3_context *, int, sqlite3_value **);
} ours[] = {
    { "like", 2, like },
    { "like", 3, like },
    { "glob", 2, glob },
    { "instr", 2, instr },
    { "replace", 3, replace },
    { "printf", -1, query_printf },
    { "format", -1, query_printf },
    { "trim", 2, refuse_trim },
    { "ltrim", 2, refuse_trim },
    { "rtrim", 2, refuse_trim },
};

bool query_function_is_ours(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof ours / sizeof ours[0]; i++)
        if (ours[i].function != refuse_trim && strlen(ours[i].name) == length && memcmp(ours[i].name, name, length) == 0)
            return true;
    return false;
}

bool query_functions_install(sqlite3 *database, query_watch *watch)
{
    bool good = query_statistics_install(database, watch);
    for (size_t i = 0; i < sizeof ours / sizeof ours[0]; i++)
        good = good
               && sqlite3_create_function(database, ours[i].name, ours[i].arguments, SQLITE_UTF8 | SQLITE_DETERMINISTIC, watch,
                                          ours[i].function, NULL, NULL)
                      == SQLITE_OK;
    return good;
}
