/* Counts for GET /metrics, in Prometheus' text format. */
#ifndef METRICS_H
#define METRICS_H

#include "dispatcher.h"
#include "prune.h"
#include "routes.h"
#include "text_buffer.h"

enum { METRICS_CODES = 21, METRICS_BUCKETS = 7 };

typedef struct http_metrics {
    /* [route_count] counts requests that reached no route; the last code counts all others */
    _Atomic uint64_t requests[MOST_ROUTES + 1][METRICS_CODES];
    _Atomic uint64_t bucket[METRICS_BUCKETS]; /* by time to answer, without the time asked for by ?wait= */
    _Atomic uint64_t nanoseconds;
    _Atomic int connections;
} http_metrics;

/* route: NULL when none was reached. */
void metrics_count(http_metrics *metrics, const http_route *route, int status, double seconds);
/* pruned: since the start. */
void metrics_write(http_metrics *metrics, job_dispatcher *dispatcher, const prune_tally *pruned, text_buffer *out);

#endif
