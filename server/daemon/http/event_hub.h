/* Who follows the jobs by GET /events: streams of server-sent events, each a connection that is suspended until there is something
 * to be said. One thread makes of each commit the events that it means, once for all streams; the newest are kept for those that
 * come back with Last-Event-ID. Where nobody listens nothing is made. */
#ifndef EVENT_HUB_H
#define EVENT_HUB_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

#include "http_exchange.h"
#include "job_store.h"

enum {
    EVENT_HUB_STREAMS = 1024,
    EVENT_HUB_STREAMS_PER_ADDRESS = 256, /* the rest of what one address may have stays for its other requests */
    EVENT_HUB_KEPT = 512                 /* events */
};

typedef struct event_stream event_stream;

typedef struct event_hub {
    pthread_mutex_t lock;
    pthread_t thread;
    job_store *store;
    event_stream *first;
    int streams;
    unsigned long long begun; /* ids of another daemon's life begin with another number */
    uint64_t last, oldest;    /* number of the newest event, and of the oldest that is kept */
    char *event[EVENT_HUB_KEPT];
    bool is_closing;
} event_hub;

/* False: no thread. */
bool event_hub_open(event_hub *hub, job_store *store);
/* Ends all streams, and the thread; the memory goes with event_hub_clear, once no connection is left. */
void event_hub_close(event_hub *hub);
void event_hub_clear(event_hub *hub);

/* The body of an answer to this exchange, which is a stream from now on; NULL: there are too many, or no memory. */
struct MHD_Response *event_hub_reply(event_hub *hub, const http_exchange *exchange);

#endif
