/* Claims about databases that an earlier version of the program made. */
#include <unistd.h>

#include "claims.h"
#include "database.h"
#include "older_schema.h"

static void run_sql(sqlite3 *database, const char *sql)
{
    char *problem = NULL;
    if (sqlite3_exec(database, sql, NULL, NULL, &problem) != SQLITE_OK) fail_msg("%s: %s", problem, sql);
}

static int64_t number_of(sqlite3 *database, const char *sql)
{
    sqlite3_stmt *statement;
    if (sqlite3_prepare_v2(database, sql, -1, &statement, NULL) != SQLITE_OK) fail_msg("%s: %s", sqlite3_errmsg(database), sql);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    const int64_t number = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    return number;
}

static void run_migration(sqlite3 *database, const schema_migration *migration)
{
    for (size_t p = 0; p < sizeof migration->parts / sizeof migration->parts[0]; p++)
        if (migration->parts[p]) run_sql(database, migration->parts[p]);
}

/* A database as version `version` of the tables left it, with one drum that has run. */
static void make_database(const char *path, int version)
{
    sqlite3 *database;
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    for (int m = 0; m < version; m++) {
        run_migration(database, &older_migrations[m]);
        run_migration(database, &schema_migrations[m]);
    }
    char text[200];
    snprintf(text, sizeof text, "PRAGMA application_id=%d; PRAGMA user_version=%d", SCHEMA_APPLICATION_ID, version);
    run_sql(database, text);
    run_sql(
        database,
        "INSERT INTO job(id,process,label,spec,status,message,threads,estimated_seconds,estimated_memory_bytes,created,"
        "updated) VALUES('a','drum','{}','{\"inputs\":{\"particles\":[{\"shape\":\"cube\"}]}}','successful','done',1,1,1,'x','x')");
    run_sql(database,
            "INSERT INTO "
            "drum_input(job,drum_diameter,drum_length,rotation_rate,gravity,fill_fraction,particles,species,diameter,density,"
            "friction,restitution,wall_friction,tangential_stiffness_ratio,stiffness,lining_diameter,time_step,duration,seed)"
            " VALUES(1,.1,.1,2,9.81,.5,100,1,.004,2500,.25,.8,.5,.8,4000,0,1e-5,1,7)");
    run_sql(database, "INSERT INTO run_result(job,particles) VALUES(1,100)");
    run_sql(database, "INSERT INTO repose_result(job,angle_deg) VALUES(1,23.5)");
    assert_int_equal(sqlite3_close(database), SQLITE_OK);
}

/* A folder for one database, whose path is written. */
typedef struct database_folder {
    char folder[40], path[64];
} database_folder;

static database_folder make_folder(void)
{
    database_folder made = { .folder = "/tmp/reposed_schema_XXXXXX" };
    assert_non_null(mkdtemp(made.folder));
    snprintf(made.path, sizeof made.path, "%s/reposed.sqlite", made.folder);
    return made;
}

static void remove_folder(const database_folder *made)
{
    char command[64];
    snprintf(command, sizeof command, "rm -r %s", made->folder);
    assert_int_equal(system(command), 0);
}

static void every_earlier_version_is_brought_up_to_date_with_what_it_holds(void **state)
{
    (void)state;
    for (int version = 1; version <= OLDER_VERSIONS; version++) {
        const database_folder made = make_folder();
        make_database(made.path, version);
        sqlite3 *database = database_open_writer(made.path);
        assert_non_null(database);
        assert_int_equal(number_of(database, "PRAGMA user_version"), schema_version);
        assert_int_equal(number_of(database, "SELECT count(*) FROM run_summary WHERE process='drum' AND friction=.25"
                                             " AND rotation_rate=2 AND particles=100 AND angle_deg=23.5 AND ends='periodic'"
                                             " AND lifters=0"),
                         1);
        if (version < 4) /* from when the specification alone knew */
            assert_int_equal(number_of(database, "SELECT count(*) FROM run_summary WHERE shape='cube'"), 1);
        run_sql(database, "INSERT INTO granule_input VALUES(1,.5,.063,NULL,30,9.81,1e-9)");
        run_sql(database, "INSERT INTO granule_result(job,minimum_omega2) VALUES(1,1.826)");
        sqlite3_close(database);
        remove_folder(&made);
    }
}

/* What a program of that time finds in a database that it did not make, it must not write into. */
static void what_an_earlier_program_could_not_fill_in_has_a_number_that_it_does_not_know(void **state)
{
    (void)state;
    assert_true(schema_version > OLDER_VERSIONS);
}

static char *text_of(sqlite3 *database, const char *sql)
{
    sqlite3_stmt *statement;
    if (sqlite3_prepare_v2(database, sql, -1, &statement, NULL) != SQLITE_OK) fail_msg("%s: %s", sqlite3_errmsg(database), sql);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    char *text = strdup((const char *)sqlite3_column_text(statement, 0));
    sqlite3_finalize(statement);
    return text;
}

/* Columns of the tables of inputs and results, and of the view, by name. */
static const char columns_of_all_tables[] =
    "SELECT group_concat(line, char(10)) FROM (SELECT s.name||' '||c.name||' '||c.type AS line FROM sqlite_schema s,"
    " pragma_table_xinfo(s.name) c WHERE s.name LIKE '%_input' OR s.name LIKE '%_result' OR s.name='run_summary' ORDER BY 1)";

static void a_new_database_has_the_columns_of_one_that_was_brought_up_to_date(void **state)
{
    (void)state;
    char *columns[2];
    for (int is_old = 0; is_old < 2; is_old++) {
        const database_folder made = make_folder();
        if (is_old) make_database(made.path, OLDER_VERSIONS);
        sqlite3 *database = database_open_writer(made.path);
        assert_non_null(database);
        columns[is_old] = text_of(database, columns_of_all_tables);
        sqlite3_close(database);
        remove_folder(&made);
    }
    assert_string_equal(columns[0], columns[1]);
    assert_non_null(strstr(columns[0], "drum_input lining_diameter REAL"));
    assert_non_null(strstr(columns[0], "repose_result slumps_count INTEGER"));
    assert_non_null(strstr(columns[0], "run_summary regime TEXT"));
    free(columns[0]);
    free(columns[1]);
}

static void a_database_of_a_newer_program_is_refused(void **state)
{
    (void)state;
    const database_folder made = make_folder();
    make_database(made.path, OLDER_VERSIONS);
    sqlite3 *database;
    assert_int_equal(sqlite3_open(made.path, &database), SQLITE_OK);
    char text[100];
    snprintf(text, sizeof text, "PRAGMA user_version=%d", schema_version + 1);
    run_sql(database, text);
    sqlite3_close(database);
    assert_null(database_open_writer(made.path));
    remove_folder(&made);
}

UNIT_TESTS(every_earlier_version_is_brought_up_to_date_with_what_it_holds,
           what_an_earlier_program_could_not_fill_in_has_a_number_that_it_does_not_know,
           a_new_database_has_the_columns_of_one_that_was_brought_up_to_date, a_database_of_a_newer_program_is_refused)
