/* The table of a drum's results: output, name, unit and meaning of each. It drives writing the results document and
 * describing it. Only members that are words, and the angles by other methods, are not in it. */
#ifndef RESULT_FIELDS_H
#define RESULT_FIELDS_H

#include <jansson.h>
#include <stddef.h>

typedef enum result_kind {
    RESULT_REAL,
    RESULT_WHOLE, /* a whole number kept in a double */
    RESULT_SIZE,  /* a size_t */
    RESULT_TRUTH  /* a bool */
} result_kind;

typedef struct result_field {
    const char *output, *group, *name; /* group: object inside the output, NULL: none */
    result_kind kind;
    size_t offset;                     /* in job_result */
    const char *unit, *meaning;
} result_field;

extern const result_field result_fields[];
extern const size_t result_field_count;

/* "outputs" of the process description. New reference. */
json_t *result_outputs_description(void);

#endif
