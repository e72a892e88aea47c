#include "status_info.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json_writer.h"

enum { LONGEST_BASE = 400, LONGEST_INFO = 1 << 20 };

static const char *const status_names[] = { "accepted", "running", "successful", "failed", "dismissed" };
_Static_assert(sizeof status_names / sizeof *status_names == JOB_STATUSES, "each status has a name");

const char *job_status_name(job_status status) { return status_names[status]; }

bool job_status_parse(const char *name, size_t length, job_status *status)
{
    for (int i = 0; i < JOB_STATUSES; i++) {
        if (strlen(status_names[i]) != length || strncmp(status_names[i], name, length) != 0) continue;
        *status = (job_status)i;
        return true;
    }
    return false;
}

void job_record_clear(job_record *job)
{
    json_decref(job->label);
    for (size_t i = 0; i < job->summary_count; i++) free(job->summary[i].text);
    free(job->summary);
    *job = (job_record){ .number = 0 };
}

json_t *link_to(const char *rel, const char *type, const char *href)
{
    return json_pack("{s:s, s:s, s:s}", "rel", rel, "type", type, "href", href);
}

#define WRITE(out, literal) text_buffer_add(out, literal, sizeof literal - 1)

static bool summary_has(const job_record *job, const char *name)
{
    for (size_t i = 0; i < job->summary_count; i++)
        if (strcmp(job->summary[i].name, name) == 0) return true;
    return false;
}

static void write_links(text_buffer *out, const job_record *job, const char *base)
{
    static const struct {
        const char *rel, *type, *end;
        bool is_result;      /* there once the job has ended well */
        bool is_of_run;      /* there soon after the job has begun */
        const char *process; /* of this one alone; NULL: of all */
        const char *but;     /* not of this one */
        const char *with;    /* of jobs whose summary has this alone; NULL: of all */
    } links[] = {
        { "self", "application/json", .end = "" },
        { "http://www.opengis.net/def/rel/ogc/1.0/results", "application/json", .end = "/results", .is_result = true },
        { "spec", "application/json", .end = "/spec" },
        { "log", "text/plain", .end = "/log" },
        { "samples", "application/json", .end = "/samples" },
        { "snapshots", "application/json", .end = "/snapshots" },
        { "series", "application/json", .end = "/snapshots.hdf.series", .is_result = true, .but = "granule" },
        { "walls", "application/xml", .end = "/walls.vtp", .is_result = true, .but = "granule" },
        { "frames", "application/octet-stream", .end = "/frames.bin", .is_of_run = true, .but = "granule" },
        { "picture", "image/png", .end = "/picture.png", .is_of_run = true, .but = "granule" },
        { "fields", "application/json", .end = "/fields.json", .is_result = true, .process = "drum" },
        { "fields", "application/json", .end = "/fields.json", .is_result = true, .process = "orifice" },
        { "fields", "application/x-hdf5", .end = "/fields.hdf", .is_result = true, .process = "drum" },
        { "fields", "application/x-hdf5", .end = "/fields.hdf", .is_result = true, .process = "orifice" },
        { "tracers", "text/csv", .end = "/tracers.csv", .is_result = true, .with = "tracers" },
        { "tracers", "application/x-hdf5", .end = "/tracers.hdf", .is_result = true, .with = "tracers" },
        { "archive", "application/x-tar", .end = "/files.tar" },
    };
    char between = '[';
    for (size_t i = 0; i < sizeof links / sizeof links[0]; i++) {
        if (links[i].is_result && job->status != JOB_SUCCESSFUL) continue;
        if (links[i].is_of_run && !job->started[0]) continue;
        if (links[i].process && strcmp(job->process, links[i].process) != 0) continue;
        if (links[i].but && strcmp(job->process, links[i].but) == 0) continue;
        if (links[i].with && !summary_has(job, links[i].with)) continue;
        char href[LONGEST_BASE + 80];
        snprintf(href, sizeof href, "%.*s/jobs/%s%s", LONGEST_BASE, base, job->id, links[i].end);
        text_buffer_add(out, &between, 1);
        between = ',';
        WRITE(out, "{\"rel\":");
        json_write_string(out, links[i].rel);
        WRITE(out, ",\"type\":");
        json_write_string(out, links[i].type);
        WRITE(out, ",\"href\":");
        json_write_string(out, href);
        WRITE(out, "}");
    }
    WRITE(out, "]");
}

static void write_summary(text_buffer *out, const job_record *job)
{
    char between = '{';
    for (size_t i = 0; i < job->summary_count; i++) {
        const summary_value *value = &job->summary[i];
        text_buffer_add(out, &between, 1);
        between = ',';
        json_write_string(out, value->name);
        WRITE(out, ":");
        if (value->kind == SUMMARY_REAL) json_write_real(out, value->real);
        else if (value->kind == SUMMARY_TEXT) json_write_string(out, value->text);
        else if (value->kind == SUMMARY_WHOLE) json_write_integer(out, value->whole);
        else if (value->whole) WRITE(out, "true");
        else WRITE(out, "false");
    }
    if (between == '{') WRITE(out, "{");
    WRITE(out, "}");
}

/* "": it is not there. */
static void write_text(text_buffer *out, const char *name, const char *text)
{
    if (!text[0]) return;
    WRITE(out, ",");
    json_write_string(out, name);
    WRITE(out, ":");
    json_write_string(out, text);
}

static void write_whole(text_buffer *out, const char *name, int64_t number)
{
    WRITE(out, ",");
    json_write_string(out, name);
    WRITE(out, ":");
    json_write_integer(out, number);
}

void status_info_write(text_buffer *out, const job_record *job, const char *base)
{
    WRITE(out, "{\"jobID\":");
    json_write_string(out, job->id);
    write_text(out, "processID", job->process);
    write_text(out, "type", "process");
    write_text(out, "status", job_status_name(job->status));
    WRITE(out, ",\"message\":");
    json_write_string(out, job->message);
    write_whole(out, "progress", (int64_t)job->progress);
    write_whole(out, "attempt", job->attempt);
    write_whole(out, "priority", job->priority);
    write_text(out, "created", job->created);
    write_text(out, "started", job->started);
    write_text(out, "finished", job->finished);
    write_text(out, "updated", job->updated);
    if (job->status == JOB_RUNNING && isfinite(job->eta_seconds)) {
        WRITE(out, ",\"eta_seconds\":");
        json_write_real(out, job->eta_seconds);
    }
    write_text(out, "studyID", job->study);
    if (job->is_pinned) WRITE(out, ",\"pinned\":true");
    if (job->label) {
        WRITE(out, ",\"label\":");
        if (!json_write(out, job->label)) out->failed = true;
    }
    WRITE(out, ",\"summary\":");
    write_summary(out, job);
    WRITE(out, ",\"links\":");
    write_links(out, job, base);
    WRITE(out, "}");
}

json_t *status_info(const job_record *job)
{
    text_buffer text;
    text_buffer_init(&text, LONGEST_INFO);
    status_info_write(&text, job, "");
    json_t *info = text.failed ? NULL : json_loadb(text.text, text.length, 0, NULL);
    text_buffer_clear(&text);
    return info;
}
