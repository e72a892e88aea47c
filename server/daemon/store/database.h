/* SQLite as this daemon uses it: one connection that writes, several that only read.
 *
 * The release in use may damage a write-ahead log when two connections checkpoint it, so only the writer may:
 * readers open mode=ro, which also keeps them from writing anything else. */
#ifndef DATABASE_H
#define DATABASE_H

#include <sqlite3.h>
#include <stdbool.h>

#include "store.h"

/* Opens for writing and brings the tables up to date. NULL: the problem is logged. */
sqlite3 *database_open_writer(const char *path);
sqlite3 *database_open_reader(const char *path);
/* Any connection on which the functions below were used. NULL is nothing. */
void database_close(sqlite3 *database);

/* Takes the statement that was prepared for this text before (statement_cache.h), or prepares it, and binds the values. types has
 * one letter for each: i int64_t, d double (NaN becomes NULL), t text (may be NULL). The caller keeps texts until the statement
 * ends. NULL: the problem is in the log. */
sqlite3_stmt *sql_prepare(sqlite3 *database, const char *sql, const char *types, ...);
/* The same for a statement without rows. *changed, where not NULL: rows changed. */
store_status sql_run(sqlite3 *database, int64_t *changed, const char *sql, const char *types, ...);
/* Ends a statement, and keeps it for the next, whose last step gave this code: SQLITE_ROW or SQLITE_DONE are good. */
store_status sql_finish(sqlite3_stmt *statement, int code);
store_status sql_status(sqlite3 *database, int code);

#endif
