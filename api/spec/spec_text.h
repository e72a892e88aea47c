/* Inputs from JSON and back, driven by the table of fields. */
#ifndef SPEC_TEXT_H
#define SPEC_TEXT_H

#include <jansson.h>

#include "problem.h"
#include "spec_fields.h"

/* Every input that can't be used becomes NaN and a problem, so that later checks, all written as comparisons
 * that are false for NaN, stay silent about it. object: the request's "inputs"; inputs: the process's struct. */
void spec_inputs_read(const spec_table *table, const json_t *object, void *inputs, problem_list *problems);

/* Frees what reading allocated: long lists, which stand in the inputs' own struct and not in a list's entries. */
void spec_inputs_clear(const spec_table *table, void *inputs);

/* ["contact/friction", ...]: those that an object of inputs has. New reference; NULL: no memory. */
json_t *spec_inputs_given(const spec_table *table, const json_t *inputs);
/* New reference; NULL: no memory. */
json_t *spec_inputs_write(const spec_table *table, const void *inputs);
/* Likewise, without the fields that act later. */
json_t *spec_inputs_of_bed(const spec_table *table, const void *inputs);

enum { LONGEST_POINTER = 256 };

/* A warning for each number that its field's usual range does not hold (spec_unusual.c). */
void spec_inputs_warn(const spec_table *table, const void *inputs, problem_list *warnings);

/* A step of a JSON pointer, with ~ and / escaped (RFC 6901). */
void pointer_to_member(char pointer[LONGEST_POINTER], const char *parent, const char *name);

/* One short ASCII text for any JSON value, for messages. */
void json_value_text(const json_t *value, char *text, size_t size);

/* One problem for each member of `object` that is not in `known`, a list that ends with NULL. */
void refuse_unknown_members(const json_t *object, const char *pointer, const char *const *known, problem_list *problems);

#endif
