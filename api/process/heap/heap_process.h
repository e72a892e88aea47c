/* The parts that the heap below a lifted tube as a process is made of. */
#ifndef HEAP_PROCESS_H
#define HEAP_PROCESS_H

#include "process_type.h"

extern const process_type heap_process;
extern const spec_table heap_fields;          /* heap_fields.c */
extern const result_table heap_result_fields; /* heap_result_fields.c */

/* heap_rules.c; what they do: process_type.h */
void heap_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems);
job_estimate heap_estimate(const job_spec *spec, const calibration *machine);
void heap_warn(const job_spec *spec, problem_list *warnings);
void heap_understand(const job_spec *spec, json_t *words);

#endif
