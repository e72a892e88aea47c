/* What a heap came to, and the document that says it. */
#ifndef HEAP_RESULT_H
#define HEAP_RESULT_H

#include <jansson.h>

#include "dem_mound.h"
#include "run_facts.h"

typedef struct heap_result {
    dem_heap_results measured;
    dem_standing standing;
    double azimuths;
    const char *method; /* set where it is written */
    run_facts run;
} heap_result;

/* New reference; NULL: no memory. */
json_t *heap_result_to_json(const heap_result *result);

#endif
