/* The service about itself: landing page, conformance, OpenAPI document, the page's files, health, metrics. */
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "handlers.h"
#include "openapi_outline.h"
#include "openapi_schemas.h"
#include "status_info.h"
#include "yaml_text.h"

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
        { "service-desc", "application/vnd.oai.openapi;version=3.1", "/api" },
        /* The types that clients in use know; JSON is YAML, too. */
        { "service-desc", "application/vnd.oai.openapi+json;version=3.0", "/api?f=json" },
        { "service-desc", "application/vnd.oai.openapi;version=3.0", "/api?f=json" },
        { "service-desc", "application/vnd.oai.openapi+json;version=3.1", "/api" },
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

/* A browser names text/html; curl's wildcard gets what a program can read. */
void show_landing(api_service *service, const http_request *request, http_response *response)
{
    if (!http_request_parameter(request, "f") && http_request_accepts(request, "text/html")
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
    static const char *const classes[] = { "core", "json", "job-list", "dismiss" };
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof classes / sizeof classes[0]; i++)
        json_array_append_new(list, json_sprintf("http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/%s", classes[i]));
    http_respond_json(response, 200, json_pack("{s:o}", "conformsTo", list));
}

static void show_outline(http_response *response)
{
    http_respond_json(response, 200, openapi_outline(response->base));
    response->content_type = "application/vnd.oai.openapi+json;version=3.0";
}

static void respond_json_document(http_response *response, const text_buffer *text)
{
    int line = 0;
    json_t *document = text->text ? yaml_read(text->text, text->length, &line) : NULL;
    if (!document) {
        http_respond_problem(response, 500, NULL, "No OpenAPI document", "line %d of the file of --api-file can't be read as YAML",
                             line);
        return;
    }
    http_respond_json(response, 200, document);
    response->content_type = "application/vnd.oai.openapi+json;version=3.1";
}

/* The file, with the schemas of this very program; where it has them already it is sent as it is. */
static void respond_document(const http_request *request, http_response *response, int file)
{
    static const char type[] = "application/vnd.oai.openapi;version=3.1";
    text_buffer read, whole;
    text_buffer_init(&whole, 4 << 20);
    const bool differs = openapi_read(file, &read) && read.text && openapi_write(read.text, read.length, &whole)
                         && (whole.length != read.length || memcmp(whole.text, read.text, read.length) != 0);
    const bool as_json =
        !http_request_accepts(request, "application/vnd.oai.openapi")
        && (http_request_accepts(request, "application/vnd.oai.openapi+json") || http_request_accepts(request, "application/json"));
    if (as_json) respond_json_document(response, differs ? &whole : &read);
    text_buffer_clear(&read);
    if (as_json) {
        close(file);
        text_buffer_clear(&whole);
        return;
    }
    if (differs) {
        close(file);
        http_respond_text(response, 200, type, whole.text, whole.length);
        return;
    }
    text_buffer_clear(&whole);
    http_respond_file(request, response, file, type, HTTP_FILE_CHANGING);
}

void show_api(api_service *service, const http_request *request, http_response *response)
{
    if (http_request_parameter(request, "f")) {
        show_outline(response);
        return;
    }
    const int file = open(service->api_file, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        http_respond_problem(response, 404, NULL, "No OpenAPI document", "the file of --api-file can't be read: %s",
                             strerror(errno));
    else respond_document(request, response, file);
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

void show_asset(api_service *service, const http_request *request, http_response *response)
{
    const char *name = request->segment[0];
    const char *type = asset_type(name);
    if (!type || !send_page_file(service, request, response, name, type))
        http_respond_problem(response, 404, NULL, "Not found", "the page has no file \"%s\"", name);
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
