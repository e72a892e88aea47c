/* What became of a single particle, as the results document says it. */
#ifndef GRANULE_RESULT_H
#define GRANULE_RESULT_H

#include <jansson.h>

#include "dem_granule.h"
#include "run_facts.h"

typedef struct granule_result {
    dem_granule_result solved;
    double slip_onset_deg;
    /* At the rate asked for; NaN and NULL: none was. */
    const char *regime;
    double keeps_contact, goes_round, revolutions, motion_slip_onset_deg;
    run_facts run;
} granule_result;

/* Fills all of *result; of run only particles, wall_seconds, threads and attempt are told. */
void granule_result_set(granule_result *result, const dem_granule_result *solved, const run_facts *run);

/* New reference; NULL: no memory. */
json_t *granule_result_to_json(const granule_result *result);

#endif
