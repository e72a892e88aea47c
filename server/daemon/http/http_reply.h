/* A handler's answer as the HTTP library sends it: from memory, from a file, or in pieces; compressed where the client
 * takes that. */
#ifndef HTTP_REPLY_H
#define HTTP_REPLY_H

#include <microhttpd.h>

#include "http_request.h"

/* Takes body, file and pieces out of the response. NULL: no memory. */
struct MHD_Response *http_reply_make(const http_request *request, http_response *response);

/* The headers of an answer whose body is made elsewhere. */
void http_reply_add_headers(struct MHD_Response *reply, const http_request *request, const http_response *response);

#endif
