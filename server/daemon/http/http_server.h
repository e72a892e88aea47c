/* The HTTP side: libmicrohttpd with a few threads, the guard before and the routes behind. */
#ifndef HTTP_SERVER_H
#define HTTP_SERVER_H

#include <stdatomic.h>

#include "connection_watch.h"
#include "event_hub.h"
#include "http_guard.h"
#include "metrics.h"
#include "waiting_room.h"

typedef struct http_server {
    api_service *service;
    http_guard guard;
    http_metrics metrics;
    connection_watch watch;
    atomic_size_t bodies_held, answers_held; /* bytes of the large ones that are in memory */
    atomic_int under_way;                    /* requests that have begun and are not answered to the end */
    waiting_room room;
    event_hub hub;
    struct MHD_Daemon *daemon;
    int listener, port; /* the port that was opened */
    int nothing;        /* a descriptor that is never ready */
} http_server;

/* Listens, but answers nobody yet. False: the problem is logged. */
bool http_server_open(http_server *server, const config *settings, api_service *service);
bool http_server_start(http_server *server);
/* No new connections; those waiting for a job are answered as things are. */
void http_server_leave(http_server *server);
/* What is being answered has two seconds to reach its client. */
void http_server_stop(http_server *server);

#endif
