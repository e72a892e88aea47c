/* The list of jobs, one job, and dismissing, deleting or trying it again. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"
#include "status_info.h"

void respond_store_failure(http_response *response, store_status status, const char *wanted)
{
    if (status == STORE_FULL) {
        http_respond_problem(
            response, 507, NULL, "No room on the disk",
            "could not %s: the data folder's disk is full, or so nearly that what is left is for jobs that run. DELETE of jobs "
            "and studies that have ended makes room, most of it of their snapshots; the option --keep-bytes does "
            "so by itself",
            wanted);
        return;
    }
    if (status == STORE_QUEUE_FULL) {
        http_respond_problem(response, 503, NULL, "The queue is full",
                             "could not %s: with it more jobs would wait than may (--queue-limit); try again later", wanted);
        response->retry_after = 60;
        return;
    }
    http_respond_problem(response, 503, NULL, "Store not available", "could not %s; the daemon's log says why", wanted);
    response->retry_after = 5;
}

void respond_not_kept(api_service *service, http_response *response, store_status status, const char *wanted)
{
    room_to_free room;
    if (status != STORE_FULL || store_look_for_room(service->store, &room) != STORE_OK) {
        respond_store_failure(response, status, wanted);
        return;
    }
    http_respond_problem(
        response, 507, NULL, "No room on the disk",
        "could not %s: the data folder's disk is full, or nearly so: it has %.3g MB and %.0f inodes free, of which "
        "%.3g MB and %.0f inodes are for jobs that run. The snapshots of %lld jobs that have ended take %s%.3g MB; "
        "the option --keep-bytes removes the oldest by itself, `reposed prune` once. DELETE of the %lld jobs that "
        "have ended frees these and the rest of their folders",
        wanted, 1e-6 * room.free_bytes, room.free_inodes, 1e-6 * room.kept_bytes, room.kept_inodes, (long long)room.jobs,
        room.is_more ? "more than " : "", 1e-6 * room.snapshot_bytes, (long long)room.ended);
}

void respond_no_such_job(http_response *response, const char *id)
{
    http_respond_problem(response, 404, NULL, "No such job", "there is no job \"%s\"; /jobs lists them", id);
}

bool find_job(api_service *service, const http_request *request, http_response *response, job_record *job)
{
    const char *id = request->segment[0];
    const store_status status = job_id_is_valid(id) ? store_find_job(service->store, id, job) : STORE_NOT_FOUND;
    if (status == STORE_NOT_FOUND) respond_no_such_job(response, id);
    else if (status != STORE_OK) respond_store_failure(response, status, "read the job");
    return status == STORE_OK;
}

static bool has_ended(const job_record *job) { return job->status != JOB_ACCEPTED && job->status != JOB_RUNNING; }

/* What is told of one job: of one that waits also where it stands. */
static json_t *info_with_place(api_service *service, const job_record *job)
{
    json_t *info = status_info(job);
    queue_place place;
    if (job->status == JOB_ACCEPTED && store_find_place(service->store, job->id, &place) == STORE_OK) {
        json_object_set_new(info, "position", json_integer(place.position));
        json_object_set_new(info, "expected_start", json_string(place.expected_start));
    }
    return info;
}

/* ?wait=SECONDS answers as soon as the job has ended, at the latest when the time is up. */
void show_job(api_service *service, const http_request *request, http_response *response)
{
    char problem[160];
    int64_t wait;
    if (!http_request_integer(request, "wait", 0, LONGEST_WAIT, 0, &wait, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return;
    }
    job_record job;
    if (!find_job(service, request, response, &job)) return;
    if (leads_to_page(request, response, "/web/job.html?id=%s", job.id)) /* at once */
        ;
    else if (!has_ended(&job) && request->may_wait && request->waited < (double)wait)
        response->wait = (double)wait - request->waited;
    else http_respond_json(response, 200, info_with_place(service, &job));
    job_record_clear(&job);
}

/* What is told of a deleted job: what it was, as OGC has it a dismissed one, and nothing that could be asked for. */
static json_t *deleted_info(const job_record *job)
{
    json_t *info = status_info(job);
    json_object_set_new(info, "status", json_string(job_status_name(JOB_DISMISSED)));
    json_object_set_new(info, "message", json_sprintf("deleted with its folder; it was %s", job_status_name(job->status)));
    json_object_set_new(info, "links", json_pack("[o]", link_to("up", "application/json", "/jobs")));
    return info;
}

bool read_removal(const http_request *request, http_response *response, removal *asked)
{
    const char *only = http_request_parameter(request, "only");
    const bool dismiss = only && strcmp(only, "dismiss") == 0, delete = only && strcmp(only, "delete") == 0;
    *asked = (removal){ .may_dismiss = !delete, .may_delete = !dismiss };
    if (!only || dismiss || delete) return true;
    http_respond_problem(response, 400, NULL, "Bad parameter", "parameter only is \"%.40s\"; must be dismiss or delete", only);
    return false;
}

static void delete_job(api_service *service, http_response *response, const job_record *job)
{
    const store_status status = store_delete_job(service->store, job->id);
    if (status == STORE_OK) {
        service->jobs_deleted(service->daemon);
        http_respond_json(response, 200, deleted_info(job));
    } else if (status == STORE_CONFLICT) {
        http_respond_problem(response, 409, NULL, "The job has not ended", "job %s waits or runs, and is not deleted", job->id);
    } else if (status == STORE_NOT_FOUND) {
        respond_no_such_job(response, job->id);
    } else {
        respond_store_failure(response, status, "delete the job");
    }
}

/* One that waits or runs is dismissed; one that has ended is deleted. */
void remove_job(api_service *service, const http_request *request, http_response *response)
{
    const char *id = request->segment[0];
    removal asked;
    job_record job;
    if (!read_removal(request, response, &asked)) return;
    store_status status = job_id_is_valid(id) ? STORE_CONFLICT : STORE_NOT_FOUND;
    if (status == STORE_CONFLICT && asked.may_dismiss) status = store_dismiss_job(service->store, id);
    if (status == STORE_OK) {
        service->jobs_changed(service->daemon);
    } else if (status != STORE_NOT_FOUND && status != STORE_CONFLICT) {
        respond_store_failure(response, status, "dismiss the job");
        return;
    }
    if (!find_job(service, request, response, &job)) return;
    if (status == STORE_CONFLICT && asked.may_delete) delete_job(service, response, &job);
    else if (status == STORE_CONFLICT && job.status != JOB_DISMISSED)
        http_respond_problem(response, 409, NULL, "The job has ended",
                             "job %s is %s; its results are kept and it can't be dismissed any more", job.id,
                             job_status_name(job.status));
    else /* dismissing twice is no mistake */ http_respond_json(response, 200, status_info(&job));
    job_record_clear(&job);
}

void retry_job(api_service *service, const http_request *request, http_response *response)
{
    const char *id = request->segment[0];
    const store_status status = job_id_is_valid(id) ? store_retry_job(service->store, id) : STORE_NOT_FOUND;
    job_record job;
    if (status != STORE_OK && status != STORE_NOT_FOUND && status != STORE_CONFLICT) {
        respond_not_kept(service, response, status, "put the job into the queue");
        return;
    }
    if (!find_job(service, request, response, &job)) return;
    if (status == STORE_CONFLICT)
        http_respond_problem(response, 409, NULL, "The job can't be tried again",
                             "job %s is %s; only a failed or dismissed job can be tried again", job.id,
                             job_status_name(job.status));
    else http_respond_json(response, 200, status_info(&job));
    job_record_clear(&job);
    if (status == STORE_OK) service->jobs_changed(service->daemon); /* now, so that it is shown as accepted */
}

static void set_pin(api_service *service, const http_request *request, http_response *response, bool pinned)
{
    const char *id = request->segment[0];
    const store_status status = job_id_is_valid(id) ? store_pin_job(service->store, id, pinned) : STORE_NOT_FOUND;
    job_record job;
    if (status != STORE_OK && status != STORE_NOT_FOUND) {
        respond_store_failure(response, status, pinned ? "pin the job" : "unpin the job");
        return;
    }
    if (!find_job(service, request, response, &job)) return;
    http_respond_json(response, 200, status_info(&job));
    job_record_clear(&job);
}

void pin_job(api_service *service, const http_request *request, http_response *response)
{
    set_pin(service, request, response, true);
}

void unpin_job(api_service *service, const http_request *request, http_response *response)
{
    set_pin(service, request, response, false);
}

enum { LONGEST_PAGE = 256 << 20 };

typedef struct job_page {
    text_buffer text; /* the jobs, with commas between them */
    const char *base; /* before addresses */
    int64_t limit, jobs;
    char last[JOB_CURSOR_SIZE]; /* of the last job on the page */
    bool more;
} job_page;

static bool add_job_to_page(void *context, const job_record *job)
{
    job_page *page = context;
    page->more = page->jobs == page->limit;
    if (page->more) return false;
    snprintf(page->last, sizeof page->last, "%s", job->cursor);
    if (page->jobs++ > 0) text_buffer_add(&page->text, ",", 1);
    status_info_write(&page->text, job, page->base);
    return !page->text.failed;
}

static void add_escaped(text_buffer *out, const char *text)
{
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || strchr("-_.~,", c))
            text_buffer_add(out, text, 1);
        else text_buffer_print(out, "%%%02X", c);
    }
}

bool leads_to_page(const http_request *request, http_response *response, const char *format, ...)
{
    const char *asked = http_request_parameter(request, "f");
    if (!asked || strcmp(asked, "html") != 0) return false;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(response->location, sizeof response->location, format, arguments);
    va_end(arguments);
    http_respond_text(response, 303, "text/html; charset=utf-8", strdup(""), 0);
    return true;
}

void name_file(http_response *response, const char *id, const char *end, bool is_attachment)
{
    snprintf(response->file_name, sizeof response->file_name, "%.40s%.50s", id, end);
    response->is_attachment = is_attachment;
}

/* The page shows what some of the filters let through; it knows no others. */
static bool leads_to_list(const http_request *request, http_response *response)
{
    static const char *const shown[] = { "status", "q", "study", "cursor" };
    text_buffer query;
    text_buffer_init(&query, 500);
    text_buffer_add(&query, "", 0);
    for (size_t i = 0; i < sizeof shown / sizeof shown[0]; i++) {
        const char *value = http_request_parameter(request, shown[i]);
        if (!value) continue;
        text_buffer_print(&query, "%c%s=", query.length ? '&' : '?', shown[i]);
        add_escaped(&query, value);
    }
    const bool leads = leads_to_page(request, response, "/%s", query.text && !query.failed ? query.text : "");
    text_buffer_clear(&query);
    return leads;
}

json_t *list_link(const http_request *request, const char *rel, const char *cursor)
{
    text_buffer href;
    text_buffer_init(&href, 4096);
    text_buffer_print(&href, "%s", request->path);
    char between = '?';
    for (size_t i = 0; i < request->parameter_count; i++) {
        if (cursor && strcmp(request->parameter[i].name, "cursor") == 0) continue;
        text_buffer_print(&href, "%c%s=", between, request->parameter[i].name);
        add_escaped(&href, request->parameter[i].value);
        between = '&';
    }
    if (cursor) {
        text_buffer_print(&href, "%ccursor=", between);
        add_escaped(&href, cursor);
    }
    json_t *link = link_to(rel, "application/json", href.text ? href.text : "");
    text_buffer_clear(&href);
    return link;
}

static json_t *counts_to_json(const int64_t counts[JOB_STATUSES])
{
    json_t *object = json_object();
    for (int i = 0; i < JOB_STATUSES; i++) json_object_set_new(object, job_status_name((job_status)i), json_integer(counts[i]));
    return object;
}

static void respond_list(api_service *service, const http_request *request, http_response *response, job_filter *filter)
{
    int64_t counts[JOB_STATUSES] = { 0 };
    job_page page = { .base = response->base, .limit = filter->limit };
    text_buffer_init(&page.text, LONGEST_PAGE);
    text_buffer_print(&page.text, "{\"jobs\":[");
    filter->limit++; /* one more than asked for says whether there is a next page */
    if (store_list_jobs(service->store, filter, counts, add_job_to_page, &page) != STORE_OK || page.text.failed) {
        text_buffer_clear(&page.text);
        respond_store_failure(response, STORE_FAILED, "list the jobs");
        return;
    }
    json_t *rest = json_pack("{s:[o], s:o}", "links", list_link(request, "self", NULL), "counts", counts_to_json(counts));
    if (page.more) json_array_append_new(json_object_get(rest, "links"), list_link(request, "next", page.last));
    text_buffer_add(&page.text, "]", 1);
    http_respond_json_after(response, &page.text, rest);
}

void list_jobs(api_service *service, const http_request *request, http_response *response)
{
    job_filter filter;
    problem_list problems;
    if (!problem_list_init(&problems)) {
        respond_store_failure(response, STORE_FAILED, "list the jobs");
        return;
    }
    read_job_filter(service, request, &filter, &problems);
    if (!problem_list_is_empty(&problems)) respond_bad_parameters(response, &problems);
    else if (leads_to_list(request, response)) /* at once */
        ;
    else if (!request->in_lane && !store_lists_quickly(service->store, &filter)) response->wants_lane = true;
    else if (wants_csv(request)) respond_jobs_csv(service, request, response, &filter);
    else respond_list(service, request, response, &filter);
    problem_list_clear(&problems);
}
