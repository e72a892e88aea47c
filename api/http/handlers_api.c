/* The OpenAPI document: 3.1 as it is written, or 3.0 for clients that read no other, each as YAML or JSON. By f it is 3.0,
 * unless the parameter version says otherwise; by Accept it is what that prefers. */
#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "handlers.h"
#include "http_accept.h"
#include "openapi_down.h"
#include "openapi_schemas.h"
#include "yaml_text.h"

enum { LONGEST_DOCUMENT = 8 << 20 };

typedef struct api_format {
    const char *accepted; /* media type as clients ask for it */
    bool is_json, is_old; /* old: 3.0 */
} api_format;

static const api_format formats[] = {
    { "application/vnd.oai.openapi;version=3.1", false, false },
    { "application/vnd.oai.openapi+json;version=3.1", true, false },
    { "application/vnd.oai.openapi;version=3.0", false, true },
    { "application/vnd.oai.openapi+json;version=3.0", true, true },
    { "application/json", true, false },
    { "application/yaml", false, false },
    { "application/x-yaml", false, false },
    { "text/yaml", false, false },
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

/* False: the parameter version is another, and the response says so. */
static bool choose(const http_request *request, http_response *response, api_format *chosen)
{
    const char *f = http_request_parameter(request, "f"), *version = http_request_parameter(request, "version");
    const char *offers[FORMATS];
    for (size_t i = 0; i < FORMATS; i++) offers[i] = formats[i].accepted;
    *chosen = formats[http_accept_choose(request->accept, offers, FORMATS)];
    if (f) *chosen = (api_format){ .is_json = strcmp(f, "json") == 0, .is_old = true };
    if (version) chosen->is_old = strcmp(version, "3.0") == 0;
    if (!version || chosen->is_old || strcmp(version, "3.1") == 0) return true;
    http_respond_problem(response, 400, NULL, "Bad parameter", "parameter version is \"%.40s\"; must be 3.0 or 3.1", version);
    return false;
}

static const char *media_type(const api_format *format)
{
    for (size_t i = 0; i < FORMATS; i++)
        if (formats[i].is_json == format->is_json && formats[i].is_old == format->is_old) return formats[i].accepted;
    return formats[0].accepted;
}

/* Another form of the text that the file has. server: where the addresses are; NULL: as the file says. */
static void respond_made(http_response *response, const text_buffer *text, const api_format *format, const char *server)
{
    assert(response);
    int line = 0;
    json_t *document = text->text ? yaml_read(text->text, text->length, &line) : NULL;
    if (!document) {
        http_respond_problem(response, 500, NULL, "No OpenAPI document", "line %d of the file of --api-file can't be read as YAML",
                             line);
        return;
    }
    if (format->is_old) openapi_turn_down(document);
    if (server) json_object_set_new(document, "servers", json_pack("[{s:s}]", "url", server));
    if (format->is_json) {
        http_respond_json(response, 200, document);
    } else {
        text_buffer out;
        text_buffer_init(&out, LONGEST_DOCUMENT);
        if (!yaml_write_members(&out, document, 0)) text_buffer_clear(&out);
        json_decref(document);
        http_respond_text(response, 200, NULL, out.text, out.length);
    }
    response->content_type = media_type(format);
}

/* The file, with the schemas of this very program; where it has them already it is sent as it is. */
static void respond_document(const api_service *service, const http_request *request, http_response *response, int file,
                             const api_format *format)
{
    text_buffer read, whole;
    text_buffer_init(&whole, LONGEST_DOCUMENT);
    const bool differs = openapi_read(file, &read) && read.text && openapi_write(read.text, read.length, &whole)
                         && (whole.length != read.length || memcmp(whole.text, read.text, read.length) != 0);
    const char *url = service->public_url;
    if (format->is_json || format->is_old || url) {
        respond_made(response, differs ? &whole : &read, format, format->is_old ? response->base : url);
    } else if (differs) {
        http_respond_text(response, 200, media_type(format), whole.text, whole.length);
        whole.text = NULL;
    } else {
        http_respond_file(request, response, file, media_type(format), HTTP_FILE_CHANGING);
        file = -1;
    }
    if (file >= 0) close(file);
    text_buffer_clear(&whole);
    text_buffer_clear(&read);
}

void show_api(api_service *service, const http_request *request, http_response *response)
{
    api_format format;
    if (!choose(request, response, &format)) return;
    const int file = open(service->api_file, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        http_respond_problem(response, 404, NULL, "No OpenAPI document", "the file of --api-file can't be read: %s",
                             strerror(errno));
    else respond_document(service, request, response, file, &format);
}
