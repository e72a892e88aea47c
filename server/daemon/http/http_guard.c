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

#include "http_accept.h"
#include "log.h"

/* --- the address to listen on --- */

static bool is_loopback(const char *host)
{
    struct in_addr four;
    struct in6_addr six;
    if (inet_pton(AF_INET, host, &four) == 1) return (ntohl(four.s_addr) >> 24) == 127;
    if (inet_pton(AF_INET6, host, &six) == 1) return IN6_IS_ADDR_LOOPBACK(&six);
    return strcmp(host, "localhost") == 0;
}

static bool has_token_where_needed(const char *host, const char *token_file)
{
    if (token_file || is_loopback(host)) return true;
    log_line("--host %s is reachable from outside; this needs --token-file", host);
    return false;
}

bool http_guard_init(http_guard *guard, const config *settings)
{
    guard->settings = settings;
    address_limits_init(&guard->limits, settings->address_rate);
    return access_open(&guard->access, settings->token_file) && has_token_where_needed(settings->host, settings->token_file);
}

bool http_guard_read_tokens(http_guard *guard, const config *fresh)
{
    const config *settings = guard->settings; /* the host stays as it is */
    const char *before = settings->token_file, *now = fresh->token_file;
    if (before && now && strcmp(before, now) == 0) now = before; /* `fresh` need not last where it brings nothing new */
    return has_token_where_needed(settings->host, now) && access_read_again(&guard->access, now);
}

void http_guard_set_options(http_guard *guard, const config *settings)
{
    address_limits_set_rate(&guard->limits, settings->address_rate);
    guard->settings = settings;
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
        { "Last-Event-ID", &request->last_event_id, NULL },
        { "Cookie", &request->cookie, NULL },
        { "Access-Control-Request-Method", &request->asked_method, NULL },
        { "X-Request-Id", &request->request_id, NULL },
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
    if (!request->origin || request->allowed_origin) return true;
    const size_t length = strlen(request->origin);
    if (settings->public_url && strncasecmp(settings->public_url, request->origin, length) == 0
        && strchr("/", settings->public_url[length]))
        return true;
    const char *scheme_end = strstr(request->origin, "://");
    return scheme_end && strcasecmp(scheme_end + 3, request->host) == 0;
}

static bool is_type(const char *content_type, const char *wanted)
{
    const size_t length = strlen(wanted);
    return content_type && strncasecmp(content_type, wanted, length) == 0
           && (content_type[length] == '\0' || strchr("; \t", content_type[length]));
}

/* All methods but these may change something. */
static bool only_reads(const char *method) { return strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0; }

static bool admits_body(const http_headers *headers, const http_request *request, const http_route *route, http_response *response,
                        size_t *length)
{
    *length = 0;
    const bool sends = !only_reads(request->method) && strcmp(request->method, "DELETE") != 0;
    const bool has_none = headers->encodings == 0 && (!headers->length || strcmp(headers->length, "0") == 0);
    if (has_none && route->bodiless) return true;
    if (headers->encodings > 0 || (sends && !headers->length))
        return refuse(response, 411, "Length required", "send the body with a Content-Length");
    const int limit = route->takes_csv ? HTTP_CSV_LIMIT : HTTP_BODY_LIMIT;
    if (sends && route->takes_csv && !is_type(request->content_type, "text/csv"))
        return refuse(response, 415, "Not CSV",
                      "send Content-Type: text/csv; with curl: -H 'Content-Type: text/csv' --data-binary @file");
    if (sends && !route->takes_csv && !is_type(request->content_type, "application/json"))
        return refuse(response, 415, "Not JSON", "send Content-Type: application/json; with curl: curl --json @file");
    *length = headers->length ? (size_t)strtoull(headers->length, NULL, 10) : 0;
    if (*length > (size_t)limit) {
        http_respond_problem(response, 413, NULL, "Body too large", "the body has %zu bytes; at most %d are read", *length, limit);
        return false;
    }
    return true;
}

static bool refuse_for(http_response *response, double seconds, const char *title, const char *detail)
{
    response->retry_after = (int)seconds + 1;
    return refuse(response, 429, title, detail);
}

/* Before the token is looked at: guesses are slow, and hold nothing meanwhile. What an address has sent as a token shows in no
 * other way than that it may have to wait. */
static bool token_may_be_tried(http_guard *guard, const http_request *request, http_response *response)
{
    const double seconds = request->address ? address_limits_try(&guard->limits, request->address) : 0.0;
    return seconds <= 0.0
           || refuse_for(response, seconds, "Too many wrong tokens",
                         "many tokens from this address were none; no token is looked at for a while");
}

static void refuse_token(http_response *response)
{
    refuse(response, 401, "Token needed", "send Authorization: Bearer with a token of --token-file");
    response->authenticate = "Bearer";
}

/* A page is for everybody, but the same address tells programs about the service. */
static bool is_open(const http_request *request, const http_route *route)
{
    static const http_format formats[] = { { "json", "application/json" }, { "html", "text/html" } };
    return route->open && (strcmp(route->pattern, "/") != 0 || http_format_choose(request, formats, 2) == 1);
}

static bool has_access(http_guard *guard, const http_request *request, const http_route *route, http_response *response)
{
    if (!guard->access.file || is_open(request, route)) return true;
    access_level level = ACCESS_NONE;
    if (!request->authorization) {
        level = access_of_cookie(&guard->access, request->cookie);
    } else if (!token_may_be_tried(guard, request, response)) {
        return false;
    } else if (strncasecmp(request->authorization, "Bearer ", 7) == 0) {
        level = access_of_token(&guard->access, request->authorization + 7);
        if (level == ACCESS_NONE && request->address) address_limits_note_failure(&guard->limits, request->address);
    }
    if (level == ACCESS_WRITE || (level == ACCESS_READ && route_only_reads(route, request))) return true;
    if (level == ACCESS_NONE) refuse_token(response);
    else refuse(response, 403, "The token may only read", "this needs a token with \"write\" in the token file");
    return false;
}

/* Where the cookie counts: below the path of the public address. */
static const char *prefix_of(const char *url)
{
    const char *path = url ? strchr(strstr(url, "://") + 3, '/') : NULL;
    return path ? path : "";
}

void http_guard_begin_session(http_guard *guard, const http_request *request, const char *token, http_response *response)
{
    char id[ACCESS_SESSION_SIZE], name[ACCESS_NAME_SIZE] = "";
    const config *settings = guard->settings;
    const char *url = settings->public_url;
    if (!guard->access.file) {
        http_respond_json(response, 200, json_pack("{s:n, s:s}", "name", "access", "write"));
        return;
    }
    if (!token_may_be_tried(guard, request, response)) return;
    const access_level level = access_begin_session(&guard->access, token, id, name);
    if (level == ACCESS_NONE) {
        if (request->address) address_limits_note_failure(&guard->limits, request->address);
        refuse_token(response);
        return;
    }
    snprintf(response->set_cookie, sizeof response->set_cookie, ACCESS_COOKIE "=%s; Path=%s/; HttpOnly; SameSite=Strict%s", id,
             prefix_of(url), url && strncmp(url, "https:", 6) == 0 ? "; Secure" : "");
    http_respond_json(response, 201, json_pack("{s:s, s:s}", "name", name, "access", level == ACCESS_WRITE ? "write" : "read"));
}

void http_guard_end_session(http_guard *guard, const http_request *request, http_response *response)
{
    const config *settings = guard->settings;
    access_end_session(&guard->access, request->cookie);
    snprintf(response->set_cookie, sizeof response->set_cookie, ACCESS_COOKIE "=; Path=%s/; Max-Age=0; HttpOnly; SameSite=Strict",
             prefix_of(settings->public_url));
    http_respond_json(response, 200, json_pack("{s:n, s:s}", "name", "access", guard->access.file ? "none" : "write"));
}

bool http_guard_admits(http_guard *guard, const http_headers *headers, const http_request *request, const http_route *route,
                       http_response *response, size_t *body_length)
{
    if (!has_access(guard, request, route, response)) return false;
    if (!only_reads(request->method) && !origin_is_ours(guard->settings, request))
        return refuse(response, 403, "Foreign page",
                      "writes are taken from this service's own page or from programs, not from other pages");
    return admits_body(headers, request, route, response, body_length);
}

bool http_guard_is_preflight(const http_guard *guard, http_request *request, http_response *response)
{
    const config *settings = guard->settings;
    for (int i = 0; request->origin && i < settings->allowed_origins; i++)
        if (strcmp(request->origin, settings->allowed_origin[i]) == 0) request->allowed_origin = settings->allowed_origin[i];
    if (!request->allowed_origin || !request->asked_method || strcmp(request->method, "OPTIONS") != 0) return false;
    response->status = 204;
    response->is_preflight = true;
    return true;
}

bool http_guard_counts(http_guard *guard, const http_request *request, http_response *response)
{
    const double seconds = request->address ? address_limits_ask(&guard->limits, request->address) : 0.0;
    return seconds <= 0.0
           || refuse_for(response, seconds, "Too many requests", "this address asks faster than --address-rate allows");
}
