/* What OGC API - Processes lets a client say around the inputs when it executes a process. */
#ifndef EXECUTE_REQUEST_H
#define EXECUTE_REQUEST_H

#include <jansson.h>

#include "job_spec.h"

/* response, outputs and subscriber: every answer is a document of all outputs by value, and nobody is called back, so what
 * asks for that is fine and anything else is a problem. type: NULL, unknown. */
void execute_request_check(const json_t *request, const process_type *type, problem_list *problems);
/* Inputs, of which any may be qualified, {"value": ..., "mediaType": "application/json"}, as values alone. New reference. */
json_t *execute_request_inputs(const json_t *inputs, problem_list *problems);

#endif
