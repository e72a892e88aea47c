#include "status_info.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
    json_decref(job->summary);
    *job = (job_record){ .number = 0 };
}

json_t *link_to(const char *rel, const char *type, const char *href)
{
    return json_pack("{s:s, s:s, s:s}", "rel", rel, "type", type, "href", href);
}

static json_t *links_of(const job_record *job)
{
    static const struct {
        const char *rel, *type, *end;
        bool is_result;      /* there once the job has ended well */
        const char *process; /* of this one alone; NULL: of all */
        const char *but;     /* not of this one */
    } links[] = {
        { "self", "application/json", .end = "" },
        { "http://www.opengis.net/def/rel/ogc/1.0/results", "application/json", .end = "/results", .is_result = true },
        { "spec", "application/json", .end = "/spec" },
        { "log", "text/plain", .end = "/log" },
        { "samples", "application/json", .end = "/samples" },
        { "snapshots", "application/json", .end = "/snapshots" },
        { "series", "application/json", .end = "/snapshots.hdf.series", .is_result = true, .but = "granule" },
        { "walls", "application/xml", .end = "/walls.vtp", .is_result = true, .but = "granule" },
        { "fields", "application/x-hdf5", .end = "/fields.hdf", .is_result = true, .process = "drum" },
        { "archive", "application/x-tar", .end = "/files.tar" },
    };
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof links / sizeof links[0]; i++) {
        if (links[i].is_result && job->status != JOB_SUCCESSFUL) continue;
        if (links[i].process && strcmp(job->process, links[i].process) != 0) continue;
        if (links[i].but && strcmp(job->process, links[i].but) == 0) continue;
        char href[80];
        snprintf(href, sizeof href, "/jobs/%s%s", job->id, links[i].end);
        json_array_append_new(list, link_to(links[i].rel, links[i].type, href));
    }
    return list;
}

static void set_time(json_t *info, const char *name, const char *time)
{
    if (time[0]) json_object_set_new(info, name, json_string(time));
}

json_t *status_info(const job_record *job)
{
    json_t *info =
        json_pack("{s:s, s:s, s:s, s:s, s:s, s:i, s:i}", "jobID", job->id, "processID", job->process, "type", "process", "status",
                  job_status_name(job->status), "message", job->message, "progress", (int)job->progress, "attempt", job->attempt);
    if (!info) return NULL;
    json_object_set_new(info, "priority", json_integer(job->priority));
    set_time(info, "created", job->created);
    set_time(info, "started", job->started);
    set_time(info, "finished", job->finished);
    set_time(info, "updated", job->updated);
    if (job->status == JOB_RUNNING && isfinite(job->eta_seconds))
        json_object_set_new(info, "eta_seconds", json_real(job->eta_seconds));
    if (job->study[0]) json_object_set_new(info, "studyID", json_string(job->study));
    if (job->is_pinned) json_object_set_new(info, "pinned", json_true());
    json_object_set(info, "label", job->label);
    json_object_set(info, "summary", job->summary);
    json_object_set_new(info, "links", links_of(job));
    return info;
}
