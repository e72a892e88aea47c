#include "event_tail.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    const char *phase = json_string_value(json_object_get(event, "phase"));
    snprintf(batch->phase, sizeof batch->phase, "%s", phase ? phase : "");
}

static void take_event(event_batch *batch, json_t *event)
{
    const char *kind = json_string_value(json_object_get(event, "event"));
    if (!kind) return;
    batch->any = true;
    if (strcmp(kind, "progress") == 0) take_progress(batch, event);
    else if (strcmp(kind, "sample") == 0) json_array_append(batch->samples, event);
    else if (strcmp(kind, "snapshot") == 0) json_array_append(batch->snapshots, event);
    else if (strcmp(kind, "checkpoint") == 0) json_array_append(batch->checkpoints, event);
    else if (strcmp(kind, "failure") == 0 || strcmp(kind, "start") == 0) {
        json_decref(batch->failure);
        batch->failure = kind[0] == 'f' ? json_incref(event) : NULL; /* a new start forgets an earlier failure */
    }
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
    for (ssize_t left = length; left > 0;) {
        const char *end = memchr(line, '\n', (size_t)left);
        if (!end && left == BATCH_BYTES) end = line + left - 1; /* no event is that long: skip the piece */
        if (!end) break;
        json_t *event = json_loadb(line, (size_t)(end - line), 0, NULL);
        take_event(batch, event);
        json_decref(event);
        left -= end + 1 - line;
        line = end + 1;
    }
    if (length > 0) batch->end = offset + (line - text);
    batch->more = length == BATCH_BYTES;
    free(text);
    if (length < 0) event_batch_clear(batch);
    return length >= 0;
}
