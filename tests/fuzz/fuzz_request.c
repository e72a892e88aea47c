/* Requests as they come in: the first line is method and target, the others are headers, and after an empty one there may be
 * a body. What is let in and reads is answered by the real handlers, from a store with one job.
 * No answer may break out of its headers, and what says that it is JSON is. */
#include <string.h>
#include <sys/stat.h>

#include "fuzz.h"
#include "http_guard.h"
#include "http_range.h"
#include "routes.h"
#include "served_job.h"

static data_folder data;
static api_service service;
static char job[JOB_ID_SIZE];
static http_guard open_to_all, guard; /* the second asks for a token */

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    (void)count;
    (void)arguments;
    service = service_of(store_with_a_job(&data, job));
    static const config settings = { .host = "127.0.0.1", .allowed_host = { "rig.example" }, .allowed_hosts = 1 };
    static config closed;
    FILE *file = fopen("token", "w");
    CLAIM(file && fputs("0123456789abcdef\n", file) >= 0 && fchmod(fileno(file), 0600) == 0 && fclose(file) == 0);
    closed = settings;
    closed.token_file = "token";
    CLAIM(http_guard_init(&open_to_all, &settings) && http_guard_init(&guard, &closed));
    return 0;
}

/* A job is named "JOB" in seeds, since its id is made of the time. */
static void name_the_job(http_request *request)
{
    for (int s = 0; s < HTTP_SEGMENTS; s++)
        if (strcmp(request->segment[s], "JOB") == 0) memcpy(request->segment[s], job, sizeof job);
}

static void answer(http_request *request, const http_headers *headers, http_response *response)
{
    size_t length = 0;
    if (!http_guard_knows_host(&open_to_all, headers, request, response)) return;
    const http_route *route = routes_match(route_table, route_count, request, response);
    if (!route) return;
    if (!http_guard_admits(request->authorization ? &guard : &open_to_all, headers, request, route, response, &length)) return;
    CLAIM(length <= HTTP_BODY_LIMIT);
    if (strcmp(route->method, "GET") != 0 || route->slow) return;
    name_the_job(request);
    route_respond(route, &service, request, response);
    CLAIM(response->wait >= 0);
    if (response->wait > 0 || response->wants_lane) response->status = 200;
}

static void split(char *text, http_request *request, http_headers *headers, http_response *response)
{
    char *rest = text, *target = strsep(&rest, "\n"), *line;
    request->method = strsep(&target, " ");
    while ((line = strsep(&rest, "\n")) && *line) {
        const char *name = strsep(&line, ":");
        http_headers_take(headers, request, name, line ? line + strspn(line, " ") : NULL);
    }
    request->body = rest ? rest : "";
    request->body_length = strlen(request->body);
    if (!target || http_request_split_target(request, target)) return;
    CLAIM(!strstr(request->path, "/../") && request->path[0] == '/' && request->parameter_count <= HTTP_PARAMETERS);
    answer(request, headers, response);
    if (response->status) is_sound_answer(response);
}

/* A part lies within the file, whatever its length. */
static void ranges_fit(const char *range)
{
    static const uint64_t sizes[] = { 0, 1, 22, 1000, UINT64_MAX };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        uint64_t offset, length;
        if (http_range_parse(range, sizes[s], &offset, &length) != HTTP_RANGE_PART) continue;
        CLAIM(length > 0 && offset < sizes[s] && length <= sizes[s] - offset);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    http_request request = { 0 };
    http_headers headers = { 0 };
    http_response response;
    char *text = malloc(size + 1);
    CLAIM(text);
    memcpy(text, bytes, size);
    text[size] = '\0';
    http_response_init(&response);
    split(text, &request, &headers, &response);
    ranges_fit(request.range);
    http_response_clear(&response);
    free(text);
    return 0;
}
