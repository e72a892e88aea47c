/* Calibrations: posting one, the list, one, its document, cancelling, going on, deleting. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"
#include "plan_budget.h"
#include "plan_info.h"
#include "status_info.h"

/* priority: of its jobs, below that of jobs that are posted by themselves. */
enum { PLANS_DEFAULT_LIMIT = 50, PLANS_HIGHEST_LIMIT = 500, PLAN_PRIORITY = -1 };

static void respond_no_such_plan(http_response *response, const char *id)
{
    http_respond_problem(response, 404, NULL, "No such calibration", "there is no calibration \"%s\"; /calibrations lists them",
                         id);
}

bool find_plan(api_service *service, const http_request *request, http_response *response, plan_record *plan)
{
    const char *id = request->segment[0];
    const store_status status = job_id_is_valid(id) ? store_find_plan(service->store, id, plan) : STORE_NOT_FOUND;
    if (status == STORE_NOT_FOUND) respond_no_such_plan(response, id);
    else if (status != STORE_OK) respond_store_failure(response, status, "read the calibration");
    return status == STORE_OK;
}

/* --- posting --- */

static void add_plan(api_service *service, http_response *response, const json_t *document, const plan_request *plan,
                     const plan_estimate *estimate, const problem_list *warnings)
{
    const json_t *name = json_object_get(document, "name"), *priority = json_object_get(document, "priority");
    const plan_addition addition = { .document = document,
                                     .name = name ? json_string_value(name) : "calibration",
                                     .priority = priority ? (int)json_integer_value(priority) : PLAN_PRIORITY,
                                     .most_jobs = plan->most_jobs,
                                     .estimated_seconds = estimate->wall_seconds };
    char id[JOB_ID_SIZE];
    plan_record record;
    const store_status status = store_add_plan(service->store, &addition, id);
    if (status != STORE_OK) {
        respond_not_kept(service, response, status, "keep the calibration");
        return;
    }
    json_t *info = store_find_plan(service->store, id, &record) == STORE_OK
                       ? plan_info(&record)
                       : json_pack("{s:s, s:s}", "calibrationID", id, "status", "accepted");
    json_object_set_new(info, "estimate", plan_estimate_to_json(estimate));
    json_object_set_new(info, "warnings", job_warnings_to_json(warnings));
    http_respond_json(response, 201, info);
    snprintf(response->location, sizeof response->location, "/calibrations/%s", id);
    service->jobs_changed(service->daemon);
}

/* Refused whole or kept whole: every test is read before the planner makes the first job. */
static void check_and_add(api_service *service, http_response *response, const json_t *document, problem_list *problems,
                          problem_list *warnings)
{
    plan_request plan;
    calibration machine;
    plan_estimate estimate = { .jobs = 0.0 };
    store_read_calibration(service->store, &machine);
    if (plan_request_parse(document, &plan, problems)) {
        estimate = plan_estimate_make(&plan, &machine);
        plan_check(&plan, &machine, service->limits, store_free_bytes(service->store), problems, warnings);
    }
    if (problem_list_is_empty(problems)) add_plan(service, response, document, &plan, &estimate, warnings);
    else
        http_respond_problems(response, 400, "The calibration can't be run, and nothing was added",
                              "each entry of errors names a place in the calibration, what is there and what may be", problems);
    plan_request_clear(&plan);
}

void create_calibration(api_service *service, const http_request *request, http_response *response)
{
    json_t *document = parse_body(request, response);
    problem_list problems = { 0 }, warnings = { 0 };
    if (!document) return;
    if (problem_list_init(&problems) && problem_list_init(&warnings))
        check_and_add(service, response, document, &problems, &warnings);
    else http_respond_problem(response, 503, NULL, "Out of memory", "the request could not be read; try again");
    problem_list_clear(&problems);
    problem_list_clear(&warnings);
    json_decref(document);
}

/* --- looking --- */

static bool has_ended(const plan_record *plan) { return plan->status != JOB_ACCEPTED && plan->status != JOB_RUNNING; }

/* ?wait=SECONDS answers as soon as there is an answer or can be none, at the latest when the time is up. */
void show_calibration(api_service *service, const http_request *request, http_response *response)
{
    char problem[160];
    int64_t wait;
    plan_record plan;
    if (!http_request_integer(request, "wait", 0, LONGEST_WAIT, 0, &wait, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return;
    }
    if (!find_plan(service, request, response, &plan)) return;
    if (leads_to_page(request, response, "/web/calibrations.html#%s", plan.id)) return;
    if (!has_ended(&plan) && request->may_wait && request->waited < (double)wait) response->wait = (double)wait - request->waited;
    else http_respond_json(response, 200, plan_info(&plan));
}

typedef struct plan_page {
    json_t *plans;
    int64_t limit, last; /* number of the last on the page */
    bool more;
} plan_page;

static bool add_to_page(void *context, const plan_record *plan)
{
    plan_page *page = context;
    page->more = (int64_t)json_array_size(page->plans) == page->limit;
    if (page->more) return false;
    page->last = plan->number;
    return json_array_append_new(page->plans, plan_info(plan)) == 0;
}

void list_calibrations(api_service *service, const http_request *request, http_response *response)
{
    char problem[160], next[24];
    int64_t before;
    plan_page page = { .plans = NULL };
    if (!http_request_integer(request, "limit", 1, PLANS_HIGHEST_LIMIT, PLANS_DEFAULT_LIMIT, &page.limit, problem, sizeof problem)
        || !http_request_integer(request, "cursor", 1, INT64_MAX, 0, &before, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return;
    }
    if (leads_to_page(request, response, "/web/calibrations.html")) return;
    page.plans = json_array();
    const store_status status = store_list_plans(service->store, before, page.limit + 1, add_to_page, &page);
    if (status != STORE_OK) {
        json_decref(page.plans);
        respond_store_failure(response, status, "list the calibrations");
        return;
    }
    json_t *links = json_pack("[o]", list_link(request, "self", NULL));
    snprintf(next, sizeof next, "%lld", (long long)page.last);
    if (page.more) json_array_append_new(links, list_link(request, "next", next));
    http_respond_json(response, 200, json_pack("{s:o, s:o}", "calibrations", page.plans, "links", links));
}

void show_calibration_spec(api_service *service, const http_request *request, http_response *response)
{
    plan_record plan;
    char *text = NULL;
    if (!find_plan(service, request, response, &plan)) return;
    const store_status status = store_read_plan_request(service->store, plan.id, &text);
    if (status == STORE_OK) http_respond_text(response, 200, "application/json", text, strlen(text));
    else respond_store_failure(response, status, "read the calibration");
    name_file(response, plan.id, "-spec.json", false);
}

/* --- ending and going on --- */

static void delete_plan(api_service *service, http_response *response, const plan_record *plan)
{
    const store_status status = store_delete_plan(service->store, plan->id);
    if (status == STORE_OK) {
        service->jobs_deleted(service->daemon);
        json_t *info = plan_info(plan);
        json_object_set_new(info, "message", json_sprintf("deleted with its %lld jobs", (long long)plan->runs));
        json_object_set_new(info, "links", json_pack("[o]", link_to("up", "application/json", "/calibrations")));
        http_respond_json(response, 200, info);
    } else if (status == STORE_CONFLICT) {
        http_respond_problem(response, 409, NULL, "The calibration has not ended",
                             "jobs of calibration %s wait or run, and nothing is deleted", plan->id);
    } else if (status == STORE_NOT_FOUND) {
        respond_no_such_plan(response, plan->id);
    } else {
        respond_store_failure(response, status, "delete the calibration");
    }
}

/* One that has not ended is dismissed with its jobs that have not; one that has is deleted. */
void remove_calibration(api_service *service, const http_request *request, http_response *response)
{
    const char *id = request->segment[0];
    removal asked;
    plan_record plan;
    if (!read_removal(request, response, &asked)) return;
    store_status status = job_id_is_valid(id) ? STORE_CONFLICT : STORE_NOT_FOUND;
    if (status == STORE_CONFLICT && asked.may_dismiss) status = store_dismiss_plan(service->store, id);
    if (status == STORE_OK) {
        service->jobs_changed(service->daemon);
    } else if (status != STORE_NOT_FOUND && status != STORE_CONFLICT) {
        respond_store_failure(response, status, "dismiss the calibration");
        return;
    }
    if (!find_plan(service, request, response, &plan)) return;
    if (status == STORE_CONFLICT && asked.may_delete) delete_plan(service, response, &plan);
    else if (status == STORE_CONFLICT && plan.status != JOB_DISMISSED)
        http_respond_problem(response, 409, NULL, "The calibration has ended", "calibration %s is %s, and what it found is kept",
                             plan.id, job_status_name(plan.status));
    else /* dismissing twice is no mistake */ http_respond_json(response, 200, plan_info(&plan));
}

/* Dismissed or failed, it goes on where it was. */
void retry_calibration(api_service *service, const http_request *request, http_response *response)
{
    const char *id = request->segment[0];
    const store_status status = job_id_is_valid(id) ? store_retry_plan(service->store, id) : STORE_NOT_FOUND;
    plan_record plan;
    if (status != STORE_OK && status != STORE_NOT_FOUND && status != STORE_CONFLICT) {
        respond_not_kept(service, response, status, "go on with the calibration");
        return;
    }
    if (!find_plan(service, request, response, &plan)) return;
    if (status == STORE_CONFLICT)
        http_respond_problem(response, 409, NULL, "The calibration can't go on",
                             "calibration %s is %s; only a failed or dismissed one can go on", plan.id,
                             job_status_name(plan.status));
    else http_respond_json(response, 200, plan_info(&plan));
    if (status == STORE_OK) service->jobs_changed(service->daemon);
}
