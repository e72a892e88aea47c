/* What the handlers need of the daemon around them. */
#ifndef SERVICE_H
#define SERVICE_H

#include <stdbool.h>
#include <stddef.h>

#include "http_request.h"
#include "store.h"
#include "text_buffer.h"
#include "version.h"

typedef struct api_service {
    job_store *store;
    int web_folder;                     /* descriptor of the page's folder; -1: none */
    const char *api_file;               /* the OpenAPI document, YAML */
    const char *public_url;             /* what addresses begin with, without / at the end; NULL: with the host that was asked */
    int default_threads;                /* of a job that does not ask */
    void *daemon;                       /* first argument of the functions below */
    void (*jobs_changed)(void *daemon); /* a job was added, dismissed or put into the queue again */
    void (*jobs_deleted)(void *daemon); /* their folders are to be removed */
    bool (*is_ready)(void *daemon, char *why_not, size_t size);
    void (*write_metrics)(void *daemon, text_buffer *out);
} api_service;

#endif
