/* The service about itself: landing page, conformance, kinds of problem, the page's files, health,
 * metrics. */
#include <ctype.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "handlers.h"
#include "http_accept.h"
#include "problem_kinds.h"
#include "status_info.h"

static bool send_page_file(api_service *service, const http_request *request, http_response *response, const char *name,
                           const char *type)
{
    const int file =
        service->web_folder < 0 ? -1 : openat(service->web_folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return false;
    http_respond_file(request, response, file, type, HTTP_FILE_CHANGING);
    return true;
}

static json_t *landing_links(void)
{
    static const char *const links[][3] = {
        { "self", "application/json", "/" },
        { "alternate", "text/html", "/" },
        { "service-desc", "application/vnd.oai.openapi+json;version=3.0", "/api?f=json" },
        { "service-desc", "application/vnd.oai.openapi;version=3.0", "/api?f=yaml" },
        { "service-desc", "application/vnd.oai.openapi+json;version=3.1", "/api?f=json&version=3.1" },
        { "service-desc", "application/vnd.oai.openapi;version=3.1", "/api?f=yaml&version=3.1" },
        { "http://www.opengis.net/def/rel/ogc/1.0/conformance", "application/json", "/conformance" },
        { "http://www.opengis.net/def/rel/ogc/1.0/processes", "application/json", "/processes" },
        { "http://www.opengis.net/def/rel/ogc/1.0/job-list", "application/json", "/jobs" },
        { "studies", "application/json", "/studies" },
        { "query", "application/json", "/query" },
        { "health", "application/json", "/healthz" },
        { "ready", "application/json", "/readyz" },
        { "metrics", "text/plain", "/metrics" },
    };
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof links / sizeof links[0]; i++)
        json_array_append_new(list, link_to(links[i][0], links[i][1], links[i][2]));
    return list;
}

/* A browser prefers text/html; curl's wildcard gets what a program can read. */
void show_landing(api_service *service, const http_request *request, http_response *response)
{
    static const http_format formats[] = { { "json", "application/json" }, { "html", "text/html" } };
    if (http_format_choose(request, formats, 2) == 1
        && send_page_file(service, request, response, "index.html", "text/html; charset=utf-8"))
        return;
    http_respond_json(response, 200,
                      json_pack("{s:s, s:s, s:s, s:o}", "title", "reposed", "description",
                                "Virtual rotary-drum tests: the angle of repose of granular materials", "version", REPOSED_VERSION,
                                "links", landing_links()));
}

void show_conformance(api_service *service, const http_request *request, http_response *response)
{
    (void)service, (void)request;
    static const char *const classes[] = { "core", "ogc-process-description", "json", "oas30", "job-list", "callback", "dismiss" };
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof classes / sizeof classes[0]; i++)
        json_array_append_new(list, json_sprintf("http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/%s", classes[i]));
    http_respond_json(response, 200, json_pack("{s:o}", "conformsTo", list));
}

static json_t *problem_document(const problem_kind *kind, const char *base)
{
    const bool is_ogc = strchr(kind->name, ':') != NULL;
    return json_pack("{s:o, s:s, s:s}", "type",
                     is_ogc ? json_string(kind->name) : json_sprintf("%s" PROBLEMS_PATH "%s", base, kind->name), "title",
                     kind->title, "description", kind->meaning);
}

void list_problems(api_service *service, const http_request *request, http_response *response)
{
    (void)service, (void)request;
    json_t *list = json_array();
    for (size_t i = 0; i < problem_kind_count; i++)
        json_array_append_new(list, problem_document(&problem_kinds[i], response->base));
    http_respond_json(response, 200, json_pack("{s:o}", "problems", list));
}

void show_problem(api_service *service, const http_request *request, http_response *response)
{
    (void)service;
    const problem_kind *kind = problem_kind_named(request->segment[0]);
    if (kind) http_respond_json(response, 200, problem_document(kind, response->base));
    else
        http_respond_problem(response, 404, NULL, "Not found", "there is no kind of problem \"%s\"; /problems lists them",
                             request->segment[0]);
}

/* The kinds of file a page is made of; anything else in the folder stays inside. NULL: not one of them. */
static const char *asset_type(const char *name)
{
    static const char *const types[][2] = {
        { ".html", "text/html; charset=utf-8" },
        { ".js", "text/javascript; charset=utf-8" },
        { ".css", "text/css; charset=utf-8" },
        { ".svg", "image/svg+xml" },
        { ".png", "image/png" },
        { ".ico", "image/x-icon" },
    };
    if (!isalnum((unsigned char)name[0])) return NULL;
    for (const char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("._-", *c)) return NULL;
    const char *extension = strrchr(name, '.');
    for (size_t i = 0; extension && i < sizeof types / sizeof types[0]; i++)
        if (strcmp(extension, types[i][0]) == 0) return types[i][1];
    return NULL;
}

static void send_asset(api_service *service, const http_request *request, http_response *response, const char *folder)
{
    const char *name = request->segment[0];
    const char *type = asset_type(name);
    char path[HTTP_SEGMENT_SIZE + 16];
    snprintf(path, sizeof path, "%s%s", folder, name);
    if (!type || !send_page_file(service, request, response, path, type))
        http_respond_problem(response, 404, NULL, "Not found", "the page has no file \"%s\"", name);
}

void show_asset(api_service *service, const http_request *request, http_response *response)
{
    send_asset(service, request, response, "");
}

/* Libraries of others that the page uses. */
void show_vendor_asset(api_service *service, const http_request *request, http_response *response)
{
    send_asset(service, request, response, "vendor/");
}

void show_health(api_service *service, const http_request *request, http_response *response)
{
    (void)service, (void)request;
    http_respond_json(response, 200, json_pack("{s:s, s:s}", "status", "ok", "version", REPOSED_VERSION));
}

void show_readiness(api_service *service, const http_request *request, http_response *response)
{
    (void)request;
    char why_not[200];
    if (service->is_ready(service->daemon, why_not, sizeof why_not))
        http_respond_json(response, 200, json_pack("{s:s}", "status", "ready"));
    else http_respond_problem(response, 503, NULL, "Not ready", "%s", why_not);
}

void show_metrics(api_service *service, const http_request *request, http_response *response)
{
    (void)request;
    text_buffer out;
    text_buffer_init(&out, 1 << 20);
    service->write_metrics(service->daemon, &out);
    if (out.failed) text_buffer_clear(&out);
    http_respond_text(response, 200, "text/plain; version=0.0.4; charset=utf-8", out.text, out.length);
}
