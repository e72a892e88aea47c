/* stddev(x): the standard deviation of a sample (divided by n-1), of the values that are numbers; NULL of fewer than two.
 * quantile(x, share): of the same the value below which that share of them lies; NULL of none. */
#include <math.h>
#include <stdlib.h>

#include "query_functions.h"

/* Welford's sums, which lose no digits where the mean is large. */
typedef struct moments {
    double count, mean, squares;
} moments;

static void add_to_moments(sqlite3_context *call, int count, sqlite3_value **values)
{
    (void)count;
    moments *sums = sqlite3_aggregate_context(call, sizeof *sums);
    const int type = sqlite3_value_type(values[0]);
    if (!sums) {
        sqlite3_result_error_nomem(call);
        return;
    }
    if (type != SQLITE_INTEGER && type != SQLITE_FLOAT) return;
    const double value = sqlite3_value_double(values[0]), before = sums->mean;
    sums->count += 1.0;
    sums->mean += (value - before) / sums->count;
    sums->squares += (value - before) * (value - sums->mean);
}

static void tell_deviation(sqlite3_context *call)
{
    const moments *sums = sqlite3_aggregate_context(call, 0);
    if (!sums || sums->count < 2.0) sqlite3_result_null(call);
    else sqlite3_result_double(call, sqrt(sums->squares / (sums->count - 1.0)));
}

/* --- quantile(x, share): exact, of all values --- */

enum { MOST_VALUES = 2000000 }; /* of all quantiles that one statement works on at a time: 16 MB */

typedef struct value_list {
    double *value; /* (count) sqlite's memory */
    int64_t count, room;
    double share;
} value_list;

static bool make_room(sqlite3_context *call, value_list *list)
{
    query_watch *watch = sqlite3_user_data(call);
    if (list->count < list->room) return true;
    const int64_t room = list->room ? 2 * list->room : 64;
    if (watch->values_held + room - list->room > MOST_VALUES) {
        sqlite3_result_error(call, "quantile works on at most two million values at a time", -1);
        return false;
    }
    double *value = sqlite3_realloc64(list->value, (sqlite3_uint64)room * sizeof *value);
    if (!value) {
        sqlite3_result_error_nomem(call);
        return false;
    }
    watch->values_held += room - list->room;
    list->value = value;
    list->room = room;
    return true;
}

static void add_to_values(sqlite3_context *call, int count, sqlite3_value **values)
{
    (void)count;
    value_list *list = sqlite3_aggregate_context(call, sizeof *list);
    const int type = sqlite3_value_type(values[0]), share_type = sqlite3_value_numeric_type(values[1]);
    const double share = sqlite3_value_double(values[1]);
    if (!list) {
        sqlite3_result_error_nomem(call);
        return;
    }
    if ((share_type != SQLITE_INTEGER && share_type != SQLITE_FLOAT) || !(share >= 0.0 && share <= 1.0)) {
        sqlite3_result_error(call, "quantile(x, share): the share must be a number in [0, 1]; 0.5 is the median", -1);
        return;
    }
    if ((type != SQLITE_INTEGER && type != SQLITE_FLOAT) || !make_room(call, list)) return;
    list->share = share;
    list->value[list->count++] = sqlite3_value_double(values[0]);
}

static int compare_values(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Between the two values that the place lies between it grows evenly, as numpy's and R's default have it. Called also where
 * the statement was given up. */
static void tell_quantile(sqlite3_context *call)
{
    value_list *list = sqlite3_aggregate_context(call, 0);
    if (!list || !list->value) {
        sqlite3_result_null(call);
        return;
    }
    qsort(list->value, (size_t)list->count, sizeof *list->value, compare_values);
    const double place = list->share * (double)(list->count - 1);
    const int64_t below = (int64_t)place, above = below + 1 < list->count ? below + 1 : below;
    const double low = list->value[below], high = list->value[above], part = place - (double)below;
    /* Without a difference, which of two infinite ones is no number. */
    sqlite3_result_double(call, part > 0.0 && high != low ? low * (1.0 - part) + high * part : low);
    ((query_watch *)sqlite3_user_data(call))->values_held -= list->room;
    sqlite3_free(list->value);
    list->value = NULL;
}

bool query_statistics_install(sqlite3 *database, query_watch *watch)
{
    const int flags = SQLITE_UTF8 | SQLITE_DETERMINISTIC;
    return sqlite3_create_function(database, "stddev", 1, flags, NULL, NULL, add_to_moments, tell_deviation) == SQLITE_OK
           && sqlite3_create_function(database, "quantile", 2, flags, watch, NULL, add_to_values, tell_quantile) == SQLITE_OK;
}
