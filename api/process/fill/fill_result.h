/* What a filled cylinder came to, and the document that says it. */
#ifndef FILL_RESULT_H
#define FILL_RESULT_H

#include <jansson.h>

#include "dem_mound.h"
#include "run_facts.h"

typedef struct fill_result {
    dem_fill_results measured;
    dem_angle while_filling;
    dem_standing standing;
    double azimuths;
    const char *method; /* set where it is written */
    run_facts run;
} fill_result;

/* New reference; NULL: no memory. */
json_t *fill_result_to_json(const fill_result *result);

#endif
