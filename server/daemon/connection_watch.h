/* Closes connections on which no whole request arrives in time.
 *
 * The library's own timeout counts silence only: a client that sends one byte every two seconds would keep its
 * connection for ever. Here the time runs from the connection, or the last answer, to the end of a request. */
#ifndef CONNECTION_WATCH_H
#define CONNECTION_WATCH_H

#include <pthread.h>

typedef struct watched_connection {
    int socket;
    double reading_since; /* monotonic s; 0: a whole request is being answered */
    struct watched_connection *next, *previous;
} watched_connection;

typedef struct connection_watch {
    pthread_mutex_t lock;
    watched_connection *first;
} connection_watch;

void connection_watch_init(connection_watch *watch);
void connection_watch_clear(connection_watch *watch);
watched_connection *connection_watch_add(connection_watch *watch, int socket); /* NULL: no memory */
void connection_watch_remove(connection_watch *watch, watched_connection *connection);
void connection_watch_set_reading(connection_watch *watch, watched_connection *connection, int reading);
/* Shuts down what has been reading for too long. */
void connection_watch_sweep(connection_watch *watch);

#endif
