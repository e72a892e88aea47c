#include "statement_cache.h"

#include <pthread.h>
#include <stdint.h>
#include <string.h>

enum { MOST_OF_ONE = 40, PLACES = 8 * MOST_OF_ONE }; /* of one connection; in all */

static struct {
    sqlite3_stmt *statement; /* NULL: the place is free */
    sqlite3 *database;
    int64_t given; /* the larger, the later */
} kept[PLACES];
static int64_t given;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static sqlite3_stmt *take_from(int place)
{
    sqlite3_stmt *statement = kept[place].statement;
    kept[place].statement = NULL;
    kept[place].database = NULL;
    return statement;
}

sqlite3_stmt *statement_cache_take(sqlite3 *database, const char *sql)
{
    sqlite3_stmt *found = NULL;
    pthread_mutex_lock(&lock);
    for (int k = 0; k < PLACES && !found; k++)
        if (kept[k].database == database && strcmp(sqlite3_sql(kept[k].statement), sql) == 0) found = take_from(k);
    pthread_mutex_unlock(&lock);
    return found;
}

/* A free place, or that of the connection's own oldest where it has its share: those of others may be in use by their
 * threads at this moment. -1: none. */
static int place_for(const sqlite3 *database)
{
    int own = 0, oldest = -1, free_place = -1;
    for (int k = 0; k < PLACES; k++) {
        if (!kept[k].statement) free_place = k;
        if (!kept[k].statement || kept[k].database != database) continue;
        own++;
        if (oldest < 0 || kept[k].given < kept[oldest].given) oldest = k;
    }
    return own < MOST_OF_ONE && free_place >= 0 ? free_place : oldest;
}

void statement_cache_give(sqlite3_stmt *statement)
{
    if (!statement) return;
    sqlite3 *database = sqlite3_db_handle(statement);
    sqlite3_reset(statement);
    sqlite3_clear_bindings(statement);
    pthread_mutex_lock(&lock);
    const int place = place_for(database);
    if (place >= 0) {
        sqlite3_stmt *before = take_from(place);
        kept[place].statement = statement;
        kept[place].database = database;
        kept[place].given = ++given;
        statement = before;
    }
    pthread_mutex_unlock(&lock);
    sqlite3_finalize(statement);
}

void statement_cache_drop(sqlite3 *database)
{
    pthread_mutex_lock(&lock);
    for (int k = 0; k < PLACES; k++)
        if (kept[k].statement && kept[k].database == database) sqlite3_finalize(take_from(k));
    pthread_mutex_unlock(&lock);
}
