/* The parts that the rotating drum's process is made of. */
#ifndef DRUM_PROCESS_H
#define DRUM_PROCESS_H

#include "process_type.h"
#include "spec_memory.h"

extern const process_type drum_process;
extern const spec_table drum_fields; /* drum_fields.c */
extern const result_table drum_result_fields;
extern const result_table drum_stage_fields; /* of an entry of its output "stages" */
extern const char *const drum_verdicts[];    /* drum_result_fields.c */

void drum_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems); /* drum_rules.c */
void drum_warn(const job_spec *spec, problem_list *warnings);                            /* drum_warnings.c */
void drum_understand(const job_spec *spec, json_t *words);                               /* drum_warnings.c */
job_estimate drum_estimate(const job_spec *spec, const calibration *machine);            /* drum_estimate.c */

#endif
