#include "job_resources.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "spec_text.h"

#define VALUE_CHARACTERS "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.:@/+*&|!()[]-"

const resource_field resource_fields[] = {
    { "partition", "the partition in which it runs" },
    { "account", "the account that is charged" },
    { "qos", "the quality of service" },
    { "constraint", "features that its node has" },
    { "reservation", "the reservation that it runs in" },
    { NULL, NULL },
};

static const resource_field *find_resource(const char *name, size_t length)
{
    for (const resource_field *field = resource_fields; field->name; field++)
        if (strlen(field->name) == length && strncmp(field->name, name, length) == 0) return field;
    return NULL;
}

static bool is_value(const char *text, size_t length)
{
    return length > 0 && length < RESOURCE_SIZE && *text != '-' && strspn(text, VALUE_CHARACTERS) >= length;
}

bool resource_entry_is_good(const char *entry)
{
    const char *equals = strchr(entry, '=');
    if (!equals || !find_resource(entry, (size_t)(equals - entry))) return false;
    for (const char *value = equals + 1;; value++) {
        const size_t length = strcspn(value, ",");
        if (!is_value(value, length)) return false;
        value += length;
        if (!*value) return true;
    }
}

char *resource_names(char text[RESOURCES_SIZE])
{
    size_t used = 0;
    for (const resource_field *field = resource_fields; field->name; field++)
        used += (size_t)snprintf(text + used, RESOURCES_SIZE - used, "%s%s", used ? ", " : "", field->name);
    return text;
}

void job_resources_check(const json_t *resources, problem_list *problems)
{
    char pointer[LONGEST_POINTER], seen[80], names[RESOURCES_SIZE];
    const char *name;
    json_t *value;
    if (!resources || json_is_null(resources)) return;
    json_value_text(resources, seen, sizeof seen);
    if (!json_is_object(resources)) {
        problem_list_add(problems, "/resources", "is %s; must be an object, or null", seen);
        return;
    }
    json_object_foreach((json_t *)resources, name, value)
    {
        pointer_to_member(pointer, "/resources", name);
        json_value_text(value, seen, sizeof seen);
        if (!find_resource(name, strlen(name)))
            problem_list_add(problems, pointer, "is not known here; known are %s", resource_names(names));
        else if (!json_is_string(value) || !is_value(json_string_value(value), json_string_length(value)))
            problem_list_add(problems, pointer, "is %s; must be a name of 1 to %d characters", seen, RESOURCE_SIZE - 1);
    }
}

/* The values of that resource, one after the other, in what is left of `room`; or whether `wanted` is one of them. */
static bool look_through(const resource_list *allowed, const char *name, const char *wanted, char *names, size_t room)
{
    const size_t length = strlen(name);
    *names = '\0';
    for (int e = 0; e < allowed->count; e++) {
        const char *entry = allowed->entry[e];
        if (strncmp(entry, name, length) != 0 || entry[length] != '=') continue;
        for (const char *value = entry + length + 1; *value; value += *value == ',') {
            const size_t size = strcspn(value, ",");
            if (strlen(wanted) == size && strncmp(wanted, value, size) == 0) return true;
            const size_t said = strlen(names);
            snprintf(names + said, room - said, "%s%.*s", said ? ", " : "", (int)size, value);
            value += size;
        }
    }
    return false;
}

void job_resources_check_allowed(const json_t *resources, const resource_list *allowed, problem_list *problems)
{
    char pointer[LONGEST_POINTER], names[600];
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)resources, name, value)
    {
        const char *wanted = json_string_value(value);
        if (look_through(allowed, name, wanted, names, sizeof names)) continue;
        pointer_to_member(pointer, "/resources", name);
        if (*names) problem_list_add(problems, pointer, "is \"%s\"; this service allows %s (--slurm-allow)", wanted, names);
        else problem_list_add(problems, pointer, "is \"%s\"; this service lets no job choose its %s (--slurm-allow)", wanted, name);
    }
}

bool job_resources_write(const json_t *resources, char text[RESOURCES_SIZE])
{
    *text = '\0';
    if (json_object_size(resources) == 0) return true;
    char *written = json_dumps(resources, JSON_COMPACT | JSON_SORT_KEYS);
    const bool good = written && strlen(written) < RESOURCES_SIZE;
    if (good) memcpy(text, written, strlen(written) + 1);
    free(written);
    return good;
}
