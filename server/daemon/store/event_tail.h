/* Reads what a worker has appended to its events.ndjson since the last look. */
#ifndef EVENT_TAIL_H
#define EVENT_TAIL_H

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct event_batch {
    bool any;
    double progress, eta_seconds, speed; /* of the latest progress event; NaN: none */
    char phase[24];                      /* "" none */
    json_t *samples, *snapshots;         /* arrays of events, in order; owned */
    json_t *checkpoints;                 /* as these */
    char bed[65];                        /* SHA-256 of the settled bed; "": none was told of */
    json_t *failure;                     /* the failure event since the latest start, or NULL; owned */
    int64_t end;                         /* offset up to which the file has been read */
    bool more;                           /* the batch was full before the file's end */
} event_batch;

/* file: descriptor for reading. Lines that are not whole yet are left for the next look; lines that are no event
 * are skipped. False: no memory or a read error; nothing is kept. */
bool event_tail_read(int file, int64_t offset, event_batch *batch);
void event_batch_clear(event_batch *batch);

#endif
