#include "failure_report.h"
#include "json_text.h"

#include <stdio.h>

#include "worker_log.h"

typedef struct failure_kind {
    const char *name; /* "status" of the failure event */
    enum worker_exit code;
} failure_kind;

static failure_kind kind_of(dem_status status)
{
    switch (status) {
    case DEM_OK: return (failure_kind){ "none", WORKER_FAULT };
    case DEM_NO_MEMORY: return (failure_kind){ "no-memory", WORKER_MACHINE };
    case DEM_BAD_PARAMETER: return (failure_kind){ "bad-parameter", WORKER_BAD_SPEC };
    case DEM_DOES_NOT_FIT: return (failure_kind){ "does-not-fit", WORKER_BAD_SPEC };
    case DEM_NOT_A_NUMBER: return (failure_kind){ "not-a-number", WORKER_NUMERICAL };
    case DEM_OVERLAP_TOO_LARGE: return (failure_kind){ "overlap-too-large", WORKER_NUMERICAL };
    case DEM_PARTICLE_ESCAPED: return (failure_kind){ "particle-escaped", WORKER_NUMERICAL };
    case DEM_NEVER_SETTLED: return (failure_kind){ "never-settled", WORKER_NUMERICAL };
    case DEM_TOO_FEW_FRAMES: return (failure_kind){ "too-few-frames", WORKER_FAULT };
    case DEM_STATE_MISMATCH: return (failure_kind){ "state-mismatch", WORKER_FAULT };
    }
    return (failure_kind){ "unknown", WORKER_FAULT };
}

/* "an overlap is too large: particle 17 with the wall, overlap 1.2e-3 m (limit 9e-4 m) at (..) m, step 5, 0.1 s after
 * rotation began. Likely cause: ..." */
static void describe(const dem_failure *failure, char *text, size_t size)
{
    char particle[140] = "", other[40] = "", value[120] = "";
    if (failure->particle >= 0) {
        if (failure->other >= 0) snprintf(other, sizeof other, " with particle %lld", (long long)failure->other);
        snprintf(particle, sizeof particle, " particle %lld%s at (%.4g, %.4g, %.4g) m,", (long long)failure->particle, other,
                 failure->position[0], failure->position[1], failure->position[2]);
    }
    if (failure->quantity)
        snprintf(value, sizeof value, " %.40s %.4g %.16s (limit %.4g %.16s),", failure->quantity, failure->value,
                 failure->unit ? failure->unit : "", failure->limit, failure->unit ? failure->unit : "");
    snprintf(text, size, "%s:%s%s step %lld, time %.6g s.%s%s", dem_status_text(failure->status), particle, value,
             (long long)failure->step, failure->time, failure->likely_cause ? " Likely cause: " : "",
             failure->likely_cause ? failure->likely_cause : "");
}

static json_t *detail_json(const dem_failure *failure)
{
    json_t *detail =
        json_pack("{s:I, s:o, s:I, s:I, s:[o, o, o], s:o, s:o, s:s, s:s, s:s}", "step", (json_int_t)failure->step, "time",
                  json_real_or_null(failure->time), "particle", (json_int_t)failure->particle, "other", (json_int_t)failure->other,
                  "position", json_real_or_null(failure->position[0]), json_real_or_null(failure->position[1]),
                  json_real_or_null(failure->position[2]), "value", json_real_or_null(failure->value), "limit",
                  json_real_or_null(failure->limit), "quantity", failure->quantity ? failure->quantity : "", "unit",
                  failure->unit ? failure->unit : "", "likely_cause", failure->likely_cause ? failure->likely_cause : "");
    return detail;
}

enum worker_exit failure_report(event_log *events, dem_status status, const dem_failure *failure)
{
    const failure_kind kind = kind_of(status);
    char message[700];
    if (failure && failure->status != status) failure = NULL; /* of something else, or of nothing */
    if (failure) describe(failure, message, sizeof message);
    else snprintf(message, sizeof message, "%s", dem_status_text(status));
    json_t *event = json_pack("{s:s, s:s, s:s}", "event", "failure", "status", kind.name, "message", message);
    if (event && failure) {
        json_object_set_new(event, "step", json_integer(failure->step));
        json_object_set_new(event, "time", json_real_or_null(failure->time));
        json_object_set_new(event, "detail", detail_json(failure));
    }
    worker_warn("failed: %s", message);
    /* An end that can't be told counts as one for want of room: the next attempt tells it. */
    return event_log_add(events, event) || kind.code == WORKER_MACHINE ? kind.code : WORKER_DISK;
}

enum worker_exit failure_report_as(event_log *events, dem_status status, const char *message)
{
    const failure_kind kind = kind_of(status);
    json_t *event = json_pack("{s:s, s:s, s:s}", "event", "failure", "status", kind.name, "message", message);
    worker_warn("failed: %s", message);
    return event_log_add(events, event) ? kind.code : WORKER_DISK;
}

enum worker_exit failure_report_disk(event_log *events, const char *name)
{
    event_log_add(events, json_pack("{s:s, s:s, s:o}", "event", "failure", "status", "disk", "message",
                                    json_sprintf("can't write %s: disk full or not writable", name)));
    return WORKER_DISK;
}
