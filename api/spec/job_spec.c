/* A request as a whole: process, inputs, label. */
#include "job_spec.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "execute_request.h"
#include "given_files.h"
#include "json_text.h"
#include "process_type.h"
#include "spec_memory.h"
#include "spec_text.h"

enum { MOST_LABELS = 16, LONGEST_LABEL_NAME = 64, LONGEST_LABEL = 200 };

/* The process that is asked for; NULL: there is no such one, or two were named. */
static const process_type *read_process(const char *process, const json_t *request, problem_list *problems)
{
    const json_t *member = json_object_get(request, "process");
    char seen[80], names[200];
    json_value_text(member, seen, sizeof seen);
    process_type_names(names, sizeof names);
    const char *name = process ? process : member ? json_string_value(member) : "drum";
    const process_type *type = name ? process_type_find(name) : NULL;
    if (member && !json_is_string(member)) {
        problem_list_add(problems, "/process", "is %s; must be the name of a process", seen);
    } else if (member && process && strcmp(json_string_value(member), process) != 0) {
        problem_list_add(problems, "/process", "is %s; was sent to the process \"%.40s\"", seen, process);
    } else if (!type && process) {
        problem_list_add(problems, "/process", "\"%.40s\" is not available; available: %s", process, names);
    } else if (!type) {
        problem_list_add(problems, "/process", "is %s; available: %s", seen, names);
    }
    return type;
}

static void check_label(const char *name, const json_t *value, problem_list *problems)
{
    char pointer[LONGEST_POINTER], seen[80];
    if (strlen(name) == 0 || strlen(name) > LONGEST_LABEL_NAME) {
        problem_list_add(problems, "/label", "has a name of %zu bytes; must be 1 to %d", strlen(name), LONGEST_LABEL_NAME);
        return;
    }
    pointer_to_member(pointer, "/label", name);
    json_value_text(value, seen, sizeof seen);
    if (json_is_string(value) && json_string_length(value) > LONGEST_LABEL)
        problem_list_add(problems, pointer, "is a text of %zu bytes; must have at most %d", json_string_length(value),
                         LONGEST_LABEL);
    else if (!json_is_string(value) && !json_is_number(value))
        problem_list_add(problems, pointer, "is %s; must be a number or a text of at most %d bytes", seen, LONGEST_LABEL);
}

static json_t *read_label(const json_t *label, problem_list *problems)
{
    if (!label) return json_object();
    if (!json_is_object(label)) {
        char seen[80];
        json_value_text(label, seen, sizeof seen);
        problem_list_add(problems, "/label", "is %s; must be an object of texts and numbers", seen);
        return NULL;
    }
    if (json_object_size(label) > MOST_LABELS)
        problem_list_add(problems, "/label", "has %zu members; must have at most %d", json_object_size(label), MOST_LABELS);
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)label, name, value) if (!problem_list_is_full(problems)) check_label(name, value, problems);
    return json_deep_copy(label);
}

static bool advances_a_scene(const job_spec *spec) { return spec->type->inputs_at == offsetof(job_spec, inputs); }

/* A long list of particles that was read before is not read again. */
static void read_inputs(job_spec *spec, spec_memory *memory, const json_t *inputs, problem_list *problems)
{
    const bool remembers = memory && advances_a_scene(spec);
    const size_t before = json_array_size(problems->errors);
    json_t *rest = remembers ? spec_memory_without_placed(memory, inputs) : NULL;
    spec_inputs_read(spec->type->inputs, rest ? rest : inputs, (char *)spec + spec->type->inputs_at, problems);
    if (rest && !spec_memory_place(memory, &spec->inputs.start))
        problem_list_add(problems, "/inputs/start/particles", "could not be read: out of memory");
    if (remembers && !rest && json_array_size(problems->errors) == before)
        spec_memory_keep_placed(memory, inputs, &spec->inputs.start);
    if (remembers) spec->inputs.memory = memory;
    json_decref(rest);
}

int read_priority(const json_t *priority, problem_list *problems)
{
    char seen[60];
    const json_int_t value = json_integer_value(priority);
    if (!priority || (json_is_integer(priority) && value >= -PRIORITY_MOST && value <= PRIORITY_MOST)) return (int)value;
    json_value_text(priority, seen, sizeof seen);
    problem_list_add(problems, "/priority", "is %s; must be a whole number in [%d, %d]", seen, -PRIORITY_MOST, PRIORITY_MOST);
    return 0;
}

bool job_spec_parse(const char *process, const json_t *request, uint64_t seed_if_missing, job_spec *spec, problem_list *problems)
{
    return job_spec_parse_with(NULL, process, request, seed_if_missing, spec, problems);
}

bool job_spec_parse_with(const start_source *beds, const char *process, const json_t *request, uint64_t seed_if_missing,
                         job_spec *spec, problem_list *problems)
{
    static const char *const known[] = { "process",    "inputs",   "label",     "response", "outputs",
                                         "subscriber", "priority", "resources", NULL };
    memset(spec, 0, sizeof *spec);
    if (!json_is_object(request)) {
        problem_list_add(problems, "", "must be an object with \"inputs\" and, if wanted, \"label\"");
        return false;
    }
    refuse_unknown_members(request, "", known, problems);
    spec->beds = beds;
    spec->type = read_process(process, request, problems);
    if (spec->type) spec->process = spec->type->name;

    execute_request_check(request, spec->type, problems);

    const json_t *inputs = json_object_get(request, "inputs");
    if (inputs && !json_is_object(inputs)) {
        problem_list_add(problems, "/inputs", "must be an object");
    } else if (!inputs) {
        problem_list_add(problems, "/inputs", "is missing; must be an object");
    } else if (spec->type) { /* without a process nobody knows what its inputs are */
        bool refers;
        json_t *values = given_files_take(execute_request_inputs(inputs, &refers, problems), beds, problems);
        if (!refers) {
            read_inputs(spec, beds ? beds->memory : NULL, values, problems);
            if (beds && advances_a_scene(spec)) spec->inputs.client = beds->client;
            spec->given = spec_inputs_given(spec->type->inputs, values);
            spec->type->apply_rules(spec, seed_if_missing, problems);
        }
        json_decref(values);
    }
    if (spec->type && advances_a_scene(spec)) {
        spec->inputs.memory = NULL;
        spec->inputs.client = NULL;
    }
    spec->beds = NULL;

    spec->priority = read_priority(json_object_get(request, "priority"), problems);
    spec->wanted = execute_request_wanted(request);
    spec->subscriber = execute_request_subscriber(request);
    spec->resources = execute_request_resources(request);
    spec->label = read_label(json_object_get(request, "label"), problems);
    if (problem_list_is_empty(problems) && !spec->label) problem_list_add(problems, "/label", "could not be kept: out of memory");
    if (problem_list_is_empty(problems)) return true;
    job_spec_clear(spec);
    memset(spec, 0, sizeof *spec);
    return false;
}

void job_spec_clear(job_spec *spec)
{
    json_decref(spec->label);
    json_decref(spec->wanted);
    json_decref(spec->given);
    json_decref(spec->subscriber);
    json_decref(spec->resources);
    if (spec->type) spec_inputs_clear(spec->type->inputs, (char *)spec + spec->type->inputs_at);
    /* A tenth of a megabyte, of which nothing else is owned. */
    spec->type = NULL;
    spec->label = spec->wanted = spec->given = spec->subscriber = spec->resources = NULL;
}

json_t *job_spec_to_json(const job_spec *spec)
{
    return json_pack("{s:s, s:o, s:O}", "process", spec->process, "inputs",
                     spec_inputs_write(spec->type->inputs, (const char *)spec + spec->type->inputs_at), "label", spec->label);
}

char *job_spec_to_brief(const job_spec *spec)
{
    json_t *document = job_spec_to_json(spec);
    json_t *start = json_object_get(json_object_get(document, "inputs"), "start");
    json_t *particles = json_object_get(start, "particles");
    if (particles) json_object_set_new(start, "particles", json_integer((json_int_t)json_array_size(particles)));
    char *text = json_text_write(document);
    json_decref(document);
    return text;
}

char *job_spec_to_text(const job_spec *spec)
{
    json_t *document = job_spec_to_json(spec);
    char *text = json_text_write(document);
    json_decref(document);
    return text;
}
