/* What a flow through an orifice came to, and the document that says it. */
#ifndef ORIFICE_RESULT_H
#define ORIFICE_RESULT_H

#include <jansson.h>

#include "dem_flow.h"
#include "run_facts.h"

typedef struct orifice_result {
    dem_flow_results measured;
    dem_profile solid_fraction, velocity;          /* along the orifice */
    double outlet_solid_fraction, outlet_velocity; /* means over it; m/s downward */
    run_facts run;
} orifice_result;

/* New reference; NULL: no memory. */
json_t *orifice_result_to_json(const orifice_result *result);

#endif
