/* A snapshot, its frame, and the frames of several snapshots one after the other. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "checksum.h"
#include "frame_format.h"
#include "handlers.h"
#include "job_folder.h"

enum { MOST_FRAMES = 10000, READ_AT_ONCE = 64 << 10 };

static const char frame_type[] = "application/octet-stream";

/* "000012.hdf" or "12.hdf" is number 12 where the end is ".hdf"; -1: it is not of this kind. */
static int64_t number_in(const char *name, const char *end)
{
    const size_t digits = strspn(name, "0123456789");
    if (digits == 0 || digits > 12 || strcmp(name + digits, end) != 0) return -1;
    return strtoll(name, NULL, 10);
}

static store_status open_frame(job_store *store, const char *id, int64_t number, int *file)
{
    char name[40];
    snprintf(name, sizeof name, JOB_FRAME_FILE_FORMAT, (long long)number);
    return store_open_file(store, id, JOB_SNAPSHOT_FOLDER, name, file);
}

void send_snapshot(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    if (!find_job(service, request, response, &job)) return;
    const int64_t frame = number_in(request->segment[1], ".bin");
    const int64_t number = frame >= 0 ? frame : number_in(request->segment[1], ".hdf");
    int file;
    store_status status = STORE_NOT_FOUND;
    if (frame >= 0) status = open_frame(service->store, job.id, frame, &file);
    else if (number >= 0) status = store_open_snapshot(service->store, job.id, number, &file);
    char end[40];
    snprintf(end, sizeof end, "-%06lld.%s", (long long)number, frame >= 0 ? "bin" : "hdf");
    name_file(response, job.id, end, true);
    if (status == STORE_OK)
        http_respond_file(request, response, file, frame >= 0 ? frame_type : "application/x-hdf5", HTTP_FILE_IMMUTABLE);
    else if (status == STORE_NOT_FOUND)
        http_respond_problem(response, 404, NULL, "No such snapshot",
                             "job %s has no snapshot \"%s\"; /jobs/%s/snapshots lists them, with the frames of those that have one",
                             job.id, request->segment[1], job.id);
    else respond_store_failure(response, status, "open the snapshot");
    job_record_clear(&job);
}

/* --- several frames --- */

typedef struct frame_stream {
    job_store *store;
    char id[JOB_ID_SIZE];
    int64_t from, to, every;
    struct {
        int64_t number;
        uint64_t bytes;
    } * frame; /* (frames) */
    size_t frames, room;
    bool is_too_many, no_memory;
    uint64_t version, size; /* of them all */
    size_t next;            /* frame to be opened */
    int file;               /* being sent, or -1 */
    uint64_t skipped, left; /* bytes before those asked for; those still to be sent */
} frame_stream;

static void free_frames(void *context)
{
    frame_stream *stream = context;
    if (stream->file >= 0) close(stream->file);
    free(stream->frame);
    free(stream);
}

static bool note_frame(void *context, const snapshot_row *row)
{
    frame_stream *stream = context;
    if (row->number > stream->to) return false;
    if (row->frame_bytes <= 0 || (row->number - stream->from) % stream->every) return true;
    stream->is_too_many = stream->frames == MOST_FRAMES;
    if (stream->is_too_many) return false;
    if (stream->frames == stream->room) {
        const size_t room = 2 * stream->room + 64;
        void *larger = realloc(stream->frame, room * sizeof *stream->frame);
        stream->no_memory = !larger;
        if (!larger) return false;
        stream->frame = larger;
        stream->room = room;
    }
    stream->frame[stream->frames].number = row->number;
    stream->frame[stream->frames++].bytes = (uint64_t)row->frame_bytes;
    stream->size += (uint64_t)row->frame_bytes;
    const uint64_t both[] = { stream->version, row->frame_version, (uint64_t)row->frame_bytes };
    stream->version = checksum_of(both, sizeof both);
    return true;
}

/* The first byte that is asked for may be in the middle of a frame. False: it has gone meanwhile, or is another. */
static bool open_next(frame_stream *stream)
{
    while (stream->next < stream->frames && stream->skipped >= stream->frame[stream->next].bytes)
        stream->skipped -= stream->frame[stream->next++].bytes;
    if (stream->next == stream->frames) return false;
    const int64_t number = stream->frame[stream->next].number;
    return open_frame(stream->store, stream->id, number, &stream->file) == STORE_OK
           && lseek(stream->file, 0, SEEK_END) == (off_t)stream->frame[stream->next].bytes
           && lseek(stream->file, (off_t)stream->skipped, SEEK_SET) == (off_t)stream->skipped;
}

static bool add_piece(void *context, text_buffer *out)
{
    frame_stream *stream = context;
    char piece[8 << 10];
    while (out->length < READ_AT_ONCE && stream->left > 0) {
        if (stream->file < 0 && !open_next(stream)) return false;
        const uint64_t of_frame = stream->frame[stream->next].bytes - stream->skipped;
        const uint64_t wanted = of_frame < stream->left ? of_frame : stream->left;
        const ssize_t got = read(stream->file, piece, wanted < sizeof piece ? (size_t)wanted : sizeof piece);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        text_buffer_add(out, piece, (size_t)got);
        stream->left -= (uint64_t)got;
        stream->skipped += (uint64_t)got;
        if (stream->skipped < stream->frame[stream->next].bytes) continue;
        close(stream->file);
        stream->file = -1;
    }
    return !out->failed;
}

/* False: the response says what is wrong with the query. */
static bool read_query(frame_stream *stream, const http_request *request, http_response *response)
{
    char problem[160];
    if (http_request_integer(request, "from", 0, INT64_MAX, 0, &stream->from, problem, sizeof problem)
        && http_request_integer(request, "to", 0, INT64_MAX, INT64_MAX, &stream->to, problem, sizeof problem)
        && http_request_integer(request, "every", 1, INT64_MAX, 1, &stream->every, problem, sizeof problem))
        return true;
    http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
    return false;
}

static void respond_frames(frame_stream *stream, const http_request *request, http_response *response)
{
    char version[32];
    snprintf(version, sizeof version, "%016llx", (unsigned long long)stream->version);
    name_file(response, stream->id, "-frames.bin", true);
    if (http_respond_unchanged(request, response, version)) return;
    response->status = 200;
    response->content_type = frame_type;
    if (!http_respond_part(request, response, stream->size)) return;
    stream->skipped = response->offset;
    stream->left = response->length;
    response->pieces = (http_pieces){ add_piece, free_frames, stream };
    response->pieces_length = response->length;
    response->offset = response->length = 0;
}

static void list_and_respond(frame_stream *stream, const http_request *request, http_response *response)
{
    const store_status status = store_list_snapshots(stream->store, stream->id, stream->from - 1, INT64_MAX, note_frame, stream);
    if (status != STORE_OK || stream->no_memory) {
        respond_store_failure(response, STORE_FAILED, "list the frames");
    } else if (stream->is_too_many) {
        http_respond_problem(response, 400, NULL, "Bad parameter",
                             "these are more than %d frames: ask for fewer by from, to and every", MOST_FRAMES);
    } else if (stream->frames == 0) {
        http_respond_problem(response, 404, NULL, "No such snapshot",
                             "job %s has no frames there; /jobs/%s/snapshots lists those that it has", stream->id, stream->id);
    } else {
        respond_frames(stream, request, response);
    }
}

void send_frames(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    if (!find_job(service, request, response, &job)) return;
    frame_stream *stream = calloc(1, sizeof *stream);
    if (stream) {
        stream->store = service->store;
        stream->file = -1;
        memcpy(stream->id, job.id, sizeof stream->id);
        if (read_query(stream, request, response)) list_and_respond(stream, request, response);
        if (!response->pieces.context) free_frames(stream);
    } else {
        respond_store_failure(response, STORE_FAILED, "list the frames");
    }
    job_record_clear(&job);
}
