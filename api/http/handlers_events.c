/* Every change of any job, as it comes. The server makes the stream (server-sent events); here it is only asked for. */
#include "handlers.h"

void send_events(api_service *service, const http_request *request, http_response *response)
{
    (void)service, (void)request;
    response->status = 200;
    response->content_type = "text/event-stream";
    response->cache_control = "no-store";
    response->is_stream = true;
}
