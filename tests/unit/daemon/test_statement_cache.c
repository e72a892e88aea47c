/* Claims about statements that are kept for their next use. */
#include "claims.h"
#include "database.h"

static sqlite3 *opened(void)
{
    sqlite3 *database;
    assert_int_equal(sqlite3_open(":memory:", &database), SQLITE_OK);
    return database;
}

static int statements_of(sqlite3 *database)
{
    int count = 0;
    for (sqlite3_stmt *one = NULL; (one = sqlite3_next_stmt(database, one));) count++;
    return count;
}

static sqlite3_stmt *asked(sqlite3 *database, const char *value)
{
    sqlite3_stmt *statement = sql_prepare(database, "SELECT ?1 IS NULL, ?1", "t", value);
    assert_non_null(statement);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    return statement;
}

static void a_text_is_parsed_once(void **state)
{
    (void)state;
    sqlite3 *database = opened();
    sqlite3_stmt *first = asked(database, "one");
    assert_string_equal((const char *)sqlite3_column_text(first, 1), "one");
    assert_int_equal(sql_finish(first, SQLITE_ROW), STORE_OK);
    sqlite3_stmt *second = asked(database, "two");
    assert_ptr_equal(first, second);
    assert_string_equal((const char *)sqlite3_column_text(second, 1), "two");
    sql_finish(second, SQLITE_ROW);
    /* Nothing of its last use is left. */
    sqlite3_stmt *third = sql_prepare(database, "SELECT ?1 IS NULL, ?1", "");
    assert_ptr_equal(first, third);
    assert_int_equal(sqlite3_step(third), SQLITE_ROW);
    assert_int_equal(sqlite3_column_int(third, 0), 1);
    sql_finish(third, SQLITE_ROW);
    database_close(database);
}

static void one_in_use_is_not_used_by_another(void **state)
{
    (void)state;
    sqlite3 *database = opened(), *other = opened();
    sqlite3_stmt *outer = asked(database, "outer"), *inner = asked(database, "inner");
    assert_ptr_not_equal(outer, inner);
    sql_finish(inner, SQLITE_ROW);
    assert_string_equal((const char *)sqlite3_column_text(outer, 1), "outer");
    sql_finish(outer, SQLITE_ROW);
    sqlite3_stmt *elsewhere = asked(other, "elsewhere");
    assert_ptr_equal(sqlite3_db_handle(elsewhere), other);
    sql_finish(elsewhere, SQLITE_ROW);
    database_close(other);
    database_close(database);
}

static void many_texts_are_not_all_kept(void **state)
{
    (void)state;
    sqlite3 *database[12]; /* more than there is room for */
    for (int d = 0; d < 12; d++) {
        database[d] = opened();
        for (int k = 0; k < 100; k++) {
            char sql[40];
            snprintf(sql, sizeof sql, "SELECT %d", k);
            sqlite3_stmt *statement = sql_prepare(database[d], sql, "");
            assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
            assert_int_equal(sqlite3_column_int(statement, 0), k);
            assert_int_equal(sql_finish(statement, SQLITE_ROW), STORE_OK);
        }
        assert_true(statements_of(database[d]) <= 40);
    }
    assert_int_equal(statements_of(database[0]), 40);
    for (int d = 0; d < 12; d++) {
        assert_int_equal(sqlite3_errcode(database[d]), SQLITE_OK);
        database_close(database[d]);
    }
}

static void one_that_failed_is_not_kept(void **state)
{
    (void)state;
    sqlite3 *database = opened();
    assert_int_equal(sql_run(database, NULL, "CREATE TABLE t(x INTEGER PRIMARY KEY)", ""), STORE_OK);
    const int before = statements_of(database);
    assert_int_equal(sql_run(database, NULL, "INSERT INTO t VALUES(?)", "i", (int64_t)1), STORE_OK);
    assert_int_equal(sql_run(database, NULL, "INSERT INTO t VALUES(?)", "i", (int64_t)1), STORE_REFUSED);
    assert_int_equal(statements_of(database), before);
    assert_int_equal(sql_run(database, NULL, "INSERT INTO t VALUES(?)", "i", (int64_t)2), STORE_OK);
    database_close(database);
}

UNIT_TESTS(a_text_is_parsed_once, one_in_use_is_not_used_by_another, many_texts_are_not_all_kept, one_that_failed_is_not_kept)
