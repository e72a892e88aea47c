/* Refuses requests before any handler sees them: headers that two servers could read differently, names that are not
 * ours, writes from foreign pages, missing tokens. */
#ifndef HTTP_GUARD_H
#define HTTP_GUARD_H

#include "access.h"
#include "address_limits.h"
#include "config.h"
#include "routes.h"

enum { HTTP_BODY_LIMIT = 1 << 20, HTTP_CSV_LIMIT = 16 << 20 };

typedef struct http_guard {
    const config *_Atomic settings;
    access_list access;
    address_limits limits;
} http_guard;

/* What the headers add up to beyond those in http_request. */
typedef struct http_headers {
    int hosts, lengths, encodings; /* how many of each were sent */
    const char *length;            /* Content-Length */
    bool strange_name;             /* a header name with other characters than a token has: a folded line */
} http_headers;

/* False: the problem is logged. A host beyond loopback needs a token. */
bool http_guard_init(http_guard *guard, const config *settings);
/* The token file of the options as they are now. False: it is logged, and all stays as it was. */
bool http_guard_read_tokens(http_guard *guard, const config *fresh);
/* From now on these, which outlive the guard. */
void http_guard_set_options(http_guard *guard, const config *settings);
void http_headers_take(http_headers *headers, http_request *request, const char *name, const char *value);
/* False: the response says why not. *body_length: to be expected. */
bool http_guard_admits(http_guard *guard, const http_headers *headers, const http_request *request, const http_route *route,
                       http_response *response, size_t *body_length);
/* Notes whether a page of --allow-origin asks. True: it asks what it may ask, and the response says so. */
bool http_guard_is_preflight(const http_guard *guard, http_request *request, http_response *response);
/* Whether the address asks no faster than it may. */
bool http_guard_counts(http_guard *guard, const http_request *request, http_response *response);
/* What the service's functions of these names do. */
void http_guard_begin_session(http_guard *guard, const http_request *request, const char *token, http_response *response);
void http_guard_end_session(http_guard *guard, const http_request *request, http_response *response);
/* The part that holds for requests to unknown addresses, too. */
bool http_guard_knows_host(const http_guard *guard, const http_headers *headers, const http_request *request,
                           http_response *response);

#endif
