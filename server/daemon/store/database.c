#include "database.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "field_tables.h"
#include "log.h"
#include "schema.h"
#include "statement_cache.h"

store_status sql_status(sqlite3 *database, int code)
{
    if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return STORE_OK;
    log_line("database: %s (%s)", sqlite3_errmsg(database), sqlite3_errstr(code));
    if ((code & 0xff) == SQLITE_CONSTRAINT) return STORE_REFUSED;
    const int system_reason = sqlite3_system_errno(database);
    return (code & 0xff) == SQLITE_FULL || ((code & 0xff) == SQLITE_IOERR && system_reason == ENOSPC) ? STORE_FULL : STORE_FAILED;
}

static void bind_all(sqlite3_stmt *statement, const char *types, va_list values)
{
    for (int i = 1; *types; i++, types++) {
        if (*types == 'i') {
            sqlite3_bind_int64(statement, i, va_arg(values, int64_t));
        } else if (*types == 'd') {
            sqlite3_bind_double(statement, i, va_arg(values, double)); /* NaN binds NULL */
        } else {
            const char *text = va_arg(values, const char *);
            sqlite3_bind_text(statement, i, text, -1, SQLITE_STATIC);
        }
    }
}

static sqlite3_stmt *prepare_and_bind(sqlite3 *database, const char *sql, const char *types, va_list values)
{
    sqlite3_stmt *statement = statement_cache_take(database, sql);
    if (!statement) {
        const int code = sqlite3_prepare_v3(database, sql, -1, SQLITE_PREPARE_PERSISTENT, &statement, NULL);
        if (sql_status(database, code) != STORE_OK) return NULL;
    }
    bind_all(statement, types, values);
    return statement;
}

sqlite3_stmt *sql_prepare(sqlite3 *database, const char *sql, const char *types, ...)
{
    va_list values;
    va_start(values, types);
    sqlite3_stmt *statement = prepare_and_bind(database, sql, types, values);
    va_end(values);
    return statement;
}

store_status sql_run(sqlite3 *database, int64_t *changed, const char *sql, const char *types, ...)
{
    va_list values;
    va_start(values, types);
    sqlite3_stmt *statement = prepare_and_bind(database, sql, types, values);
    va_end(values);
    if (!statement) return STORE_FAILED;
    const store_status status = sql_finish(statement, sqlite3_step(statement));
    if (changed) *changed = status == STORE_OK ? sqlite3_changes64(database) : 0;
    return status;
}

store_status sql_finish(sqlite3_stmt *statement, int code)
{
    const store_status status = sql_status(sqlite3_db_handle(statement), code);
    if (status == STORE_OK) statement_cache_give(statement);
    else sqlite3_finalize(statement);
    return status;
}

/* --- making it ready --- */

/* What whoever starts the daemon can do about it. */
static const char *way_out(int code)
{
    switch (code & 0xff) {
    case SQLITE_FULL: return "make room on its disk and start again; what is in it is kept";
    case SQLITE_IOERR: return "see to its disk and start again; what is in it is kept";
    case SQLITE_NOMEM: return "start again when there is memory; what is in it is kept";
    case SQLITE_BUSY:
    case SQLITE_LOCKED: return "another program holds it; end that one and start again";
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_READONLY: return "the user of the daemon must be able to write it and its folder";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB: return "put a copy of it back, or start with another --data";
    default: return "start with another --data, or with the program that made it; what is in it is kept";
    }
}

/* Says what SQLite met last, or that our own memory was out. */
static void log_unusable(sqlite3 *database, const char *path)
{
    const int code = sqlite3_errcode(database), reason = sqlite3_system_errno(database);
    const bool of_system = (code & 0xff) == SQLITE_IOERR || (code & 0xff) == SQLITE_CANTOPEN;
    const bool is_full = of_system && (reason == ENOSPC || reason == EDQUOT);
    char words[128] = "";
    if (of_system && reason) snprintf(words, sizeof words, " (%s)", strerror(reason));
    log_line("%s can't be used: %s%s; %s", path, code ? sqlite3_errmsg(database) : sqlite3_errstr(SQLITE_NOMEM), words,
             way_out(is_full ? SQLITE_FULL
                     : code  ? code
                             : SQLITE_NOMEM));
}

static bool read_pragma(sqlite3 *database, const char *sql, int *value)
{
    sqlite3_stmt *statement;
    if (sqlite3_prepare_v2(database, sql, -1, &statement, NULL) != SQLITE_OK) return false;
    const bool read = sqlite3_step(statement) == SQLITE_ROW;
    if (read) *value = sqlite3_column_int(statement, 0);
    sqlite3_finalize(statement);
    return read;
}

/* Each migration and the new version number in one transaction, which is rolled back with the connection. */
static bool migrate_from(sqlite3 *database, int version)
{
    for (int next = version; next < schema_version; next++) {
        const char *const *parts = schema_migrations[next].parts;
        const size_t most = sizeof schema_migrations[next].parts / sizeof *parts;
        char end[128];
        snprintf(end, sizeof end, "PRAGMA application_id=%d; PRAGMA user_version=%d; COMMIT;", SCHEMA_APPLICATION_ID, next + 1);
        bool done = sqlite3_exec(database, "BEGIN IMMEDIATE;", NULL, NULL, NULL) == SQLITE_OK;
        for (size_t p = 0; done && p < most && parts[p]; p++)
            done = sqlite3_exec(database, parts[p], NULL, NULL, NULL) == SQLITE_OK;
        if (!done || sqlite3_exec(database, end, NULL, NULL, NULL) != SQLITE_OK) return false;
    }
    return true;
}

static bool bring_up_to_date(sqlite3 *database, const char *path)
{
    int version = 0, application = 0;
    field_tables tables = { .listed_count = 0 };
    const bool read =
        read_pragma(database, "PRAGMA user_version", &version) && read_pragma(database, "PRAGMA application_id", &application);
    const bool known =
        version >= 0 && version <= schema_version && (application == SCHEMA_APPLICATION_ID || (application == 0 && version == 0));
    if (read && !known) {
        log_line("%s is of schema version %d, application %d; this program knows versions 0 to %d: start the one that made it, "
                 "or start this one with another --data",
                 path, version, application, schema_version);
        return false;
    }
    const bool good = read && field_tables_init(&tables) && field_tables_make(&tables, database) && migrate_from(database, version)
                      && field_tables_make_view(&tables, database);
    if (!good) log_unusable(database, path);
    field_tables_clear(&tables);
    return good;
}

static sqlite3 *open_with(const char *path, int flags, const char *pragmas)
{
    sqlite3 *database;
    if (sqlite3_open_v2(path, &database, flags | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, NULL) != SQLITE_OK
        || sqlite3_exec(database, pragmas, NULL, NULL, NULL) != SQLITE_OK) {
        log_unusable(database, path);
        sqlite3_close(database);
        return NULL;
    }
    return database;
}

sqlite3 *database_open_writer(const char *path)
{
    sqlite3 *database = open_with(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE,
                                  "PRAGMA busy_timeout=5000; PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;"
                                  "PRAGMA foreign_keys=ON; PRAGMA journal_size_limit=67108864; PRAGMA cache_size=-2000;");
    int keep = 1; /* the log and its index: on a full disk they could not be made anew, and nothing could be read */
    if (database) sqlite3_file_control(database, NULL, SQLITE_FCNTL_PERSIST_WAL, &keep);
    if (database && bring_up_to_date(database, path)) return database;
    sqlite3_close(database);
    return NULL;
}

sqlite3 *database_open_reader(const char *path)
{
    return open_with(path, SQLITE_OPEN_READONLY, "PRAGMA busy_timeout=2000; PRAGMA query_only=ON; PRAGMA cache_size=-1300;");
}

void database_close(sqlite3 *database)
{
    statement_cache_drop(database);
    sqlite3_close(database);
}
