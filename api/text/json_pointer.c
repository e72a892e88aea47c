#include "json_pointer.h"

#include <stdlib.h>
#include <string.h>

bool json_pointer_is_valid(const char *pointer)
{
    if (pointer[0] != '/' || strlen(pointer) >= JSON_POINTER_SIZE) return false;
    for (const char *c = pointer; *c; c++)
        if (*c == '~' && c[1] != '0' && c[1] != '1') return false;
    return true;
}

/* The step after the slash that *rest points at, unescaped; *rest moves to the next slash or the end. */
static bool next_step(const char **rest, char step[JSON_POINTER_SIZE])
{
    const char *c = *rest;
    if (*c != '/') return false;
    size_t length = 0;
    for (c++; *c && *c != '/'; c++) {
        if (length + 1 >= JSON_POINTER_SIZE) return false;
        step[length++] = *c != '~' ? *c : *++c == '0' ? '~' : '/';
        if (!*c) return false;
    }
    step[length] = '\0';
    *rest = c;
    return true;
}

/* "0", "12": an entry of the list. "-", "01" and entries past the end are none. */
static json_t *entry_at(const json_t *list, const char *step, size_t *index)
{
    const size_t digits = strspn(step, "0123456789");
    if (digits == 0 || digits > 6 || step[digits] != '\0' || (step[0] == '0' && digits > 1)) return NULL;
    *index = (size_t)strtoul(step, NULL, 10);
    return json_array_get(list, *index);
}

static json_t *child_of(const json_t *parent, const char *step)
{
    size_t index;
    return json_is_array(parent) ? entry_at(parent, step, &index) : json_object_get(parent, step);
}

json_t *json_pointer_find(const json_t *document, const char *pointer)
{
    char step[JSON_POINTER_SIZE];
    const char *rest = pointer;
    json_t *at = (json_t *)document;
    while (at && *rest) at = next_step(&rest, step) ? child_of(at, step) : NULL;
    return at;
}

static bool put(json_t *parent, const char *step, const json_t *value)
{
    size_t index;
    if (json_is_object(parent)) return json_object_set(parent, step, (json_t *)value) == 0;
    return json_is_array(parent) && entry_at(parent, step, &index) && json_array_set(parent, index, (json_t *)value) == 0;
}

bool json_pointer_set(json_t *document, const char *pointer, const json_t *value)
{
    char step[JSON_POINTER_SIZE];
    const char *rest = pointer;
    json_t *at = document;
    while (next_step(&rest, step)) {
        if (*rest == '\0') return put(at, step, value);
        json_t *child = child_of(at, step);
        if (!child && !json_is_object(at)) return false;
        child = child ? json_copy(child) : json_object();
        const bool is_put = child && put(at, step, child);
        json_decref(child); /* `at` holds it */
        if (!is_put) return false;
        at = child;
    }
    return false;
}

bool json_pointer_append(char *pointer, const char *name)
{
    size_t length = strlen(pointer);
    const size_t start = length;
    if (length + 1 < JSON_POINTER_SIZE) pointer[length++] = '/';
    for (; *name && length + 2 < JSON_POINTER_SIZE; name++) {
        if (*name == '~' || *name == '/') pointer[length++] = '~';
        pointer[length++] = *name == '~' ? '0' : *name == '/' ? '1' : *name;
    }
    pointer[*name ? start : length] = '\0';
    return *name == '\0';
}

bool json_pointer_is_within(const char *pointer, const char *place)
{
    const size_t length = strlen(place);
    return strncmp(pointer, place, length) == 0 && (pointer[length] == '\0' || pointer[length] == '/');
}
