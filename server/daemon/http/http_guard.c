#include "http_guard.h"

#include <arpa/inet.h>
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "log.h"

/* --- the token and the address to listen on --- */

/* The whole file, or as much of it as the buffer holds; -1: errno says why not. */
static ssize_t read_file(const char *path, char *text, size_t size, mode_t *mode)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    struct stat facts = { .st_mode = 0 };
    ssize_t got = file < 0 || fstat(file, &facts) != 0 ? -1 : 1, length = 0;
    while (got > 0 && (size_t)length < size) {
        got = read(file, text + length, size - (size_t)length);
        if (got > 0) length += got;
    }
    const int problem = errno;
    if (file >= 0) close(file);
    errno = problem;
    *mode = facts.st_mode;
    return got < 0 ? -1 : length;
}

/* A token is never taken in part: a client that sends all of it would be refused, and who knows a part let in. */
static bool read_token(const char *path, char token[HTTP_TOKEN_SIZE])
{
    char text[HTTP_TOKEN_SIZE + 64]; /* and white space around it */
    mode_t mode;
    const ssize_t length = read_file(path, text, sizeof text, &mode);
    if (length < 0) {
        log_line("token file %s can't be read: %s", path, strerror(errno));
        return false;
    }
    size_t first = 0, end = (size_t)length;
    while (first < end && isspace((unsigned char)text[first])) first++;
    while (end > first && isspace((unsigned char)text[end - 1])) end--;
    size_t plain = first;
    while (plain < end && isgraph((unsigned char)text[plain])) plain++;
    const size_t characters = end - first;
    if ((mode & 077) != 0) log_line("token file %s has mode %03o; must be 0600", path, (unsigned)mode & 0777U);
    else if ((size_t)length == sizeof text)
        log_line("token file %s holds %zu characters or more; must hold 16 to %d", path, sizeof text, HTTP_TOKEN_SIZE - 1);
    else if (characters < 16 || characters >= HTTP_TOKEN_SIZE)
        log_line("token file %s holds %zu characters; must hold 16 to %d", path, characters, HTTP_TOKEN_SIZE - 1);
    else if (plain < end)
        log_line("token file %s holds, at character %zu, one that a header can't hold; must hold ASCII without spaces", path,
                 plain - first + 1);
    else {
        memcpy(token, text + first, characters);
        token[characters] = '\0';
        return true;
    }
    return false;
}

static bool is_loopback(const char *host)
{
    struct in_addr four;
    struct in6_addr six;
    if (inet_pton(AF_INET, host, &four) == 1) return (ntohl(four.s_addr) >> 24) == 127;
    if (inet_pton(AF_INET6, host, &six) == 1) return IN6_IS_ADDR_LOOPBACK(&six);
    return strcmp(host, "localhost") == 0;
}

bool http_guard_init(http_guard *guard, const config *settings)
{
    *guard = (http_guard){ .settings = settings };
    if (settings->token_file) return read_token(settings->token_file, guard->token);
    if (is_loopback(settings->host)) return true;
    log_line("--host %s is reachable from outside; this needs --token-file", settings->host);
    return false;
}

/* --- headers --- */

void http_headers_take(http_headers *headers, http_request *request, const char *name, const char *value)
{
    for (const char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("!#$%&'*+-.^_`|~", *c)) headers->strange_name = true;
    const struct {
        const char *name;
        const char **value;
        int *count;
    } wanted[] = {
        { "Host", &request->host, &headers->hosts },
        { "Content-Length", &headers->length, &headers->lengths },
        { "Transfer-Encoding", NULL, &headers->encodings },
        { "Origin", &request->origin, NULL },
        { "Accept", &request->accept, NULL },
        { "Content-Type", &request->content_type, NULL },
        { "Authorization", &request->authorization, NULL },
        { "Prefer", &request->prefer, NULL },
        { "Range", &request->range, NULL },
        { "If-Range", &request->if_range, NULL },
        { "If-None-Match", &request->if_none_match, NULL },
        { "Accept-Encoding", &request->accept_encoding, NULL },
        { "Idempotency-Key", &request->idempotency_key, NULL },
    };
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        if (strcasecmp(name, wanted[i].name) != 0) continue;
        if (wanted[i].value) *wanted[i].value = value ? value : "";
        if (wanted[i].count) ++*wanted[i].count;
    }
}

static bool refuse(http_response *response, int status, const char *title, const char *detail)
{
    http_respond_problem(response, status, NULL, title, "%s", detail);
    return false;
}

/* Name or address without the port; "" when it is malformed. */
static void split_host(const char *host, char name[256])
{
    const char *end = host[0] == '[' ? strchr(host, ']') : strchrnul(host, ':');
    const char *start = host[0] == '[' ? host + 1 : host;
    name[0] = '\0';
    if (!end || end - start > 255) return;
    const char *port = *end == ']' ? end + 1 : end;
    if (*port == ':' && strspn(port + 1, "0123456789") == strlen(port + 1)) port = "";
    if (*port == '\0') snprintf(name, 256, "%.*s", (int)(end - start), start);
}

/* A page of a stranger can make its own name point at us (DNS rebinding), but it can't make an address do so. */
static bool host_is_ours(const config *settings, const char *host)
{
    char name[256], bytes[16];
    split_host(host, name);
    if (inet_pton(AF_INET, name, bytes) == 1 || inet_pton(AF_INET6, name, bytes) == 1) return true;
    if (strcasecmp(name, "localhost") == 0 || strcasecmp(name, settings->host) == 0) return name[0] != '\0';
    if (strcasecmp(name, settings->public_host) == 0) return name[0] != '\0';
    for (int i = 0; i < settings->allowed_hosts; i++)
        if (strcasecmp(name, settings->allowed_host[i]) == 0) return true;
    return false;
}

bool http_guard_knows_host(const http_guard *guard, const http_headers *headers, const http_request *request,
                           http_response *response)
{
    if (headers->hosts != 1) return refuse(response, 400, "Bad request", "exactly one Host header must be sent");
    if (headers->strange_name)
        return refuse(response, 400, "Bad request",
                      "a header name holds a character that is not allowed, or a header goes on over a second line");
    if (headers->lengths > 1 || (headers->lengths > 0 && headers->encodings > 0))
        return refuse(response, 400, "Bad request", "the length of the body is given twice");
    if (!host_is_ours(guard->settings, request->host))
        return refuse(response, 421, "Not this host",
                      "the Host header names neither localhost, nor an address, nor a name of --allow-host");
    return true;
}

/* --- writes and tokens --- */

static bool origin_is_ours(const config *settings, const http_request *request)
{
    if (!request->origin) return true;
    const size_t length = strlen(request->origin);
    if (settings->public_url && strncasecmp(settings->public_url, request->origin, length) == 0
        && strchr("/", settings->public_url[length]))
        return true;
    const char *scheme_end = strstr(request->origin, "://");
    return scheme_end && strcasecmp(scheme_end + 3, request->host) == 0;
}

static bool is_json(const char *content_type)
{
    static const char json[] = "application/json";
    return content_type && strncasecmp(content_type, json, sizeof json - 1) == 0
           && (content_type[sizeof json - 1] == '\0' || strchr("; \t", content_type[sizeof json - 1]));
}

/* Looks at every byte whatever it finds, so that the time tells nothing about where they differ. */
static bool token_matches(const char *token, const char *authorization)
{
    if (!authorization || strncasecmp(authorization, "Bearer ", 7) != 0) return false;
    const char *given = authorization + 7;
    const size_t length = strlen(token), given_length = strlen(given);
    unsigned char difference = length != given_length;
    for (size_t i = 0; i < length; i++) difference |= (unsigned char)(token[i] ^ (i < given_length ? given[i] : 0));
    return difference == 0;
}

/* All methods but these may change something. */
static bool only_reads(const char *method) { return strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0; }

static bool admits_body(const http_headers *headers, const http_request *request, bool takes_no_body, http_response *response,
                        size_t *length)
{
    *length = 0;
    const bool sends = !only_reads(request->method) && strcmp(request->method, "DELETE") != 0;
    const bool has_none = headers->encodings == 0 && (!headers->length || strcmp(headers->length, "0") == 0);
    if (has_none && takes_no_body) return true;
    if (headers->encodings > 0 || (sends && !headers->length))
        return refuse(response, 411, "Length required", "send the body with a Content-Length");
    if (sends && !is_json(request->content_type))
        return refuse(response, 415, "Not JSON", "send Content-Type: application/json; with curl: curl --json @file");
    *length = headers->length ? (size_t)strtoull(headers->length, NULL, 10) : 0;
    if (*length > HTTP_BODY_LIMIT) {
        http_respond_problem(response, 413, NULL, "Body too large", "the body has %zu bytes; at most %d are read", *length,
                             HTTP_BODY_LIMIT);
        return false;
    }
    return true;
}

bool http_guard_admits(const http_guard *guard, const http_headers *headers, const http_request *request, const http_route *route,
                       http_response *response, size_t *body_length)
{
    if (guard->token[0] && !route->open && !token_matches(guard->token, request->authorization)) {
        refuse(response, 401, "Token needed", "send Authorization: Bearer with the token of --token-file");
        response->authenticate = "Bearer";
        return false;
    }
    if (!only_reads(request->method) && !origin_is_ours(guard->settings, request))
        return refuse(response, 403, "Foreign page",
                      "writes are taken from this service's own page or from programs, not from other pages");
    return admits_body(headers, request, route->bodiless, response, body_length);
}
