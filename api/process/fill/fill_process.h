/* The parts that the filling of a cylinder as a process is made of. */
#ifndef FILL_PROCESS_H
#define FILL_PROCESS_H

#include "process_type.h"

extern const process_type fill_process;
extern const spec_table fill_fields;          /* fill_fields.c */
extern const result_table fill_result_fields; /* fill_result_fields.c */

/* fill_rules.c; what they do: process_type.h */
void fill_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems);
job_estimate fill_estimate(const job_spec *spec, const calibration *machine);
void fill_warn(const job_spec *spec, problem_list *warnings);
void fill_understand(const job_spec *spec, json_t *words);

#endif
