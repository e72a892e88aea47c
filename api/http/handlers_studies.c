/* Studies: posting one, the list, one, its results and its document, cancelling it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "handlers.h"
#include "status_info.h"
#include "study_info.h"
#include "study_results.h"

enum { STUDIES_DEFAULT_LIMIT = 50, STUDIES_HIGHEST_LIMIT = 500, RESULTS_BYTES = 64 << 20 };

static void respond_no_such_study(http_response *response, const char *id)
{
    http_respond_problem(response, 404, NULL, "No such study", "there is no study \"%s\"; /studies lists them", id);
}

static bool find_study(api_service *service, const http_request *request, http_response *response, study_record *study)
{
    const char *id = request->segment[0];
    const store_status status = job_id_is_valid(id) ? store_find_study(service->store, id, study) : STORE_NOT_FOUND;
    if (status == STORE_NOT_FOUND) respond_no_such_study(response, id);
    else if (status != STORE_OK) respond_store_failure(response, status, "read the study");
    return status == STORE_OK;
}

/* --- posting --- */

static void respond_created(api_service *service, http_response *response, const study_estimate *estimate,
                            const problem_list *warnings, const char *id)
{
    study_record study;
    json_t *info = store_find_study(service->store, id, &study) == STORE_OK
                       ? study_info(&study)
                       : json_pack("{s:s, s:s}", "studyID", id, "status", "accepted");
    json_object_set_new(info, "estimate", study_estimate_to_json(estimate));
    json_object_set_new(info, "warnings", job_warnings_to_json(warnings));
    http_respond_json(response, 201, info);
    snprintf(response->location, sizeof response->location, "/studies/%s", id);
}

static void add_study(api_service *service, http_response *response, study_stage *stage, const study_spec *study,
                      const study_estimate *estimate, const problem_list *warnings)
{
    char id[JOB_ID_SIZE];
    const store_status status = store_add_study(service->store, stage, study, estimate, id);
    if (status != STORE_OK) {
        respond_not_kept(service, response, status, "keep the study");
        return;
    }
    service->jobs_changed(service->daemon);
    respond_created(service, response, estimate, warnings, id);
}

/* What would become of it, and nothing else. */
static void respond_checked(http_response *response, const study_spec *study, const study_estimate *estimate,
                            const problem_list *warnings)
{
    http_respond_json(response, 200,
                      json_pack("{s:s, s:s, s:I, s:i, s:o, s:o}", "name", study->name, "process", study->process, "cases",
                                (json_int_t)study->cases, "repeats", study->repeats, "estimate", study_estimate_to_json(estimate),
                                "warnings", job_warnings_to_json(warnings)));
}

static bool take_nothing(void *context, const job_spec *spec, size_t index, int repeat)
{
    (void)context, (void)spec, (void)index, (void)repeat;
    return true;
}

/* Reads each job, once; taker: who is given them. False: they can't be run, or its client has left. */
static bool check_jobs(api_service *service, const http_request *request, const study_spec *study, study_taker taker,
                       study_estimate *estimate, problem_list *problems, problem_list *warnings)
{
    calibration machine;
    store_read_calibration(service->store, &machine);
    taker.client = &request->client;
    taker.limits = service->limits;
    if (!study_check(study, &machine, &taker, estimate, problems, warnings)) return false;
    if (taker.limits)
        job_check_limits(taker.limits, "/base/inputs", estimate->wall_seconds, NAN, estimate->snapshot_bytes, NAN, problems);
    job_check_disk(estimate->disk_bytes, store_free_bytes(service->store), "/base/inputs/snapshots/interval", problems);
    return problem_list_is_empty(problems);
}

/* Refused whole or kept whole: every job is read before any is added. checks: only that. */
static void check_and_add(api_service *service, const http_request *request, http_response *response, const study_spec *study,
                          bool checks, problem_list *problems)
{
    calibration machine;
    problem_list warnings;
    study_estimate estimate;
    store_read_calibration(service->store, &machine);
    study_stage *stage = checks ? NULL : store_stage_study(service->store, study, &machine);
    if ((!stage && !checks) || !problem_list_init(&warnings)) {
        respond_store_failure(response, STORE_FAILED, "keep the study");
        store_drop_stage(stage);
        return;
    }
    study_taker taker = { .take = take_nothing };
    if (!checks) taker = store_stage_taker(stage);
    const bool good = check_jobs(service, request, study, taker, &estimate, problems, &warnings);
    const store_status status = stage ? store_stage_status(stage) : STORE_OK;
    if (status != STORE_OK) respond_not_kept(service, response, status, "keep the study");
    else if (!problem_list_is_empty(problems))
        http_respond_problems(response, 400, "The study can't be run, and none of its jobs was added",
                              "each entry of errors names a place in the study, what is there and what may be", problems);
    else if (!good)
        http_respond_problem(response, 503, NULL, "Nobody waits", "the client has left, and nothing of the study was added");
    else if (checks) respond_checked(response, study, &estimate, &warnings);
    else add_study(service, response, stage, study, &estimate, &warnings);
    problem_list_clear(&warnings);
    store_drop_stage(stage);
}

void create_study(api_service *service, const http_request *request, http_response *response)
{
    char problem[160];
    bool checks;
    if (!http_request_truth(request, "check", &checks, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return;
    }
    json_t *document = parse_body(request, response);
    if (!document) return;
    const start_source beds = store_beds(service->store);
    const study_options options = { .beds = &beds,
                                    .seed_if_missing = choose_seed(),
                                    .default_threads = service->default_threads,
                                    .most_jobs = store_queue_limit(service->store) };
    problem_list problems;
    study_spec study;
    if (!problem_list_init(&problems)) {
        http_respond_problem(response, 503, NULL, "Out of memory", "the request could not be read; try again");
        json_decref(document);
        return;
    }
    study_spec_parse(document, &options, &study, &problems);
    json_decref(document);
    check_and_add(service, request, response, &study, checks, &problems);
    study_spec_clear(&study);
    problem_list_clear(&problems);
}

/* --- looking --- */

/* ?wait=SECONDS answers as soon as every job has ended, at the latest when the time is up. */
void show_study(api_service *service, const http_request *request, http_response *response)
{
    char problem[160];
    int64_t wait;
    study_record study;
    if (!http_request_integer(request, "wait", 0, LONGEST_WAIT, 0, &wait, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return;
    }
    if (!find_study(service, request, response, &study)) return;
    const job_status status = study_status(&study);
    const bool has_ended = status != JOB_ACCEPTED && status != JOB_RUNNING;
    if (leads_to_page(request, response, "/web/studies.html#%s", study.id)) return;
    if (!has_ended && request->may_wait && request->waited < (double)wait) response->wait = (double)wait - request->waited;
    else http_respond_json(response, 200, study_info(&study));
}

typedef struct study_page {
    json_t *studies;
    int64_t limit, last; /* number of the last study on the page */
    bool more;
} study_page;

static bool add_study_to_page(void *context, const study_record *study)
{
    study_page *page = context;
    page->more = (int64_t)json_array_size(page->studies) == page->limit;
    if (page->more) return false;
    page->last = study->number;
    return json_array_append_new(page->studies, study_info(study)) == 0;
}

void list_studies(api_service *service, const http_request *request, http_response *response)
{
    char problem[160];
    int64_t before;
    study_page page = { .studies = NULL };
    if (!http_request_integer(request, "limit", 1, STUDIES_HIGHEST_LIMIT, STUDIES_DEFAULT_LIMIT, &page.limit, problem,
                              sizeof problem)
        || !http_request_integer(request, "cursor", 1, INT64_MAX, 0, &before, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
        return;
    }
    if (leads_to_page(request, response, "/web/studies.html")) return;
    page.studies = json_array();
    const store_status status = store_list_studies(service->store, before, page.limit + 1, add_study_to_page, &page);
    if (status != STORE_OK) {
        json_decref(page.studies);
        respond_store_failure(response, status, "list the studies");
        return;
    }
    json_t *links = json_pack("[o]", list_link(request, "self", NULL));
    char next[24];
    snprintf(next, sizeof next, "%lld", (long long)page.last);
    if (page.more) json_array_append_new(links, list_link(request, "next", next));
    http_respond_json(response, 200, json_pack("{s:o, s:o}", "studies", page.studies, "links", links));
}

void show_study_spec(api_service *service, const http_request *request, http_response *response)
{
    study_record study;
    if (!find_study(service, request, response, &study)) return;
    char *text = NULL;
    const store_status status = store_read_study(service->store, study.id, &text);
    if (status == STORE_OK) http_respond_text(response, 200, "application/json", text, strlen(text));
    else respond_store_failure(response, status, "read the study");
    name_file(response, study.id, "-spec.json", false);
}

static void delete_study(api_service *service, http_response *response, const study_record *study)
{
    const store_status status = store_delete_study(service->store, study->id);
    if (status == STORE_OK) {
        service->jobs_deleted(service->daemon);
        json_t *info = study_info(study);
        json_object_set_new(info, "message", json_sprintf("deleted with its %lld jobs", (long long)study->jobs));
        json_object_set_new(info, "links", json_pack("[o]", link_to("up", "application/json", "/studies")));
        http_respond_json(response, 200, info);
    } else if (status == STORE_CONFLICT) {
        http_respond_problem(response, 409, NULL, "The study has not ended", "jobs of study %s wait or run, and nothing is deleted",
                             study->id);
    } else if (status == STORE_NOT_FOUND) {
        respond_no_such_study(response, study->id);
    } else {
        respond_store_failure(response, status, "delete the study");
    }
}

/* What waits or runs is dismissed; a study that has ended is deleted. */
void remove_study(api_service *service, const http_request *request, http_response *response)
{
    const char *id = request->segment[0];
    removal asked;
    study_record study;
    if (!read_removal(request, response, &asked)) return;
    store_status status = job_id_is_valid(id) ? STORE_CONFLICT : STORE_NOT_FOUND;
    if (status == STORE_CONFLICT && asked.may_dismiss) status = store_dismiss_study(service->store, id);
    if (status == STORE_OK) {
        service->jobs_changed(service->daemon);
    } else if (status != STORE_NOT_FOUND && status != STORE_CONFLICT) {
        respond_store_failure(response, status, "dismiss the study");
        return;
    }
    if (!find_study(service, request, response, &study)) return;
    if (status == STORE_CONFLICT && asked.may_delete) delete_study(service, response, &study);
    else if (status == STORE_CONFLICT && study.counts[JOB_DISMISSED] == 0)
        http_respond_problem(response, 409, NULL, "The study has ended",
                             "all %lld jobs of study %s have ended; their results are kept", (long long)study.jobs, study.id);
    else /* dismissing twice is no mistake */ http_respond_json(response, 200, study_info(&study));
}

/* Those of its jobs that failed; what is done stays. */
void retry_study(api_service *service, const http_request *request, http_response *response)
{
    const char *id = request->segment[0];
    const store_status status = job_id_is_valid(id) ? store_retry_study(service->store, id) : STORE_NOT_FOUND;
    study_record study;
    if (status != STORE_OK && status != STORE_NOT_FOUND && status != STORE_CONFLICT) {
        respond_not_kept(service, response, status, "put the study's failed jobs into the queue");
        return;
    }
    if (!find_study(service, request, response, &study)) return;
    if (status == STORE_CONFLICT)
        http_respond_problem(response, 409, NULL, "The study can't be tried again",
                             "of the %lld jobs of study %s none has failed; a dismissed one is tried again by itself",
                             (long long)study.jobs, study.id);
    else http_respond_json(response, 200, study_info(&study));
    if (status == STORE_OK) service->jobs_changed(service->daemon);
}

/* --- results --- */

static bool tabulate(api_service *service, const char *id, http_response *response, study_table *table)
{
    if (!study_table_init(table)) table->failed = true;
    store_status status = store_list_study_cases(service->store, id, study_table_add_case, table);
    if (status == STORE_OK) {
        study_summing summing;
        study_summing_init(&summing, table);
        status = store_list_study_runs(service->store, id, study_summing_add_run, &summing);
        study_summing_end(&summing);
    }
    if (status == STORE_OK && !table->failed) return true;
    study_table_clear(table);
    respond_store_failure(response, status == STORE_OK ? STORE_FAILED : status, "read the results");
    return false;
}

static void respond_csv(http_response *response, const study_table *table)
{
    text_buffer out;
    text_buffer_init(&out, RESULTS_BYTES);
    study_table_write_csv(table, &out);
    if (out.failed) {
        text_buffer_clear(&out);
        respond_store_failure(response, STORE_FAILED, "write the results");
        return;
    }
    http_respond_text(response, 200, "text/csv; charset=utf-8", out.text, out.length);
}

/* Only `limit` cases are left, from the one on that has `after` before it. */
static void keep_part(json_t *cases, int64_t after, int64_t limit)
{
    const size_t count = json_array_size(cases), first = after < (int64_t)count ? (size_t)after : count;
    json_t *part = json_array();
    for (size_t i = first; i < count && (int64_t)(i - first) < limit; i++) json_array_append(part, json_array_get(cases, i));
    json_array_clear(cases);
    json_array_extend(cases, part);
    json_decref(part);
}

/* after: cases that are left out at the beginning; limit: cases at most. */
static void show_table(api_service *service, const http_request *request, http_response *response, bool csv, int64_t after,
                       int64_t limit)
{
    study_record study;
    study_table table;
    char version[96];
    if (!find_study(service, request, response, &study)) return;
    /* Nothing in it changes but with a job's state. */
    name_file(response, study.id, csv ? "-results.csv" : "-results.json", csv);
    snprintf(version, sizeof version, "%s-%s-%lld-%lld", csv ? "csv" : "json", study.updated, (long long)after, (long long)limit);
    if (http_respond_unchanged(request, response, version) || !tabulate(service, study.id, response, &table)) return;
    keep_part(table.cases, after, limit);
    if (csv) {
        respond_csv(response, &table);
    } else {
        char href[80];
        snprintf(href, sizeof href, "/studies/%s/results", study.id);
        http_respond_json(response, 200,
                          json_pack("{s:s, s:s, s:s, s:O, s:[o]}", "studyID", study.id, "name", study.name, "status",
                                    job_status_name(study_status(&study)), "cases", table.cases, "links",
                                    link_to("self", "application/json", href)));
    }
    study_table_clear(&table);
}

void show_study_results(api_service *service, const http_request *request, http_response *response)
{
    const bool csv = wants_csv(request);
    int64_t after, limit;
    char problem[160];
    if (!http_request_integer(request, "limit", 1, INT64_MAX, INT64_MAX, &limit, problem, sizeof problem)
        || !http_request_integer(request, "after", 0, INT64_MAX, 0, &after, problem, sizeof problem))
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
    else show_table(service, request, response, csv, csv ? 0 : after, csv ? INT64_MAX : limit);
}

void show_study_csv(api_service *service, const http_request *request, http_response *response)
{
    show_table(service, request, response, true, 0, INT64_MAX);
}
