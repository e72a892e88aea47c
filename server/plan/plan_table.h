/* The runs of a calibration so far: each case that the planner asked for, as it was, with what came of it.
 *
 *   {"number": 17, "stage": "start", "test": 1, "set": 0, "parameters": {pointer: value}, "status": "successful", "results": {...}}
 *
 * They may come in any order: the planner takes them by their numbers, so that it decides alike whichever run ended first. */
#ifndef PLAN_TABLE_H
#define PLAN_TABLE_H

#include <jansson.h>

#include "plan_request.h"

typedef enum plan_stage { STAGE_START, STAGE_REFINE, STAGE_VERIFY, STAGES } plan_stage;
extern const char *const plan_stage_names[STAGES];

typedef struct plan_run {
    int64_t number;
    plan_stage stage;
    size_t test, set;                                            /* set: of verification, the place in the family */
    double value[PLAN_MOST_PARAMETERS], x[PLAN_MOST_PARAMETERS]; /* x: in the unit cube */
    bool is_over, has_failed;
    const json_t *results; /* borrowed; NULL: none */
} plan_run;

typedef struct plan_table {
    size_t count, waiting;
    plan_run *run; /* (count) owned, by number */
} plan_table;

/* runs: a list, or NULL for none. False: problems say what is wrong with it. Clear the table either way. */
bool plan_table_read(const plan_request *request, const json_t *runs, plan_table *table, problem_list *problems);
void plan_table_clear(plan_table *table);
/* Of all runs, and of those that the emulators are made of. */
int64_t plan_table_next_number(const plan_table *table);
size_t plan_table_count(const plan_table *table, plan_stage stage);

/* Between values and the unit cube. */
double plan_to_cube(const plan_parameter *parameter, double value);
double plan_from_cube(const plan_parameter *parameter, double x);

/* What a run says of the measure, and its own standard error of that (NaN: it tells none). False: it says nothing. */
bool plan_run_tells(const plan_run *run, const plan_measure *measure, double *value, double *error);

/* A number of the "run" of its results; fallback where there is none. */
double plan_run_number(const plan_run *run, const char *name, double fallback);
/* Spheres times steps; 0: not known. Unlike a time it is the same whenever the run is run. */
double plan_run_work(const plan_run *run);

#endif
