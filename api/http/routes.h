/* Which handler answers which address. The table is the whole list: what is not in it is 404, and the metrics
 * count by its rows. */
#ifndef ROUTES_H
#define ROUTES_H

#include "service.h"

typedef void route_handler(api_service *service, const http_request *request, http_response *response);

typedef struct http_route {
    const char *method;     /* GET answers HEAD, too */
    const char *pattern;    /* "/jobs/{}/log": {} stands for one segment of at most 64 characters */
    const char *parameters; /* " names " of the query parameters, each between spaces; others are refused. With a
                             * star where it may be given several times */
    route_handler *handler;
    const char *formats; /* " names " that f, and format, may have; NULL: " json " */
    bool slow;           /* may take seconds: answered apart, so that nothing else waits for it */
    bool open;           /* needs no token */
    bool bodiless;       /* a POST that needs no body, and so no Content-Type */
    bool takes_csv;      /* a POST whose body is text/csv, and may be longer */
    const char *dry;     /* the parameter with which it only tells what it would do; NULL: there is none */
} http_route;

enum { MOST_ROUTES = 64 }; /* for what is counted by route */
extern const http_route route_table[];
extern const size_t route_count;

/* What addresses in the answer begin with. */
void route_set_base(const api_service *service, const http_request *request, http_response *response);
/* Takes the prefix of the public address off the path: a proxy may leave it there. */
void route_strip_prefix(const api_service *service, http_request *request);
/* The route for request->method and ->path, its segments filled in. NULL: the response says why not. */
const http_route *routes_match(const http_route *table, size_t count, http_request *request, http_response *response);
/* Whether the request changes nothing, whatever the handler does otherwise. */
bool route_only_reads(const http_route *route, const http_request *request);
/* Refuses unknown parameters, then calls the handler; its addresses then name the host that was asked. */
void route_respond(const http_route *route, api_service *service, const http_request *request, http_response *response);

#endif
