/* Units that a number may be given in instead of its row's own: {"value": 15, "unit": "rpm"}. */
#ifndef UNIT_TABLE_H
#define UNIT_TABLE_H

#include <jansson.h>
#include <stdbool.h>

#include "spec_fields.h"

enum { UNITS_TEXT_SIZE = 160 };

/* Has a "value" and a "unit": a quantity, right or wrong. */
bool is_quantity(const json_t *value);

/* The number in the field's unit: where only a power of ten lies between the two units, the double that is nearest to the
 * decimals as they were written, so 3.78 mm is the very number 0.00378. False: the unit is of another dimension. */
bool unit_convert(const spec_field *field, const char *unit, double number, double *converted);

/* The quantity as a number in the field's unit. New reference; NULL: it is none that the field can be given as. */
json_t *quantity_to_json(const spec_field *field, const json_t *quantity);

/* What people give numbers of this dimension in: "mm" of a length; the field's own unit where there is no other such. */
const char *unit_usual(const spec_field *field);
const char *unit_dimension(const spec_field *field); /* "length" */
/* "m", "mm", ...: the field's own first. New reference. */
json_t *unit_names(const spec_field *field);
void unit_names_text(const spec_field *field, char text[UNITS_TEXT_SIZE]);

#endif
