/* How long the texts may be that a statement of a user works on, so that it can be stopped in time. */
#ifndef QUERY_COST_H
#define QUERY_COST_H

#include <sqlite3.h>

enum { QUERY_LONGEST_TEXT = 256 << 10, QUERY_SHORT_SQL = 2000 /* bytes: too few for a program that could be a trouble */ };

/* Bytes, at most QUERY_LONGEST_TEXT; 0: the statement can't be looked into. */
int query_longest_text(sqlite3 *database, const char *sql);
/* The same for one that met a longer text: more where it only reads what is stored, such as a long specification, and 0
 * where it makes texts of its own. */
int query_longest_stored_text(sqlite3 *database, const char *sql);

#endif
