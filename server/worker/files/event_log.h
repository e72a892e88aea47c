/* events.ndjson: what a worker tells whoever watches it, one line an event (api/spec/job_folder.h lists them). */
#ifndef EVENT_LOG_H
#define EVENT_LOG_H

#include <jansson.h>
#include <stdbool.h>

typedef struct event_log {
    int fd;
    bool failed; /* a line could not be written: nothing more is */
} event_log;

/* Opens the log of the job folder and locks it for this worker alone: another one's lock is waited for a few
 * seconds. A last line without its end, left by a worker that died, is cut off. */
bool event_log_open(event_log *log);
void event_log_close(event_log *log);
bool event_log_empty(event_log *log); /* forget what another run has left */

/* Takes over the reference; NULL (no memory) fails the log. False once the log has failed. */
bool event_log_add(event_log *log, json_t *event);

/* So that a checkpoint never knows of more than the log does. */
bool event_log_sync(event_log *log);

#endif
