#include "field_views.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "database.h"
#include "process_type.h"

bool field_view_make(sqlite3 *writer, const char *name, text_buffer *sql)
{
    char drop[80];
    snprintf(drop, sizeof drop, "DROP VIEW IF EXISTS %s", name);
    sqlite3_stmt *row = sql->failed
                            ? NULL
                            : sql_prepare(writer, "SELECT count(*) FROM sqlite_schema WHERE type='view' AND name=? AND sql=?", "tt",
                                          name, sql->text);
    bool good = row && sqlite3_step(row) == SQLITE_ROW;
    const bool is_there = good && sqlite3_column_int(row, 0) == 1;
    sqlite3_finalize(row);
    if (good && !is_there)
        good = sqlite3_exec(writer, drop, NULL, NULL, NULL) == SQLITE_OK
               && sqlite3_exec(writer, sql->text, NULL, NULL, NULL) == SQLITE_OK;
    text_buffer_clear(sql);
    return good;
}

/* "center-of-mass" as "center_of_mass". */
static void write_name(char *name, size_t size, const char *definition)
{
    snprintf(name, size, "%s", definition);
    for (char *c = name; *c; c++)
        if (*c == '-') *c = '_';
}

void field_views_add_angles(text_buffer *sql)
{
    for (size_t p = 0; process_types[p]; p++) {
        const char *const *angles = process_types[p]->results->other_angles;
        for (size_t a = 0; angles && angles[a]; a++) {
            char name[60];
            write_name(name, sizeof name, angles[a]);
            text_buffer_print(sql,
                              ", result.document->>'$.repose.other_methods.\"%s\"' AS %s_deg"
                              ", result.document->>'$.repose.other_methods_standard_error_deg.\"%s\"' AS %s_standard_error_deg",
                              angles[a], name, angles[a], name);
        }
    }
}

/* --- inputs --- */

/* A member of an entry of a list is told of with the list. */
static bool is_in_list(const spec_table *table, const spec_field *field)
{
    for (spec_group group = field->group; group != SPEC_INPUTS;) {
        const spec_field *owner = NULL;
        for (size_t f = 0; f < table->count && !owner; f++)
            if (table->field[f].kind >= FIELD_CHOICE_OR_OBJECT && table->field[f].child == group) owner = &table->field[f];
        if (!owner || (owner->kind != FIELD_OBJECT && owner->kind != FIELD_OBJECT_OR_NULL)) return true;
        group = owner->group;
    }
    return false;
}

static void write_default(text_buffer *sql, const spec_field *field)
{
    const bool is_number = field->kind == FIELD_REAL || field->kind == FIELD_INTEGER;
    if (field->kind == FIELD_CHOICE && !field->required) text_buffer_print(sql, "'%s'", field->choices[0]);
    else if (is_number && !field->required && !isnan(field->fallback)) text_buffer_print(sql, "%.17g", field->fallback);
    else text_buffer_print(sql, "NULL");
}

static void write_path(text_buffer *sql, const char *name)
{
    text_buffer_print(sql, "'$.inputs");
    for (const char *step = name; *step;) {
        const size_t length = strcspn(step, "/");
        text_buffer_print(sql, ".%.*s", (int)length, step);
        step += length + (step[length] == '/');
    }
    text_buffer_print(sql, "'");
}

void field_views_write_input_field(text_buffer *sql)
{
    const char *comma = "";
    text_buffer_print(sql, "CREATE VIEW input_field(process, name, path, default_value, unit) AS VALUES");
    for (size_t p = 0; process_types[p]; p++) {
        const spec_table *table = process_types[p]->inputs;
        for (size_t f = 0; f < table->count; f++) {
            const spec_field *field = &table->field[f];
            char name[200];
            if (field->kind == FIELD_OBJECT || field->kind == FIELD_OBJECT_OR_NULL || is_in_list(table, field)) continue;
            spec_field_path(table, field, name, sizeof name);
            text_buffer_print(sql, "%s\n('%s','%s',", comma, process_types[p]->name, name);
            write_path(sql, name);
            text_buffer_print(sql, ",");
            write_default(sql, field);
            text_buffer_print(sql, ",'%s')", field->unit ? field->unit : "");
            comma = ",";
        }
    }
}

void field_views_write_job_input(text_buffer *sql)
{
    text_buffer_print(sql, "CREATE VIEW job_input AS SELECT job.id, job.number AS job, job.process, input_field.name,"
                           " json_extract(job.spec, input_field.path) AS value, input_field.default_value, input_field.unit,"
                           " iif(job.given IS NULL, NULL, instr(job.given, '\"'||input_field.name||'\"')>0) AS is_given"
                           " FROM job JOIN input_field ON input_field.process=job.process");
}

void field_views_write_stage(text_buffer *sql)
{
    text_buffer_print(sql, "CREATE VIEW stage AS SELECT job.id, job.number AS job, each.key AS number");
    for (size_t p = 0; process_types[p]; p++) {
        const result_table *entries = process_types[p]->results->entries;
        for (size_t f = 0; entries && f < entries->count; f++) {
            const result_field *field = &entries->field[f];
            text_buffer_print(sql, ", each.value->>'$.%s' AS %s", field->name, field->view_name ? field->view_name : field->name);
        }
    }
    text_buffer_print(sql, " FROM result JOIN job ON job.number=result.job JOIN json_each(result.document, '$.stages') AS each");
}
