/* Statements that have ended, kept for whoever needs the same text on the same connection next: parsing one takes longer
 * than running it. One that is taken belongs to its taker until it is given back, so it is never used twice at once. */
#ifndef STATEMENT_CACHE_H
#define STATEMENT_CACHE_H

#include <sqlite3.h>

/* NULL: there is none. Its values are unset. */
sqlite3_stmt *statement_cache_take(sqlite3 *database, const char *sql);
/* NULL is nothing. */
void statement_cache_give(sqlite3_stmt *statement);
/* Before the connection is closed. */
void statement_cache_drop(sqlite3 *database);

#endif
