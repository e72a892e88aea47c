/* printf and format of users' SQL, conversion by conversion: SQLite's own writes "%.2147483647c" character by character
 * though the text has long been too long, and takes hours for a format of many. Here a width or a precision beyond the
 * longest text ends the call at once, and the clock is looked at between conversions. What one conversion looks
 * like is still SQLite's. */
#include <ctype.h>
#include <limits.h>
#include <stdint.h>
#include <string.h>

#include "query_cost.h"
#include "query_functions.h"

/* Each may make a text of the longest, in about a millisecond. */
enum { CONVERSIONS_BETWEEN_LOOKS = 16 };

/* %[flags][width][.precision][l]type */
typedef struct conversion {
    char flags[8], type;
    bool is_left;
    int64_t width, precision; /* precision -1: none */
} conversion;

typedef struct arguments {
    sqlite3_value **value;
    int left;
} arguments;

static sqlite3_value *next_argument(arguments *rest)
{
    if (rest->left <= 0) return NULL;
    rest->left--;
    return *rest->value++;
}

static int64_t next_integer(arguments *rest)
{
    sqlite3_value *value = next_argument(rest);
    return value ? sqlite3_value_int64(value) : 0;
}

static int64_t read_size(const char **at, arguments *rest)
{
    if (**at == '*') {
        (*at)++;
        return (int)next_integer(rest);
    }
    int64_t size = 0;
    for (; isdigit((unsigned char)**at); (*at)++) size = size < INT_MAX ? 10 * size + (**at - '0') : size;
    return size;
}

/* at: behind the percent sign; returns the place behind the conversion. */
static const char *read_conversion(const char *at, arguments *rest, conversion *c)
{
    *c = (conversion){ .precision = -1 };
    for (; *at && strchr("-+ #0!,", *at); at++) {
        if (*at == '-') c->is_left = true;
        else if (!strchr(c->flags, *at)) c->flags[strlen(c->flags)] = *at;
    }
    c->width = read_size(&at, rest);
    if (c->width < 0) c->is_left = true;
    if (c->width < 0) c->width = -c->width;
    if (*at == '.') {
        at++;
        c->precision = read_size(&at, rest);
        if (c->precision < 0) c->precision = -c->precision;
    }
    while (*at == 'l') at++;
    c->type = *at;
    return *at ? at + 1 : at;
}

/* The first character of the text, as often as the precision says. */
static void add_character(sqlite3_str *out, const conversion *c, const char *text)
{
    int bytes = 1;
    if (((unsigned char)text[0] & 0xc0) == 0xc0)
        while (bytes < 4 && ((unsigned char)text[bytes] & 0xc0) == 0x80) bytes++;
    const int64_t times = c->precision > 1 ? c->precision : 1;
    const int spaces = c->width > times ? (int)(c->width - times) : 0;
    if (!c->is_left) sqlite3_str_appendchar(out, spaces, ' ');
    if (bytes == 1) sqlite3_str_appendchar(out, (int)times, text[0]);
    else
        for (int64_t i = 0; i < times && sqlite3_str_errcode(out) == SQLITE_OK; i++) sqlite3_str_append(out, text, bytes);
    if (c->is_left) sqlite3_str_appendchar(out, spaces, ' ');
}

static char *write_number(char *at, int64_t number)
{
    char digits[20];
    int count = 0;
    do digits[count++] = (char)('0' + number % 10);
    while ((number /= 10) > 0);
    while (count > 0) *at++ = digits[--count];
    return at;
}

/* By hand, since this is most of what a short conversion takes. */
static void write_format(const conversion *c, char type, bool is_long, char format[64])
{
    char *at = format;
    *at++ = '%';
    if (c->is_left) *at++ = '-';
    for (const char *flag = c->flags; *flag; flag++) *at++ = *flag;
    if (c->width > 0) at = write_number(at, c->width);
    if (c->precision >= 0) *at++ = '.';
    if (c->precision >= 0) at = write_number(at, c->precision);
    if (is_long) *at++ = 'l';
    if (is_long) *at++ = 'l';
    *at++ = type;
    *at = '\0';
}

/* False: the format ends here, as SQLite's does at a type that it does not know. */
static bool add_conversion(sqlite3_str *out, conversion *c, arguments *rest, int64_t longest)
{
    static const char integers[] = "diuxXopr", reals[] = "feEgG", texts[] = "szqQw";
    char format[64];
    if (c->type == '\0' || !strchr("diuxXoprfeEgGszqQwc%n", c->type)) return false;
    const bool is_text = strchr(texts, c->type) != NULL;
    if (is_text && c->precision > longest) c->precision = longest; /* cuts nothing */
    if (c->width > longest || c->precision > longest) {
        sqlite3_str_appendchar(out, INT_MAX, ' '); /* too long, as the text would be */
        return false;
    }
    if (c->type == '%') {
        c->precision = -1;
        add_character(out, c, "%");
    } else if (c->type == 'c') {
        sqlite3_value *value = next_argument(rest);
        const char *text = value ? (const char *)sqlite3_value_text(value) : NULL;
        add_character(out, c, text ? text : "");
    } else if (is_text) {
        sqlite3_value *value = next_argument(rest);
        write_format(c, c->type == 'z' ? 's' : c->type, false, format); /* z would free the text */
        sqlite3_str_appendf(out, format, value ? (const char *)sqlite3_value_text(value) : NULL);
    } else if (strchr(integers, c->type)) {
        write_format(c, c->type, true, format);
        sqlite3_str_appendf(out, format, (sqlite3_int64)next_integer(rest));
    } else if (strchr(reals, c->type)) {
        sqlite3_value *value = next_argument(rest);
        write_format(c, c->type, false, format);
        sqlite3_str_appendf(out, format, value ? sqlite3_value_double(value) : 0.0);
    }
    return true;
}

void query_printf(sqlite3_context *call, int count, sqlite3_value **values)
{
    const char *at = count > 0 ? (const char *)sqlite3_value_text(values[0]) : NULL;
    if (!at) return; /* NULL */
    sqlite3 *database = sqlite3_context_db_handle(call);
    const int64_t longest = sqlite3_limit(database, SQLITE_LIMIT_LENGTH, -1);
    arguments rest = { values + 1, count - 1 };
    sqlite3_str *out = sqlite3_str_new(database);
    bool in_time = true, more = true;
    for (int conversions = 0; more && *at && sqlite3_str_errcode(out) == SQLITE_OK; conversions++) {
        if (conversions % CONVERSIONS_BETWEEN_LOOKS == 0 && !(in_time = query_call_is_in_time(call))) break;
        const size_t plain = strcspn(at, "%");
        if (plain > 0) sqlite3_str_append(out, at, (int)plain); /* where nothing is ever added, the answer is NULL, as SQLite's */
        at += plain;
        if (*at == '\0') break;
        if (at[1] == '\0') {
            sqlite3_str_appendchar(out, 1, '%');
            break;
        }
        conversion one;
        at = read_conversion(at + 1, &rest, &one);
        more = add_conversion(out, &one, &rest, longest);
    }
    const bool fits = sqlite3_str_errcode(out) == SQLITE_OK;
    const int length = sqlite3_str_length(out);
    char *text = sqlite3_str_finish(out);
    if (in_time && fits && text) sqlite3_result_text(call, text, length, sqlite3_free);
    else sqlite3_free(text);
    /* As SQLite has it, a text that is too long is NULL; but not where it is this statement that allows less. */
    if (in_time && !fits && longest < QUERY_LONGEST_TEXT) sqlite3_result_error_toobig(call);
}
