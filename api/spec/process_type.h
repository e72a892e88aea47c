/* A process: a test that can be run. Each is a table of inputs, rules that make of them something to run, an estimate
 * of its cost, and a table of results; everything else about requests, jobs and descriptions is common to all.
 *
 * A new one takes X_fields.c (inputs), X_rules.c, X_result_fields.c, X_process.c with its process_type, a line in process_type.c, its
 * members in job_spec.h and its runner in the worker (server/worker/run/job_run.c). Its tables in the daemon follow from its rows. */
#ifndef PROCESS_TYPE_H
#define PROCESS_TYPE_H

#include "job_spec.h"
#include "result_fields.h"
#include "spec_fields.h"

struct process_type {
    const char *name, *title, *description;
    const spec_table *inputs;
    size_t inputs_at; /* offset in job_spec of the struct that the table fills */

    /* Sets the defaults that depend on other inputs, checks combinations, and derives what is run. Inputs that were
     * refused are NaN. Nothing derived is of use when there are problems. */
    void (*apply_rules)(job_spec *spec, uint64_t seed_if_missing, problem_list *problems);
    /* machine: how fast this one is; NULL takes cautious built-in figures. */
    job_estimate (*estimate)(const job_spec *spec, const calibration *machine);
    /* Adds warnings of combinations that were hardly meant; NULL: there are none. Of single inputs the table knows. */
    void (*warn)(const job_spec *spec, problem_list *warnings);
    /* Adds to an object what the inputs come to in other words. */
    void (*understand)(const job_spec *spec, json_t *words);

    const result_table *results;
};

/* Its members where its parts have the names that all processes give theirs (X_fields, X_rules_apply, ...). */
#define PROCESS_PARTS(process)                                                                                                     \
    .inputs = &process##_fields, .apply_rules = process##_rules_apply, .estimate = process##_estimate, .warn = process##_warn,     \
    .understand = process##_understand, .results = &process##_result_fields

extern const process_type *const process_types[];        /* ends with NULL */
const process_type *process_type_find(const char *name); /* NULL: unknown */

/* JSON Schema of all its inputs. New reference; process_description.c */
json_t *process_inputs_schema(const process_type *process);

/* "10 days 2 h" */
enum { TIME_IN_WORDS_SIZE = 40 };
void time_in_words(double seconds, char text[TIME_IN_WORDS_SIZE]); /* job_warnings.c */

double rotation_of_rpm(double rpm); /* rad/s; job_warnings.c */

/* The names of all, for messages: "drum", "fill", ... */
void process_type_names(char *text, size_t size);

#endif
