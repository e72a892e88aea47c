/* Where requests are that can't be answered at once: parked ones wait for a job to change (?wait=), slow ones for a
 * thread of their lane, which runs what may take seconds: one lane for what reads, one for what writes, and one for lists
 * that have much to read in first, which no query of a user is to hold up. Meanwhile their connections are suspended, so none of the HTTP threads is held up. The library does not look at a suspended
 * connection; the clock does, and lets go whoever has closed its end. */
#ifndef WAITING_ROOM_H
#define WAITING_ROOM_H

#include <pthread.h>
#include <stdbool.h>

#include "connection_watch.h"
#include "http_exchange.h"

enum {
    WAITING_ROOM_PARKED = 160, /* of all that may be connected: the others stay for who does not wait */
    WAITING_ROOM_PARKED_PER_ADDRESS = 96,
    WAITING_ROOM_SLOW_LIMIT = 128, /* of each lane */
    WAITING_ROOM_SLOW_PER_ADDRESS = 96,
    WAITING_ROOM_LANES = 3
};

typedef struct slow_lane {
    struct waiting_room *room;
    http_exchange *first;
    uint8_t last[CONNECTION_ADDRESS_SIZE]; /* of the client whose request was taken last */
    int count;
    pthread_cond_t wakes;
    pthread_t thread;
} slow_lane;

typedef struct waiting_room {
    pthread_mutex_t lock;
    pthread_cond_t clock_wakes;
    http_exchange *parked;
    slow_lane lane[WAITING_ROOM_LANES];
    unsigned long changes; /* how often jobs have changed */
    bool closing;
    pthread_t clock_thread;
    api_service *service;
    connection_watch *watch; /* swept by the clock's thread */
} waiting_room;

typedef enum parking { PARKING_DONE, PARKING_JOBS_CHANGED, PARKING_FULL } parking;

bool waiting_room_open(waiting_room *room, api_service *service, connection_watch *watch);
/* Lets everybody go, stops what the lanes run and ends the threads; from then on nobody may wait. */
void waiting_room_close(waiting_room *room);
void waiting_room_jobs_changed(waiting_room *room);
unsigned long waiting_room_changes(waiting_room *room, bool *closing);
/* changes: as the room said before the handler looked. PARKING_JOBS_CHANGED: something changed since, look again. */
parking waiting_room_park(waiting_room *room, http_exchange *exchange, unsigned long changes, double seconds);
/* False: too many are waiting, or the room is closing. */
bool waiting_room_queue_slow(waiting_room *room, http_exchange *exchange);
/* Whether what is being done for this exchange is for nobody: its client has left, or the daemon leaves. */
bool waiting_room_has_left(void *exchange);

#endif
