/* While the machine can't run jobs (a full disk, no memory, no processes), none is started for a while: intervals that grow,
 * after each of which a single worker tries. */
#ifndef QUEUE_PAUSE_H
#define QUEUE_PAUSE_H

#include <stdbool.h>

typedef struct queue_pause {
    int setbacks;         /* in a row; 0: the machine is sound */
    double since, length; /* monotonic s of the latest setback, and how long nothing is started from then on */
} queue_pause;

/* A worker could not be started, or could not go on, for want of something of the machine. */
void queue_pause_add(queue_pause *pause, double now);
/* Nothing is to be started now. */
bool queue_pause_holds(const queue_pause *pause, double now);
/* Whether a worker that was started then is the one that tries: nothing else is started beside it. */
bool queue_pause_is_trying(const queue_pause *pause, double started);
/* A worker that was started then is well now: if it tries and has been at work for longer than the pause was, the machine
 * is sound again. */
void queue_pause_note_well(queue_pause *pause, double started, double now);
/* A worker that was started then came to its end by itself. */
void queue_pause_note_end(queue_pause *pause, double started);

#endif
