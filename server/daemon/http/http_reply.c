#include "http_reply.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "http_compress.h"

enum { READ_AT_ONCE = 32 << 10, MOST_PIECE_BYTES = 4 << 20 };

/* --- headers --- */

static void add_header(struct MHD_Response *reply, const char *name, const char *value)
{
    if (value && value[0]) MHD_add_response_header(reply, name, value);
}

static void add_headers(struct MHD_Response *reply, const http_response *response)
{
    char retry_after[16] = "", disposition[140] = "";
    if (response->retry_after > 0) snprintf(retry_after, sizeof retry_after, "%d", response->retry_after);
    if (response->file_name[0] && response->status < 300)
        snprintf(disposition, sizeof disposition, "%s; filename=\"%s\"", response->is_attachment ? "attachment" : "inline",
                 response->file_name);
    add_header(reply, "Content-Type", response->content_type);
    add_header(reply, "Content-Disposition", disposition);
    add_header(reply, "Location", response->location);
    add_header(reply, "ETag", response->etag);
    add_header(reply, "Link", response->link);
    add_header(reply, "Content-Range", response->content_range);
    add_header(reply, "Accept-Ranges", response->accept_ranges);
    add_header(reply, "Cache-Control", response->cache_control ? response->cache_control : "no-store");
    add_header(reply, "Allow", response->allow[0] ? response->allow : NULL);
    add_header(reply, "Preference-Applied", response->preference_applied);
    add_header(reply, "WWW-Authenticate", response->authenticate);
    add_header(reply, "Retry-After", retry_after);
    add_header(reply, "Set-Cookie", response->set_cookie);
    add_header(reply, "Content-Security-Policy", "default-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'self'");
    add_header(reply, "X-Content-Type-Options", "nosniff");
    add_header(reply, "Referrer-Policy", "no-referrer");
    /* After a refusal the rest of the stream may not be what it seems. */
    if (response->status >= 400) add_header(reply, "Connection", "close");
}

/* A page of another origin sends its token as any program does: cookies are not for it. */
static void add_headers_for_pages(struct MHD_Response *reply, const char *origin, const http_response *response)
{
    add_header(reply, "Access-Control-Allow-Origin", origin);
    add_header(reply, "Vary", "Origin");
    add_header(reply, "Access-Control-Expose-Headers",
               "Location, Link, ETag, Retry-After, Content-Disposition, Preference-Applied, X-Request-Id");
    if (!response->is_preflight) return;
    add_header(reply, "Access-Control-Allow-Methods", "GET, HEAD, POST, DELETE");
    add_header(reply, "Access-Control-Allow-Headers",
               "Authorization, Content-Type, Prefer, Range, If-Range, If-None-Match, Idempotency-Key");
    add_header(reply, "Access-Control-Max-Age", "600");
}

/* --- answers in pieces --- */

typedef struct stream {
    http_pieces pieces;
    text_buffer out;
    size_t sent; /* of out */
} stream;

/* Called as the client reads on, so that no more than one piece is in memory. */
static ssize_t read_stream(void *context, uint64_t position, char *piece, size_t size)
{
    (void)position;
    stream *from = context;
    if (from->sent == from->out.length) {
        from->sent = from->out.length = 0;
        if (!from->pieces.next(from->pieces.context, &from->out) || from->out.failed) return MHD_CONTENT_READER_END_WITH_ERROR;
        if (from->out.length == 0) return MHD_CONTENT_READER_END_OF_STREAM;
    }
    const size_t left = from->out.length - from->sent, length = left < size ? left : size;
    memcpy(piece, from->out.text + from->sent, length);
    from->sent += length;
    return (ssize_t)length;
}

static void free_stream(void *context)
{
    stream *from = context;
    from->pieces.free(from->pieces.context);
    text_buffer_clear(&from->out);
    free(from);
}

/* The body, then piece after piece. */
static struct MHD_Response *reply_in_pieces(http_response *response)
{
    stream *from = calloc(1, sizeof *from);
    if (!from) return NULL;
    text_buffer_init(&from->out, MOST_PIECE_BYTES);
    from->out.text = response->body;
    from->out.length = response->length;
    from->out.capacity = response->length;
    from->pieces = response->pieces;
    response->body = NULL;
    response->pieces = (http_pieces){ .context = NULL };
    const uint64_t length = response->pieces_length ? response->pieces_length : MHD_SIZE_UNKNOWN;
    struct MHD_Response *reply = MHD_create_response_from_callback(length, READ_AT_ONCE, read_stream, from, free_stream);
    if (!reply) free_stream(from);
    return reply;
}

/* The same answer compressed is other bytes: its tag is then a weak one, and so is that of a client which has it already. */
static void weaken_etag(http_response *response)
{
    char strong[sizeof response->etag];
    memcpy(strong, response->etag, sizeof strong);
    if (*strong) snprintf(response->etag, sizeof response->etag, "W/%.*s", (int)sizeof strong - 3, strong);
}

static bool has_weak_etag(const http_request *request, const http_response *response)
{
    const char *at = request->if_none_match && *response->etag ? strstr(request->if_none_match, response->etag) : NULL;
    return at && at - request->if_none_match >= 2 && strncmp(at - 2, "W/", 2) == 0;
}

static struct MHD_Response *reply_of(http_response *response)
{
    if (response->pieces.context) return reply_in_pieces(response);
    if (response->file >= 0 && response->length > 0) {
        struct MHD_Response *reply = MHD_create_response_from_fd_at_offset64(response->length, response->file, response->offset);
        if (reply) response->file = -1; /* the library closes it */
        return reply;
    }
    struct MHD_Response *reply =
        MHD_create_response_from_buffer(response->body ? response->length : 0, response->body, MHD_RESPMEM_MUST_FREE);
    if (reply) response->body = NULL; /* the library frees it */
    return reply;
}

void http_reply_add_headers(struct MHD_Response *reply, const http_request *request, const http_response *response)
{
    add_headers(reply, response);
    if (request->allowed_origin) add_headers_for_pages(reply, request->allowed_origin, response);
}

struct MHD_Response *http_reply_make(const http_request *request, http_response *response)
{
    const bool compressed = http_compress_is_wanted(request, response);
    struct MHD_Response *reply = compressed ? http_compress_reply(response) : reply_of(response);
    if (!reply) return NULL;
    if (compressed || (response->status == 304 && has_weak_etag(request, response))) weaken_etag(response);
    if (compressed) {
        response->accept_ranges = NULL; /* of the file as it is */
        add_header(reply, "Content-Encoding", "gzip");
    }
    if (response->status == 304 || http_compress_is_text(response)) add_header(reply, "Vary", "Accept-Encoding");
    http_reply_add_headers(reply, request, response);
    return reply;
}
