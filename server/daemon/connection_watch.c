#include "connection_watch.h"

#include <stdlib.h>
#include <sys/socket.h>

#include "log.h"

#define SECONDS_FOR_A_REQUEST 15.0

void connection_watch_init(connection_watch *watch)
{
    watch->first = NULL;
    pthread_mutex_init(&watch->lock, NULL);
}

void connection_watch_clear(connection_watch *watch) { pthread_mutex_destroy(&watch->lock); }

watched_connection *connection_watch_add(connection_watch *watch, int socket)
{
    watched_connection *connection = malloc(sizeof *connection);
    if (!connection) return NULL;
    *connection = (watched_connection){ .socket = socket, .reading_since = monotonic_seconds() };
    pthread_mutex_lock(&watch->lock);
    connection->next = watch->first;
    if (watch->first) watch->first->previous = connection;
    watch->first = connection;
    pthread_mutex_unlock(&watch->lock);
    return connection;
}

void connection_watch_remove(connection_watch *watch, watched_connection *connection)
{
    if (!connection) return;
    pthread_mutex_lock(&watch->lock);
    if (connection->previous) connection->previous->next = connection->next;
    else watch->first = connection->next;
    if (connection->next) connection->next->previous = connection->previous;
    pthread_mutex_unlock(&watch->lock);
    free(connection);
}

void connection_watch_set_reading(connection_watch *watch, watched_connection *connection, int reading)
{
    if (!connection) return;
    pthread_mutex_lock(&watch->lock);
    connection->reading_since = reading ? monotonic_seconds() : 0.0;
    pthread_mutex_unlock(&watch->lock);
}

/* A socket is taken off the list before it is closed, and here the list is locked: the number can't have become
 * another connection's. */
void connection_watch_sweep(connection_watch *watch)
{
    const double latest = monotonic_seconds() - SECONDS_FOR_A_REQUEST;
    pthread_mutex_lock(&watch->lock);
    for (watched_connection *c = watch->first; c; c = c->next)
        if (c->reading_since > 0.0 && c->reading_since < latest) shutdown(c->socket, SHUT_RDWR);
    pthread_mutex_unlock(&watch->lock);
}
