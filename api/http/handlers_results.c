/* What a job was asked, what it said on the way, and what came out. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "handlers.h"

static void respond_failure(api_service *service, http_response *response, const job_record *job)
{
    json_t *problem = problem_json(404, "about:blank", "The job failed", job->message, NULL);
    char *text = NULL;
    if (store_read_failure(service->store, job->id, &text) == STORE_OK)
        json_object_set_new(problem, "failure", json_loads(text, 0, NULL));
    free(text);
    http_respond_json(response, 404, problem);
}

static void respond_stored_text(http_response *response, store_status status, char *text, const char *wanted)
{
    if (status == STORE_OK) http_respond_text(response, 200, "application/json", text, strlen(text));
    else respond_store_failure(response, status, wanted);
}

void show_results(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    if (!find_job(service, request, response, &job)) return;
    char *text = NULL;
    if (job.status == JOB_SUCCESSFUL) {
        const store_status status = store_read_results(service->store, job.id, &text);
        respond_stored_text(response, status, text, "read the results");
    } else if (job.status == JOB_FAILED) {
        respond_failure(service, response, &job);
    } else if (job.status == JOB_DISMISSED) {
        http_respond_problem(response, 404, NULL, "The job was dismissed", "job %s was dismissed before it had results", job.id);
    } else {
        http_respond_problem(response, 404, OGC_EXCEPTION "result-not-ready", "Result not ready",
                             "job %s is %s; /jobs/%s?wait=60 answers when it has ended", job.id, job_status_name(job.status),
                             job.id);
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
    job_record_clear(&job);
}
