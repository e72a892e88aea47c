#include "waiting_room.h"

#include <math.h>
#include <string.h>
#include <time.h>

#include "log.h"
#include "request_key.h"

#define SECONDS_BETWEEN_SWEEPS 1.0
#define SECONDS_BETWEEN_LOOKS 0.4 /* at who has left */
#define SECONDS_IN_A_LANE 20.0    /* before a request is told to come again */
/* A client may close its end when it has sent its request and still read the answer. It gets one, if that takes less. */
#define SECONDS_OF_A_HALF_CLOSED 0.5

static bool is_abandoned(const http_exchange *exchange, double now)
{
    return now - exchange->arrived > SECONDS_OF_A_HALF_CLOSED && connection_is_closed(exchange->socket);
}

bool waiting_room_has_left(void *context)
{
    const http_exchange *exchange = context;
    waiting_room *room = exchange->room;
    pthread_mutex_lock(&room->lock);
    const bool closing = room->closing;
    pthread_mutex_unlock(&room->lock);
    return closing || is_abandoned(exchange, monotonic_seconds());
}

/* --- parked: the clock's thread --- */

/* With the lock held. */
static void release_parked(waiting_room *room, double now, bool everybody)
{
    http_exchange **link = &room->parked;
    while (*link) {
        http_exchange *exchange = *link;
        exchange->waits_no_more = exchange->waits_no_more || is_abandoned(exchange, now);
        if (everybody || exchange->waits_no_more || exchange->resume_at <= now) {
            *link = exchange->next;
            MHD_resume_connection(exchange->connection);
        } else {
            link = &exchange->next;
        }
    }
}

static struct timespec next_look(const waiting_room *room, double now)
{
    double at = now + SECONDS_BETWEEN_SWEEPS;
    bool anybody = room->parked != NULL;
    for (const slow_lane *lane = room->lane; lane < room->lane + WAITING_ROOM_LANES; lane++) anybody = anybody || lane->first;
    if (anybody) at = fmin(at, now + SECONDS_BETWEEN_LOOKS);
    for (const http_exchange *e = room->parked; e; e = e->next) at = fmin(at, e->resume_at);
    return (struct timespec){ (time_t)at, (long)((at - floor(at)) * 1e9) };
}

static void release_slow(slow_lane *lane, double now);

static void *run_clock(void *context)
{
    waiting_room *room = context;
    double swept = 0.0;
    pthread_mutex_lock(&room->lock);
    while (!room->closing) {
        const double now = monotonic_seconds();
        release_parked(room, now, false);
        for (int i = 0; i < WAITING_ROOM_LANES; i++) release_slow(&room->lane[i], now);
        if (now - swept >= SECONDS_BETWEEN_SWEEPS) {
            connection_watch_sweep(room->watch);
            swept = now;
        }
        const struct timespec until = next_look(room, now);
        pthread_cond_timedwait(&room->clock_wakes, &room->lock, &until);
    }
    release_parked(room, 0.0, true);
    pthread_mutex_unlock(&room->lock);
    return NULL;
}

static bool has_place_to_park(const waiting_room *room, const http_exchange *exchange)
{
    int all = 0, same = 0;
    for (const http_exchange *e = room->parked; e; e = e->next) {
        all++;
        same += connection_is_from(e->watched, exchange->watched);
    }
    return all < WAITING_ROOM_PARKED && same < WAITING_ROOM_PARKED_PER_ADDRESS;
}

parking waiting_room_park(waiting_room *room, http_exchange *exchange, unsigned long changes, double seconds)
{
    pthread_mutex_lock(&room->lock);
    const parking outcome = room->changes != changes || room->closing ? PARKING_JOBS_CHANGED
                            : has_place_to_park(room, exchange)       ? PARKING_DONE
                                                                      : PARKING_FULL;
    if (outcome == PARKING_DONE) {
        exchange->resume_at = monotonic_seconds() + seconds;
        exchange->next = room->parked;
        room->parked = exchange;
        MHD_suspend_connection(exchange->connection);
        pthread_cond_signal(&room->clock_wakes);
    }
    pthread_mutex_unlock(&room->lock);
    return outcome;
}

unsigned long waiting_room_changes(waiting_room *room, bool *closing)
{
    pthread_mutex_lock(&room->lock);
    const unsigned long changes = room->changes;
    *closing = room->closing;
    pthread_mutex_unlock(&room->lock);
    return changes;
}

void waiting_room_jobs_changed(waiting_room *room)
{
    pthread_mutex_lock(&room->lock);
    room->changes++;
    release_parked(room, 0.0, true);
    pthread_mutex_unlock(&room->lock);
}

/* --- slow: a thread a lane --- */

/* With the lock held. */
static bool has_place_in_lane(const slow_lane *lane, const http_exchange *exchange)
{
    int same = 0;
    for (const http_exchange *e = lane->first; e; e = e->next) same += connection_is_from(e->watched, exchange->watched);
    return lane->count < WAITING_ROOM_SLOW_LIMIT && same < WAITING_ROOM_SLOW_PER_ADDRESS;
}

/* What reads and is not slow by its nature came here since there is much to read in before. */
static slow_lane *lane_of(waiting_room *room, const http_exchange *exchange)
{
    const bool reads = strcmp(exchange->route->method, "GET") == 0;
    return &room->lane[!reads ? 1 : exchange->route->slow ? 0 : 2];
}

bool waiting_room_queue_slow(waiting_room *room, http_exchange *exchange)
{
    slow_lane *lane = lane_of(room, exchange);
    pthread_mutex_lock(&room->lock);
    const bool fits = has_place_in_lane(lane, exchange) && !room->closing;
    if (fits) {
        http_exchange **end = &lane->first;
        while (*end) end = &(*end)->next;
        exchange->next = NULL;
        *end = exchange;
        lane->count++;
        MHD_suspend_connection(exchange->connection);
        pthread_cond_signal(&lane->wakes);
    }
    pthread_mutex_unlock(&room->lock);
    return fits;
}

static void take_out(slow_lane *lane, http_exchange **link)
{
    *link = (*link)->next;
    lane->count--;
}

static void answer_without_work(http_exchange *exchange, const char *why)
{
    http_respond_problem(&exchange->response, 503, NULL, "Not answered", "%s; try again later", why);
    exchange->response.retry_after = 5;
    exchange->stage = EXCHANGE_ANSWERED;
    MHD_resume_connection(exchange->connection);
}

/* With the lock held: who has left, or has waited long enough. */
static void release_slow(slow_lane *lane, double now)
{
    for (http_exchange **link = &lane->first; *link;) {
        http_exchange *exchange = *link;
        const bool late = now - exchange->arrived > SECONDS_IN_A_LANE;
        if (!late && !is_abandoned(exchange, now)) {
            link = &exchange->next;
            continue;
        }
        take_out(lane, link);
        answer_without_work(exchange, late ? "others took all the time" : "the client has left");
    }
}

/* The oldest of another client than the last one, if there is any: so one that asks much leaves room for others. */
static http_exchange *take_slow(slow_lane *lane)
{
    waiting_room *room = lane->room;
    pthread_mutex_lock(&room->lock);
    while (!lane->first && !room->closing) pthread_cond_wait(&lane->wakes, &room->lock);
    while (room->closing && lane->first) {
        http_exchange *exchange = lane->first;
        take_out(lane, &lane->first);
        answer_without_work(exchange, "the service is leaving");
    }
    http_exchange **link = &lane->first, *exchange = NULL;
    while (*link && memcmp((*link)->watched->address, lane->last, CONNECTION_ADDRESS_SIZE) == 0) link = &(*link)->next;
    if (!*link) link = &lane->first;
    if (*link) {
        exchange = *link;
        memcpy(lane->last, exchange->watched->address, sizeof lane->last);
        take_out(lane, link);
    }
    pthread_mutex_unlock(&room->lock);
    return exchange;
}

static void *run_slow(void *context)
{
    slow_lane *lane = context;
    for (http_exchange *exchange; (exchange = take_slow(lane)) != NULL;) {
        const double start = monotonic_seconds();
        http_response_clear(&exchange->response);
        exchange->request.in_lane = true;
        respond_once(exchange->route, lane->room->service, &exchange->request, &exchange->response);
        exchange->worked = monotonic_seconds() - start;
        /* What has begun in the lane may wait outside of it. */
        if (exchange->response.wait > 0.0) memcpy(exchange->request.made, exchange->response.made, sizeof exchange->request.made);
        else exchange->stage = EXCHANGE_ANSWERED;
        MHD_resume_connection(exchange->connection);
    }
    return NULL;
}

/* --- opening and closing --- */

static void wake_all(waiting_room *room)
{
    pthread_mutex_lock(&room->lock);
    room->closing = true;
    pthread_cond_broadcast(&room->clock_wakes);
    for (int i = 0; i < WAITING_ROOM_LANES; i++) pthread_cond_broadcast(&room->lane[i].wakes);
    pthread_mutex_unlock(&room->lock);
}

bool waiting_room_open(waiting_room *room, api_service *service, connection_watch *watch)
{
    *room = (waiting_room){ .service = service, .watch = watch };
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&room->lock, NULL);
    pthread_cond_init(&room->clock_wakes, &monotonic);
    pthread_condattr_destroy(&monotonic);
    for (int i = 0; i < WAITING_ROOM_LANES; i++) {
        room->lane[i].room = room;
        pthread_cond_init(&room->lane[i].wakes, NULL);
    }
    bool good = pthread_create(&room->clock_thread, NULL, run_clock, room) == 0;
    for (int i = 0; good && i < WAITING_ROOM_LANES; i++)
        good = pthread_create(&room->lane[i].thread, NULL, run_slow, &room->lane[i]) == 0;
    if (!good) wake_all(room); /* the threads that were made end; so does the process */
    return good;
}

void waiting_room_close(waiting_room *room)
{
    wake_all(room);
    pthread_join(room->clock_thread, NULL);
    for (int i = 0; i < WAITING_ROOM_LANES; i++) pthread_join(room->lane[i].thread, NULL);
}
