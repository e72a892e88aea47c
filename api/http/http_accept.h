/* Which of several representations a client wants (RFC 9110, 12.5.1): by the Accept header with its qualities, or by the
 * query parameter f, which counts more. */
#ifndef HTTP_ACCEPT_H
#define HTTP_ACCEPT_H

#include "http_request.h"

/* The place in offers of the media type that has the highest quality; of several, of the one that is named most exactly, then
 * of the one that is named first, then of the first. 0 where none is acceptable: another type is better than no answer.
 * An offer has parameters where these tell it from another ("application/x;version=2"). accept may be NULL. */
size_t http_accept_choose(const char *accept, const char *const *offers, size_t count);

typedef struct http_format {
    const char *name, *media_type; /* as f has it, and as Accept has it */
} http_format;
/* The place in formats of what f names, else of what Accept prefers. f is one that the route knows. */
size_t http_format_choose(const http_request *request, const http_format *formats, size_t count);

#endif
