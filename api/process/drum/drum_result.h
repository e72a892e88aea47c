/* What a drum run found, and the document of GET /jobs/{id}/results that says it. */
#ifndef DRUM_RESULT_H
#define DRUM_RESULT_H

#include <jansson.h>

#include "dem_mound.h"
#include "run_facts.h"

typedef struct drum_result {
    dem_drum_results measured;
    dem_profile interface;
    bool has_regime;        /* false: too few frames, or no bed, to tell */
    double steady, certain; /* 1, 0; NaN: nobody can know. As is the next, written from what was measured */
    const char *verdict, *method, *regime;
    run_facts run;
} drum_result;

/* A stage of its rotation. */
typedef struct drum_stage_result {
    double rate, begins, ends; /* rad/s as asked for; s since rotation began */
    dem_drum_results measured;
    double steady, certain;
    const char *verdict, *regime;
} drum_stage_result;

/* Every measure NaN, as when there were too few frames to measure. */
void drum_result_init(drum_result *result);

/* Of `count` beds of a run: of all together. Each bed says what it tells in words, too. */
void drum_result_of_beds(drum_result *bed, size_t count, drum_result *all);

/* The results document of the same: NaN becomes null. New reference; NULL: no memory. */
json_t *drum_result_to_json(drum_result *bed, size_t count);
/* Every measure NaN, and an entry of the list of stages. */
void drum_stage_result_init(drum_stage_result *result);
json_t *drum_stage_result_to_json(const drum_stage_result *result);

#endif
