/* Functions of users' SQL that could hold up a query for minutes within one call. */
#ifndef QUERY_FUNCTIONS_H
#define QUERY_FUNCTIONS_H

#include <sqlite3.h>
#include <stdbool.h>

/* deadline: monotonic seconds; read at every call, so it must live as long as statements run. False: no memory. */
bool query_functions_install(sqlite3 *database, const double *deadline);

#endif
