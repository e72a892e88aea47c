/* One request and its answer on their way through the server. Belongs to the connection's thread, but for the time
 * in which it is suspended: then it is the waiting room's. */
#ifndef HTTP_EXCHANGE_H
#define HTTP_EXCHANGE_H

#include <microhttpd.h>

#include "connection_watch.h"
#include "http_guard.h"
#include "log.h"
#include "routes.h"

typedef struct http_exchange {
    struct http_server *server;
    struct MHD_Connection *connection;
    struct waiting_room *room;
    watched_connection *watched;
    int socket;
    char *target; /* as it was sent; request.path and the parameters point into it */
    char *body;
    size_t body_expected;
    http_request request;
    http_headers headers;
    http_response response;
    const http_route *route; /* NULL: none was reached */
    enum {
        EXCHANGE_NEW,     /* the request line is here */
        EXCHANGE_READING, /* headers are good, the body comes in */
        EXCHANGE_REFUSED, /* the answer is made; what still comes of the body is dropped */
        EXCHANGE_WHOLE,   /* to be answered */
        EXCHANGE_ANSWERED /* the answer is made */
    } stage;
    char id[LOG_REQUEST_SIZE]; /* by which log and answer name it */
    double arrived, worked;    /* monotonic s when the request was whole; s spent on the answer */
    double resume_at;          /* monotonic s, while parked */
    bool
        waits_no_more; /* parked or to be parked: it is answered as things are, since its client closed its end or the room is full */
    size_t body_held, answer_held; /* bytes that count in the server's sums */
    struct http_exchange *next;
} http_exchange;

#endif
