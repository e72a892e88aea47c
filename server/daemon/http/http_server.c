#include "http_server.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "http_panic.h"
#include "http_reply.h"
#include "log.h"
#include "request_key.h"

enum {
    HTTP_THREADS = 16,         /* most of them wait for the disk: jobs that are posted at once share a commit */
    MOST_CONNECTIONS = 512,    /* more than may be parked and wait in the lanes: some are always left, */
    ENOUGH_CONNECTIONS = 448,  /* and from here on those that ask nothing, or take no answer, make room for new ones */
    ADDRESS_CONNECTIONS = 320, /* of one address; the others stay for others */
    CONNECTION_MEMORY = 32768,
    THREAD_STACK = 1 << 20, /* JSON nests up to 2048 deep */
    SILENCE_SECONDS = 20,
    DROPPED_BODY_LIMIT = 16 << 20,
    SMALL = 64 << 10,              /* bytes that nobody counts: as many as connections, they are still bearable */
    MOST_BODY_BYTES = 64 << 20,    /* of all large bodies that are being read */
    MOST_ANSWER_BYTES = 64 << 20,  /* of all large answers that are on their way to clients, who may be slow to read them */
    MOST_ADDRESS_BYTES = 32 << 20, /* of both, for one address */
    LAST_ANSWERS_MS = 2000         /* that the answers under way have at the end, before their connections are cut */
};

/* --- memory in sum --- */

typedef enum holding { HELD, ADDRESS_IS_FULL, ALL_IS_FULL } holding;

/* A single one always fits. */
static holding hold(http_exchange *exchange, atomic_size_t *sum, size_t bytes, size_t most, size_t *held)
{
    connection_watch *watch = &exchange->server->watch;
    if (bytes <= SMALL) return HELD;
    if (!connection_watch_hold(watch, exchange->watched, bytes, MOST_ADDRESS_BYTES)) return ADDRESS_IS_FULL;
    const size_t before = atomic_fetch_add(sum, bytes);
    if (before > 0 && before + bytes > most) {
        atomic_fetch_sub(sum, bytes);
        connection_watch_release(watch, exchange->watched, bytes);
        return ALL_IS_FULL;
    }
    *held = bytes;
    return HELD;
}

static void refuse_held(http_exchange *exchange, holding why, const char *title, const char *detail)
{
    http_response *response = &exchange->response;
    http_response_clear(response);
    if (why == ADDRESS_IS_FULL)
        http_respond_problem(response, 429, NULL, "Too much of one address",
                             "what this address sends and has not read yet fills its share of the memory, %d MB; try again later",
                             MOST_ADDRESS_BYTES >> 20);
    else http_respond_problem(response, 503, NULL, title, "%s", detail);
    response->retry_after = 2;
}

/* Where the answers that are on their way fill the memory, those that nobody reads go, and this one is to be asked for
 * again. */
static void hold_answer(http_exchange *exchange)
{
    http_server *server = exchange->server;
    const http_response *response = &exchange->response;
    if (!response->body) return;
    const holding held = hold(exchange, &server->answers_held, response->length, MOST_ANSWER_BYTES, &exchange->answer_held);
    if (held == HELD) return;
    connection_watch_drop_stalled(&server->watch);
    refuse_held(exchange, held, "Too much on its way",
                "long answers that other clients are still reading fill the memory; try again later");
}

/* --- answering --- */

/* NULL: too many follow the jobs already, and the response says so. */
static struct MHD_Response *stream_of(http_exchange *exchange)
{
    http_response *response = &exchange->response;
    struct MHD_Response *reply = event_hub_reply(&exchange->server->hub, exchange);
    if (reply) {
        http_reply_add_headers(reply, &exchange->request, response);
        return reply;
    }
    http_respond_problem(
        response, 503, NULL, "Too many follow the jobs",
        "there are as many streams of events as may be, %d in all and %d of one address; ask for the list now and then",
        EVENT_HUB_STREAMS, EVENT_HUB_STREAMS_PER_ADDRESS);
    response->is_stream = false;
    response->retry_after = 60;
    return NULL;
}

static enum MHD_Result send_response(http_exchange *exchange)
{
    http_response *response = &exchange->response;
    hold_answer(exchange);
    const bool streams = response->is_stream && strcmp(exchange->request.method, "HEAD") != 0;
    struct MHD_Response *reply = streams ? stream_of(exchange) : NULL;
    if (!reply) reply = http_reply_make(&exchange->request, response);
    if (!reply) return MHD_NO;
    metrics_count(&exchange->server->metrics, exchange->route, response->status, exchange->worked);
    MHD_add_response_header(reply, "X-Request-Id", exchange->id);
    log_set_request(exchange->id);
    log_request(exchange->request.method, exchange->request.path, response->status, exchange->worked);
    log_set_request("");
    connection_watch_set_sending(&exchange->server->watch, exchange->watched);
    if (streams && response->is_stream) connection_watch_set_stream(&exchange->server->watch, exchange->watched);
    const enum MHD_Result result = MHD_queue_response(exchange->connection, (unsigned)response->status, reply);
    MHD_destroy_response(reply);
    return result;
}

/* The client's own id where it sent a plain one, else one that nothing else has. */
static void name_request(http_exchange *exchange)
{
    static atomic_ullong count;
    const char *sent = exchange->request.request_id;
    const size_t length = sent ? strlen(sent) : 0;
    if (length > 0 && length < sizeof exchange->id
        && strspn(sent, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~") == length)
        memcpy(exchange->id, sent, length + 1);
    else
        snprintf(exchange->id, sizeof exchange->id, "%lx-%llx", (unsigned long)time(NULL),
                 (unsigned long long)atomic_fetch_add(&count, 1) + 1);
}

static enum MHD_Result answer_slowly(http_exchange *exchange)
{
    if (waiting_room_queue_slow(&exchange->server->room, exchange)) return MHD_YES;
    http_respond_problem(&exchange->response, 503, NULL, "Too many requests that take long",
                         "%d wait already, or %d of this address; try again later", WAITING_ROOM_SLOW_LIMIT,
                         WAITING_ROOM_SLOW_PER_ADDRESS);
    exchange->response.retry_after = 5;
    return send_response(exchange);
}

static enum MHD_Result answer(http_exchange *exchange)
{
    http_server *server = exchange->server;
    if (exchange->stage == EXCHANGE_WHOLE && exchange->route->slow) return answer_slowly(exchange);
    while (exchange->stage == EXCHANGE_WHOLE) {
        bool closing;
        const unsigned long changes = waiting_room_changes(&server->room, &closing);
        const double start = monotonic_seconds();
        exchange->request.may_wait = !closing && !exchange->waits_no_more;
        exchange->request.waited = start - exchange->arrived;
        http_response_clear(&exchange->response);
        log_set_request(exchange->id);
        respond_once(exchange->route, server->service, &exchange->request, &exchange->response);
        exchange->worked += monotonic_seconds() - start;
        log_set_request("");
        if (exchange->response.wants_lane) return answer_slowly(exchange);
        if (!(exchange->response.wait > 0.0)) break;
        memcpy(exchange->request.made, exchange->response.made, sizeof exchange->request.made);
        const parking outcome = waiting_room_park(&server->room, exchange, changes, exchange->response.wait);
        if (outcome == PARKING_DONE) return MHD_YES;
        if (outcome == PARKING_FULL) exchange->waits_no_more = true; /* answered as things are */
    }
    return send_response(exchange);
}

/* --- taking requests in --- */

static watched_connection *watched(struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info ? info->socket_context : NULL;
}

static void set_out(http_exchange *exchange, http_server *server, struct MHD_Connection *connection)
{
    exchange->server = server;
    exchange->room = &server->room;
    exchange->connection = connection;
    exchange->watched = watched(connection);
    exchange->request.address = exchange->watched ? exchange->watched->address : NULL;
    exchange->socket = exchange->watched ? exchange->watched->socket : -1;
    exchange->request.client = (client_watch){ waiting_room_has_left, exchange };
}

static enum MHD_Result take_header(void *context, enum MHD_ValueKind kind, const char *name, const char *value)
{
    (void)kind;
    http_exchange *exchange = context;
    http_headers_take(&exchange->headers, &exchange->request, name, value);
    return MHD_YES;
}

static bool admit(http_exchange *exchange, const char *method)
{
    http_request *request = &exchange->request;
    request->method = method;
    request->path = "/";
    MHD_get_connection_values(exchange->connection, MHD_HEADER_KIND, take_header, exchange);
    name_request(exchange);
    const api_service *service = exchange->server->service;
    const char *problem = http_request_split_target(request, exchange->target);
    if (problem) {
        http_respond_problem(&exchange->response, 400, NULL, "Bad address", "%s", problem);
        return false;
    }
    http_guard *guard = &exchange->server->guard;
    if (!http_guard_counts(guard, request, &exchange->response)) return false;
    if (!http_guard_knows_host(guard, &exchange->headers, request, &exchange->response)) return false;
    if (http_guard_is_preflight(guard, request, &exchange->response)) return false;
    route_set_base(service, request, &exchange->response);
    route_strip_prefix(service, request);
    exchange->route = routes_match(route_table, route_count, request, &exchange->response);
    return exchange->route
           && http_guard_admits(guard, &exchange->headers, request, exchange->route, &exchange->response, &exchange->body_expected);
}

static enum MHD_Result begin(http_exchange *exchange, const char *method)
{
    if (!exchange->watched) return MHD_NO; /* no memory */
    const bool admitted = admit(exchange, method);
    const holding held =
        admitted ? hold(exchange, &exchange->server->bodies_held, exchange->body_expected, MOST_BODY_BYTES, &exchange->body_held)
                 : HELD;
    if (held != HELD) refuse_held(exchange, held, "Too many large bodies at once", "try again later");
    if (admitted && held == HELD) {
        exchange->stage = EXCHANGE_READING;
        exchange->body = exchange->body_expected ? malloc(exchange->body_expected) : NULL;
        return exchange->body || !exchange->body_expected ? MHD_YES : MHD_NO;
    }
    exchange->stage = EXCHANGE_REFUSED;
    /* Taking in what is still on its way lets the client read the answer rather than a broken connection. */
    const http_headers *headers = &exchange->headers;
    const bool takes_rest =
        headers->lengths == 1 && headers->encodings == 0 && strtoull(headers->length, NULL, 10) <= DROPPED_BODY_LIMIT;
    return takes_rest ? MHD_YES : send_response(exchange);
}

static enum MHD_Result take_body(http_exchange *exchange, const char *piece, size_t *size)
{
    const size_t room = exchange->body_expected - exchange->request.body_length;
    if (exchange->stage == EXCHANGE_READING) {
        if (*size > room) return MHD_NO;
        memcpy(exchange->body + exchange->request.body_length, piece, *size);
        exchange->request.body_length += *size;
    }
    *size = 0;
    return MHD_YES;
}

/* Called for each step of a request: headers, pieces of the body, its end, and again after a suspension. */
static enum MHD_Result take_request(void *context, struct MHD_Connection *connection, const char *url, const char *method,
                                    const char *version, const char *data, size_t *data_size, void **state)
{
    (void)url, (void)version;
    http_exchange *exchange = *state;
    if (!exchange) return MHD_NO;
    if (exchange->stage == EXCHANGE_NEW) {
        set_out(exchange, context, connection);
        return begin(exchange, method);
    }
    if (*data_size > 0) return take_body(exchange, data, data_size);
    if (exchange->stage == EXCHANGE_READING) {
        connection_watch_set_reading(&exchange->server->watch, exchange->watched, 0);
        exchange->request.body = exchange->body;
        exchange->arrived = monotonic_seconds();
        exchange->stage = EXCHANGE_WHOLE;
    }
    return answer(exchange);
}

/* The raw target, before anything is decoded. What it returns comes back as the request's state. */
static void *take_target(void *context, const char *target, struct MHD_Connection *connection)
{
    (void)connection;
    http_server *server = context;
    http_exchange *exchange = calloc(1, sizeof *exchange);
    if (!exchange) return NULL;
    http_response_init(&exchange->response);
    exchange->target = strdup(target);
    if (!exchange->target) {
        free(exchange);
        return NULL;
    }
    atomic_fetch_add(&server->under_way, 1);
    return exchange;
}

static void end_request(void *context, struct MHD_Connection *connection, void **state, enum MHD_RequestTerminationCode why)
{
    (void)why;
    http_server *server = context;
    http_exchange *exchange = *state;
    *state = NULL;
    if (!exchange) return;
    connection_watch_set_reading(&server->watch, watched(connection), 1);
    connection_watch_release(&server->watch, watched(connection), exchange->body_held + exchange->answer_held);
    atomic_fetch_sub(&server->bodies_held, exchange->body_held);
    atomic_fetch_sub(&server->answers_held, exchange->answer_held);
    http_response_clear(&exchange->response);
    free(exchange->body);
    free(exchange->target);
    free(exchange);
    atomic_fetch_sub(&server->under_way, 1);
}

static enum MHD_Result admit_connection(void *context, const struct sockaddr *address, socklen_t length)
{
    (void)length;
    http_server *server = context;
    return connection_watch_admits(&server->watch, address) ? MHD_YES : MHD_NO;
}

static void note_connection(void *context, struct MHD_Connection *connection, void **socket_context,
                            enum MHD_ConnectionNotificationCode what)
{
    http_server *server = context;
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        const union MHD_ConnectionInfo *from = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
        *socket_context = connection_watch_add(&server->watch, info->connect_fd, from ? from->client_addr : NULL);
        server->metrics.connections++;
    } else {
        connection_watch_remove(&server->watch, *socket_context);
        *socket_context = NULL;
        server->metrics.connections--;
    }
}

/* --- listening --- */

static int open_listener(const char *host, int port)
{
    char service[8];
    snprintf(service, sizeof service, "%d", port);
    const struct addrinfo wanted = { .ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE | AI_NUMERICSERV };
    struct addrinfo *found;
    const int code = getaddrinfo(host, service, &wanted, &found);
    if (code != 0) {
        log_line("--host %s: %s", host, gai_strerror(code));
        return -1;
    }
    const int on = 1;
    int listener = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (listener < 0 || setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0
        || bind(listener, found->ai_addr, found->ai_addrlen) != 0 || listen(listener, 128) != 0) {
        const bool taken = errno == EADDRINUSE;
        log_line("%s port %d can't be opened: %s%s", host, port, strerror(errno),
                 taken ? "; --port N takes another (make serve PORT=N), --port 0 any that is free" : "");
        if (listener >= 0) close(listener);
        listener = -1;
    }
    freeaddrinfo(found);
    return listener;
}

static int port_of(int listener)
{
    struct sockaddr_storage address;
    socklen_t length = sizeof address;
    char port[8] = "0";
    if (getsockname(listener, (struct sockaddr *)&address, &length) == 0)
        getnameinfo((struct sockaddr *)&address, length, NULL, 0, port, sizeof port, NI_NUMERICSERV);
    return atoi(port);
}

bool http_server_open(http_server *server, const config *settings, api_service *service)
{
    memset(server, 0, sizeof *server);
    server->service = service;
    if (!http_guard_init(&server->guard, settings)) return false;
    server->listener = open_listener(settings->host, settings->port);
    server->nothing = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (server->listener < 0 || server->nothing < 0) return false;
    server->port = port_of(server->listener);
    connection_watch_init(&server->watch, ENOUGH_CONNECTIONS, ADDRESS_CONNECTIONS);
    server->watch.most = MOST_CONNECTIONS;
    return true;
}

/* Each connection is a descriptor, and the limit of old for programs that select() is below what we have. */
static void allow_descriptors(void)
{
    struct rlimit limit;
    const rlim_t wanted = MOST_CONNECTIONS + EVENT_HUB_STREAMS + 1024;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return;
    limit.rlim_cur = limit.rlim_max < wanted ? limit.rlim_max : wanted;
    setrlimit(RLIMIT_NOFILE, &limit);
}

bool http_server_start(http_server *server)
{
    allow_descriptors();
    http_panic_watch();
    if (!waiting_room_open(&server->room, server->service, &server->watch)) return false;
    if (!event_hub_open(&server->hub, server->service->store)) return false;
    server->daemon = MHD_start_daemon(
        MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME, 0, admit_connection, server, take_request, server,
        MHD_OPTION_LISTEN_SOCKET, server->listener, MHD_OPTION_THREAD_POOL_SIZE, (unsigned)HTTP_THREADS,
        MHD_OPTION_THREAD_STACK_SIZE, (size_t)THREAD_STACK, MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_URI_LOG_CALLBACK,
        take_target, server, MHD_OPTION_NOTIFY_COMPLETED, end_request, server, MHD_OPTION_NOTIFY_CONNECTION, note_connection,
        server, MHD_OPTION_CONNECTION_LIMIT, (unsigned)(MOST_CONNECTIONS + EVENT_HUB_STREAMS), MHD_OPTION_CONNECTION_TIMEOUT,
        (unsigned)SILENCE_SECONDS, MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)CONNECTION_MEMORY, MHD_OPTION_END);
    if (server->daemon) return true;
    log_line("the HTTP server can't be started");
    event_hub_close(&server->hub);
    waiting_room_close(&server->room);
    return false;
}

/* MHD_quiesce_daemon would be the library's way to stop listening, but it races with the library's own threads, and the process
 * aborts when they come between. So the descriptor becomes another file, on which nothing ever happens: that closes the socket, and
 * the kernel takes it out of every thread's epoll. */
static void stop_listening(http_server *server)
{
    if (dup3(server->nothing, server->listener, O_CLOEXEC) < 0)
        log_line("the listening socket can't be closed: %s", strerror(errno));
    close(server->nothing);
}

void http_server_leave(http_server *server)
{
    http_panic_leaves();
    waiting_room_close(&server->room);
    event_hub_close(&server->hub);
    stop_listening(server);
}

void http_server_stop(http_server *server)
{
    for (int ms = 0; ms < LAST_ANSWERS_MS && atomic_load(&server->under_way) > 0 && !http_panic_has_come(); ms += 10)
        nanosleep(&(struct timespec){ .tv_nsec = 10000000 }, NULL);
    http_panic_may_end();
    MHD_stop_daemon(server->daemon);
    event_hub_clear(&server->hub);
    connection_watch_clear(&server->watch);
}
