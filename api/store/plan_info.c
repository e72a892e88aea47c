#include "plan_info.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "json_text.h"
#include "status_info.h"

static json_t *links_of(const plan_record *plan)
{
    static const struct {
        const char *rel, *type, *format;
    } links[] = {
        { "self", "application/json", "/calibrations/%s" },
        { "http://www.opengis.net/def/rel/ogc/1.0/results", "application/json", "/calibrations/%s/results" },
        { "http://www.opengis.net/def/rel/ogc/1.0/results", "text/csv", "/calibrations/%s/results.csv" },
        { "spec", "application/json", "/calibrations/%s/spec" },
        { "http://www.opengis.net/def/rel/ogc/1.0/job-list", "application/json", "/jobs?label.calibrationID=%s" },
    };
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof links / sizeof links[0]; i++) {
        char href[100];
        snprintf(href, sizeof href, links[i].format, plan->id);
        json_array_append_new(list, link_to(links[i].rel, links[i].type, href));
    }
    return list;
}

static bool has_ended(const plan_record *plan) { return plan->status != JOB_ACCEPTED && plan->status != JOB_RUNNING; }

/* What the planner is waiting for, or what became of it all. */
static json_t *message_of(const plan_record *plan)
{
    static const char *const stages[][2] = { { "start", "runs all over the ranges" },
                                             { "refine", "runs where they tell most" },
                                             { "verify", "fresh runs of the sets that were found" } };
    const char *doing = "";
    const int64_t left = plan->counts[JOB_ACCEPTED] + plan->counts[JOB_RUNNING];
    if (has_ended(plan) || plan->message[0]) return json_string(plan->message);
    if (plan->runs == 0) return json_string("waiting to be planned");
    for (size_t s = 0; s < sizeof stages / sizeof stages[0]; s++)
        if (strcmp(stages[s][0], plan->stage) == 0) doing = stages[s][1];
    if (left == 0) return json_sprintf("%s: planning, %lld runs have ended", doing, (long long)plan->runs);
    return json_sprintf("%s: %lld of %lld have ended, %lld at most in all", doing, (long long)(plan->runs - left),
                        (long long)plan->runs, (long long)plan->most_jobs);
}

json_t *plan_info(const plan_record *plan)
{
    json_t *info =
        json_pack("{s:s, s:s, s:s, s:s, s:o, s:f, s:s, s:I, s:I, s:f, s:i}", "calibrationID", plan->id, "type", "calibration",
                  "name", plan->name, "status", job_status_name(plan->status), "message", message_of(plan), "progress",
                  plan->progress, "stage", plan->stage, "jobs", (json_int_t)plan->runs, "most_jobs", (json_int_t)plan->most_jobs,
                  "estimated_seconds", plan->estimated_seconds, "priority", plan->priority);
    if (!info) return NULL;
    json_t *counts = json_object();
    for (int i = 0; i < JOB_STATUSES; i++)
        json_object_set_new(counts, job_status_name((job_status)i), json_integer(plan->counts[i]));
    json_object_set_new(info, "counts", counts);
    if (isfinite(plan->eta_seconds)) json_object_set_new(info, "eta_seconds", json_real(plan->eta_seconds));
    json_object_set_new(info, "created", json_string(plan->created));
    if (plan->started[0]) json_object_set_new(info, "started", json_string(plan->started));
    if (plan->finished[0]) json_object_set_new(info, "finished", json_string(plan->finished));
    json_object_set_new(info, "updated", json_string(plan->updated));
    json_object_set_new(info, "links", links_of(plan));
    return info;
}
