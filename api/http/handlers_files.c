/* Files of a job's folder, one by one or all in an archive. Snapshots are in handlers_snapshots.c. */
#include <string.h>

#include "handlers.h"
#include "job_folder.h"
#include "tar_stream.h"

typedef struct job_file {
    const char *name, *media_type;
    enum http_file_kind kind;
    const char *when; /* it is there */
} job_file;

static void send_file(api_service *service, const http_request *request, http_response *response, const job_file *wanted)
{
    job_record job;
    int file;
    char end[40] = "-";
    if (!find_job(service, request, response, &job)) return;
    strncat(end, wanted->name, sizeof end - 2);
    name_file(response, job.id, end, true);
    if (store_open_file(service->store, job.id, NULL, wanted->name, &file) == STORE_OK)
        http_respond_file(request, response, file, wanted->media_type, wanted->kind);
    else http_respond_problem(response, 404, NULL, "No such file", "job %s has no %s; %s", job.id, wanted->name, wanted->when);
    job_record_clear(&job);
}

void send_fields(api_service *service, const http_request *request, http_response *response)
{
    static const job_file fields = { JOB_FIELDS_FILE, "application/x-hdf5", HTTP_FILE_IMMUTABLE,
                                     "a drum or an orifice has it when its run is over, other tests never" };
    send_file(service, request, response, &fields);
}

void send_fields_text(api_service *service, const http_request *request, http_response *response)
{
    static const job_file fields = {
        JOB_FIELDS_TEXT_FILE, "application/json", HTTP_FILE_CHANGING,
        "a drum and a flow have it when their run is over, other tests and jobs of earlier versions never"
    };
    send_file(service, request, response, &fields);
    response->is_attachment = false;
}

static const char WHEN_TRACED[] = "a job has it when its run is over, if its inputs have tracers";

void send_tracers(api_service *service, const http_request *request, http_response *response)
{
    static const job_file tracers = { JOB_TRACERS_FILE, "application/x-hdf5", HTTP_FILE_IMMUTABLE, WHEN_TRACED };
    send_file(service, request, response, &tracers);
}

void send_tracers_table(api_service *service, const http_request *request, http_response *response)
{
    static const job_file tracers = { JOB_TRACERS_TABLE, "text/csv", HTTP_FILE_IMMUTABLE, WHEN_TRACED };
    send_file(service, request, response, &tracers);
}

void send_walls(api_service *service, const http_request *request, http_response *response)
{
    static const job_file walls = { JOB_WALLS_FILE, "application/xml", HTTP_FILE_CHANGING,
                                    "it is there from the first snapshot on, or when the run is over; a granule has none" };
    send_file(service, request, response, &walls);
}

void send_picture(api_service *service, const http_request *request, http_response *response)
{
    static const char when[] =
        "it is there some seconds after the start, and when the run is over; a granule has none, nor has a job of "
        "an earlier version";
    static const job_file large = { JOB_PICTURE_FILE, "image/png", HTTP_FILE_CHANGING, when };
    static const job_file small = { JOB_SMALL_PICTURE_FILE, "image/png", HTTP_FILE_CHANGING, when };
    char problem[160];
    int64_t width;
    if (!http_request_integer(request, "width", 1, INT64_MAX, JOB_PICTURE_LARGE, &width, problem, sizeof problem)) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "%s", problem);
    } else if (width != JOB_PICTURE_LARGE && width != JOB_PICTURE_SMALL) {
        http_respond_problem(response, 400, NULL, "Bad parameter", "parameter width is %lld; must be %d or %d pixels",
                             (long long)width, JOB_PICTURE_SMALL, JOB_PICTURE_LARGE);
    } else {
        send_file(service, request, response, width == JOB_PICTURE_LARGE ? &large : &small);
        response->is_attachment = false; /* it is to be seen */
    }
}

void send_snapshot_series(api_service *service, const http_request *request, http_response *response)
{
    static const job_file series = { JOB_SERIES_FILE, "application/json", HTTP_FILE_CHANGING,
                                     "it is there from the first snapshot on, or when the run is over; a granule has none" };
    send_file(service, request, response, &series);
}

void send_archive(api_service *service, const http_request *request, http_response *response)
{
    job_record job;
    if (!find_job(service, request, response, &job)) return;
    if (tar_stream_open(service->store, job.id, &response->pieces)) {
        response->status = 200;
        response->content_type = "application/x-tar";
        name_file(response, job.id, ".tar", true);
    } else {
        respond_store_failure(response, STORE_FAILED, "read the folder of the job");
    }
    job_record_clear(&job);
}
