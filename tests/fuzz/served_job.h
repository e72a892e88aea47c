/* The real handlers over a store with one job in it. */
#ifndef SERVED_JOB_H
#define SERVED_JOB_H

#include <string.h>

#include "routes.h"
#include "running_job.h"

static inline void served_nothing(void *daemon) { (void)daemon; }

static inline bool served_readiness(void *daemon, char *why_not, size_t size)
{
    (void)daemon;
    snprintf(why_not, size, "it is");
    return true;
}

static inline void served_no_metrics(void *daemon, text_buffer *out)
{
    (void)daemon;
    (void)out;
}

static inline api_service service_of(job_store *store)
{
    return (api_service){ .store = store,
                          .web_folder = -1,
                          .api_file = "",
                          .default_threads = 1,
                          .jobs_changed = served_nothing,
                          .jobs_deleted = served_nothing,
                          .is_ready = served_readiness,
                          .write_metrics = served_no_metrics };
}

static inline void is_one_line(const char *text)
{
    for (; text && *text; text++) CLAIM((unsigned char)*text >= ' ' && *text != 127);
}

/* Breaks out of no header, and where it says that it is JSON it is. */
static inline void is_sound_answer(const http_response *response)
{
    CLAIM(response->status >= 200 && response->status < 600);
    is_one_line(response->location);
    is_one_line(response->etag);
    is_one_line(response->content_range);
    is_one_line(response->allow);
    is_one_line(response->link);
    const char *type = response->content_type;
    if (!response->body || response->pieces.context || !type || !strstr(type, "json") || strstr(type, "ndjson")) return;
    json_t *document = json_loadb(response->body, response->length, JSON_DECODE_ANY, NULL);
    CLAIM(document);
    json_decref(document);
}

/* Asks for something of the job, as "/jobs/%s/samples", which must be had. */
static inline void can_be_asked_for(api_service *service, const char *pattern, const char *id)
{
    char target[200];
    http_request request = { .method = "GET", .host = "localhost" };
    http_response response;
    http_response_init(&response);
    snprintf(target, sizeof target, pattern, id);
    CLAIM(!http_request_split_target(&request, target));
    const http_route *route = routes_match(route_table, route_count, &request, &response);
    CLAIM(route);
    route_respond(route, service, &request, &response);
    CLAIM(response.status == 200);
    is_sound_answer(&response);
    http_response_clear(&response);
}

#endif
