#include "study_stage.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "checksum.h"
#include "database.h"
#include "json_pointer.h"
#include "log.h"
#include "spec_bed.h"
#include "study_parts.h"
#include "text_buffer.h"

struct study_stage {
    job_store *store;
    const study_spec *study;
    const calibration *machine;
    sqlite3 *database;
    study_parts parts;
    time_t second; /* of the ids, */
    uint32_t bits; /* the study's */
    char id[JOB_ID_SIZE];
    bool has_starts;
    bool may_share_beds;
    checksum sum; /* of the id: beds are shared within a study */
    store_status status;
};

typedef store_status table_visitor(study_stage *stage, const char *table, void *context);

/* In the order in which they are copied: what refers to a row comes after it. */
static store_status visit_tables(study_stage *stage, table_visitor *visit, void *context)
{
    static const char *const tables[] = { "study_case", "study_part", "job", "job_load" };
    store_status status = STORE_OK;
    for (size_t t = 0; status == STORE_OK && t < sizeof tables / sizeof tables[0]; t++) status = visit(stage, tables[t], context);
    for (size_t p = 0; status == STORE_OK && process_types[p]; p++) {
        char inputs[40];
        snprintf(inputs, sizeof inputs, "%s_input", process_types[p]->name);
        status = visit(stage, inputs, context);
    }
    return status;
}

/* --- a database with the same tables --- */

/* Of the table the columns alone, their defaults and the number that its rows are in order of: what else it demands of a row is
 * looked at when the row is copied. */
static bool write_definition(sqlite3 *reader, const char *table, text_buffer *sql)
{
    sqlite3_stmt *row =
        sql_prepare(reader,
                    "SELECT name, CASE WHEN pk=1 AND type='INTEGER' AND (SELECT max(pk) FROM pragma_table_info(?1))=1"
                    " THEN ' INTEGER PRIMARY KEY' ELSE coalesce(' DEFAULT ('||dflt_value||')','') END"
                    " FROM pragma_table_info(?1)",
                    "t", table);
    int columns = 0;
    text_buffer_print(sql, "CREATE TABLE %s(", table);
    for (; row && sqlite3_step(row) == SQLITE_ROW; columns++)
        text_buffer_print(sql, "%s\"%s\"%s", columns ? "," : "", (const char *)sqlite3_column_text(row, 0),
                          (const char *)sqlite3_column_text(row, 1));
    text_buffer_print(sql, ")");
    sqlite3_finalize(row);
    return columns > 0 && !sql->failed;
}

static store_status copy_definition(study_stage *stage, const char *table, void *database)
{
    text_buffer sql;
    text_buffer_init(&sql, 8192);
    sqlite3 *reader = store_borrow_reader(stage->store);
    const bool good = write_definition(reader, table, &sql) && sqlite3_exec(database, sql.text, NULL, NULL, NULL) == SQLITE_OK;
    store_return_reader(stage->store, reader);
    text_buffer_clear(&sql);
    return good ? STORE_OK : STORE_FAILED;
}

static sqlite3 *open_stage(study_stage *stage)
{
    sqlite3 *database;
    bool good = sqlite3_open_v2("", &database,
                                SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, NULL)
                    == SQLITE_OK
                && sqlite3_exec(database,
                                "PRAGMA page_size=32768; PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA cache_size=-12000;"
                                "CREATE TABLE start(id TEXT NOT NULL, job TEXT NOT NULL, snapshot REAL);",
                                NULL, NULL, NULL)
                       == SQLITE_OK;
    good = good && visit_tables(stage, copy_definition, database) == STORE_OK
           && sqlite3_exec(database, "BEGIN", NULL, NULL, NULL) == SQLITE_OK;
    if (good) return database;
    log_line("a study's rows can't be kept: %s", sqlite3_errmsg(database));
    sqlite3_close(database);
    return NULL;
}

/* It, what it is a part of, or one that it may have as a part. */
static bool may_act_later(const spec_table *table, const char *column)
{
    char path[JSON_POINTER_SIZE];
    for (size_t end = strcspn(column, "/");; end += 1 + strcspn(column + end + 1, "/")) {
        snprintf(path, sizeof path, "%.*s", (int)end, column);
        const spec_field *field = spec_field_at(table, path);
        if (!field || field->acts_later) return true;
        if (!column[end]) return field->kind >= FIELD_CHOICE_OR_OBJECT;
    }
}

/* Whether cases differ in anything that acts after the bed has settled. */
static bool may_share_beds(const study_spec *study)
{
    const process_type *type = process_type_find(study->process);
    for (size_t c = 0; type && c < json_array_size(study->columns); c++)
        if (may_act_later(type->inputs, json_string_value(json_array_get(study->columns, c)))) return true;
    return false;
}

study_stage *store_stage_study(job_store *store, const study_spec *study, const calibration *machine)
{
    study_stage *stage = calloc(1, sizeof *stage);
    if (!stage) return NULL;
    *stage = (study_stage){ .store = store, .study = study, .machine = machine, .second = time(NULL) };
    if (store_random_bits(&stage->bits)) stage->database = open_stage(stage);
    if (!stage->database) {
        free(stage);
        return NULL;
    }
    store_write_id(stage->id, stage->second, stage->bits);
    stage->may_share_beds = may_share_beds(study);
    checksum_begin(&stage->sum);
    checksum_add(&stage->sum, stage->id, strlen(stage->id));
    study_parts_init(&stage->parts, stage->database);
    return stage;
}

void store_drop_stage(study_stage *stage)
{
    if (!stage) return;
    study_parts_clear(&stage->parts);
    database_close(stage->database);
    free(stage);
}

const char *study_stage_id(const study_stage *stage) { return stage->id; }
store_status store_stage_status(const study_stage *stage) { return stage->status; }

/* --- rows of one job --- */

enum { MOST_VALUES = 100 }; /* of an input that the table of results shows as it is */

static bool holds_more(const json_t *value, size_t *left)
{
    const char *name;
    size_t i;
    json_t *member;
    if (*left == 0) return true;
    --*left;
    json_object_foreach((json_t *)value, name, member) if (holds_more(member, left)) return true;
    json_array_foreach(value, i, member) if (holds_more(member, left)) return true;
    return false;
}

/* An input that is a long list is named by its place in the study's document: /vary/~1inputs~1start/2. */
static void shorten_inputs(const study_spec *study, size_t index, json_t *inputs)
{
    for (size_t c = 0; c < json_array_size(study->columns); c++) {
        const char *column = json_string_value(json_array_get(study->columns, c));
        size_t left = MOST_VALUES;
        char varied[JSON_POINTER_SIZE + 8], place[2 * JSON_POINTER_SIZE] = "/vary";
        if (!json_object_get(study->document, "vary") || !holds_more(json_object_get(inputs, column), &left)) continue;
        snprintf(varied, sizeof varied, "/inputs/%s", column);
        if (!json_pointer_append(place, varied)) continue;
        json_object_set_new(inputs, column, json_sprintf("%s/%zu", place, study_value_index(study, index, c)));
    }
}

static store_status stage_case(study_stage *stage, const job_spec *spec, size_t index)
{
    char name[STUDY_NAME_SIZE];
    study_case_name(stage->study, index, name);
    json_t *varied = study_case_inputs(stage->study, index);
    shorten_inputs(stage->study, index, varied);
    char *label = json_dumps(spec->label, JSON_COMPACT), *inputs = json_dumps(varied, JSON_COMPACT | JSON_REAL_PRECISION(15));
    const store_status status = !label || !inputs ? STORE_FAILED
                                                  : sql_run(stage->database, NULL, "INSERT INTO study_case VALUES(0,?,?,?,?)",
                                                            "ittt", (int64_t)index, name, inputs, label);
    free(inputs);
    free(label);
    json_decref(varied);
    return status;
}

static store_status stage_start(study_stage *stage, const job_spec *spec, const char *id)
{
    const char *from = job_started_from(spec);
    if (!from) return STORE_OK;
    stage->has_starts = true;
    return sql_run(stage->database, NULL, "INSERT INTO start VALUES(?,?,?)", "ttd", id, from, spec->inputs.start.snapshot);
}

/* Alike in all jobs of the study that settle the same bed; 0: this one settles none. */
static int64_t bed_of(const study_stage *stage, const job_spec *spec)
{
    char *text = stage->may_share_beds ? spec_bed_text(spec) : NULL;
    if (!text) return 0;
    checksum sum = stage->sum;
    checksum_add(&sum, text, strlen(text));
    free(text);
    return (int64_t)(checksum_end(&sum) >> 1) + 1;
}

/* First each case once, then each case again: the whole table is seen early. */
static bool stage_job(void *context, const job_spec *spec, size_t index, int repeat)
{
    study_stage *stage = context;
    const int64_t number = (int64_t)repeat * (int64_t)stage->study->cases + (int64_t)index + 1;
    const job_place place = { 1, (int64_t)index, repeat, number, bed_of(stage, spec) };
    char id[JOB_ID_SIZE];
    store_write_id(id, stage->second, stage->bits + (uint32_t)number);
    char *text = study_parts_write(&stage->parts, spec);
    store_status status = text ? STORE_OK : STORE_FAILED;
    if (repeat == 0) status = stage_case(stage, spec, index);
    if (status == STORE_OK)
        status = store_insert_job(&stage->store->fields, stage->database, number, spec, id, text, &place, stage->machine);
    if (status == STORE_OK) status = stage_start(stage, spec, id);
    free(text);
    stage->status = status;
    return status == STORE_OK;
}

study_taker store_stage_taker(study_stage *stage) { return (study_taker){ .take = stage_job, .context = stage }; }

/* --- beds --- */

store_status study_stage_match_beds(study_stage *stage)
{
    static const char alone[] = "UPDATE job SET bed=NULL WHERE bed IN (SELECT bed FROM job GROUP BY bed HAVING count(*)=1)";
    return stage->may_share_beds ? sql_run(stage->database, NULL, alone, "") : STORE_OK;
}

store_status study_stage_bring_starts(study_stage *stage)
{
    if (!stage->has_starts) return STORE_OK;
    sqlite3_stmt *row = sql_prepare(stage->database, "SELECT id, job, snapshot FROM start", "");
    if (!row) return STORE_FAILED;
    int code;
    bool good = true;
    while (good && (code = sqlite3_step(row)) == SQLITE_ROW) {
        const double snapshot = sqlite3_column_type(row, 2) == SQLITE_NULL ? NAN : sqlite3_column_double(row, 2);
        good = store_bring_start(stage->store, (const char *)sqlite3_column_text(row, 1), snapshot,
                                 (const char *)sqlite3_column_text(row, 0));
    }
    const store_status reason = errno == ENOSPC || errno == EDQUOT ? STORE_FULL : STORE_FAILED;
    if (!good) sqlite3_finalize(row);
    else if (sql_finish(row, code) != STORE_OK) return STORE_FAILED;
    if (!good) return reason;
    return data_folder_sync(stage->store->data) ? STORE_OK : STORE_FAILED;
}

void study_stage_discard_starts(study_stage *stage)
{
    sqlite3_stmt *row = stage->has_starts ? sql_prepare(stage->database, "SELECT id FROM start", "") : NULL;
    while (row && sqlite3_step(row) == SQLITE_ROW)
        job_folder_discard(stage->store->data, (const char *)sqlite3_column_text(row, 0));
    sqlite3_finalize(row);
}

/* --- copying --- */

/* How a column's value comes to be: numbers of jobs go on from the last job (?1) and turns from the last
 * turn (?4), the study is ?2, times are now (?3). */
static void add_column(text_buffer *sources, text_buffer *targets, const char *table, const char *name)
{
    const char *comma = sources->length ? "," : "";
    const bool of_job = strcmp(table, "job") == 0;
    text_buffer_print(targets, "%s\"%s\"", comma, name);
    if (strcmp(name, "study") == 0) text_buffer_print(sources, "%s?2", comma);
    else if (of_job && (strcmp(name, "created") == 0 || strcmp(name, "updated") == 0)) text_buffer_print(sources, "%s?3", comma);
    else if (of_job && strcmp(name, "turn") == 0) text_buffer_print(sources, "%s\"turn\"+?4", comma);
    else if (strcmp(name, of_job ? "number" : "job") == 0) text_buffer_print(sources, "%s\"%s\"+?1", comma, name);
    else text_buffer_print(sources, "%s\"%s\"", comma, name);
}

/* columns: how many. */
static bool write_copy(study_stage *stage, const char *table, text_buffer *select, text_buffer *insert, int *columns)
{
    text_buffer sources, targets, values;
    text_buffer_init(&sources, 4096);
    text_buffer_init(&targets, 4096);
    text_buffer_init(&values, 4096);
    sqlite3_stmt *row = sql_prepare(stage->database, "SELECT name FROM pragma_table_info(?)", "t", table);
    *columns = 0;
    while (row && sqlite3_step(row) == SQLITE_ROW) {
        text_buffer_print(&values, *columns ? ",?" : "?");
        add_column(&sources, &targets, table, (const char *)sqlite3_column_text(row, 0));
        ++*columns;
    }
    sqlite3_finalize(row);
    const bool good = *columns > 0 && !sources.failed && !targets.failed && !values.failed;
    if (good) text_buffer_print(select, "SELECT %s FROM %s", sources.text, table);
    if (good) text_buffer_print(insert, "INSERT INTO %s(%s) VALUES(%s)", table, targets.text, values.text);
    text_buffer_clear(&sources);
    text_buffer_clear(&targets);
    text_buffer_clear(&values);
    return good && !select->failed && !insert->failed;
}

static store_status copy_rows(sqlite3_stmt *from, sqlite3_stmt *to, int columns)
{
    int code;
    while ((code = sqlite3_step(from)) == SQLITE_ROW) {
        for (int c = 0; c < columns; c++) sqlite3_bind_value(to, c + 1, sqlite3_column_value(from, c));
        code = sqlite3_step(to);
        sqlite3_reset(to);
        if (code != SQLITE_DONE) return sql_status(sqlite3_db_handle(to), code);
    }
    return sql_status(sqlite3_db_handle(from), code);
}

/* What the copied rows are given. */
typedef struct copied_rows {
    int64_t last_job, last_turn, study;
    char now[JOB_TIME_SIZE];
} copied_rows;

static store_status copy_table(study_stage *stage, const char *table, void *context)
{
    const copied_rows *rows = context;
    text_buffer select, insert;
    int columns;
    text_buffer_init(&select, 8192);
    text_buffer_init(&insert, 8192);
    store_status status = STORE_FAILED;
    if (write_copy(stage, table, &select, &insert, &columns)) {
        sqlite3_stmt *from = sql_prepare(stage->database, select.text, ""),
                     *to = sql_prepare(stage->store->writer, insert.text, "");
        if (from && to) {
            sqlite3_bind_int64(from, 1, rows->last_job);
            sqlite3_bind_int64(from, 2, rows->study);
            sqlite3_bind_text(from, 3, rows->now, -1, SQLITE_STATIC);
            sqlite3_bind_int64(from, 4, rows->last_turn);
            status = copy_rows(from, to, columns);
        }
        sqlite3_finalize(from);
        sqlite3_finalize(to);
    }
    text_buffer_clear(&select);
    text_buffer_clear(&insert);
    return status;
}

/* Of the client of its first job, who as a rule is that of all. */
static store_status read_last_turn(study_stage *stage, int64_t *turn)
{
    sqlite3_stmt *row = sql_prepare(stage->database, "SELECT client, priority FROM job ORDER BY number LIMIT 1", "");
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const store_status status = code == SQLITE_ROW ? store_last_turn(stage->store, (const char *)sqlite3_column_text(row, 0),
                                                                     sqlite3_column_int64(row, 1), turn)
                                                   : STORE_FAILED;
    sqlite3_finalize(row);
    return status;
}

/* The rows are copied without triggers, since with them SQLite keeps, for each row by itself, all the pages that it changes, to be
 * able to undo it alone. What the triggers of an INSERT count (schema.c) is then counted once. */
static store_status copy_uncounted(study_stage *stage, copied_rows *rows)
{
    sqlite3 *writer = stage->store->writer;
    if (sqlite3_db_config(writer, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL) != SQLITE_OK) return STORE_FAILED;
    store_status status = visit_tables(stage, copy_table, rows);
    sqlite3_db_config(writer, SQLITE_DBCONFIG_ENABLE_TRIGGER, 1, NULL);
    const int64_t jobs = (int64_t)stage->study->cases * stage->study->repeats;
    if (status == STORE_OK) status = sql_run(writer, NULL, "UPDATE job_count SET jobs=jobs+? WHERE status='accepted'", "i", jobs);
    if (status == STORE_OK)
        status = sql_run(writer, NULL, "UPDATE study SET accepted=accepted+? WHERE number=?", "ii", jobs, rows->study);
    return status;
}

store_status study_stage_copy(study_stage *stage, int64_t study)
{
    copied_rows rows = { .study = study };
    time_text(rows.now);
    sqlite3_stmt *row =
        sql_prepare(stage->store->writer, "SELECT max(number,coalesce((SELECT max(number) FROM job),0)) FROM last_deleted", "");
    rows.last_job = row && sqlite3_step(row) == SQLITE_ROW ? sqlite3_column_int64(row, 0) : -1;
    sqlite3_finalize(row);
    if (rows.last_job < 0 || read_last_turn(stage, &rows.last_turn) != STORE_OK) return STORE_FAILED;
    return copy_uncounted(stage, &rows);
}
