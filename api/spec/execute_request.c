#include "execute_request.h"

#include <stdio.h>
#include <string.h>

#include "job_resources.h"
#include "process_type.h"
#include "spec_text.h"
#include "subscriber.h"

static bool is_text(const json_t *value, const char *text)
{
    return json_is_string(value) && strcmp(json_string_value(value), text) == 0;
}

static void check_output(const char *name, const json_t *wanted, const process_type *type, problem_list *problems)
{
    static const char *const known[] = { "transmissionMode", "format", NULL };
    char pointer[LONGEST_POINTER], member[LONGEST_POINTER], seen[80], available[300] = "";
    size_t o = 0;
    pointer_to_member(pointer, "/outputs", name);
    for (size_t i = 0; i < type->results->output_count; i++) {
        const size_t length = strlen(available);
        snprintf(available + length, sizeof available - length, "%s%s", i ? ", " : "", type->results->output[i].name);
    }
    while (o < type->results->output_count && strcmp(type->results->output[o].name, name) != 0) o++;
    if (o == type->results->output_count) problem_list_add(problems, pointer, "is not an output; available: %s", available);
    json_value_text(wanted, seen, sizeof seen);
    if (!json_is_object(wanted)) {
        if (!json_is_null(wanted)) problem_list_add(problems, pointer, "is %s; must be an object", seen);
        return;
    }
    refuse_unknown_members(wanted, pointer, known, problems);
    const json_t *mode = json_object_get(wanted, "transmissionMode");
    const json_t *media = json_object_get(json_object_get(wanted, "format"), "mediaType");
    json_value_text(mode, seen, sizeof seen);
    pointer_to_member(member, pointer, "transmissionMode");
    if (mode && !is_text(mode, "value") && !is_text(mode, "reference"))
        problem_list_add(problems, member, "is %s; must be \"value\" or \"reference\"", seen);
    json_value_text(media, seen, sizeof seen);
    pointer_to_member(member, pointer, "format/mediaType");
    if (media && !is_text(media, "application/json"))
        problem_list_add(problems, member, "is %s; must be \"application/json\"", seen);
}

static void check_outputs(const json_t *outputs, const process_type *type, problem_list *problems)
{
    const char *name;
    json_t *wanted;
    char seen[80];
    json_value_text(outputs, seen, sizeof seen);
    if (outputs && !json_is_null(outputs) && !json_is_object(outputs))
        problem_list_add(problems, "/outputs", "is %s; must be an object, or be left out", seen);
    json_object_foreach((json_t *)outputs, name, wanted)
    {
        if (type) check_output(name, wanted, type, problems);
    }
}

void execute_request_check(const json_t *request, const process_type *type, problem_list *problems)
{
    const json_t *response = json_object_get(request, "response");
    char seen[80];
    json_value_text(response, seen, sizeof seen);
    if (response && !json_is_null(response) && !is_text(response, "document") && !is_text(response, "raw"))
        problem_list_add(problems, "/response", "is %s; must be \"document\" or \"raw\"", seen);
    subscriber_check(json_object_get(request, "subscriber"), problems);
    job_resources_check(json_object_get(request, "resources"), problems);
    check_outputs(json_object_get(request, "outputs"), type, problems);
}

json_t *execute_request_wanted(const json_t *request)
{
    const bool raw = is_text(json_object_get(request, "response"), "raw");
    const char *name;
    json_t *wanted, *modes = json_object(), *outputs = json_object_get(request, "outputs");
    json_object_foreach(outputs, name, wanted)
    {
        const json_t *mode = json_object_get(wanted, "transmissionMode");
        json_object_set_new(modes, name, json_string(mode ? json_string_value(mode) : "value"));
    }
    json_t *all = raw || json_object_size(modes) > 0 ? json_pack("{s:b}", "raw", raw) : NULL;
    if (all && json_object_size(modes) > 0) json_object_set(all, "outputs", modes);
    json_decref(modes);
    return all;
}

json_t *execute_request_subscriber(const json_t *request)
{
    const json_t *subscriber = json_object_get(request, "subscriber");
    return json_is_object(subscriber) ? json_deep_copy(subscriber) : NULL;
}

json_t *execute_request_resources(const json_t *request)
{
    const json_t *resources = json_object_get(request, "resources");
    return json_object_size(resources) > 0 ? json_deep_copy(resources) : NULL;
}

/* --- qualified values --- */

/* Borrowed: what a qualified value holds, else the value itself; a number with its unit is one (unit_table.h). */
static json_t *value_of(json_t *value, const char *pointer, bool *refers, problem_list *problems)
{
    static const char *const known[] = { "value", "mediaType", "encoding", "schema", "format", NULL };
    if (json_is_string(json_object_get(value, "href"))) {
        *refers = true;
        problem_list_add(problems, pointer, "is a reference (href); must be given by value, since this service fetches nothing");
        return value;
    }
    json_t *inner = json_is_object(value) ? json_object_get(value, "value") : NULL;
    if (!inner || json_object_get(value, "unit")) return value;
    refuse_unknown_members(value, pointer, known, problems);
    const json_t *media = json_object_get(value, "mediaType");
    if (!media) media = json_object_get(json_object_get(value, "format"), "mediaType");
    char seen[80];
    json_value_text(media, seen, sizeof seen);
    if (media && !is_text(media, "application/json"))
        problem_list_add(problems, pointer, "has the mediaType %s; must be \"application/json\"", seen);
    return inner;
}

json_t *execute_request_inputs(const json_t *inputs, bool *refers, problem_list *problems)
{
    *refers = false;
    json_t *plain = json_object(), *value, *entry;
    const char *name;
    size_t i;
    json_object_foreach((json_t *)inputs, name, value)
    {
        char pointer[LONGEST_POINTER], member[LONGEST_POINTER];
        pointer_to_member(pointer, "/inputs", name);
        value = value_of(value, pointer, refers, problems);
        json_t *entries = json_is_array(value) ? json_array() : json_incref(value);
        json_array_foreach(value, i, entry)
        {
            snprintf(member, sizeof member, "%.200s/%zu", pointer, i);
            json_array_append(entries, value_of(entry, member, refers, problems));
        }
        json_object_set_new(plain, name, entries);
    }
    return plain;
}
