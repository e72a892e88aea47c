/* A list of problems, and the RFC 9457 document they are sent in.
 *
 * A problem that can't be recorded for want of memory must not turn a bad request into a good one: the list then
 * loses its array, and a list without an array is not empty. */
#include "problem.h"

#include <stdarg.h>
#include <stdio.h>

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

/* Cut back to whole UTF-8 characters: a text cut at the buffer's end is otherwise no JSON string. */
static void trim_cut_character(char *text, size_t length)
{
    size_t start = length;
    while (start > 0 && ((unsigned char)text[start - 1] & 0xC0) == 0x80) start--;
    if (start == 0) return;
    const unsigned char lead = (unsigned char)text[start - 1];
    const size_t needed = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
    if (length - (start - 1) < needed) text[start - 1] = '\0';
}

void problem_list_add(problem_list *problems, const char *pointer, const char *format, ...)
{
    if (!problems->errors || json_array_size(problems->errors) >= MOST_PROBLEMS) return;
    char detail[LONGEST_DETAIL];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(detail, sizeof detail, format, arguments);
    va_end(arguments);
    if (length >= (int)sizeof detail) trim_cut_character(detail, sizeof detail - 1);

    json_t *problem = json_pack("{s:s, s:s}", "pointer", pointer, "detail", detail);
    if (!problem || json_array_append_new(problems->errors, problem) != 0) problem_list_clear(problems);
}

json_t *problem_json(int http_status, const char *type, const char *title, const char *detail, const problem_list *errors)
{
    json_t *document = json_pack("{s:s, s:s, s:i, s:s}", "type", type, "title", title, "status", http_status, "detail", detail);
    if (!document || !errors || !errors->errors) return document;
    if (json_object_set(document, "errors", errors->errors) != 0) {
        json_decref(document);
        return NULL;
    }
    return document;
}
