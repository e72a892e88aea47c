/* A list of problems, and the RFC 9457 document they are sent in.
 *
 * A problem that can't be recorded for want of memory must not turn a bad request into a good one: the list then
 * loses its array, and a list without an array is not empty. */
#include "problem.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PROBLEMS = 100, LONGEST_DETAIL = 600 };

bool problem_list_init(problem_list *problems)
{
    problems->errors = json_array();
    return problems->errors != NULL;
}

void problem_list_clear(problem_list *problems)
{
    json_decref(problems->errors);
    problems->errors = NULL;
}

bool problem_list_is_empty(const problem_list *problems) { return problems->errors && json_array_size(problems->errors) == 0; }

bool problem_list_is_full(const problem_list *problems)
{
    return !problems->errors || json_array_size(problems->errors) >= MOST_PROBLEMS;
}

/* Of a text that quotes what a client sent, perhaps cut within a character, what is UTF-8: JSON can hold nothing else.
 * New reference. */
static json_t *text_json(const char *text)
{
    json_t *whole = json_string(text);
    char *kept = whole ? NULL : strdup(text);
    if (!kept) return whole;
    size_t length = 0;
    for (const char *end = text + strlen(text); text < end;) {
        size_t bytes = 0;
        for (size_t n = 1; n <= 4 && n <= (size_t)(end - text) && bytes == 0; n++) {
            json_t *character = json_stringn(text, n);
            if (character) bytes = n;
            json_decref(character);
        }
        memcpy(kept + length, text, bytes);
        length += bytes;
        text += bytes ? bytes : 1;
    }
    json_t *rest = json_stringn(kept, length);
    free(kept);
    return rest;
}

void problem_list_add(problem_list *problems, const char *pointer, const char *format, ...)
{
    if (problem_list_is_full(problems)) return;
    char detail[LONGEST_DETAIL];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(detail, sizeof detail, format, arguments);
    va_end(arguments);

    json_t *problem = json_pack("{s:o, s:o}", "pointer", text_json(pointer), "detail", text_json(detail));
    if (!problem || json_array_append_new(problems->errors, problem) != 0) problem_list_clear(problems);
}

json_t *problem_json(int http_status, const char *type, const char *title, const char *detail, const problem_list *errors)
{
    json_t *document =
        json_pack("{s:s, s:s, s:i, s:o}", "type", type, "title", title, "status", http_status, "detail", text_json(detail));
    if (!document || !errors || !errors->errors) return document;
    if (json_object_set(document, "errors", errors->errors) != 0) {
        json_decref(document);
        return NULL;
    }
    return document;
}
