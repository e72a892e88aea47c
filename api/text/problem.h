/* What is wrong with a request: every problem at once, each with a JSON pointer to the member it is about
 * (RFC 6901) and a sentence with value, unit and allowed range. Becomes application/problem+json (RFC 9457). */
#ifndef PROBLEM_H
#define PROBLEM_H

#include <jansson.h>
#include <stdbool.h>

typedef struct problem_list {
    json_t *errors; /* array of {"pointer", "detail"}; owned */
} problem_list;

bool problem_list_init(problem_list *problems);
void problem_list_clear(problem_list *problems);
bool problem_list_is_empty(const problem_list *problems);
/* Nothing more would be kept: whoever looks at much can stop looking. */
bool problem_list_is_full(const problem_list *problems);
/* printf-like; pointer as in "/inputs/drum/diameter". A list that is full (100) drops the rest. */
void problem_list_add(problem_list *problems, const char *pointer, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* {"type", "title", "status", "detail", "errors"}; errors may be NULL. New reference. */
json_t *problem_json(int http_status, const char *type, const char *title, const char *detail, const problem_list *errors);

#endif
