/* An HTTP request as the handlers see it, and the answer they make of it: plain data, no library.
 *
 * The target is taken raw, because a library that decodes it first hides "%2e%2e" and "%00" from us: before the
 * query only [A-Za-z0-9/_.~-] is allowed, without empty, "." and ".." segments, so a path needs no decoding. */
#ifndef HTTP_REQUEST_H
#define HTTP_REQUEST_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "client_watch.h"
#include "problem.h"
#include "text_buffer.h"

enum {
    HTTP_PARAMETERS = 32,
    HTTP_SEGMENTS = 2,
    HTTP_SEGMENT_SIZE = 65,
    HTTP_BASE_SIZE = 320,
    HTTP_MADE_SIZE = 32,
    HTTP_LINK_SIZE = 3000
};

typedef struct http_parameter {
    const char *name, *value; /* decoded UTF-8 */
} http_parameter;

typedef struct http_request {
    const char *method, *path;
    /* headers; NULL where there is none */
    const char *host, *origin, *accept, *content_type, *authorization, *prefer, *range, *if_range, *if_none_match, *accept_encoding,
        *idempotency_key, *last_event_id;
    const char *cookie, *asked_method; /* Access-Control-Request-Method */
    const char *allowed_origin;        /* that of the page which asks, where it may read the answer; else NULL */
    const uint8_t *address;            /* of the client, 16 bytes; NULL: not known */
    const char *request_id;            /* as its client sent it; NULL: it did not */
    size_t parameter_count;
    http_parameter parameter[HTTP_PARAMETERS];
    char segment[HTTP_SEGMENTS][HTTP_SEGMENT_SIZE]; /* what the pattern's {…} stood for */
    const char *body;
    size_t body_length;
    double waited; /* s that this request has already been kept waiting for a change */
    bool may_wait; /* false: answer at once (the daemon is leaving) */
    client_watch client;
    bool in_lane;              /* handled apart, where it may take seconds */
    char made[HTTP_MADE_SIZE]; /* by an earlier call of the handler for this very request, as that said; "": nothing */
} http_request;

/* An answer that is made while it is sent. next: adds the next piece to out, which is empty, and nothing at the end;
 * false breaks the answer off, which the client sees. Owns context. */
typedef struct http_pieces {
    bool (*next)(void *context, text_buffer *out);
    void (*free)(void *context);
    void *context; /* NULL: the body is all */
} http_pieces;

typedef struct http_response {
    int status;
    const char *content_type;
    char *body; /* owned; length bytes; NULL when a file is sent */
    int file;   /* owned descriptor, or -1: length bytes from offset are sent */
    uint64_t offset, length;
    http_pieces pieces;        /* what comes after the body */
    uint64_t pieces_length;    /* of all pieces, where it is known before and there is no body; 0: it is not known */
    char base[HTTP_BASE_SIZE]; /* "http://host:port[/prefix]", put before addresses that begin with /; "": they stay as they are */
    char file_name[100];       /* under which a client may keep the body; "": none */
    bool is_attachment;        /* to be kept rather than shown */
    char location[HTTP_BASE_SIZE + 520], etag[80], content_range[80], allow[64], link[HTTP_LINK_SIZE], preference_applied[40];
    char set_cookie[480];
    bool is_preflight; /* tells a browser what pages of allowed_origin may ask */
    const char *cache_control, *authenticate, *accept_ranges;
    int retry_after;           /* s; 0: no such header */
    bool is_stream;            /* the server sends every change of any job, until the client leaves */
    bool wants_lane;           /* nothing to say yet: it may take long; call the handler again with in_lane */
    double wait;               /* s, above 0: nothing to say yet; call the handler again after a change, or after that long */
    char made[HTTP_MADE_SIZE]; /* with wait: what that call is to find in the request */
} http_response;

/* Splits a raw target in place into path and parameters. NULL when good, else what is wrong with it. */
const char *http_request_split_target(http_request *request, char *target);
const char *http_request_parameter(const http_request *request, const char *name); /* the first; NULL: not given */
/* Calls take for each value of a parameter that may be given several times, with commas between values as well; an empty
 * one is passed over. False: take refused one. */
typedef bool http_value_taker(void *context, const char *value, size_t length);
bool http_request_values(const http_request *request, const char *name, http_value_taker *take, void *context);
/* Whole number in [low, high]; `missing` where the parameter is not given. False: *problem says what is wrong. */
bool http_request_integer(const http_request *request, const char *name, int64_t low, int64_t high, int64_t missing, int64_t *value,
                          char *problem, size_t problem_size);
/* "true" or "false", which it is where the parameter is not given. False: *problem says what is wrong. */
bool http_request_truth(const http_request *request, const char *name, bool *value, char *problem, size_t problem_size);
void http_response_init(http_response *response);
void http_response_clear(http_response *response);
void http_respond_json(http_response *response, int status, json_t *document); /* takes the reference; NULL: no memory */
/* An object whose first members are written already, from its brace on; rest has the others. Takes both. */
void http_respond_json_after(http_response *response, text_buffer *begun, json_t *rest);
void http_respond_text(http_response *response, int status, const char *content_type, char *text, size_t length); /* takes text */
/* type NULL: that of the kind of problem which has this title (problem_kinds.h). */
void http_respond_problem(http_response *response, int status, const char *type, const char *title, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
/* The same with a list of problems, of which errors may be NULL. */
void http_respond_problems(http_response *response, int status, const char *title, const char *detail,
                           const problem_list *problems);
/* The results of a job that failed; takes the reference to what its worker told, which may be NULL. */
void http_respond_failure(http_response *response, int status, const char *title, const char *detail, json_t *failure);
/* Names the version of what is answered, for the client to ask again by If-None-Match. True: it has that one, and 304 says so. */
bool http_respond_unchanged(const http_request *request, http_response *response, const char *version);
/* Sends a file that was opened, whole or the part asked for; takes the descriptor. immutable: it never changes
 * under this address. growing: no ETag, because the next read may give more. */
enum http_file_kind { HTTP_FILE_IMMUTABLE, HTTP_FILE_CHANGING, HTTP_FILE_GROWING };
void http_respond_file(const http_request *request, http_response *response, int file, const char *content_type,
                       enum http_file_kind kind);
/* Of an answer of `size` bytes, whose etag is set: offset, length, status and headers of what is to be sent of it, all or the part
 * asked for. False: there is no such part, and the response says so. */
bool http_respond_part(const http_request *request, http_response *response, uint64_t size);

#endif
