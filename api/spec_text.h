/* Inputs from JSON and back, driven by the table of fields. */
#ifndef SPEC_TEXT_H
#define SPEC_TEXT_H

#include <jansson.h>

#include "job_spec.h"
#include "problem.h"

/* Every input that can't be used becomes NaN and a problem, so that later checks, all written as comparisons
 * that are false for NaN, stay silent about it. inputs: the request's "inputs", NULL when it has none. */
void drum_inputs_read(const json_t *object, drum_inputs *inputs, problem_list *problems);

/* New reference; NULL: no memory. */
json_t *drum_inputs_write(const drum_inputs *inputs);

/* One short ASCII text for any JSON value, for messages. */
void json_value_text(const json_t *value, char *text, size_t size);

/* One problem for each member of `object` that is not in `known`, a list that ends with NULL. */
void refuse_unknown_members(const json_t *object, const char *pointer, const char *const *known,
                            problem_list *problems);

#endif
