/* The page's session: a token once, then a cookie that the page's scripts can't read. */
#include <string.h>

#include "handlers.h"

void begin_session(api_service *service, const http_request *request, http_response *response)
{
    json_t *body = parse_body(request, response);
    if (!body) return;
    const char *token = json_string_value(json_object_get(body, "token"));
    if (token && json_object_size(body) == 1) service->begin_session(service->daemon, request, token, response);
    else
        http_respond_problem(response, 400, NULL, "Not a session",
                             "the body must be {\"token\": \"...\"}, with one token of the service's token file");
    json_decref(body);
}

void end_session(api_service *service, const http_request *request, http_response *response)
{
    service->end_session(service->daemon, request, response);
}
