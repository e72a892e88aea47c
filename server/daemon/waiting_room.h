/* Where requests are that can't be answered at once: parked ones wait for a job to change (?wait=), slow ones for
 * the one thread that runs what may take seconds. Meanwhile their connections are suspended, so none of the HTTP
 * threads is held up. */
#ifndef WAITING_ROOM_H
#define WAITING_ROOM_H

#include <pthread.h>
#include <stdbool.h>

#include "connection_watch.h"
#include "http_exchange.h"

enum { WAITING_ROOM_SLOW_LIMIT = 8 };

typedef struct waiting_room {
    pthread_mutex_t lock;
    pthread_cond_t clock_wakes, slow_wakes;
    http_exchange *parked, *slow, **slow_end;
    int slow_count;
    unsigned long changes; /* how often jobs have changed */
    bool closing;
    pthread_t clock_thread, slow_thread;
    api_service *service;
    connection_watch *watch; /* swept by the clock's thread */
} waiting_room;

bool waiting_room_open(waiting_room *room, api_service *service, connection_watch *watch);
/* Lets everybody go and ends the threads; from then on nobody may wait. */
void waiting_room_close(waiting_room *room);
void waiting_room_jobs_changed(waiting_room *room);
/* changes: as the room said before the handler looked. False: something changed since, look again. */
unsigned long waiting_room_changes(waiting_room *room, bool *closing);
bool waiting_room_park(waiting_room *room, http_exchange *exchange, unsigned long changes, double seconds);
/* False: too many are waiting, or the room is closing. */
bool waiting_room_queue_slow(waiting_room *room, http_exchange *exchange);

#endif
