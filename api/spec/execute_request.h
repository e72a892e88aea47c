/* What OGC API - Processes lets a client say around the inputs when it executes a process. */
#ifndef EXECUTE_REQUEST_H
#define EXECUTE_REQUEST_H

#include <jansson.h>

#include "job_spec.h"

/* response and outputs say how the results are wanted, subscriber who is called back, resources what is asked of a cluster. type: NULL, unknown. */
void execute_request_check(const json_t *request, const process_type *type, problem_list *problems);
/* {"raw": bool, "outputs": {name: "value" | "reference"}}, without outputs where all are wanted by value. New reference; NULL:
 * nothing of that was said. The request has no problems. */
json_t *execute_request_wanted(const json_t *request);
/* Who is called back (subscriber.h). New reference; NULL: nobody. The request has no problems. */
json_t *execute_request_subscriber(const json_t *request);
/* What is asked of a cluster (job_resources.h). New reference; NULL: nothing. The request has no problems. */
json_t *execute_request_resources(const json_t *request);
/* Inputs, of which any may be qualified, {"value": ..., "mediaType": "application/json"}, as values alone. New reference. refers:
 * some are references, {"href": ...}, which are refused, and there is nothing to be read of them. */
json_t *execute_request_inputs(const json_t *inputs, bool *refers, problem_list *problems);

#endif
