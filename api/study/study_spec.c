#include "study_spec.h"

#include <stdio.h>
#include <string.h>

#include "json_pointer.h"
#include "merge_patch.h"
#include "process_type.h"
#include "spec_text.h"
#include "unit_table.h"

enum { LONGEST_DESCRIPTION = 2000, MOST_COLUMNS = 200 };
#define INPUTS "/inputs"

/* --- reading --- */

static void refuse_value(problem_list *problems, const char *pointer, const json_t *value, const char *must)
{
    char seen[80];
    json_value_text(value, seen, sizeof seen);
    problem_list_add(problems, pointer, "is %s; must be %s", seen, must);
}

/* A text of 1 to `size` - 1 bytes. */
static bool read_text(const json_t *value, const char *pointer, size_t size, problem_list *problems)
{
    if (!json_is_string(value)) {
        refuse_value(problems, pointer, value, "a text");
        return false;
    }
    const size_t length = json_string_length(value);
    if (length > 0 && length < size) return true;
    problem_list_add(problems, pointer, "has %zu bytes; must have 1 to %zu", length, size - 1);
    return false;
}

static void read_head(study_spec *study, problem_list *problems)
{
    static const char *const known[] = { "name", "description", "base", "cases", "vary", "repeats", "priority", NULL };
    refuse_unknown_members(study->document, "", known, problems);
    const json_t *process = json_object_get(json_object_get(study->document, "base"), "process");
    snprintf(study->process, sizeof study->process, "%s", json_is_string(process) ? json_string_value(process) : "drum");
    snprintf(study->name, sizeof study->name, "%s study", study->process);
    const json_t *name = json_object_get(study->document, "name");
    if (name && read_text(name, "/name", STUDY_NAME_SIZE, problems))
        snprintf(study->name, sizeof study->name, "%s", json_string_value(name));
    study->priority = read_priority(json_object_get(study->document, "priority"), problems);
    const json_t *description = json_object_get(study->document, "description");
    if (description) read_text(description, "/description", LONGEST_DESCRIPTION + 1, problems);
}

static void read_repeats(study_spec *study, problem_list *problems)
{
    study->repeats = 1;
    const json_t *repeats = json_object_get(study->document, "repeats");
    if (!repeats) return;
    char must[60];
    snprintf(must, sizeof must, "a whole number in [1, %d]", STUDY_MOST_REPEATS);
    if (!json_is_integer(repeats) || json_integer_value(repeats) < 1 || json_integer_value(repeats) > STUDY_MOST_REPEATS)
        refuse_value(problems, "/repeats", repeats, must);
    else if (json_integer_value(repeats) > 1 && process_type_find(study->process) && !study->has_seed)
        problem_list_add(problems, "/repeats",
                         "is %lld; must be 1, because the process \"%s\" has no seed and gives the same each time",
                         (long long)json_integer_value(repeats), study->process);
    else if (json_integer_value(repeats) > 1
             && json_is_object(json_object_get(json_object_get(json_object_get(study->document, "base"), "inputs"), "start")))
        problem_list_add(problems, "/repeats",
                         "is %lld; must be 1, because runs that start from the same bed are the same whatever their seed",
                         (long long)json_integer_value(repeats));
    else study->repeats = (int)json_integer_value(repeats);
}

/* The process and what it takes; then what the daemon adds to the base: a seed and the number of threads. */
static void read_base(study_spec *study, const study_options *options, problem_list *problems)
{
    json_t *base = json_object_get(study->document, "base");
    json_t *inputs = json_object_get(base, "inputs");
    const process_type *type = process_type_find(study->process);
    study->has_seed = type && spec_field_find(type->inputs, SPEC_INPUTS, "seed");
    if (!base) problem_list_add(problems, "/base", "is missing; must be an object with \"inputs\" and, if wanted, \"label\"");
    else if (!json_is_object(base)) refuse_value(problems, "/base", base, "an object with \"inputs\" and, if wanted, \"label\"");
    else if (!inputs) problem_list_add(problems, "/base/inputs", "is missing; must be an object");
    else if (!json_is_object(inputs)) refuse_value(problems, "/base/inputs", inputs, "an object");
    if (json_is_object(json_object_get(base, "subscriber")))
        refuse_value(problems, "/base/subscriber", json_object_get(base, "subscriber"),
                     "null: of the jobs of a study nobody is called back");
    if (json_is_object(inputs) && study->has_seed && !json_object_get(inputs, "seed"))
        json_object_set_new(inputs, "seed", json_integer((json_int_t)(options->seed_if_missing & LARGEST_WHOLE_NUMBER)));
    if (json_is_object(inputs) && type && spec_field_find(type->inputs, SPEC_INPUTS, "threads")
        && !json_object_get(inputs, "threads"))
        json_object_set_new(inputs, "threads", json_integer(options->default_threads));
}

/* --- the columns: what differs between cases --- */

static void add_column(study_spec *study, const char *column)
{
    size_t i;
    json_t *known;
    json_array_foreach(study->columns, i, known)
    {
        if (strcmp(json_string_value(known), column) == 0) return;
    }
    if (json_array_size(study->columns) < MOST_COLUMNS) json_array_append_new(study->columns, json_string(column));
}

/* Every leaf below value; pointer: of value, without "/inputs". */
static void add_leaves(study_spec *study, const json_t *value, char pointer[JSON_POINTER_SIZE])
{
    const size_t length = strlen(pointer);
    char number[24];
    const char *name;
    json_t *member;
    size_t i;
    if (json_is_object(value) && !is_quantity(value)) {
        json_object_foreach((json_t *)value, name, member)
        {
            if (json_pointer_append(pointer, name)) add_leaves(study, member, pointer);
            pointer[length] = '\0';
        }
    } else if (json_is_array(value)) {
        json_array_foreach(value, i, member)
        {
            snprintf(number, sizeof number, "%zu", i);
            if (json_pointer_append(pointer, number)) add_leaves(study, member, pointer);
            pointer[length] = '\0';
        }
    } else if (length > 0) {
        add_column(study, pointer + 1);
    }
}

/* names: those of earlier cases, as members. */
static void read_case_name(const json_t *name, const char *pointer, json_t *names, problem_list *problems)
{
    if (!name) {
        problem_list_add(problems, pointer, "is missing; must be a text");
    } else if (read_text(name, pointer, STUDY_NAME_SIZE, problems)) {
        if (json_object_get(names, json_string_value(name)))
            problem_list_add(problems, pointer, "is the name of an earlier case, too; each must have its own");
        json_object_set_new(names, json_string_value(name), json_true());
    }
}

static void read_case(study_spec *study, const json_t *cases, size_t index, json_t *names, problem_list *problems)
{
    static const char *const known[] = { "name", "inputs", "label", "resources", NULL };
    const json_t *one = json_array_get(cases, index);
    char pointer[64], name_pointer[80], leaf[JSON_POINTER_SIZE] = "";
    snprintf(pointer, sizeof pointer, "/cases/%zu", index);
    snprintf(name_pointer, sizeof name_pointer, "%s/name", pointer);
    if (!json_is_object(one)) {
        refuse_value(problems, pointer, one, "an object with \"name\" and \"inputs\"");
        return;
    }
    refuse_unknown_members(one, pointer, known, problems);
    read_case_name(json_object_get(one, "name"), name_pointer, names, problems);
    add_leaves(study, json_object_get(one, "inputs"), leaf);
}

static void read_cases(study_spec *study, const json_t *cases, int64_t most, problem_list *problems)
{
    const size_t count = json_array_size(cases);
    if (count == 0) refuse_value(problems, "/cases", cases, "a list of at least one case");
    json_t *names = json_object();
    for (size_t i = 0; i < count && (int64_t)i < most; i++) read_case(study, cases, i, names, problems);
    json_decref(names);
}

static void read_varied(study_spec *study, const char *pointer, const json_t *values, problem_list *problems)
{
    char place[JSON_POINTER_SIZE] = "/vary";
    const bool fits = json_pointer_append(place, pointer);
    const size_t start = strlen(INPUTS "/");
    if (!fits || !json_pointer_is_valid(pointer) || strncmp(pointer, INPUTS "/", start) != 0 || !pointer[start]) {
        problem_list_add(problems, fits ? place : "/vary", "names no input; must be a JSON Pointer as /inputs/contact/friction");
        return;
    }
    json_array_append_new(study->columns, json_string(pointer + start));
    if (!json_is_array(values) || json_array_size(values) == 0) {
        refuse_value(problems, place, values, "a list of at least one value");
        return;
    }
    json_t *trial = json_copy(json_object_get(study->document, "base"));
    if (json_is_object(json_object_get(trial, "inputs")) && !json_pointer_set(trial, pointer, json_array_get(values, 0)))
        problem_list_add(problems, place, "names no input: it leads through something in the base that has no such member");
    json_decref(trial);
}

/* How many combinations; 0: not all lists can be used. The product may pass any integer before it is refused: a double
 * says so without wrapping. */
static double read_vary(study_spec *study, const json_t *vary, problem_list *problems)
{
    const size_t before = json_array_size(problems->errors);
    double combinations = 1.0;
    const char *pointer;
    json_t *values;
    if (!json_is_object(vary) || json_object_size(vary) == 0 || json_object_size(vary) > STUDY_MOST_VARIED) {
        problem_list_add(problems, "/vary", "must be an object of 1 to %d lists of values, each named by a JSON Pointer",
                         STUDY_MOST_VARIED);
        return 0.0;
    }
    json_object_foreach((json_t *)vary, pointer, values)
    {
        read_varied(study, pointer, values, problems);
        combinations *= (double)json_array_size(values);
    }
    return json_array_size(problems->errors) == before ? combinations : 0.0;
}

static void read_all(study_spec *study, const study_options *options, problem_list *problems)
{
    read_head(study, problems);
    read_base(study, options, problems);
    read_repeats(study, problems);
    const json_t *cases = json_object_get(study->document, "cases"), *vary = json_object_get(study->document, "vary");
    const bool has_inputs = json_is_object(json_object_get(json_object_get(study->document, "base"), "inputs"));
    double count = 1.0;
    if (cases && vary) {
        problem_list_add(problems, "/vary", "is given beside cases; give one of the two");
        count = 0.0;
    } else if (cases) {
        read_cases(study, cases, options->most_jobs, problems);
        count = (double)json_array_size(cases);
    } else if (vary) {
        count = read_vary(study, vary, problems);
    }
    if (count * study->repeats > (double)options->most_jobs)
        problem_list_add(problems, "", "makes %.0f jobs, %.0f cases of %d; at most %lld may wait", count * study->repeats, count,
                         study->repeats, (long long)options->most_jobs);
    else if (has_inputs) study->cases = (size_t)count;
}

bool study_spec_parse(const json_t *document, const study_options *options, study_spec *study, problem_list *problems)
{
    *study = (study_spec){ .repeats = 1, .beds = options->beds };
    if (!json_is_object(document)) {
        problem_list_add(problems, "",
                         "must be an object with \"base\" and, if wanted, \"name\", \"cases\" or \"vary\", and \"repeats\"");
        return false;
    }
    study->document = json_deep_copy(document);
    study->columns = json_array();
    if (study->document && study->columns) read_all(study, options, problems);
    else problem_list_add(problems, "", "could not be read: out of memory");
    return problem_list_is_empty(problems);
}

void study_spec_clear(study_spec *study)
{
    json_decref(study->document);
    json_decref(study->columns);
    *study = (study_spec){ .repeats = 0 };
}

/* --- one case, one job --- */

static const json_t *values_of(const study_spec *study, size_t column)
{
    char pointer[JSON_POINTER_SIZE + 8];
    snprintf(pointer, sizeof pointer, INPUTS "/%s", json_string_value(json_array_get(study->columns, column)));
    return json_object_get(json_object_get(study->document, "vary"), pointer);
}

size_t study_value_index(const study_spec *study, size_t index, size_t column)
{
    for (size_t later = json_array_size(study->columns) - 1; later > column; later--)
        index /= json_array_size(values_of(study, later));
    return index % json_array_size(values_of(study, column));
}

static bool set_varied(const study_spec *study, size_t index, json_t *request)
{
    for (size_t c = 0; c < json_array_size(study->columns); c++) {
        char pointer[JSON_POINTER_SIZE + 8];
        snprintf(pointer, sizeof pointer, INPUTS "/%s", json_string_value(json_array_get(study->columns, c)));
        if (!json_pointer_set(request, pointer, json_array_get(values_of(study, c), study_value_index(study, index, c))))
            return false;
    }
    return true;
}

/* The base with the case's differences, before label and seed. */
static json_t *case_request(const study_spec *study, size_t index)
{
    const json_t *base = json_object_get(study->document, "base");
    const json_t *cases = json_object_get(study->document, "cases");
    json_t *patch = cases ? json_copy(json_array_get(cases, index)) : json_object();
    json_object_del(patch, "name");
    json_t *request = patch ? json_merge_patch(base, patch) : NULL;
    json_decref(patch);
    if (!request || !json_object_get(study->document, "vary") || set_varied(study, index, request)) return request;
    json_decref(request);
    return NULL;
}

/* The member is shared with the base: a copy of its own can be changed. NULL: it is no object. */
static json_t *own_member(json_t *request, const char *name)
{
    json_t *member = json_object_get(request, name);
    if (!json_is_object(member)) return NULL;
    return json_object_set_new(request, name, json_copy(member)) == 0 ? json_object_get(request, name) : NULL;
}

/* Unless the user's own label says them. */
static void name_in_label(const study_spec *study, size_t index, json_t *request)
{
    if (!json_object_get(request, "label")) json_object_set_new(request, "label", json_object());
    json_t *label = own_member(request, "label");
    char name[STUDY_NAME_SIZE];
    study_case_name(study, index, name);
    if (!json_object_get(label, "study")) json_object_set_new(label, "study", json_string(study->name));
    if (!json_object_get(label, "case")) json_object_set_new(label, "case", json_string(name));
}

/* A seed that is written as an object is counted up as any other. */
static void plain_seed(json_t *inputs)
{
    static const spec_field counted = { .kind = FIELD_INTEGER, .unit = "" };
    json_t *seed = json_object_get(inputs, "seed"), *number = quantity_to_json(&counted, seed);
    if (!number && json_object_size(seed) == 1) number = json_incref(json_object_get(seed, "value"));
    if (number) json_object_set_new(inputs, "seed", number);
}

json_t *study_job_request(const study_spec *study, size_t index, int repeat)
{
    json_t *request = case_request(study, index);
    if (!request) return NULL;
    name_in_label(study, index, request);
    json_object_set_new(request, "priority", json_integer(study->priority));
    json_t *inputs = own_member(request, "inputs");
    plain_seed(inputs);
    const json_t *seed = json_object_get(inputs, "seed");
    /* A seed beyond its range stays as it is, to be refused. */
    if (repeat > 0 && json_is_integer(seed) && json_integer_value(seed) <= (json_int_t)LARGEST_WHOLE_NUMBER)
        json_object_set_new(inputs, "seed", json_integer(json_integer_value(seed) + repeat));
    return request;
}

/* "friction 0.1, rotation_rate 3.14": the last step of a pointer, or all of it where two end alike. */
static const char *short_name(const study_spec *study, size_t column)
{
    const char *whole = json_string_value(json_array_get(study->columns, column));
    const char *last = strrchr(whole, '/') ? strrchr(whole, '/') + 1 : whole;
    for (size_t c = 0; c < json_array_size(study->columns); c++) {
        const char *other = json_string_value(json_array_get(study->columns, c));
        const char *other_last = strrchr(other, '/') ? strrchr(other, '/') + 1 : other;
        if (c != column && strcmp(last, other_last) == 0) return whole;
    }
    return last;
}

void study_case_name(const study_spec *study, size_t index, char name[STUDY_NAME_SIZE])
{
    const json_t *cases = json_object_get(study->document, "cases");
    const bool varied = json_object_get(study->document, "vary") != NULL;
    const char *given = json_string_value(json_object_get(json_array_get(cases, index), "name"));
    snprintf(name, STUDY_NAME_SIZE, "%s", given ? given : cases || varied ? "" : "base");
    for (size_t c = 0; varied && c < json_array_size(study->columns); c++) {
        char value[60];
        json_value_text(json_array_get(values_of(study, c), study_value_index(study, index, c)), value, sizeof value);
        const size_t length = strlen(name);
        snprintf(name + length, STUDY_NAME_SIZE - length, "%s%s %s", c ? ", " : "", short_name(study, c), value);
    }
}

json_t *study_case_inputs(const study_spec *study, size_t index)
{
    json_t *request = case_request(study, index), *inputs = json_object();
    const process_type *type = process_type_find(study->process);
    for (size_t c = 0; request && c < json_array_size(study->columns); c++) {
        const char *column = json_string_value(json_array_get(study->columns, c));
        char pointer[JSON_POINTER_SIZE + 8];
        snprintf(pointer, sizeof pointer, INPUTS "/%s", column);
        json_t *value = json_pointer_find(request, pointer);
        const spec_field *field = type && is_quantity(value) ? spec_field_at(type->inputs, column) : NULL;
        json_t *number = field && field->kind <= FIELD_INTEGER ? quantity_to_json(field, value) : NULL;
        json_object_set_new(inputs, column, number ? number : value ? json_incref(value) : json_null());
    }
    json_decref(request);
    return inputs;
}
