/* What the handlers need of the daemon around them. */
#ifndef SERVICE_H
#define SERVICE_H

#include <stdbool.h>
#include <stddef.h>

#include "http_request.h"
#include "store.h"
#include "subscriber.h"
#include "text_buffer.h"
#include "version.h"

/* What a request may do. */
typedef enum access_level { ACCESS_NONE, ACCESS_READ, ACCESS_WRITE } access_level;

typedef struct api_service {
    job_store *store;
    int web_folder;       /* descriptor of the page's folder; -1: none */
    const char *api_file; /* the OpenAPI document, YAML */
    /* These three may change at any time; what was read of them stays valid. */
    const char *_Atomic public_url;     /* what addresses begin with, without / at the end; NULL: with the host that was asked */
    _Atomic int default_threads;        /* of a job that does not ask */
    const post_limits *_Atomic limits;  /* what one POST may ask for */
    callback_hosts callback_hosts;      /* whom jobs may have called back */
    void *daemon;                       /* first argument of the functions below */
    void (*jobs_changed)(void *daemon); /* a job was added, dismissed or put into the queue again */
    void (*jobs_deleted)(void *daemon); /* their folders are to be removed */
    bool (*is_ready)(void *daemon, char *why_not, size_t size);
    void (*write_metrics)(void *daemon, text_buffer *out);
    /* Fill the response. */
    void (*begin_session)(void *daemon, const http_request *request, const char *token, http_response *response);
    void (*end_session)(void *daemon, const http_request *request, http_response *response);
} api_service;

#endif
