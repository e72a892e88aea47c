#include "csv_table.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "process_type.h"

enum { MOST_COLUMNS = 16, LONGEST_CELL = 64 };

/* What a column becomes: a member of each entry, or one of the three numbers of it. */
typedef struct csv_column {
    const char *name, *member; /* NULL: the end */
    int index;                 /* of three; -1: the member itself */
    bool is_required;
} csv_column;

static const csv_column particle_columns[] = {
    { "x", "position", 0, true },           { "y", "position", 1, true },           { "z", "position", 2, true },
    { "diameter", "diameter", -1, false },  { "species", "species", -1, false },    { "vx", "velocity", 0, false },
    { "vy", "velocity", 1, false },         { "vz", "velocity", 2, false },         { "wx", "angular_velocity", 0, false },
    { "wy", "angular_velocity", 1, false }, { "wz", "angular_velocity", 2, false }, { NULL, NULL, 0, false },
};
static const csv_column sieve_columns[] = { { "size", "sizes", -1, true },
                                            { "cumulative", "cumulative", -1, false },
                                            { "share", "shares", -1, false },
                                            { NULL, NULL, 0, false } };

/* A text that is read line by line. */
typedef struct csv_reader {
    const char *at, *end;
    size_t line; /* number of the last one read, from 1 */
    const csv_column *columns;
    spec_group group; /* whose fields say what is allowed */
    size_t count;
    const csv_column *column[MOST_COLUMNS]; /* (count) of the file */
    problem_list *problems;
} csv_reader;

/* The next line that says something, without its end; false: there is none. */
static bool next_line(csv_reader *reader, const char **line, size_t *length)
{
    while (reader->at < reader->end) {
        const char *begin = reader->at, *stop = memchr(begin, '\n', (size_t)(reader->end - begin));
        if (!stop) stop = reader->end;
        reader->at = stop < reader->end ? stop + 1 : stop;
        reader->line++;
        while (stop > begin && strchr(" \t\r", stop[-1])) stop--;
        if (stop == begin || *begin == '#') continue;
        *line = begin;
        *length = (size_t)(stop - begin);
        return true;
    }
    return false;
}

/* The next cell of a line, without spaces about it; false: there is none. A cell that is too long is cut, which no number is. */
static bool next_cell(const char **at, const char *end, char cell[LONGEST_CELL])
{
    if (!*at) return false;
    const char *comma = memchr(*at, ',', (size_t)(end - *at)), *stop = comma ? comma : end, *begin = *at;
    while (begin < stop && strchr(" \t\"", *begin)) begin++;
    while (stop > begin && strchr(" \t\"", stop[-1])) stop--;
    const size_t length = (size_t)(stop - begin) < LONGEST_CELL - 1 ? (size_t)(stop - begin) : LONGEST_CELL - 1;
    memcpy(cell, begin, length);
    cell[length] = '\0';
    *at = comma ? comma + 1 : NULL;
    return true;
}

static void add_problem(const csv_reader *reader, const char *column, const char *text)
{
    char pointer[120];
    snprintf(pointer, sizeof pointer, "/lines/%zu%s%.60s", reader->line, *column ? "/" : "", column);
    problem_list_add(reader->problems, pointer, "%s", text);
}

/* "x, y, z, ..." */
static void column_names(const csv_column *columns, char *text, size_t size)
{
    *text = '\0';
    for (; columns->name; columns++) snprintf(text + strlen(text), size - strlen(text), "%s%s", *text ? ", " : "", columns->name);
}

static void take_column(csv_reader *reader, const char *name)
{
    char known[160], text[320];
    const csv_column *found = reader->columns;
    while (found->name && strcmp(found->name, name) != 0) found++;
    bool is_twice = false;
    for (size_t k = 0; k < reader->count; k++) is_twice = is_twice || (found->name && reader->column[k] == found);
    column_names(reader->columns, known, sizeof known);
    if (!found->name) snprintf(text, sizeof text, "is no column; must be one of %s", known);
    else if (is_twice || reader->count == MOST_COLUMNS) snprintf(text, sizeof text, "is a column twice");
    else {
        reader->column[reader->count++] = found;
        return;
    }
    add_problem(reader, name, text);
}

/* The first line names the columns. False: it does not, or not all that must be. */
static bool read_header(csv_reader *reader)
{
    const char *line;
    size_t length;
    char cell[LONGEST_CELL];
    const size_t before = json_array_size(reader->problems->errors);
    if (!next_line(reader, &line, &length)) {
        problem_list_add(reader->problems, "", "is empty; must have a header row, and a row of numbers for each entry");
        return false;
    }
    for (const char *at = line; next_cell(&at, line + length, cell);) take_column(reader, cell);
    for (const csv_column *column = reader->columns; column->name; column++) {
        bool is_there = !column->is_required;
        for (size_t k = 0; k < reader->count; k++) is_there = is_there || reader->column[k] == column;
        if (!is_there) add_problem(reader, column->name, "is missing in the header row, which must name it");
    }
    return json_array_size(reader->problems->errors) == before;
}

/* The cell as a number that the field allows; false: a problem says why not. */
static bool read_cell(const csv_reader *reader, const csv_column *column, const char *cell, double *number)
{
    char *end, text[200];
    const spec_field *field = spec_field_find(process_type_find("drum")->inputs, reader->group, column->member);
    *number = strtod(cell, &end);
    const char *unit = field->unit ? field->unit : "";
    const bool is_number = *cell && !*end && isfinite(*number) && !strpbrk(cell, "xX");
    const bool is_whole = field->kind != FIELD_INTEGER || *number == floor(*number);
    if (is_number && is_whole && *number >= field->minimum && *number <= field->maximum) return true;
    snprintf(text, sizeof text, "is %s%.40s%s; must be a %snumber in [%g, %g]%s%s", is_number ? "" : "\"", cell,
             is_number ? "" : "\"", field->kind == FIELD_INTEGER ? "whole " : "", field->minimum, field->maximum, *unit ? " " : "",
             unit);
    add_problem(reader, column->name, text);
    return false;
}

/* The numbers of the next row, NaN where a cell is empty. False: there is no row. *good: they can all be used. */
static bool read_row(csv_reader *reader, double numbers[MOST_COLUMNS], bool *good)
{
    const char *line;
    size_t length, k = 0;
    char cell[LONGEST_CELL], text[100];
    *good = true;
    if (!next_line(reader, &line, &length)) return false;
    for (const char *at = line; next_cell(&at, line + length, cell); k++) {
        if (k >= reader->count) continue;
        numbers[k] = NAN;
        if (*cell || reader->column[k]->is_required) *good = read_cell(reader, reader->column[k], cell, &numbers[k]) && *good;
    }
    if (k == reader->count) return true;
    snprintf(text, sizeof text, "has %zu cells; must have %zu, as the header row", k, reader->count);
    add_problem(reader, "", text);
    *good = false;
    return true;
}

/* {"position": [x, y, z], ...} */
static json_t *particle_of(const csv_reader *reader, const double numbers[MOST_COLUMNS])
{
    json_t *particle = json_object();
    for (size_t k = 0; k < reader->count; k++) {
        const csv_column *column = reader->column[k];
        if (isnan(numbers[k])) continue;
        if (column->index < 0) {
            json_object_set_new(particle, column->member, json_real(numbers[k]));
            continue;
        }
        if (!json_object_get(particle, column->member))
            json_object_set_new(particle, column->member, json_pack("[f, f, f]", 0.0, 0.0, 0.0));
        json_array_set_new(json_object_get(particle, column->member), (size_t)column->index, json_real(numbers[k]));
    }
    return particle;
}

static csv_reader reader_of(const char *text, size_t length, const csv_column *columns, spec_group group, problem_list *problems)
{
    static const char mark[] = "\xef\xbb\xbf"; /* of UTF-8, which some programs begin a file with */
    const size_t skipped = length >= 3 && memcmp(text, mark, 3) == 0 ? 3 : 0;
    return (csv_reader){ .at = text + skipped, .end = text + length, .columns = columns, .group = group, .problems = problems };
}

/* What is left of a list once there were problems. */
static json_t *nothing(json_t *list)
{
    json_decref(list);
    return NULL;
}

json_t *csv_read_particles(const char *text, size_t length, problem_list *problems)
{
    csv_reader reader = reader_of(text, length, particle_columns, SPEC_PLACED, problems);
    const size_t before = json_array_size(problems->errors);
    double numbers[MOST_COLUMNS];
    bool good;
    json_t *list = json_array();
    if (!list || !read_header(&reader)) return nothing(list);
    while (!problem_list_is_full(problems) && json_array_size(list) <= CSV_MOST_PARTICLES && read_row(&reader, numbers, &good))
        if (good && json_array_append_new(list, particle_of(&reader, numbers)) != 0) break;
    if (json_array_size(problems->errors) == before && json_array_size(list) == 0)
        problem_list_add(problems, "", "has no particle; must have a row for each below the header row");
    if (json_array_size(list) > CSV_MOST_PARTICLES)
        problem_list_add(problems, "", "has more than %d particles; must have at most so many", CSV_MOST_PARTICLES);
    return json_array_size(problems->errors) == before ? list : nothing(list);
}

json_t *csv_read_sieves(const char *text, size_t length, problem_list *problems)
{
    csv_reader reader = reader_of(text, length, sieve_columns, SPEC_SIZES, problems);
    const size_t before = json_array_size(problems->errors);
    double numbers[MOST_COLUMNS];
    bool good;
    json_t *table = json_object();
    if (!table || !read_header(&reader)) return nothing(table);
    for (size_t k = 0; k < reader.count; k++) json_object_set_new(table, reader.column[k]->member, json_array());
    while (!problem_list_is_full(problems) && read_row(&reader, numbers, &good))
        for (size_t k = 0; good && k < reader.count; k++)
            if (!isnan(numbers[k])) json_array_append_new(json_object_get(table, reader.column[k]->member), json_real(numbers[k]));
    json_t *shares = json_object_get(table, "shares");
    const size_t count = json_array_size(shares);
    if (count == json_array_size(json_object_get(table, "sizes")) && count > 0
        && json_number_value(json_array_get(shares, count - 1)) == 0.0)
        json_array_remove(shares, count - 1);
    return json_array_size(problems->errors) == before ? table : nothing(table);
}

void csv_tell(const problem_list *of_file, const char *name, const char *pointer, problem_list *problems)
{
    size_t index;
    json_t *problem;
    json_array_foreach(of_file->errors, index, problem)
    {
        const char *at = json_string_value(json_object_get(problem, "pointer"));
        const char *detail = json_string_value(json_object_get(problem, "detail"));
        const char *line = strncmp(at, "/lines/", 7) == 0 ? at + 7 : "", *column = strchr(line, '/');
        problem_list_add(problems, pointer, "names \"%.100s\", which %s%.*s%s%s %s", name, *line ? "in line " : "",
                         (int)(column ? column - line : (ptrdiff_t)strlen(line)), line,
                         column  ? ", column "
                         : *line ? ","
                                 : "",
                         column ? column + 1 : "", detail);
    }
}
