#include "study_info.h"

#include <stdio.h>

#include "status_info.h"

job_status study_status(const study_record *study)
{
    const int64_t *counts = study->counts;
    if (study->jobs == 0) return JOB_DISMISSED; /* each was deleted by itself */
    if (counts[JOB_ACCEPTED] == study->jobs) return JOB_ACCEPTED;
    if (counts[JOB_ACCEPTED] + counts[JOB_RUNNING] > 0) return JOB_RUNNING;
    return counts[JOB_FAILED] > 0 ? JOB_FAILED : counts[JOB_DISMISSED] > 0 ? JOB_DISMISSED : JOB_SUCCESSFUL;
}

static json_t *links_of(const study_record *study)
{
    static const struct {
        const char *rel, *type, *format;
    } links[] = {
        { "self", "application/json", "/studies/%s" },
        { "http://www.opengis.net/def/rel/ogc/1.0/results", "application/json", "/studies/%s/results" },
        { "http://www.opengis.net/def/rel/ogc/1.0/results", "text/csv", "/studies/%s/results.csv" },
        { "spec", "application/json", "/studies/%s/spec" },
        { "http://www.opengis.net/def/rel/ogc/1.0/job-list", "application/json", "/jobs?study=%s" },
    };
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof links / sizeof links[0]; i++) {
        char href[80];
        snprintf(href, sizeof href, links[i].format, study->id);
        json_array_append_new(list, link_to(links[i].rel, links[i].type, href));
    }
    return list;
}

static json_t *message_of(const study_record *study)
{
    const int64_t *counts = study->counts;
    const int64_t ended = study->jobs - counts[JOB_ACCEPTED] - counts[JOB_RUNNING];
    char others[80] = "";
    int length = 0;
    if (counts[JOB_FAILED] > 0) length = snprintf(others, sizeof others, ", %lld of them failed", (long long)counts[JOB_FAILED]);
    if (counts[JOB_DISMISSED] > 0)
        snprintf(others + length, sizeof others - (size_t)length, "%s %lld dismissed", length ? "," : ", of them",
                 (long long)counts[JOB_DISMISSED]);
    return json_sprintf("%lld of %lld jobs have ended%s", (long long)ended, (long long)study->jobs, others);
}

json_t *study_info(const study_record *study)
{
    const job_status status = study_status(study);
    json_t *info =
        json_pack("{s:s, s:s, s:s, s:s, s:s, s:o, s:f, s:I, s:I, s:I, s:f}", "studyID", study->id, "processID", study->process,
                  "type", "study", "name", study->name, "status", job_status_name(status), "message", message_of(study), "progress",
                  study->progress, "cases", (json_int_t)study->cases, "repeats", (json_int_t)study->repeats, "jobs",
                  (json_int_t)study->jobs, "estimated_seconds", study->estimated_seconds);
    if (!info) return NULL;
    json_t *counts = json_object();
    for (int i = 0; i < JOB_STATUSES; i++)
        json_object_set_new(counts, job_status_name((job_status)i), json_integer(study->counts[i]));
    json_object_set_new(info, "counts", counts);
    json_object_set_new(info, "priority", json_integer(study->priority));
    json_object_set_new(info, "created", json_string(study->created));
    if (study->started[0]) json_object_set_new(info, "started", json_string(study->started));
    if (status != JOB_ACCEPTED && status != JOB_RUNNING) json_object_set_new(info, "finished", json_string(study->updated));
    json_object_set_new(info, "updated", json_string(study->updated));
    json_object_set_new(info, "links", links_of(study));
    return info;
}
