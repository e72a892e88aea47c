/* Functions of users' SQL that could hold up a query for minutes within one call. */
#ifndef QUERY_FUNCTIONS_H
#define QUERY_FUNCTIONS_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "client_watch.h"

/* Until when the statement that runs may do so. */
typedef struct query_watch {
    double deadline, looked;    /* monotonic s; when the client was last looked at */
    const client_watch *client; /* lent for one statement */
    int64_t values_held;        /* by the quantiles that it works on */
} query_watch;

bool query_watch_is_over(query_watch *watch);

/* watch: looked at in every call, so it must live as long as the connection. False: no memory. */
bool query_functions_install(sqlite3 *database, query_watch *watch);

/* It looks at the clock, and SQLite's own function of this name is not called. */
bool query_function_is_ours(const char *name, size_t length);

/* Within a call; false: it has been answered with an error. */
bool query_call_is_in_time(sqlite3_context *call);

/* query_statistics.c */
bool query_statistics_install(sqlite3 *database, query_watch *watch);

/* query_printf.c */
void query_printf(sqlite3_context *call, int count, sqlite3_value **values);

#endif
