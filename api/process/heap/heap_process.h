/* The parts that the heap below a lifted tube as a process is made of. */
#ifndef HEAP_PROCESS_H
#define HEAP_PROCESS_H

#include "process_type.h"

extern const process_type heap_process;
extern const spec_table heap_fields;          /* heap_fields.c */
extern const result_table heap_result_fields; /* heap_result_fields.c */


#endif
