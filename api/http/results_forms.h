/* The forms in which a job's results can be had. Whoever says nothing of it gets all outputs as one object by their names. A
 * request to execute may want some outputs alone, some as addresses (by reference), or raw: one output as it is, several as
 * the parts of multipart/related, addresses alone in the header Link. The parameter f or an Accept that names JSON gets an
 * object all the same, and with the profile below each output in it is what the standard calls a qualified value. */
#ifndef RESULTS_FORMS_H
#define RESULTS_FORMS_H

#include "http_request.h"

#define RESULTS_PROFILE "http://www.opengis.net/def/profile/OGC/0/ogc-results"

/* False: the parameter profile names none that there is, and the response says so. */
bool results_profile_is_good(const http_request *request, http_response *response);
/* text: object of all outputs; taken. wanted: as execute_request.h has it, or NULL. Numbers stay the digits that they are. */
void results_respond(const http_request *request, http_response *response, const char *id, char *text, const json_t *wanted);
void results_respond_output(http_response *response, const char *id, const char *name, const json_t *output);

#endif
