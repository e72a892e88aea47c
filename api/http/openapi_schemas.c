#include "openapi_schemas.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "field_columns.h"
#include "yaml_text.h"

/* The last line by hand. */
static const char marker[] =
    "    # From here on `reposed openapi FILE` writes what follows from the tables of inputs and results.\n";
enum { INDENT = 4, LONGEST_DOCUMENT = 4 << 20 };

/* "DrumInputs" */
static void write_name(char *name, size_t size, const process_type *process, const char *what)
{
    snprintf(name, size, "%s%s", process->name, what);
    name[0] = (char)toupper((unsigned char)name[0]);
}

static json_t *process_ids(void)
{
    json_t *names = json_array();
    for (size_t p = 0; process_types[p]; p++) json_array_append_new(names, json_string(process_types[p]->name));
    return json_pack("{s:s, s:o}", "type", "string", "enum", names);
}

static json_t *results_of_any(void)
{
    json_t *list = json_array();
    for (size_t p = 0; process_types[p]; p++) {
        char name[60];
        write_name(name, sizeof name, process_types[p], "Results");
        json_array_append_new(list, json_pack("{s:o}", "$ref", json_sprintf("#/components/schemas/%s", name)));
    }
    return json_pack("{s:s, s:o}", "description", "An object keyed by output. null: it could not be measured", "oneOf", list);
}

/* All members are always there, and no others. */
static void close_objects(json_t *schema)
{
    const char *name;
    json_t *member, *properties = json_object_get(schema, "properties"), *items = json_object_get(schema, "items");
    if (items && !json_object_get(items, "required")) close_objects(items); /* an output that is a list */
    if (!properties) return;
    json_t *required = json_array();
    json_object_foreach(properties, name, member)
    {
        json_array_append_new(required, json_string(name));
        close_objects(member);
    }
    json_object_set_new(schema, "required", required);
    json_object_set_new(schema, "additionalProperties", json_false());
}

static json_t *results_schema(const process_type *process)
{
    const char *name;
    json_t *given, *properties = json_object(), *outputs = result_outputs_description(process->results);
    json_object_foreach(outputs, name, given)
    {
        json_t *schema = json_object_get(given, "schema");
        json_object_set(schema, "description", json_object_get(given, "description"));
        json_object_set(properties, name, schema);
    }
    json_decref(outputs);
    json_t *schema = json_pack("{s:s, s:o}", "type", "object", "properties", properties);
    close_objects(schema);
    return schema;
}

/* "unit of mass rate": "UnitOfMassRate" */
static void write_unit_name(char *name, size_t size, const char *title)
{
    size_t length = 0;
    bool begins = true;
    for (; *title && length + 1 < size; title++) {
        if (*title != ' ') name[length++] = begins ? (char)toupper((unsigned char)*title) : *title;
        begins = *title == ' ';
    }
    name[length] = '\0';
}

/* The units of a dimension stand once in the document, however many inputs are of it; their order tells nothing. */
static void share_units(json_t *schema, json_t *schemas)
{
    const char *key, *title;
    json_t *member;
    size_t i;
    void *next;
    json_object_foreach_safe(schema, next, key, member)
    {
        title = strcmp(key, "unit") == 0 ? json_string_value(json_object_get(member, "title")) : NULL;
        if (title && strncmp(title, "unit of ", 8) == 0) {
            char name[60];
            write_unit_name(name, sizeof name, title);
            if (!json_object_get(schemas, name)) json_object_set(schemas, name, member);
            json_object_set_new(schema, key, json_pack("{s:o}", "$ref", json_sprintf("#/components/schemas/%s", name)));
        } else {
            share_units(member, schemas);
        }
    }
    json_array_foreach(schema, i, member) share_units(member, schemas);
}

static json_t *inputs_schema(const process_type *process)
{
    json_t *schema = process_inputs_schema(process);
    json_object_set_new(schema, "description",
                        json_sprintf("The inputs of a %s. What has no default here is required, or its description says how it"
                                     " is chosen.",
                                     process->name));
    return schema;
}

/* --- a job's summary --- */

static json_t *summary_member(const field_column *column)
{
    const bool is_input = column->input != NULL;
    const char *meaning = is_input ? column->input->meaning : column->result->meaning;
    const char *unit = is_input ? column->input->unit : column->result->unit;
    const char *type = strcmp(column->type, "REAL") == 0 ? "number" : strcmp(column->type, "TEXT") == 0 ? "string" : "integer";
    json_t *schema = json_pack("{s:s}", "type", field_column_is_truth(column) ? "boolean" : type);
    if (unit && *unit) json_object_set_new(schema, "x-unit", json_string(unit));
    json_object_set_new(schema, "description",
                        !is_input && column->result->kind == RESULT_WARNINGS ? json_string("how many the results have")
                                                                             : json_string(meaning));
    return schema;
}

/* What each job of the process has: the inputs that can't be missing. */
static json_t *summary_of_process(const process_type *process, const field_column *const *list, size_t count)
{
    json_t *required = json_array();
    for (size_t i = 0; i < count; i++)
        if (list[i]->input && list[i]->process == process && !list[i]->input->column_may_miss)
            json_array_append_new(required, json_string(list[i]->shown_as));
    return json_pack("{s:o, s:o}", "description", json_sprintf("of a %s", process->name), "required", required);
}

static json_t *summary_schema(const field_column *const *list, size_t count)
{
    json_t *properties = json_pack("{s:{s:s}, s:{s:s, s:s, s:s}}", "threads", "type", "integer", "estimated_seconds", "type",
                                   "number", "x-unit", "s", "description", "of wall clock, when it was submitted"),
           *one_of = json_array();
    for (size_t i = 0; i < count; i++)
        if (!json_object_get(properties, list[i]->shown_as))
            json_object_set_new(properties, list[i]->shown_as, summary_member(list[i]));
    for (size_t p = 0; process_types[p]; p++) json_array_append_new(one_of, summary_of_process(process_types[p], list, count));
    return json_pack("{s:s, s:s, s:[s, s], s:o, s:o, s:b}", "description", "Main inputs, and the main results once there are any",
                     "type", "object", "required", "threads", "estimated_seconds", "oneOf", one_of, "properties", properties,
                     "additionalProperties", 0);
}

static json_t *summary(void)
{
    field_columns columns;
    if (!field_columns_gather(&columns)) return NULL;
    const field_column **list = calloc(columns.count, sizeof *list);
    json_t *schema = list ? summary_schema(list, field_columns_select(&columns, COLUMNS_LISTED, list)) : NULL;
    free(list);
    field_columns_clear(&columns);
    return schema;
}

/* --- the document --- */

json_t *openapi_schemas(void)
{
    json_t *schemas = json_object();
    int failed = !schemas || json_object_set_new(schemas, "ProcessId", process_ids())
                 || json_object_set_new(schemas, "Summary", summary()) || json_object_set_new(schemas, "Results", results_of_any());
    for (size_t p = 0; !failed && process_types[p]; p++) {
        char name[60];
        write_name(name, sizeof name, process_types[p], "Inputs");
        json_t *inputs = inputs_schema(process_types[p]);
        share_units(inputs, schemas);
        failed = json_object_set_new(schemas, name, inputs);
        write_name(name, sizeof name, process_types[p], "Results");
        failed = failed || json_object_set_new(schemas, name, results_schema(process_types[p]));
    }
    if (!failed) return schemas;
    json_decref(schemas);
    return NULL;
}

bool openapi_write(const char *document, size_t length, text_buffer *out)
{
    const char *line = memmem(document, length, marker, sizeof marker - 1);
    json_t *schemas = line ? openapi_schemas() : NULL;
    if (!schemas) return false;
    text_buffer_add(out, document, (size_t)(line - document) + sizeof marker - 1);
    const bool good = yaml_write_members(out, schemas, INDENT);
    json_decref(schemas);
    return good;
}

bool openapi_read(int file, text_buffer *document)
{
    char piece[16384];
    ssize_t got;
    text_buffer_init(document, LONGEST_DOCUMENT);
    while ((got = read(file, piece, sizeof piece)) > 0) text_buffer_add(document, piece, (size_t)got);
    if (got == 0 && document->failed) errno = EFBIG;
    return got == 0 && !document->failed;
}

static bool write_file(const char *path, const text_buffer *document)
{
    char temporary[4096];
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    FILE *file = fopen(temporary, "we");
    bool good = file && fwrite(document->text, 1, document->length, file) == document->length;
    if (file) good = fclose(file) == 0 && good;
    if (good && rename(temporary, path) == 0) return true;
    const int reason = errno;
    unlink(temporary);
    errno = reason;
    return false;
}

bool openapi_file_update(const char *path)
{
    text_buffer before, after;
    text_buffer_init(&after, LONGEST_DOCUMENT);
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    bool good = file >= 0 && openapi_read(file, &before);
    if (file >= 0) close(file);
    if (!good) {
        fprintf(stderr, "reposed: %s can't be read: %s\n", path, strerror(errno));
        return false;
    }
    good = openapi_write(before.text ? before.text : "", before.length, &after);
    if (!good)
        fprintf(stderr, "reposed: %s is no document of this service: the line \"%.*s\" is missing\n", path, (int)sizeof marker - 2,
                marker);
    else if (!(good = write_file(path, &after))) fprintf(stderr, "reposed: %s can't be written: %s\n", path, strerror(errno));
    text_buffer_clear(&before);
    text_buffer_clear(&after);
    return good;
}
