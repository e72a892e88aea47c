/* The tables of inputs and results, and all SQL that names their columns, made from the rows of all processes
 * (api/field_columns.h). */
#ifndef FIELD_TABLES_H
#define FIELD_TABLES_H

#include <sqlite3.h>

#include "field_columns.h"
#include "store.h"

/* Of one table. */
typedef struct field_insert {
    const char *table;
    size_t first; /* of its columns, among all */
    char *sql;    /* "INSERT OR REPLACE INTO <table>(job,...) VALUES(?,...)"; owned */
} field_insert;

typedef struct field_tables {
    field_columns columns;
    field_insert *insert; /* (insert_count) owned */
    size_t insert_count;
    const field_column **listed; /* (listed_count) what a job's summary has, in the order of select_jobs; owned */
    size_t listed_count;
    char *select_listed; /* ", friction AS ..., ...": more columns of a SELECT; owned, as all below */
    char *join_listed;   /* the tables that these are in, joined to `job` */
    char *select_study, *join_study;
} field_tables;

/* False: no memory. */
bool field_tables_init(field_tables *tables);
void field_tables_clear(field_tables *tables);

/* Makes tables and columns that the database lacks. Writes nothing where it lacks none. Before the migrations, which may
 * fill columns in. False: the connection tells why, and is to be closed, which rolls back; of it too. */
bool field_tables_make(const field_tables *tables, sqlite3 *writer);
/* Makes the views: run_summary, one row a run that has ended well or failed, with its main inputs and results; input_field and
 * job_input (field_views.h). Writes nothing where they are as they should be. After the migrations, since they show columns of
 * `job`. */
bool field_tables_make_view(const field_tables *tables, sqlite3 *writer);

/* Between begin and end: the main inputs of a job as a row of its process's table. */
store_status field_tables_insert_inputs(const field_tables *tables, sqlite3 *writer, int64_t job, const job_spec *spec);
/* Between begin and end: the results document, whole and spread over the tables. */
store_status field_tables_insert_results(const field_tables *tables, sqlite3 *writer, int64_t job, const char *document,
                                         const json_t *results);

#endif
