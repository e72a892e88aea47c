#include "event_hub.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "job_changes.h"

#define SECONDS_BETWEEN_BEATS 15.0 /* so that proxies, and whoever has lost the connection, notice */
#define ROUND_NS 100000000         /* changes of this time go together */

enum { READ_AT_ONCE = 1024, LONGEST_EVENT = 8 << 10 };

struct event_stream {
    event_hub *hub;
    struct MHD_Connection *connection;
    const watched_connection *watched;
    uint64_t sent;    /* number of the newest event that it has */
    size_t sent_part; /* bytes of the next one */
    enum { NOTHING_DUE, BEAT_DUE, MISSED_DUE, BEGINNING_DUE } due;
    bool is_suspended;
    event_stream *next, *previous;
};

/* --- what is sent --- */

static const char *event_numbered(const event_hub *hub, uint64_t number) { return hub->event[number % EVENT_HUB_KEPT]; }

/* With the lock held. "jobs" says no more than that a list may be another now. */
static void keep_event(event_hub *hub, const char *name, const char *data)
{
    char *text = NULL;
    const uint64_t number = hub->last + 1;
    if (asprintf(&text, "id: %llx-%llu\nevent: %s\ndata: %s\n\n", hub->begun, (unsigned long long)number, name, data) < 0)
        text = NULL;
    free(hub->event[number % EVENT_HUB_KEPT]);
    hub->event[number % EVENT_HUB_KEPT] = text; /* NULL, where there is no memory: those who miss it are told */
    hub->last = number;
    if (hub->oldest + EVENT_HUB_KEPT <= number) hub->oldest = number - EVENT_HUB_KEPT + 1;
    if (!text) hub->oldest = number + 1;
}

static json_t *describe(const job_record *job)
{
    json_t *data = json_pack("{s:s, s:s, s:s, s:s, s:i, s:i, s:s}", "jobID", job->id, "processID", job->process, "status",
                             job_status_name(job->status), "message", job->message, "progress", (int)job->progress, "attempt",
                             job->attempt, "updated", job->updated);
    if (data && job->status == JOB_RUNNING && isfinite(job->eta_seconds))
        json_object_set_new(data, "eta_seconds", json_real(job->eta_seconds));
    if (data && *job->study) json_object_set_new(data, "studyID", json_string(job->study));
    return data;
}

/* False: it is not there any more. */
static bool tell_job(event_hub *hub, int64_t number)
{
    job_record job;
    const store_status status = store_find_numbered_job(hub->store, number, &job);
    if (status != STORE_OK) return false;
    json_t *data = describe(&job);
    char *text = data ? json_dumps(data, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    pthread_mutex_lock(&hub->lock);
    keep_event(hub, text ? "job" : "jobs", text ? text : "{\"reason\":\"missed\"}");
    pthread_mutex_unlock(&hub->lock);
    free(text);
    json_decref(data);
    job_record_clear(&job);
    return true;
}

static void tell_all(event_hub *hub, const char *reason)
{
    char data[40];
    snprintf(data, sizeof data, "{\"reason\":\"%s\"}", reason);
    pthread_mutex_lock(&hub->lock);
    keep_event(hub, "jobs", data);
    pthread_mutex_unlock(&hub->lock);
}

/* False: nobody listens, and what would have been told is missed by who comes back. */
static bool has_listeners(event_hub *hub)
{
    pthread_mutex_lock(&hub->lock);
    const bool any = hub->streams > 0;
    if (!any) hub->oldest = ++hub->last + 1;
    pthread_mutex_unlock(&hub->lock);
    return any;
}

static void tell(event_hub *hub, const changed_jobs *changed)
{
    if (!has_listeners(hub)) return;
    bool any_gone = false;
    if (changed->are_more) tell_all(hub, "many");
    for (size_t i = 0; !changed->are_more && i < changed->count; i++)
        if (!tell_job(hub, changed->number[i])) any_gone = true;
    if (any_gone) tell_all(hub, "deleted");
}

/* --- the thread --- */

static void resume_all(event_hub *hub, bool beat)
{
    pthread_mutex_lock(&hub->lock);
    for (event_stream *stream = hub->first; stream; stream = stream->next) {
        if (!stream->is_suspended) continue;
        if (beat && stream->due == NOTHING_DUE) stream->due = BEAT_DUE;
        stream->is_suspended = false;
        MHD_resume_connection(stream->connection);
    }
    pthread_mutex_unlock(&hub->lock);
}

static void *run(void *context)
{
    event_hub *hub = context;
    double beat = monotonic_seconds();
    for (;;) {
        changed_jobs changed;
        job_changes_take(hub->store->changes, SECONDS_BETWEEN_BEATS, &changed);
        if (changed.is_over) return NULL;
        const bool any = changed.count > 0 || changed.are_more, is_beat = monotonic_seconds() - beat >= SECONDS_BETWEEN_BEATS;
        if (any) tell(hub, &changed);
        if (is_beat) beat = monotonic_seconds();
        if (any || is_beat) resume_all(hub, is_beat);
        if (any) nanosleep(&(struct timespec){ .tv_nsec = ROUND_NS }, NULL);
    }
}

bool event_hub_open(event_hub *hub, job_store *store)
{
    *hub = (event_hub){ .store = store, .begun = (unsigned long long)time(NULL), .oldest = 1 };
    pthread_mutex_init(&hub->lock, NULL);
    return pthread_create(&hub->thread, NULL, run, hub) == 0;
}

void event_hub_close(event_hub *hub)
{
    job_changes_end(hub->store->changes);
    pthread_join(hub->thread, NULL);
    pthread_mutex_lock(&hub->lock);
    hub->is_closing = true;
    pthread_mutex_unlock(&hub->lock);
    resume_all(hub, false);
}

void event_hub_clear(event_hub *hub)
{
    for (size_t k = 0; k < EVENT_HUB_KEPT; k++) free(hub->event[k]);
    pthread_mutex_destroy(&hub->lock);
}

/* --- streams --- */

/* What is to be said before the next event. The id of a beginning is what a client comes back with that has heard nothing since. */
static size_t write_due(event_stream *stream, char *piece, size_t size)
{
    const event_hub *hub = stream->hub;
    char text[120] = "";
    if (stream->due == BEAT_DUE) snprintf(text, sizeof text, ":\n\n");
    if (stream->due == BEGINNING_DUE)
        snprintf(text, sizeof text, "retry: 2000\nid: %llx-%llu\n\n", hub->begun, (unsigned long long)stream->sent);
    if (stream->due == MISSED_DUE)
        snprintf(text, sizeof text, "retry: 2000\nid: %llx-%llu\nevent: jobs\ndata: {\"reason\":\"missed\"}\n\n", hub->begun,
                 (unsigned long long)stream->sent);
    const size_t length = strlen(text);
    if (length > size) return 0;
    memcpy(piece, text, length);
    stream->due = NOTHING_DUE;
    return length;
}

/* A part of the next event, where not all of it fits. */
static size_t write_event(event_stream *stream, char *piece, size_t size)
{
    const event_hub *hub = stream->hub;
    const char *text = event_numbered(hub, stream->sent + 1) + stream->sent_part;
    const size_t left = strlen(text), length = left < size ? left : size;
    memcpy(piece, text, length);
    stream->sent_part = length < left ? stream->sent_part + length : 0;
    if (length == left) stream->sent++;
    return length;
}

/* The library asks for more of the body. Where there is nothing it is not to ask again until it is resumed. */
static ssize_t read_stream(void *context, uint64_t position, char *piece, size_t size)
{
    (void)position;
    event_stream *stream = context;
    event_hub *hub = stream->hub;
    ssize_t result = MHD_CONTENT_READER_END_OF_STREAM;
    pthread_mutex_lock(&hub->lock);
    if (!hub->is_closing) {
        size_t length = 0;
        if (stream->sent + 1 < hub->oldest && stream->sent_part == 0) { /* it has been too slow */
            stream->sent = hub->last;
            stream->due = MISSED_DUE;
        }
        if (stream->due != NOTHING_DUE && stream->sent_part == 0) length = write_due(stream, piece, size);
        const bool is_torn = stream->sent + 1 < hub->oldest;
        while (!is_torn && length < size && stream->sent < hub->last) length += write_event(stream, piece + length, size - length);
        result = is_torn ? MHD_CONTENT_READER_END_WITH_ERROR : (ssize_t)length;
        if (result == 0) {
            stream->is_suspended = true;
            MHD_suspend_connection(stream->connection);
        }
    }
    pthread_mutex_unlock(&hub->lock);
    return result;
}

static void end_stream(void *context)
{
    event_stream *stream = context;
    event_hub *hub = stream->hub;
    pthread_mutex_lock(&hub->lock);
    if (stream->previous) stream->previous->next = stream->next;
    else hub->first = stream->next;
    if (stream->next) stream->next->previous = stream->previous;
    hub->streams--;
    pthread_mutex_unlock(&hub->lock);
    free(stream);
}

/* With the lock held. */
static bool has_place(const event_hub *hub, const watched_connection *watched)
{
    int same = 0;
    for (const event_stream *s = hub->first; s; s = s->next) same += connection_is_from(s->watched, watched);
    return !hub->is_closing && hub->streams < EVENT_HUB_STREAMS && same < EVENT_HUB_STREAMS_PER_ADDRESS;
}

/* With the lock held: where this client left off; else from now on. */
static void set_beginning(event_stream *stream, const char *last_id)
{
    const event_hub *hub = stream->hub;
    unsigned long long begun = 0, number = 0;
    int end = 0;
    stream->sent = hub->last;
    stream->due = last_id ? MISSED_DUE : BEGINNING_DUE;
    if (!last_id || sscanf(last_id, "%16llx-%19llu%n", &begun, &number, &end) != 2 || last_id[end]) return;
    if (begun != hub->begun || number > hub->last || number + 1 < hub->oldest) return;
    stream->sent = number;
    stream->due = BEGINNING_DUE;
}

struct MHD_Response *event_hub_reply(event_hub *hub, const http_exchange *exchange)
{
    event_stream *stream = calloc(1, sizeof *stream);
    struct MHD_Response *reply =
        stream ? MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, READ_AT_ONCE, read_stream, stream, end_stream) : NULL;
    if (!reply) {
        free(stream);
        return NULL;
    }
    *stream = (event_stream){ .hub = hub, .connection = exchange->connection, .watched = exchange->watched };
    pthread_mutex_lock(&hub->lock);
    const bool has_room = has_place(hub, exchange->watched);
    set_beginning(stream, exchange->request.last_event_id);
    hub->streams++; /* end_stream takes it out again */
    stream->next = hub->first;
    if (hub->first) hub->first->previous = stream;
    hub->first = stream;
    pthread_mutex_unlock(&hub->lock);
    if (has_room) return reply;
    MHD_destroy_response(reply);
    return NULL;
}
