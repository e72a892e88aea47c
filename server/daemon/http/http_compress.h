/* Answers compressed by gzip for clients that take it: a slow line then brings a list in a tenth of the time. Compressed piece
 * by piece as the client reads, so that no long answer holds a thread, or memory beyond its own. */
#ifndef HTTP_COMPRESS_H
#define HTTP_COMPRESS_H

#include <microhttpd.h>

#include "http_request.h"

/* By its type: text of any kind. Pictures and snapshots are compressed in themselves. */
bool http_compress_is_text(const http_response *response);
/* Does the client prefer gzip to what is sent as it is, and is the answer long enough to gain? A part of a file is sent as it is. */
bool http_compress_is_wanted(const http_request *request, const http_response *response);
/* Takes body, file and pieces out of the response. NULL: no memory. */
struct MHD_Response *http_compress_reply(http_response *response);

#endif
