/* The parts that the flow through an orifice as a process is made of. */
#ifndef ORIFICE_PROCESS_H
#define ORIFICE_PROCESS_H

#include "process_type.h"

extern const process_type orifice_process;
extern const spec_table orifice_fields;          /* orifice_fields.c */
extern const result_table orifice_result_fields; /* orifice_result_fields.c */

/* orifice_rules.c; what they do: process_type.h */
void orifice_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems);
job_estimate orifice_estimate(const job_spec *spec, const calibration *machine);
void orifice_warn(const job_spec *spec, problem_list *warnings);
void orifice_understand(const job_spec *spec, json_t *words);

#endif
