/* Requests that carry an Idempotency-Key: sent again, they get the answer that they had, and nothing is done twice. */
#ifndef REQUEST_KEY_H
#define REQUEST_KEY_H

#include "routes.h"

/* route_respond, but for a POST that is repeated. */
void respond_once(const http_route *route, api_service *service, const http_request *request, http_response *response);

#endif
