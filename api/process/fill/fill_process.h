/* The parts that the filling of a cylinder as a process is made of. */
#ifndef FILL_PROCESS_H
#define FILL_PROCESS_H

#include "process_type.h"

extern const process_type fill_process;
extern const spec_table fill_fields;          /* fill_fields.c */
extern const result_table fill_result_fields; /* fill_result_fields.c */


#endif
