#include "event_tail.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "text_copy.h"

enum { BATCH_BYTES = 1 << 20 };

void event_batch_clear(event_batch *batch)
{
    json_decref(batch->samples);
    json_decref(batch->snapshots);
    json_decref(batch->checkpoints);
    json_decref(batch->failure);
    *batch = (event_batch){ .progress = NAN, .eta_seconds = NAN, .speed = NAN };
}

static double number_of(const json_t *event, const char *name)
{
    const json_t *value = json_object_get(event, name);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

static void take_progress(event_batch *batch, const json_t *event)
{
    batch->progress = number_of(event, "progress");
    batch->eta_seconds = number_of(event, "eta_seconds");
    batch->speed = number_of(event, "particle_steps_per_second");
    text_copy(batch->phase, sizeof batch->phase, json_string_value(json_object_get(event, "phase")));
}

static bool append(json_t *list, json_t *event) { return json_array_append(list, event) == 0; }

static void keep_failure(event_batch *batch, json_t *event)
{
    json_decref(batch->failure);
    batch->failure = json_incref(event);
}

/* False: no memory. */
static bool take_event(event_batch *batch, json_t *event)
{
    const char *kind = json_string_value(json_object_get(event, "event"));
    if (!kind) return true;
    batch->any = true;
    if (strcmp(kind, "progress") == 0) take_progress(batch, event);
    else if (strcmp(kind, "sample") == 0) return append(batch->samples, event);
    else if (strcmp(kind, "snapshot") == 0) return append(batch->snapshots, event);
    else if (strcmp(kind, "checkpoint") == 0) return append(batch->checkpoints, event);
    else if (strcmp(kind, "bed") == 0)
        text_copy(batch->bed, sizeof batch->bed, json_string_value(json_object_get(event, "sha256")));
    else if (strcmp(kind, "failure") == 0) keep_failure(batch, event);
    else if (strcmp(kind, "start") == 0) keep_failure(batch, NULL); /* forgets an earlier one */
    return true;
}

/* False: no memory, for which no event may be skipped. */
static bool take_line(event_batch *batch, const char *line, size_t length)
{
    json_error_t error;
    json_t *event = json_loadb(line, length, 0, &error);
    const enum json_error_code code = event ? json_error_unknown : json_error_code(&error);
    /* The parser tells of every fault in a text, but not of all places where memory was missing. */
    const bool good = event ? take_event(batch, event) : code != json_error_unknown && code != json_error_out_of_memory;
    json_decref(event);
    return good;
}

static ssize_t read_all(int file, char *text, size_t size, int64_t offset)
{
    size_t done = 0;
    while (done < size) {
        const ssize_t got = pread(file, text + done, size - done, offset + (int64_t)done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return -1;
        if (got == 0) break;
        done += (size_t)got;
    }
    return (ssize_t)done;
}

bool event_tail_read(int file, int64_t offset, event_batch *batch)
{
    *batch = (event_batch){ .progress = NAN, .eta_seconds = NAN, .speed = NAN, .end = offset };
    batch->samples = json_array();
    batch->snapshots = json_array();
    batch->checkpoints = json_array();
    char *text = malloc(BATCH_BYTES);
    const bool has_room = text && batch->samples && batch->snapshots && batch->checkpoints;
    const ssize_t length = has_room ? read_all(file, text, BATCH_BYTES, offset) : -1;
    const char *line = text;
    bool good = length >= 0;
    for (ssize_t left = length; good && left > 0;) {
        const char *end = memchr(line, '\n', (size_t)left);
        if (!end && left == BATCH_BYTES) end = line + left - 1; /* no event is that long: skip the piece */
        if (!end) break;
        good = take_line(batch, line, (size_t)(end - line));
        left -= end + 1 - line;
        line = end + 1;
    }
    if (length > 0) batch->end = offset + (line - text);
    batch->more = length == BATCH_BYTES;
    free(text);
    if (!good) event_batch_clear(batch);
    return good;
}
