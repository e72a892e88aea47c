#include "connection_watch.h"

#include <linux/tcp.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "log.h"

#define SECONDS_FOR_A_REQUEST 15.0
#define SECONDS_TO_BEGIN 20.0         /* in which an answer may go out at any speed */
#define LEAST_BYTES_PER_SECOND 1000.0 /* from then on, on the average */
#define SECONDS_OF_A_STALL 3.0
#define SECONDS_BETWEEN_LOOKS_AT_STREAMS 10.0
#define SECONDS_OF_A_DEAD_STREAM 60.0 /* several beats (event_hub.c) */

void connection_watch_init(connection_watch *watch, int enough, int most_of_address)
{
    *watch = (connection_watch){ .enough = enough, .most_of_address = most_of_address };
    pthread_mutex_init(&watch->lock, NULL);
}

void connection_watch_clear(connection_watch *watch) { pthread_mutex_destroy(&watch->lock); }

static const uint8_t mapped[12] = { [10] = 0xff, [11] = 0xff }; /* before an address of IPv4 */

void connection_address(uint8_t address[CONNECTION_ADDRESS_SIZE], const struct sockaddr *from)
{
    memset(address, 0, CONNECTION_ADDRESS_SIZE);
    if (from && from->sa_family == AF_INET) {
        memcpy(address, mapped, sizeof mapped);
        memcpy(address + sizeof mapped, &((const struct sockaddr_in *)(const void *)from)->sin_addr, 4);
    } else if (from && from->sa_family == AF_INET6) {
        const struct in6_addr *six = &((const struct sockaddr_in6 *)(const void *)from)->sin6_addr;
        const bool is_four = memcmp(six, mapped, sizeof mapped) == 0;
        memcpy(address, six, is_four ? CONNECTION_ADDRESS_SIZE : CONNECTION_ADDRESS_SIZE / 2);
    }
}

bool connection_is_from(const watched_connection *connection, const watched_connection *other)
{
    return connection && other && memcmp(connection->address, other->address, CONNECTION_ADDRESS_SIZE) == 0;
}

bool connection_is_closed(int socket)
{
    struct pollfd end = { .fd = socket, .events = POLLRDHUP };
    return poll(&end, 1, 0) > 0 && (end.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
}

/* With the lock held. */
static int count_from(const connection_watch *watch, const watched_connection *address)
{
    int count = 0;
    for (const watched_connection *c = watch->first; c; c = c->next) count += !c->is_going && connection_is_from(c, address);
    return count;
}

static void let_go(watched_connection *connection)
{
    shutdown(connection->socket, SHUT_RDWR);
    connection->reading_since = connection->stalled_since = 0.0; /* it goes; the next one is another */
    connection->is_going = true;
}

/* Of the address that has the most connections, the one that has asked nothing for longest, or else the one that has
 * not taken its answer for longest. */
static void make_room(connection_watch *watch)
{
    watched_connection *victim = NULL;
    int most = 0;
    for (watched_connection *c = watch->first; c; c = c->next) {
        const bool asks_nothing = c->reading_since > 0.0;
        if (c->is_stream || (!asks_nothing && c->stalled_since <= 0.0)) continue;
        const int count = victim && connection_is_from(c, victim) ? most : count_from(watch, c);
        const bool longer = victim && count == most
                            && (asks_nothing ? victim->reading_since <= 0.0 || c->reading_since < victim->reading_since
                                             : victim->reading_since <= 0.0 && c->stalled_since < victim->stalled_since);
        if (victim && count <= most && !longer) continue;
        victim = c;
        most = count;
    }
    if (victim) let_go(victim);
}

/* With the lock held: whether it was so. */
static bool drop_idle_of(connection_watch *watch, const watched_connection *address)
{
    watched_connection *victim = NULL;
    for (watched_connection *c = watch->first; c; c = c->next)
        if (connection_is_from(c, address) && c->reading_since > 0.0 && (!victim || c->reading_since < victim->reading_since))
            victim = c;
    if (victim) let_go(victim);
    return victim != NULL;
}

bool connection_watch_admits(connection_watch *watch, const struct sockaddr *address)
{
    watched_connection asking;
    connection_address(asking.address, address);
    pthread_mutex_lock(&watch->lock);
    const bool has_place = watch->most == 0 || watch->count < watch->most;
    const bool admitted = has_place && (count_from(watch, &asking) < watch->most_of_address || drop_idle_of(watch, &asking));
    pthread_mutex_unlock(&watch->lock);
    return admitted;
}

watched_connection *connection_watch_add(connection_watch *watch, int socket, const struct sockaddr *address)
{
    watched_connection *connection = malloc(sizeof *connection);
    if (!connection) return NULL;
    *connection = (watched_connection){ .socket = socket };
    connection_address(connection->address, address);
    pthread_mutex_lock(&watch->lock);
    if (watch->count >= watch->enough) make_room(watch);
    watch->count++;
    connection->reading_since = monotonic_seconds();
    connection->next = watch->first;
    if (watch->first) watch->first->previous = connection;
    watch->first = connection;
    /* Several threads may have admitted one each while there was room for one. */
    if (count_from(watch, connection) > watch->most_of_address && !drop_idle_of(watch, connection)) let_go(connection);
    pthread_mutex_unlock(&watch->lock);
    return connection;
}

void connection_watch_remove(connection_watch *watch, watched_connection *connection)
{
    if (!connection) return;
    pthread_mutex_lock(&watch->lock);
    if (!connection->is_stream) watch->count--;
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
    connection->sending_since = connection->stalled_since = 0.0;
    pthread_mutex_unlock(&watch->lock);
}

/* Bytes that the other end has acknowledged since the connection began. */
static uint64_t bytes_taken(int socket)
{
    struct tcp_info facts = { 0 };
    socklen_t size = sizeof facts;
    return getsockopt(socket, IPPROTO_TCP, TCP_INFO, &facts, &size) == 0 ? facts.tcpi_bytes_acked : 0;
}

void connection_watch_set_sending(connection_watch *watch, watched_connection *connection)
{
    if (!connection) return;
    pthread_mutex_lock(&watch->lock);
    connection->reading_since = 0.0;
    connection->sending_since = monotonic_seconds();
    connection->taken_before = connection->taken = bytes_taken(connection->socket);
    pthread_mutex_unlock(&watch->lock);
}

void connection_watch_set_stream(connection_watch *watch, watched_connection *connection)
{
    if (!connection) return;
    pthread_mutex_lock(&watch->lock);
    if (!connection->is_stream) watch->count--;
    connection->is_stream = true;
    pthread_mutex_unlock(&watch->lock);
}

static bool takes_too_long(watched_connection *c, double now)
{
    if (c->reading_since > 0.0) return now - c->reading_since > SECONDS_FOR_A_REQUEST;
    if (c->sending_since <= 0.0 || now < c->next_look) return false;
    if (c->is_stream) c->next_look = now + SECONDS_BETWEEN_LOOKS_AT_STREAMS;
    const uint64_t taken = bytes_taken(c->socket);
    if (taken != c->taken) c->stalled_since = 0.0;
    else if (c->stalled_since <= 0.0) c->stalled_since = now;
    c->taken = taken;
    if (c->is_stream) return c->stalled_since > 0.0 && now - c->stalled_since > SECONDS_OF_A_DEAD_STREAM;
    const double seconds = now - c->sending_since - SECONDS_TO_BEGIN;
    return seconds > 0.0 && (double)(taken - c->taken_before) < LEAST_BYTES_PER_SECOND * seconds;
}

/* A socket is taken off the list before it is closed, and here the list is locked: the number can't have become
 * another connection's. */
void connection_watch_sweep(connection_watch *watch)
{
    const double now = monotonic_seconds();
    pthread_mutex_lock(&watch->lock);
    for (watched_connection *c = watch->first; c; c = c->next)
        if (takes_too_long(c, now)) shutdown(c->socket, SHUT_RDWR);
    pthread_mutex_unlock(&watch->lock);
}

void connection_watch_drop_stalled(connection_watch *watch)
{
    const double now = monotonic_seconds();
    pthread_mutex_lock(&watch->lock);
    for (watched_connection *c = watch->first; c; c = c->next)
        if (!c->is_stream && c->stalled_since > 0.0 && now - c->stalled_since >= SECONDS_OF_A_STALL) shutdown(c->socket, SHUT_RDWR);
    pthread_mutex_unlock(&watch->lock);
}

bool connection_watch_hold(connection_watch *watch, watched_connection *connection, size_t bytes, size_t most)
{
    size_t before = 0;
    pthread_mutex_lock(&watch->lock);
    for (const watched_connection *c = watch->first; c; c = c->next) before += connection_is_from(c, connection) ? c->held : 0;
    const bool fits = before == 0 || before + bytes <= most;
    if (fits) connection->held += bytes;
    pthread_mutex_unlock(&watch->lock);
    return fits;
}

void connection_watch_release(connection_watch *watch, watched_connection *connection, size_t bytes)
{
    pthread_mutex_lock(&watch->lock);
    if (connection) connection->held -= bytes;
    pthread_mutex_unlock(&watch->lock);
}
