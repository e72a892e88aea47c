/* What can be run, and running it. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

#include "handlers.h"
#include "json_text.h"
#include "process_type.h"
#include "status_info.h"

/* Where a process is described, run, and its jobs are. */
static void add_links(json_t *description)
{
    const char *process = json_string_value(json_object_get(description, "id"));
    char self[40], execution[60], jobs[60];
    snprintf(self, sizeof self, "/processes/%s", process);
    snprintf(execution, sizeof execution, "/processes/%s/execution", process);
    snprintf(jobs, sizeof jobs, "/jobs?processID=%s", process);
    json_object_set_new(description, "links",
                        json_pack("[o, o, o]", link_to("self", "application/json", self),
                                  link_to("http://www.opengis.net/def/rel/ogc/1.0/execute", "application/json", execution),
                                  link_to("http://www.opengis.net/def/rel/ogc/1.0/job-list", "application/json", jobs)));
}

void list_processes(api_service *service, const http_request *request, http_response *response)
{
    (void)service;
    char problem[160];
    int64_t limit, after;
    if (!http_request_integer(request, "limit", 1, INT64_MAX, INT64_MAX, &limit, problem, sizeof problem)
        || !http_request_integer(request, "cursor", 1, INT64_MAX, 0, &after, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return;
    }
    json_t *all = process_summaries(), *page = json_array(), *links = json_pack("[o]", list_link(request, "self", NULL));
    const int64_t rest = (int64_t)json_array_size(all) - after;
    for (int64_t p = 0; p < rest && p < limit; p++) {
        add_links(json_array_get(all, (size_t)(after + p)));
        json_array_append(page, json_array_get(all, (size_t)(after + p)));
    }
    char next[24];
    snprintf(next, sizeof next, "%lld", (long long)(after + limit));
    if (limit < rest) json_array_append_new(links, list_link(request, "next", next));
    json_decref(all);
    http_respond_json(response, 200, json_pack("{s:o, s:o}", "processes", page, "links", links));
}

static void respond_no_such_process(http_response *response, const char *process)
{
    http_respond_problem(response, 404, NULL, "No such process", "there is no process \"%s\"; /processes lists them", process);
}

void show_process(api_service *service, const http_request *request, http_response *response)
{
    (void)service;
    json_t *description = process_description(request->segment[0]);
    if (description) add_links(description);
    if (description) http_respond_json(response, 200, description);
    else respond_no_such_process(response, request->segment[0]);
}

static void respond_without_memory(http_response *response)
{
    http_respond_problem(response, 503, NULL, "Out of memory", "the request could not be read; try again");
}

json_t *parse_body(const http_request *request, http_response *response)
{
    problem_list problems;
    if (!problem_list_init(&problems)) {
        respond_without_memory(response);
        return NULL;
    }
    json_t *document = json_text_load(request->body ? request->body : "", request->body_length, &problems);
    if (!document && errno == ENOMEM) respond_without_memory(response);
    else if (!document) http_respond_problems(response, 400, "Not JSON", "the body can't be read", &problems);
    problem_list_clear(&problems);
    return document;
}

uint64_t choose_seed(void)
{
    uint64_t bits = 0;
    while (getrandom(&bits, sizeof bits, 0) != (ssize_t)sizeof bits) continue; /* EINTR is the only failure of 8 bytes */
    return bits >> (64 - WHOLE_NUMBER_BITS);
}

/* Only where the process has such an input. */
static void set_default_threads(const api_service *service, const process_type *type, json_t *document)
{
    json_t *inputs = json_object_get(document, "inputs");
    if (spec_field_find(type->inputs, SPEC_INPUTS, "threads") && json_is_object(inputs) && !json_object_get(inputs, "threads"))
        json_object_set_new(inputs, "threads", json_integer(service->default_threads));
}

/* As many as a usual request has several times over, and so few that whatever they say is read and checked in some tens of
 * milliseconds: a cluster of as many spheres as they can tell of takes that long. */
enum { SHORT_BODY = 16 << 10, FEW_VALUES = 160 };

static void count_values(const json_t *value, size_t *left)
{
    const char *name;
    json_t *member;
    size_t i;
    if (*left == 0) return;
    --*left;
    json_object_foreach((json_t *)value, name, member) count_values(member, left);
    json_array_foreach(value, i, member) count_values(member, left);
}

/* Whether reading and checking it may take more than a moment. */
static bool takes_long(const json_t *document)
{
    size_t left = FEW_VALUES;
    count_values(document, &left);
    const json_t *start = json_object_get(json_object_get(document, "inputs"), "start");
    return left == 0 || json_is_object(start); /* whose bed may have been made by a long specification */
}

/* The disk, and what one POST may ask for. */
static bool fits_service(api_service *service, const job_spec *spec, problem_list *problems)
{
    const post_limits *limits = service->limits;
    const bool is_timed = limits && limits->estimate_seconds > 0.0; /* only then does it matter how fast the machine is */
    calibration machine;
    if (is_timed) store_read_calibration(service->store, &machine);
    const job_estimate estimate = job_spec_estimate(spec, is_timed ? &machine : NULL);
    if (limits) {
        job_check_limits(limits, "/inputs", estimate.wall_seconds, estimate.particles, estimate.snapshot_bytes, spec->threads,
                         problems);
        job_resources_check_allowed(spec->resources, &limits->resources, problems);
    }
    job_check_disk(job_estimate_disk_bytes(&estimate), store_free_bytes(service->store), "/inputs/snapshots/interval", problems);
    subscriber_check_hosts(spec->subscriber, &service->callback_hosts, problems);
    return problem_list_is_empty(problems);
}

/* False: there are problems, or it is answered that there is no memory. */
static bool read_document(api_service *service, const process_type *type, const http_request *request, http_response *response,
                          json_t *document, job_spec *spec, problem_list *problems)
{
    errno = 0;
    set_default_threads(service, type, document);
    start_source beds = store_beds(service->store);
    beds.client = &request->client;
    bool good = job_spec_parse_with(&beds, type->name, document, choose_seed(), spec, problems);
    if (good && !fits_service(service, spec, problems)) {
        job_spec_clear(spec);
        good = false;
    }
    /* What was left out for want of memory is nobody's fault, and nothing else may be run in its place. */
    if (errno != ENOMEM) return good;
    if (good) job_spec_clear(spec);
    json_array_clear(problems->errors);
    respond_without_memory(response);
    return false;
}

static bool read_spec(api_service *service, const process_type *type, const http_request *request, http_response *response,
                      job_spec *spec)
{
    response->wants_lane = !request->in_lane && request->body_length > SHORT_BODY;
    json_t *document = response->wants_lane ? NULL : parse_body(request, response);
    if (!document) return false;
    response->wants_lane = !request->in_lane && takes_long(document);
    if (response->wants_lane) {
        json_decref(document);
        return false;
    }
    problem_list problems;
    bool good = false;
    if (!problem_list_init(&problems)) {
        respond_without_memory(response);
    } else {
        good = read_document(service, type, request, response, document, spec, &problems);
        if (!problem_list_is_empty(&problems))
            http_respond_problems(response, 400, "The specification can't be run",
                                  "each entry of errors names a member, what it is and what it may be", &problems);
        problem_list_clear(&problems);
    }
    json_decref(document);
    return good;
}

/* What Prefer asks for (RFC 7240): "wait=10", "respond-async", or what clients of OGC API - Processes say, "respond-sync". */
typedef struct preference {
    double seconds; /* to wait for the results; 0: not at all */
    bool is_async, is_sync;
} preference;

static preference read_preference(const char *header)
{
    preference wished = { 0 };
    for (const char *at = header; at && *at; at += strcspn(at, ",;")) {
        at += strspn(at, ",; \t");
        const size_t length = strcspn(at, ",; \t");
        if (length == 13 && strncasecmp(at, "respond-async", length) == 0) wished.is_async = true;
        if (length == 12 && strncasecmp(at, "respond-sync", length) == 0) wished.is_sync = true;
        if (length > 5 && strncasecmp(at, "wait=", 5) == 0) wished.seconds = strtod(at + 5, NULL);
    }
    if (wished.is_sync && !(wished.seconds > 0.0)) wished.seconds = LONGEST_WAIT;
    if (!(wished.seconds > 0.0)) wished.seconds = 0.0;
    if (wished.seconds > LONGEST_WAIT) wished.seconds = LONGEST_WAIT;
    return wished;
}

static void add_estimate(api_service *service, json_t *info, const job_spec *spec)
{
    calibration machine;
    store_read_calibration(service->store, &machine);
    json_t *report = job_spec_report(spec, &machine);
    json_object_del(report, "spec"); /* it has an address */
    json_object_update(info, report);
    json_decref(report);
}

/* What would become of it, and nothing else. */
static void respond_checked(api_service *service, http_response *response, const job_spec *spec)
{
    calibration machine;
    store_read_calibration(service->store, &machine);
    http_respond_json(response, 200, job_spec_report(spec, &machine));
}

static void respond_created(api_service *service, const http_request *request, http_response *response, const job_spec *spec,
                            const char *id)
{
    job_record job;
    const store_status status = store_find_job(service->store, id, &job);
    if (status != STORE_OK) { /* it is safe in the queue all the same: say so */
        http_respond_json(
            response, 201,
            json_pack("{s:s, s:s, s:s, s:s}", "jobID", id, "processID", spec->process, "type", "process", "status", "accepted"));
    } else {
        json_t *info = status_info(&job);
        add_estimate(service, info, spec);
        http_respond_json(response, 201, info);
        job_record_clear(&job);
    }
    const preference wished = read_preference(request->prefer);
    snprintf(response->location, sizeof response->location, "/jobs/%s", id);
    if (wished.is_async || wished.seconds > 0.0)
        snprintf(response->preference_applied, sizeof response->preference_applied, "respond-async");
}

/* The job that this request has made is still awaited: what becomes of it, or that it goes on without anybody waiting. */
static void respond_to_wait(api_service *service, const http_request *request, http_response *response)
{
    const preference wished = read_preference(request->prefer);
    job_record job;
    char *text = NULL;
    const store_status status = store_find_job(service->store, request->made, &job);
    if (status != STORE_OK) {
        if (status == STORE_NOT_FOUND) respond_no_such_job(response, request->made);
        else respond_store_failure(response, status, "read the job");
        return;
    }
    if (job.status != JOB_ACCEPTED && job.status != JOB_RUNNING) {
        respond_results(service, request, response, &job, 500);
        snprintf(response->location, sizeof response->location, "/jobs/%s", job.id);
        if (response->status < 300)
            snprintf(response->preference_applied, sizeof response->preference_applied, wished.is_sync ? "respond-sync" : "wait=%g",
                     wished.seconds);
    } else if (request->may_wait && request->waited < wished.seconds) {
        response->wait = wished.seconds - request->waited;
        memcpy(response->made, request->made, sizeof response->made);
    } else {
        problem_list problems = { 0 };
        job_spec spec = { 0 };
        json_t *document = store_read_spec(service->store, job.id, &text) == STORE_OK ? json_loads(text, 0, NULL) : NULL;
        if (document && problem_list_init(&problems) && job_spec_parse(NULL, document, 0, &spec, &problems))
            respond_created(service, request, response, &spec, job.id);
        else respond_store_failure(response, STORE_FAILED, "read the job");
        job_spec_clear(&spec);
        problem_list_clear(&problems);
        json_decref(document);
        free(text);
    }
    job_record_clear(&job);
}

/* Waits for it where the client prefers that and it may be waited for here. */
static void add_job(api_service *service, const http_request *request, http_response *response, const job_spec *spec, bool may_wait)
{
    char id[JOB_ID_SIZE];
    if (spec->subscriber) json_object_set_new(spec->subscriber, "base", json_string(response->base));
    const store_status status = store_add_job(service->store, spec, id);
    if (status != STORE_OK) {
        respond_not_kept(service, response, status, "keep the job");
        return;
    }
    response->wait = may_wait ? read_preference(request->prefer).seconds : 0.0;
    if (response->wait > 0.0) snprintf(response->made, sizeof response->made, "%s", id);
    else respond_created(service, request, response, spec, id); /* first, so that it shows the job as accepted */
    service->jobs_changed(service->daemon);
}

void execute_process(api_service *service, const http_request *request, http_response *response)
{
    const process_type *type = process_type_find(request->segment[0]);
    if (!type) {
        respond_no_such_process(response, request->segment[0]);
        return;
    }
    if (request->made[0]) {
        respond_to_wait(service, request, response);
        return;
    }
    char problem[160];
    bool checks;
    if (!http_request_truth(request, "check", &checks, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return;
    }
    job_spec spec;
    if (!read_spec(service, type, request, response, &spec)) return;
    if (checks) respond_checked(service, response, &spec);
    else add_job(service, request, response, &spec, true);
    job_spec_clear(&spec);
}

void execute_document(api_service *service, const http_request *request, http_response *response, json_t *document,
                      problem_list *problems)
{
    const process_type *type = process_type_find(json_string_value(json_object_get(document, "process")));
    job_spec spec;
    if (!read_document(service, type, request, response, document, &spec, problems)) return;
    add_job(service, request, response, &spec, false);
    job_spec_clear(&spec);
}
