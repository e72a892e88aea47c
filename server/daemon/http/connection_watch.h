/* Closes connections that hold a place for nothing: no whole request arrives in time, an answer is not taken, or places
 * run short and nothing is being asked on them.
 *
 * The library's own timeout counts silence only: a client that sends, or reads, one byte every two seconds would keep
 * its connection for ever. Here the time runs from the connection, or the last answer, to the end of a request, and an
 * answer must go out at some least speed. */
#ifndef CONNECTION_WATCH_H
#define CONNECTION_WATCH_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <sys/socket.h>

enum { CONNECTION_ADDRESS_SIZE = 16 };

typedef struct watched_connection {
    int socket;
    bool is_stream;                           /* its answer goes on until the client leaves */
    double next_look;                         /* monotonic s: at a stream */
    bool is_going;                            /* it was shut down, and its place counts as free */
    uint8_t address[CONNECTION_ADDRESS_SIZE]; /* of the client: connection_address */
    size_t held;                              /* bytes of bodies and answers in memory that count */
    double reading_since;                     /* monotonic s; 0: a whole request is being answered */
    double sending_since, stalled_since;      /* monotonic s; 0: nothing is sent; it gets on */
    uint64_t taken_before, taken;             /* bytes that the client has taken: when sending began, at the last sweep */
    struct watched_connection *next, *previous;
} watched_connection;

typedef struct connection_watch {
    pthread_mutex_t lock;
    watched_connection *first;
    int most;          /* connections but streams; 0: any number */
    int count, enough; /* of those; from so many on, those that ask nothing make room for others */
    int most_of_address;
} connection_watch;

/* Who counts as one client: an address of IPv4, also where it comes as one of IPv6, or the first half of one of IPv6, since
 * whoever has one of these has all with that half. */
void connection_address(uint8_t address[CONNECTION_ADDRESS_SIZE], const struct sockaddr *from);

void connection_watch_init(connection_watch *watch, int enough, int most_of_address);
void connection_watch_clear(connection_watch *watch);
/* Whether a further connection of this address is taken. Where it has its share, one that asks nothing makes room. */
bool connection_watch_admits(connection_watch *watch, const struct sockaddr *address);
/* NULL: no memory. */
watched_connection *connection_watch_add(connection_watch *watch, int socket, const struct sockaddr *address);
void connection_watch_remove(connection_watch *watch, watched_connection *connection);
void connection_watch_set_reading(connection_watch *watch, watched_connection *connection, int reading);
void connection_watch_set_sending(connection_watch *watch, watched_connection *connection);
/* What it is sent from now on has no end: it no longer counts but for its address, and goes when nothing is taken for a minute. */
void connection_watch_set_stream(connection_watch *watch, watched_connection *connection);
/* Shuts down what has been reading, or not taking its answer, for too long. */
void connection_watch_sweep(connection_watch *watch);
/* The same for every answer of which nothing has been taken for some seconds. */
void connection_watch_drop_stalled(connection_watch *watch);

/* Counts bytes in memory for the connection. False: with these its address would hold more than `most`, and already holds some. */
bool connection_watch_hold(connection_watch *watch, watched_connection *connection, size_t bytes, size_t most);
void connection_watch_release(connection_watch *watch, watched_connection *connection, size_t bytes);

/* Whether the client has closed its end. The socket must be open. */
bool connection_is_closed(int socket);
bool connection_is_from(const watched_connection *connection, const watched_connection *other);

#endif
