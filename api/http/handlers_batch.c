/* Jobs cancelled or deleted by a filter. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "handlers.h"
#include "status_info.h"

enum { MOST_IDS = 500 }; /* in the answer */

static bool add_id(void *context, const char *id)
{
    json_t *ids = context;
    return json_array_size(ids) < MOST_IDS && json_array_append_new(ids, json_string(id)) == 0;
}

static bool read_dry_run(const http_request *request, problem_list *problems)
{
    char problem[160];
    bool is_true;
    if (!http_request_truth(request, "dry_run", &is_true, problem, sizeof problem))
        problem_list_add(problems, "/dry_run", "%s", problem);
    return is_true;
}

/* A filter that was forgotten must not mean all jobs. */
static void require_filter(const job_filter *filter, problem_list *problems)
{
    const bool any = filter->statuses || filter->by_process || filter->by_type || (filter->text && *filter->text) || filter->study
                     || filter->label_name || filter->created_from[0] || filter->created_before[0] || filter->range_count > 0
                     || !isnan(filter->least_seconds) || !isnan(filter->most_seconds);
    if (any || !problem_list_is_empty(problems)) return;
    problem_list_add(problems, "",
                     "no filter is given: which jobs are meant? Those of GET /jobs with the same parameters; all that "
                     "wait or run have status=accepted,running, all that have ended "
                     "status=successful,failed,dismissed");
}

static void require_no_body(const http_request *request, problem_list *problems)
{
    const char *body = request->body ? request->body : "";
    size_t length = request->body_length;
    while (length > 0 && strchr(" \t\r\n{}", body[length - 1])) length--;
    if (length > 0)
        problem_list_add(problems, "",
                         "the request has a body, which would not be looked at: the filter stands in the address, as "
                         "that of GET /jobs does");
}

static json_t *batch_to_json(const job_batch *result, bool deletes, bool dry_run, json_t *ids)
{
    const char *done = deletes ? "deleted" : "cancelled";
    json_t *message = dry_run            ? json_sprintf("%lld jobs would be %s", (long long)result->found, done)
                      : result->left > 0 ? json_sprintf("%lld jobs are %s, %lld are left: the same request again goes on",
                                                        (long long)result->changed, done, (long long)result->left)
                                         : json_sprintf("%lld jobs are %s", (long long)result->changed, done);
    return json_pack("{s:b, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:[o]}", "dry_run", dry_run, "found", (json_int_t)result->found,
                     "changed", (json_int_t)result->changed, "left", (json_int_t)result->left, "unfit", (json_int_t)result->unfit,
                     "pinned", (json_int_t)result->pinned, "message", message, "jobs", ids, "links",
                     link_to("up", "application/json", "/jobs"));
}

static void change_jobs(api_service *service, const http_request *request, http_response *response, const job_filter *filter,
                        bool deletes, bool dry_run)
{
    job_batch result;
    json_t *ids = json_array();
    const store_status status = store_change_jobs(service->store, filter, deletes, dry_run, &request->client, add_id, ids, &result);
    if (status != STORE_OK) {
        json_decref(ids);
        respond_store_failure(response, status, deletes ? "delete the jobs" : "cancel the jobs");
        return;
    }
    if (result.changed > 0) {
        if (deletes) service->jobs_deleted(service->daemon);
        else service->jobs_changed(service->daemon);
    }
    http_respond_json(response, 200, batch_to_json(&result, deletes, dry_run, ids));
}

static void read_and_change(api_service *service, const http_request *request, http_response *response, bool deletes)
{
    job_filter filter;
    problem_list problems;
    if (!problem_list_init(&problems)) {
        respond_store_failure(response, STORE_FAILED, "read the filter");
        return;
    }
    read_job_filter(service, request, &filter, &problems);
    const bool dry_run = read_dry_run(request, &problems);
    require_no_body(request, &problems);
    require_filter(&filter, &problems);
    if (problem_list_is_empty(&problems)) change_jobs(service, request, response, &filter, deletes, dry_run);
    else respond_bad_parameters(response, &problems);
    problem_list_clear(&problems);
}

void cancel_jobs(api_service *service, const http_request *request, http_response *response)
{
    read_and_change(service, request, response, false);
}

void delete_jobs(api_service *service, const http_request *request, http_response *response)
{
    read_and_change(service, request, response, true);
}
