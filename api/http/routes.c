#include "routes.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "checksum.h"

static bool path_fits(const char *pattern, const char *path, http_request *request)
{
    size_t filled = 0;
    while (*pattern && *path) {
        if (pattern[0] == '{') {
            const size_t length = strcspn(path, "/");
            assert(filled < HTTP_SEGMENTS); /* a pattern has no more */
            if (length == 0 || length >= HTTP_SEGMENT_SIZE) return false;
            memcpy(request->segment[filled], path, length);
            request->segment[filled++][length] = '\0';
            pattern += 2;
            path += length;
        } else if (*pattern++ != *path++) {
            return false;
        }
    }
    return *pattern == '\0' && *path == '\0';
}

static const char *allowed_methods(const char *method)
{
    if (strcmp(method, "GET") == 0) return "GET, HEAD";
    return method;
}

const http_route *routes_match(const http_route *table, size_t count, http_request *request, http_response *response)
{
    const char *method = strcmp(request->method, "HEAD") == 0 ? "GET" : request->method;
    char allowed[sizeof response->allow] = "";
    for (size_t i = 0; i < count; i++) {
        if (!path_fits(table[i].pattern, request->path, request)) continue;
        if (strcmp(table[i].method, method) == 0) return &table[i];
        const size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s", used ? ", " : "", allowed_methods(table[i].method));
    }
    if (allowed[0]) {
        http_respond_problem(response, 405, NULL, "Method not allowed", "%s allows %s", request->path, allowed);
        memcpy(response->allow, allowed, sizeof allowed);
    } else {
        http_respond_problem(response, 404, NULL, "Not found", "%.200s is no address of this service; / lists them", request->path);
    }
    return NULL;
}

/* Where the name stands in " limit status* ", with a star behind it where it may be given several times; NULL: nowhere. */
static const char *find_parameter(const char *known, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = known; length > 0 && (at = strstr(at, name)); at++)
        if (at > known && at[-1] == ' ' && strchr(" *", at[length]) && at[length]) return at + length;
    return NULL;
}

/* " label. " stands for all parameters that begin so. */
static const char *find_parameter_or_beginning(const char *known, const char *name)
{
    const char *end = find_parameter(known, name), *dot = strchr(name, '.');
    char beginning[16];
    if (end || !dot || !dot[1] || (size_t)(dot - name) + 2 > sizeof beginning) return end;
    snprintf(beginning, sizeof beginning, "%.*s", (int)(dot - name) + 1, name);
    return find_parameter(known, beginning);
}

/* " status* label. f " for people: " status label.NAME f". */
static void parameters_text(const char *known, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (const char *at = known; *at && used + sizeof ".NAME" < size; at++) {
        if (*at == '*' || (*at == ' ' && !at[1])) continue;
        used += (size_t)snprintf(text + used, size - used, "%c%s", *at, *at == '.' ? "NAME" : "");
    }
}

static void refuse_parameter(const http_route *route, const char *name, http_response *response)
{
    char known[300];
    parameters_text(route->parameters[0] ? route->parameters : " none", known, sizeof known);
    http_respond_problem(response, 400, NULL, "Unknown parameter", "query parameter \"%.40s\" is unknown here; known:%s", name,
                         known);
}

static bool is_given_before(const http_request *request, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (strcmp(request->parameter[k].name, request->parameter[i].name) == 0) return true;
    return false;
}

/* A misspelt filter would silently list everything; of two values one would silently not count. */
static bool parameters_are_good(const http_route *route, const http_request *request, http_response *response)
{
    const char *formats = route->formats ? route->formats : " json ";
    for (size_t i = 0; i < request->parameter_count; i++) {
        const char *name = request->parameter[i].name, *end = find_parameter_or_beginning(route->parameters, name);
        if (!end) refuse_parameter(route, name, response);
        else if (*end != '*' && is_given_before(request, i))
            http_respond_problem(response, 400, NULL, "Bad parameter", "query parameter \"%.40s\" is given twice", name);
        else if ((strcmp(name, "f") == 0 || strcmp(name, "format") == 0) && !find_parameter(formats, request->parameter[i].value))
            http_respond_problem(response, 400, NULL, "Bad parameter", "parameter %s is \"%.40s\"; must be one of:%s", name,
                                 request->parameter[i].value, formats);
        else continue;
        return false;
    }
    return true;
}

bool route_only_reads(const http_route *route, const http_request *request)
{
    char problem[160];
    bool dry = false;
    if (route->dry && !http_request_truth(request, route->dry, &dry, problem, sizeof problem)) return false;
    return dry || strcmp(request->method, "GET") == 0 || strcmp(request->method, "HEAD") == 0;
}

void route_set_base(const api_service *service, const http_request *request, http_response *response)
{
    const char *url = service->public_url;
    if (url) snprintf(response->base, sizeof response->base, "%.310s", url);
    else if (request->host) snprintf(response->base, sizeof response->base, "http://%.300s", request->host);
}

void route_strip_prefix(const api_service *service, http_request *request)
{
    const char *url = service->public_url, *host = url ? strstr(url, "://") : NULL;
    const char *prefix = host ? strchr(host + 3, '/') : NULL;
    const size_t length = prefix ? strlen(prefix) : 0;
    if (length == 0 || strncmp(request->path, prefix, length) != 0) return;
    if (request->path[length] == '/') request->path += length;
    else if (request->path[length] == '\0') request->path = "/";
}

/* What is answered from memory is named by its content, so that who has it already is not sent it again. */
static void name_content(const http_request *request, http_response *response)
{
    static const char json[] = "application/json", csv[] = "text/csv";
    const bool reads = strcmp(request->method, "GET") == 0 || strcmp(request->method, "HEAD") == 0;
    if (!reads || response->status != 200 || !response->body || response->pieces.context || response->etag[0]) return;
    if (strncmp(response->content_type, json, strlen(json)) != 0 && strncmp(response->content_type, csv, strlen(csv)) != 0) return;
    char version[20];
    snprintf(version, sizeof version, "%016llx", (unsigned long long)checksum_of(response->body, response->length));
    const bool has_it = http_respond_unchanged(request, response, version);
    response->cache_control = "private, no-cache";
    if (!has_it) return;
    free(response->body);
    response->body = NULL;
    response->length = 0;
}

void route_respond(const http_route *route, api_service *service, const http_request *request, http_response *response)
{
    route_set_base(service, request, response);
    if (parameters_are_good(route, request, response)) route->handler(service, request, response);
    name_content(request, response);
    if (response->location[0] != '/') return;
    const size_t length = strlen(response->location), before = strlen(response->base);
    if (length + before >= sizeof response->location) return;
    memmove(response->location + before, response->location, length + 1);
    memcpy(response->location, response->base, before);
}
