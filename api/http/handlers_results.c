/* What a job was asked, what it said on the way, and what came out. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "handlers.h"
#include "results_forms.h"

/* As the worker names what went wrong. */
static bool failure_is_numerical(const json_t *failure)
{
    static const char *const kinds[] = { "not-a-number", "overlap-too-large", "particle-escaped", "never-settled" };
    const char *kind = json_string_value(json_object_get(failure, "status"));
    for (size_t i = 0; kind && i < sizeof kinds / sizeof kinds[0]; i++)
        if (strcmp(kinds[i], kind) == 0) return true;
    return false;
}

static void respond_failure(api_service *service, http_response *response, const job_record *job, int status)
{
    char *text = NULL;
    json_t *failure = store_read_failure(service->store, job->id, &text) == STORE_OK ? json_loads(text, 0, NULL) : NULL;
    free(text);
    http_respond_failure(response, status, failure_is_numerical(failure) ? "The job failed in its numbers" : "The job failed",
                         job->message, failure);
}

static void respond_stored_text(http_response *response, store_status status, char *text, const char *wanted)
{
    if (status == STORE_OK) http_respond_text(response, 200, "application/json", text, strlen(text));
    else respond_store_failure(response, status, wanted);
}

/* NULL: the response says why not. To be freed. */
static char *read_results(api_service *service, http_response *response, const char *id)
{
    char *text = NULL;
    const store_status status = store_read_results(service->store, id, &text);
    if (status != STORE_OK) respond_store_failure(response, status, "read the results");
    return text;
}

static json_t *read_wanted(api_service *service, const char *id)
{
    char *text = NULL;
    json_t *wanted = store_read_wanted(service->store, id, &text) == STORE_OK ? json_loads(text, 0, NULL) : NULL;
    free(text);
    return wanted;
}

void respond_results(api_service *service, const http_request *request, http_response *response, const job_record *job, int failed)
{
    if (job->status == JOB_FAILED) {
        respond_failure(service, response, job, failed);
    } else if (job->status == JOB_DISMISSED) {
        http_respond_problem(response, 404, NULL, "The job was dismissed", "job %s was dismissed before it had results", job->id);
    } else {
        char *text = read_results(service, response, job->id);
        json_t *wanted = text ? read_wanted(service, job->id) : NULL;
        name_file(response, job->id, "-results.json", false);
        if (text) results_respond(request, response, job->id, text, wanted);
        json_decref(wanted);
    }
}

static bool has_results(const http_request *request, http_response *response, const job_record *job)
{
    if (job->status != JOB_ACCEPTED && job->status != JOB_RUNNING) return true;
    http_respond_problem(response, 404, NULL, "Result not ready", "job %s is %s; /jobs/%s?wait=60 answers when it has ended",
                         job->id, job_status_name(job->status), request->segment[0]);
    return false;
}

void show_results(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    if (!results_profile_is_good(request, response) || !find_job(service, request, response, &job)) return;
    if (has_results(request, response, &job)) respond_results(service, request, response, &job, 404);
    job_record_clear(&job);
}

void show_output(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    const char *name = request->segment[1];
    if (!find_job(service, request, response, &job)) return;
    if (has_results(request, response, &job) && job.status != JOB_SUCCESSFUL) {
        respond_results(service, request, response, &job, 404);
    } else if (job.status == JOB_SUCCESSFUL) {
        char *text = read_results(service, response, job.id);
        json_t *results = text ? json_loads(text, 0, NULL) : NULL;
        json_t *output = json_object_get(results, name);
        if (output) results_respond_output(response, job.id, name, output);
        else if (results)
            http_respond_problem(response, 404, NULL, "No such output", "job %s has no output \"%s\"; /processes/%s lists them",
                                 job.id, name, job.process);
        json_decref(results);
        free(text);
    }
    job_record_clear(&job);
}

void show_spec(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    if (!find_job(service, request, response, &job)) return;
    char *text = NULL;
    const store_status status = store_read_spec(service->store, job.id, &text);
    respond_stored_text(response, status, text, "read the specification");
    name_file(response, job.id, "-spec.json", false);
    job_record_clear(&job);
}

void show_log(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    if (!find_job(service, request, response, &job)) return;
    int file;
    if (store_open_log(service->store, job.id, &file) == STORE_OK)
        http_respond_file(request, response, file, "text/plain; charset=utf-8", HTTP_FILE_GROWING);
    else /* no worker has said anything yet */ http_respond_text(response, 200, "text/plain; charset=utf-8", strdup(""), 0);
    name_file(response, job.id, "-log.txt", false);
    job_record_clear(&job);
}
