/* Whether anybody still waits for an answer: what takes long looks now and then, and stops where nobody does. */
#ifndef CLIENT_WATCH_H
#define CLIENT_WATCH_H

#include <stdbool.h>
#include <stddef.h>

typedef struct client_watch {
    bool (*has_left)(void *client); /* takes about a microsecond; NULL: the client stays */
    void *client;
} client_watch;

static inline bool client_has_left(const client_watch *watch) { return watch && watch->has_left && watch->has_left(watch->client); }

#endif
