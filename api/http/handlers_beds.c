/* Tables of particles that clients send, for runs to start from. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "csv_table.h"
#include "handlers.h"
#include "status_info.h"

static json_t *bed_info(const bed_record *bed)
{
    char self[60];
    snprintf(self, sizeof self, "/beds/%s", bed->id);
    return json_pack("{s:s, s:s, s:I, s:I, s:[o, o]}", "bedID", bed->id, "created", bed->created, "particles",
                     (json_int_t)bed->particles, "bytes", (json_int_t)bed->bytes, "links", link_to("self", "text/csv", self),
                     link_to("up", "application/json", "/beds"));
}

static void keep(api_service *service, http_response *response, const char *text, const json_t *particles)
{
    bed_record bed;
    const store_status status = store_add_bed(service->store, text, strlen(text), (int64_t)json_array_size(particles), &bed);
    if (status == STORE_QUEUE_FULL) {
        http_respond_problem(response, 409, NULL, "Too many beds", "there are %d beds, as many as are kept: delete one first",
                             STORE_MOST_BEDS);
    } else if (status != STORE_OK) {
        respond_not_kept(service, response, status, "keep the bed");
    } else {
        http_respond_json(response, 201, bed_info(&bed));
        snprintf(response->location, sizeof response->location, "/beds/%s", bed.id);
    }
}

void create_bed(api_service *service, const http_request *request, http_response *response)
{
    problem_list problems;
    if (!problem_list_init(&problems)) {
        http_respond_problem(response, 503, NULL, "Out of memory", "the request could not be read; try again");
        return;
    }
    const size_t length = request->body ? request->body_length : 0;
    char *text = strndup(length ? request->body : "", length);
    json_t *particles = NULL;
    if (text && strlen(text) < length) problem_list_add(&problems, "", "holds a byte 0, which no text has");
    else if (text) particles = csv_read_particles(text, length, &problems);
    if (particles) keep(service, response, text, particles);
    else if (problem_list_is_empty(&problems))
        http_respond_problem(response, 503, NULL, "Out of memory", "the table could not be read; try again");
    else
        http_respond_problems(response, 400, "The table can't be a bed",
                              "each entry of errors names a line and a column, what is there and what may be", &problems);
    json_decref(particles);
    free(text);
    problem_list_clear(&problems);
}

static bool add_bed(void *context, const bed_record *bed) { return json_array_append_new(context, bed_info(bed)) == 0; }

void list_beds(api_service *service, const http_request *request, http_response *response)
{
    (void)request;
    json_t *beds = json_array();
    const store_status status = store_list_beds(service->store, add_bed, beds);
    if (status == STORE_OK) {
        http_respond_json(response, 200, json_pack("{s:o, s:[o]}", "beds", beds, "links", link_to("up", "application/json", "/")));
        return;
    }
    json_decref(beds);
    respond_store_failure(response, status, "list the beds");
}

static void respond_no_such_bed(http_response *response, const char *id)
{
    http_respond_problem(response, 404, NULL, "No such bed", "there is no bed \"%s\"; /beds lists them", id);
}

void show_bed(api_service *service, const http_request *request, http_response *response)
{
    const char *id = request->segment[0];
    char *text = NULL;
    const store_status status = job_id_is_valid(id) ? store_read_bed(service->store, id, &text) : STORE_NOT_FOUND;
    if (status == STORE_OK) http_respond_text(response, 200, "text/csv; charset=utf-8", text, strlen(text));
    else if (status == STORE_NOT_FOUND) respond_no_such_bed(response, id);
    else respond_store_failure(response, status, "read the bed");
}

void remove_bed(api_service *service, const http_request *request, http_response *response)
{
    const char *id = request->segment[0];
    bed_record bed;
    store_status status = job_id_is_valid(id) ? store_find_bed(service->store, id, &bed) : STORE_NOT_FOUND;
    if (status == STORE_OK) status = store_delete_bed(service->store, id);
    if (status == STORE_OK) http_respond_json(response, 200, bed_info(&bed));
    else if (status == STORE_NOT_FOUND) respond_no_such_bed(response, id);
    else respond_store_failure(response, status, "delete the bed");
}
