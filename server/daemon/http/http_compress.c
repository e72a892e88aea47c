#include "http_compress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>
#include <zlib.h>

enum {
    SHORTEST = 1 << 10, /* bytes: what is shorter fits a packet or two anyway */
    READ_AT_ONCE = 32 << 10,
    FED_AT_ONCE = 64 << 10, /* a millisecond or two of compressing */
    LEVEL = 5,
    WINDOW_BITS = 13 + 16, /* 8 kB, and the format of gzip: a stream takes 64 kB in all, since many may be on their way */
    MEMORY_LEVEL = 6,
    MOST_PIECE_BYTES = 4 << 20
};

/* --- whether --- */

bool http_compress_is_text(const http_response *response)
{
    static const char *const types[] = { "text/", "application/json", "application/problem+json", "application/vnd.oai.openapi",
                                         "image/svg+xml" };
    for (size_t i = 0; response->content_type && i < sizeof types / sizeof types[0]; i++)
        if (strncmp(response->content_type, types[i], strlen(types[i])) == 0) return true;
    return false;
}

/* The weight of one coding, "gzip" or "gzip;q=0.5"; what can't be read is no wish. */
static double weight_of(const char *parameters, size_t length)
{
    char text[32], *end;
    snprintf(text, sizeof text, "%.*s", (int)length, parameters);
    const char *q = text + strspn(text, "; \t");
    if (*q == '\0') return 1.0;
    if (strncasecmp(q, "q=", 2) != 0) return 0.0;
    const double weight = strtod(q + 2, &end);
    return end > q + 2 && weight >= 0.0 && weight <= 1.0 ? weight : 0.0;
}

/* RFC 9110, 12.5.3. What is sent as it is, is always allowed here, and preferred only where its weight says so. */
static bool prefers_gzip(const char *accepted)
{
    double gzip = -1.0, any = 0.0, identity = 0.0;
    for (const char *part = accepted; part && *part;) {
        part += strspn(part, ", \t");
        const size_t all = strcspn(part, ","), name = strcspn(part, ",; \t");
        const double weight = weight_of(part + name, all - name);
        if ((name == 4 && strncasecmp(part, "gzip", 4) == 0) || (name == 6 && strncasecmp(part, "x-gzip", 6) == 0)) gzip = weight;
        else if (name == 1 && *part == '*') any = weight;
        else if (name == 8 && strncasecmp(part, "identity", 8) == 0) identity = weight;
        part += all;
    }
    if (gzip < 0.0) gzip = any;
    return gzip > 0.0 && gzip >= identity;
}

bool http_compress_is_wanted(const http_request *request, const http_response *response)
{
    if (request->range || response->status == 206 || response->status == 304 || !http_compress_is_text(response)) return false;
    return (response->pieces.context || response->length >= SHORTEST) && prefers_gzip(request->accept_encoding);
}

/* --- how --- */

typedef struct compressor {
    z_stream z;
    text_buffer text; /* what is in memory: the body, then piece after piece */
    size_t fed;       /* of it */
    int file;         /* or -1 */
    uint64_t offset, left;
    http_pieces pieces;
    char *part; /* (FED_AT_ONCE) of the file */
    int flush;  /* of what was fed last; Z_NO_FLUSH: all that it gave is sent */
    bool has_ended;
} compressor;

static bool feed_from_file(compressor *c)
{
    const ssize_t got = pread(c->file, c->part, c->left < FED_AT_ONCE ? (size_t)c->left : FED_AT_ONCE, (off_t)c->offset);
    if (got <= 0) return false; /* shorter than it was */
    c->z.next_in = (unsigned char *)c->part;
    c->z.avail_in = (unsigned)got;
    c->offset += (uint64_t)got;
    c->left -= (uint64_t)got;
    return true;
}

/* The next part of what is to be compressed, or nothing at the end. False: it breaks off. */
static bool feed(compressor *c)
{
    c->flush = Z_SYNC_FLUSH; /* the client has all of it, however well it compresses */
    if (c->file >= 0 && c->left > 0) return feed_from_file(c);
    if (c->fed == c->text.length && c->pieces.context) {
        c->fed = c->text.length = 0;
        if (!c->pieces.next(c->pieces.context, &c->text) || c->text.failed) return false;
    }
    const size_t left = c->text.length - c->fed, length = left < FED_AT_ONCE ? left : FED_AT_ONCE;
    c->z.next_in = length ? (unsigned char *)c->text.text + c->fed : NULL;
    c->z.avail_in = (unsigned)length;
    c->fed += length;
    if (length == 0) c->flush = Z_FINISH;
    return true;
}

static ssize_t read_compressed(void *context, uint64_t position, char *piece, size_t size)
{
    (void)position;
    compressor *c = context;
    c->z.next_out = (unsigned char *)piece;
    c->z.avail_out = (unsigned)size;
    while (!c->has_ended && c->z.avail_out == size) {
        if (c->flush == Z_NO_FLUSH && !feed(c)) return MHD_CONTENT_READER_END_WITH_ERROR;
        c->has_ended = deflate(&c->z, c->flush) == Z_STREAM_END;
        if (c->z.avail_out > 0) c->flush = Z_NO_FLUSH;
    }
    const size_t length = size - c->z.avail_out;
    return length > 0 ? (ssize_t)length : MHD_CONTENT_READER_END_OF_STREAM;
}

static void free_compressor(void *context)
{
    compressor *c = context;
    deflateEnd(&c->z);
    if (c->file >= 0) close(c->file);
    if (c->pieces.context) c->pieces.free(c->pieces.context);
    text_buffer_clear(&c->text);
    free(c->part);
    free(c);
}

struct MHD_Response *http_compress_reply(http_response *response)
{
    compressor *c = calloc(1, sizeof *c);
    if (!c) return NULL;
    c->file = -1;
    text_buffer_init(&c->text, MOST_PIECE_BYTES);
    if (response->file >= 0) c->part = malloc(FED_AT_ONCE);
    struct MHD_Response *reply = NULL;
    if ((c->part || response->file < 0)
        && deflateInit2(&c->z, LEVEL, Z_DEFLATED, WINDOW_BITS, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) == Z_OK)
        reply = MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, READ_AT_ONCE, read_compressed, c, free_compressor);
    if (!reply) {
        free_compressor(c);
        return NULL;
    }
    c->file = response->file;
    c->offset = response->offset;
    c->left = response->file >= 0 ? response->length : 0;
    c->text.text = response->body;
    c->text.length = c->text.capacity = response->body ? response->length : 0;
    c->pieces = response->pieces;
    response->file = -1;
    response->body = NULL;
    response->pieces = (http_pieces){ .context = NULL };
    return reply;
}
