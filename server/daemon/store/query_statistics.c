/* stddev(x): the standard deviation of a sample (divided by n-1), of the values that are numbers; NULL of fewer than two. */
#include <math.h>

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

bool query_statistics_install(sqlite3 *database)
{
    return sqlite3_create_function(database, "stddev", 1, SQLITE_UTF8 | SQLITE_DETERMINISTIC, NULL, NULL, add_to_moments,
                                   tell_deviation)
           == SQLITE_OK;
}
