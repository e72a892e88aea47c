/* The parts that the single particle's process is made of. */
#ifndef GRANULE_PROCESS_H
#define GRANULE_PROCESS_H

#include "process_type.h"

extern const process_type granule_process;
extern const spec_table granule_fields;          /* granule_fields.c */
extern const result_table granule_result_fields; /* granule_result_fields.c */

#endif
