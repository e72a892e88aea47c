#include "waiting_room.h"

#include <math.h>
#include <time.h>

#include "log.h"

#define SECONDS_BETWEEN_SWEEPS 5.0

/* --- parked: the clock's thread --- */

/* With the lock held. */
static void release_parked(waiting_room *room, double now, bool everybody)
{
    http_exchange **link = &room->parked;
    while (*link) {
        http_exchange *exchange = *link;
        if (everybody || exchange->resume_at <= now) {
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
    for (const http_exchange *e = room->parked; e; e = e->next) at = fmin(at, e->resume_at);
    return (struct timespec){ (time_t)at, (long)((at - floor(at)) * 1e9) };
}

static void *run_clock(void *context)
{
    waiting_room *room = context;
    double swept = 0.0;
    pthread_mutex_lock(&room->lock);
    while (!room->closing) {
        const double now = monotonic_seconds();
        release_parked(room, now, false);
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

bool waiting_room_park(waiting_room *room, http_exchange *exchange, unsigned long changes, double seconds)
{
    pthread_mutex_lock(&room->lock);
    const bool parks = room->changes == changes && !room->closing;
    if (parks) {
        exchange->resume_at = monotonic_seconds() + seconds;
        exchange->next = room->parked;
        room->parked = exchange;
        MHD_suspend_connection(exchange->connection);
        pthread_cond_signal(&room->clock_wakes);
    }
    pthread_mutex_unlock(&room->lock);
    return parks;
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

/* --- slow: one thread --- */

bool waiting_room_queue_slow(waiting_room *room, http_exchange *exchange)
{
    pthread_mutex_lock(&room->lock);
    const bool fits = room->slow_count < WAITING_ROOM_SLOW_LIMIT && !room->closing;
    if (fits) {
        exchange->next = NULL;
        *room->slow_end = exchange;
        room->slow_end = &exchange->next;
        room->slow_count++;
        MHD_suspend_connection(exchange->connection);
        pthread_cond_signal(&room->slow_wakes);
    }
    pthread_mutex_unlock(&room->lock);
    return fits;
}

static http_exchange *take_slow(waiting_room *room)
{
    pthread_mutex_lock(&room->lock);
    while (!room->slow && !room->closing) pthread_cond_wait(&room->slow_wakes, &room->lock);
    http_exchange *exchange = room->slow;
    if (exchange) {
        room->slow = exchange->next;
        if (!room->slow) room->slow_end = &room->slow;
        room->slow_count--;
    }
    pthread_mutex_unlock(&room->lock);
    return exchange;
}

static void *run_slow(void *context)
{
    waiting_room *room = context;
    for (http_exchange *exchange; (exchange = take_slow(room)) != NULL;) {
        const double start = monotonic_seconds();
        route_respond(exchange->route, room->service, &exchange->request, &exchange->response);
        exchange->worked = monotonic_seconds() - start;
        exchange->stage = EXCHANGE_ANSWERED;
        MHD_resume_connection(exchange->connection);
    }
    return NULL;
}

/* --- opening and closing --- */

bool waiting_room_open(waiting_room *room, api_service *service, connection_watch *watch)
{
    *room = (waiting_room){ .service = service, .watch = watch };
    room->slow_end = &room->slow;
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&room->lock, NULL);
    pthread_cond_init(&room->clock_wakes, &monotonic);
    pthread_cond_init(&room->slow_wakes, NULL);
    pthread_condattr_destroy(&monotonic);
    if (pthread_create(&room->clock_thread, NULL, run_clock, room) != 0) return false;
    if (pthread_create(&room->slow_thread, NULL, run_slow, room) == 0) return true;
    room->closing = true;
    pthread_cond_signal(&room->clock_wakes);
    pthread_join(room->clock_thread, NULL);
    return false;
}

void waiting_room_close(waiting_room *room)
{
    pthread_mutex_lock(&room->lock);
    room->closing = true;
    pthread_cond_broadcast(&room->clock_wakes);
    pthread_cond_broadcast(&room->slow_wakes);
    pthread_mutex_unlock(&room->lock);
    pthread_join(room->clock_thread, NULL);
    pthread_join(room->slow_thread, NULL);
}
